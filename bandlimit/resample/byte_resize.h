// Resampling of 8-bit codes in integers.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/core/view.h"
#include "bandlimit/resample/byte_bank.h"
#include "bandlimit/resample/byte_combine.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// Output columns [first, last) that are computed from top to bottom before the next ones, so that the source rows stay
/// in the second cache, however wide the image is.
struct ByteStrip {
    int first = 0, last = 0;
    IndexRange read;    ///< the source columns read; may reach outside the image
    IndexRange stored;  ///< those that exist, and those that others outside resolve to, from an even one on
};

/// What resize_bytes() needs to know about a pair of banks.
struct BytePlan {
    ByteBanks banks;
    BytePairs pairs;
    std::vector<ByteStrip> strips_of_one, strips_of_four;  ///< of columns that fit, for pixels of one and four samples
    int origin = 0;                                        ///< of the groups of four rows
    bool is_half_box = false;
};
BytePlan make_byte_plan(const ByteBanks& banks);

/// Computes rows [begin, end) of the output, which must all fit integers, in one thread: the codes of
/// resize_bytes_scalar(). Columns that do not fit are left as they are. The monitor hears of what is made.
///
/// shapes   src holds the stored rows from first_source on that the outputs read, dst the output rows from first_target
///          on; any strides, any number of channels
/// memory   of one strip, the source rows that 8 output rows read, 32 where a channel runs by itself, and 16 bits per
///          sample of so many rows: about 1 MiB
/// cost     to half by 12 taps about 1.8 times that of reading and writing memory for four channels side by side;
///          2 and 3 run as 4
void resize_bytes(const BytePlan& plan, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                  int first_target, int begin, int end, RunMonitor& monitor);

}  // namespace bandlimit
