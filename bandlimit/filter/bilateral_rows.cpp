#include "bandlimit/filter/bilateral_rows.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace bandlimit {
namespace {

/// The squared distance in range of the sample at `offset` from output x.
float squared_range(const BilateralRow& row, std::ptrdiff_t offset, int x) {
    float sum = 0;
    for (int c = 0; c < row.guides; ++c) {
        const float* const guide = row.guide + c * row.plane;
        const float t = (guide[offset + x] - (c == 0 ? row.centre : guide)[x]) * row.scales[c];
        sum = c == 0 ? t * t : std::fma(t, t, sum);
    }
    return sum;
}

/// Sums are kept per row of the window first, so that they stay accurate however large it is. Differences from the middle
/// sample are what is weighted: a constant stays what it is.
float mean_at(const BilateralRow& row, int signal, int x) {
    const float* const samples = row.signal + signal * row.plane;
    const float middle = samples[x];
    const float* space = row.space;
    float weights = 0, sum = 0;
    for (int j = -row.radius_y; j <= row.radius_y; ++j) {
        float row_weights = 0, row_sum = 0;
        for (int i = -row.radius_x; i <= row.radius_x; ++i) {
            const std::ptrdiff_t offset = j * row.row + i;
            const float weight = *space++ * falloff(squared_range(row, offset, x));
            row_weights += weight;
            row_sum = std::fma(weight, samples[offset + x] - middle, row_sum);
        }
        weights += row_weights;
        sum += row_sum;
    }
    return middle + sum / weights;
}

}  // namespace

double range_scale(double sigma) {
    constexpr auto least = static_cast<double>(std::numeric_limits<float>::min());
    constexpr auto most = static_cast<double>(std::numeric_limits<float>::max());
    return std::clamp(std::sqrt(std::numbers::log2e / 2) / sigma, least, most);
}

void bilateral_row_scalar(const BilateralRow& row) {
    for (int c = 0; c < row.signals; ++c)
        for (int x = 0; x < row.width; ++x) row.out[c * row.out_plane + x] = mean_at(row, c, x);
}

}  // namespace bandlimit
