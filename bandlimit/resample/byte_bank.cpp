#include "bandlimit/resample/byte_bank.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bandlimit/core/overlap.h"

namespace bandlimit {
namespace {

constexpr double largest_sum = 1.9;  // 255 codes with 6 bits of fraction then stay below 2^15

std::span<const float> row_of(const Bank& bank, const Bank::Row& row) {
    return std::span(bank.weights).subspan(row.offset, static_cast<std::size_t>(row.count));
}

bool fits(std::span<const float> row) {
    double sum = 0;
    for (const float w : row) sum += std::abs(double{w});
    return sum <= largest_sum;
}

/// The largest sum of the magnitudes of two adjacent weights.
double largest_pair(std::span<const float> row) {
    double largest = 0, before = 0;
    for (const float w : row) {
        const double magnitude = std::abs(double{w});
        largest = std::max(largest, before + magnitude);
        before = magnitude;
    }
    return largest;
}

int bits_along_x(std::span<const float> row) { return fits(row) ? 14 : 0; }

/// A weight is split in two signed bytes, and products of two rows are added up in 16 bits where the machine has no
/// wider sums: two adjacent weights must not reach 1, or 2 with one bit less.
int bits_along_y(std::span<const float> row) { return !fits(row) ? 0 : largest_pair(row) < 0.99 ? 14 : 13; }

/// Rounds down first; then the weights that lost most get back what the sum lacks (the method of largest remainders).
void quantize(std::span<const float> row, double one, std::int16_t* out) {
    std::vector<double> lost(row.size());
    double sum = 0;
    int floors = 0;
    for (std::size_t j = 0; j < row.size(); ++j) {
        const double exact = double{row[j]} * one, whole = std::floor(exact);
        out[j] = static_cast<std::int16_t>(whole);
        lost[j] = exact - whole;
        sum += exact;
        floors += static_cast<int>(whole);
    }
    std::vector<std::size_t> order(row.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lost[a] > lost[b]; });
    const int lacking = static_cast<int>(std::lround(sum)) - floors;
    for (int k = 0; k < lacking; ++k) ++out[order[static_cast<std::size_t>(k)]];
}

ByteBank make_byte_bank(const Bank& bank, int (*bits_along)(std::span<const float>)) {
    ByteBank result{&bank, {}, std::vector<std::int16_t>(bank.weights.size())};
    for (const Bank::Row& info : bank.rows) {
        const std::span<const float> row = row_of(bank, info);
        const int bits = bits_along(row);
        result.bits.push_back(bits);
        if (bits > 0) quantize(row, std::ldexp(1.0, bits), result.weights.data() + info.offset);
    }
    return result;
}

/// floor(sum / 2^shift + 1/2)
int rounded(int sum, int shift) { return (sum + (1 << (shift - 1))) >> shift; }

}  // namespace

ByteBanks make_byte_banks(const Bank& x, const Bank& y) {
    return {make_byte_bank(x, bits_along_x), make_byte_bank(y, bits_along_y)};
}

void resize_bytes_scalar(const ByteBanks& banks, View<const std::uint8_t> src, int first_source, View<std::uint8_t> dst,
                         int first_target) {
    check_apart("resize_bytes_scalar", src, dst);
    const Bank &x = *banks.x.bank, &y = *banks.y.bank;
    std::vector<int> column(static_cast<std::size_t>(src.width));
    const auto along_y = [&](int v, int i, int c) {
        int sum = 0;
        const std::span<const std::int16_t> row = banks.y.row(i);
        for (int j = 0; j < static_cast<int>(row.size()); ++j)
            sum +=
                row[static_cast<std::size_t>(j)] * src(v, resolve(y.first(i) + j, y.inputs, y.edge) - first_source, c);
        return rounded(sum, banks.y.bits_of(i) - 6);
    };
    for (int c = 0; c < dst.channels; ++c)
        for (int i = 0; i < dst.height; ++i) {
            if (!banks.y.fits(first_target + i)) continue;
            for (int v = 0; v < src.width; ++v) column[static_cast<std::size_t>(v)] = along_y(v, first_target + i, c);
            for (int k = 0; k < dst.width; ++k) {
                if (!banks.x.fits(k)) continue;
                int sum = 0;
                const std::span<const std::int16_t> row = banks.x.row(k);
                for (int j = 0; j < static_cast<int>(row.size()); ++j) {
                    const int v = resolve(x.first(k) + j, x.inputs, x.edge);
                    sum += row[static_cast<std::size_t>(j)] * column[static_cast<std::size_t>(v)];
                }
                dst(k, i, c) = static_cast<std::uint8_t>(std::clamp(rounded(sum, banks.x.bits_of(k) + 6), 0, 255));
            }
        }
}

}  // namespace bandlimit
