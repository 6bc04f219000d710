#include "bandlimit/resample/combine.h"

#include <cmath>

#ifdef __FAST_MATH__
#error "bandlimit needs IEEE arithmetic: results are defined to the bit, and NaN is data. Compile without -ffast-math."
#endif

namespace bandlimit {
namespace {

/// Written with comparisons, not std::min, so that NaN takes the same path as in the vector form. What lies within the
/// range keeps its bits, and an antiring of 1 gives the limit to the last one.
float limited(float sum, const float* const* near, int count, std::size_t k, float antiring) {
    float low = near[0][k], high = low;
    for (int j = 1; j < count; ++j) {
        const float x = near[j][k];
        low = x < low ? x : low;
        high = high < x ? x : high;
    }
    const float clamped = sum < low ? low : high < sum ? high : sum;
    return clamped == sum ? sum : std::fma(antiring, clamped, (1 - antiring) * sum);
}

}  // namespace

void combine_scalar(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out,
                    std::size_t length) {
    for (int i = begin; i < end; ++i) {
        const std::span<const float> row = bank.row(i);
        const Bank::Row& info = bank.row_info(i);
        const float* const* taps = lines + bank.first(i);
        for (std::size_t k = 0; k < length; ++k) {
            float sum = row[0] * taps[0][k];
            for (std::size_t j = 1; j < row.size(); ++j) sum = std::fma(row[j], taps[j][k], sum);
            if (antiring > 0) sum = limited(sum, taps + info.near_begin, info.near_count, k, antiring);
            out[i - begin][k] = sum;
        }
    }
}

}  // namespace bandlimit
