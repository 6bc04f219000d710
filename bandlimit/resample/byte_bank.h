// Weights as integers, for codes of 8 bits.
// Stability: inner.
#pragma once
#include <cstdint>
#include <vector>

#include "bandlimit/core/view.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// The weights of a Bank in multiples of 2^-bits: what filters of 8-bit codes run on.
///
/// Each row is rounded so that its sum is that of the bank, rounded once: a constant stays constant to the code. All
/// that is decided for a row depends on its weights alone, so that parts of an image have the bits of the whole.
struct ByteBank {
    const Bank* bank = nullptr;         ///< where the rows lie; must outlive this
    std::vector<int> bits;              ///< of each row of the bank; 0: sums could leave 16 bits, so floats must do it
    std::vector<std::int16_t> weights;  ///< in the places of bank->weights; 0 for rows of no bits

    int bits_of(int output) const {
        return bits[static_cast<std::size_t>(bank->outputs[static_cast<std::size_t>(output)].row)];
    }
    bool fits(int output) const { return bits_of(output) > 0; }
    std::span<const std::int16_t> row(int output) const {
        const Bank::Row& r = bank->row_info(output);
        return std::span(weights).subspan(r.offset, static_cast<std::size_t>(r.count));
    }
};

/// What both axes need to run in integers.
struct ByteBanks {
    ByteBank x, y;
};

/// The integer forms of a pair of banks. Rows do not fit where their magnitudes add up to more than 1.9, as those of
/// taps that sharpen or differentiate may, or what Edge::renormalize makes of a few weights beside the image.
ByteBanks make_byte_banks(const Bank& x, const Bank& y);

/// Calls visit(begin, end, fits) for the longest runs of the outputs [first, last) that all fit, or all do not.
template <class Visit>
void for_each_run(const ByteBank& bank, int first, int last, Visit visit) {
    for (int begin = first, end = first; begin < last; begin = end) {
        while (end < last && bank.fits(end) == bank.fits(begin)) ++end;
        visit(begin, end, bank.fits(begin));
    }
}

/// The definition of resampling 8-bit codes, y before x: plain loops, one thread.
///
/// t[x] = (sum_j y.row[j] * code[j] + half) >> (y.bits - 6), which keeps 6 bits of fraction, then
/// out = (sum_j x.row[j] * t[j] + half) >> (x.bits + 6), clamped to 0..255; half is 1/2 of what the shift makes 1.
/// Outputs whose row along x or y does not fit are left as they are.
///
/// shapes   src [x.inputs x rows x c] holds the stored rows from first_source on that the outputs read, dst
///          [x outputs x rows x c] the output rows from first_target on
/// error    at most 1 code from the nearest code of the exact sum; about 1 code in 200 differs from it
void resize_bytes_scalar(const ByteBanks& banks, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                         int first_target);

}  // namespace bandlimit
