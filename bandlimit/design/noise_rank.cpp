#include "bandlimit/design/noise_rank.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

/// The median of the Marchenko-Pastur distribution: of the squared singular values of white noise of variance
/// 1 / columns, where there are ratio <= 1 times as many rows. With x = 1 + ratio - 2 sqrt(ratio) cos(t) its density is
/// smooth in t.
double median_of_noise(double ratio) {
    const auto x = [=](double t) { return 1 + ratio - 2 * std::sqrt(ratio) * std::cos(t); };
    const auto density = [&](double t) { return 2 / std::numbers::pi * std::pow(std::sin(t), 2) / x(t); };
    double low = 0, high = std::numbers::pi;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (integrate(density, 0, middle, 16) < 0.5 ? low : high) = middle;
    }
    return x(low);
}

}  // namespace

double noise_threshold(int rows, int columns) {
    if (rows < 1 || columns < 1) fail("noise_threshold: ", rows, " x ", columns, "; pass at least 1 x 1");
    const double ratio = static_cast<double>(std::min(rows, columns)) / std::max(rows, columns);
    const double root = std::sqrt(ratio * ratio + 14 * ratio + 1);
    return std::sqrt((2 * (ratio + 1) + 8 * ratio / (ratio + 1 + root)) / median_of_noise(ratio));
}

int rank_above_noise(std::span<const double> values, int rows, int columns) {
    const double factor = noise_threshold(rows, columns);
    const auto count = static_cast<std::size_t>(std::min(rows, columns));
    if (values.size() != count)
        fail("rank_above_noise: ", values.size(), " values of ", rows, " x ", columns, "; pass ", count);
    const double median = (values[(count - 1) / 2] + values[count / 2]) / 2;
    const auto above = std::count_if(values.begin(), values.end(), [&](double v) { return v > factor * median; });
    return std::clamp(static_cast<int>(above), 1, std::max(1, numerical_rank(values, rows, columns)));
}

}  // namespace bandlimit
