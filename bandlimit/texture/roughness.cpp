#include "bandlimit/texture/roughness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandlimit {

float roughness_variance(float roughness) {
    const float alpha = roughness * roughness;
    return alpha * alpha;
}

float roughness_of_variance(float variance) {
    if (std::isnan(variance)) return variance;
    return std::sqrt(std::sqrt(std::clamp(variance, 0.0f, 1.0f)));
}

float lost_variance(float mean_length) {
    const float r = std::min(mean_length, 1.0f), spread = (1 - r) * (1 + r) - 0x1p-20f;
    if (spread <= 0) return 0;
    if (r <= 0) return std::numeric_limits<float>::infinity();
    return 2 * spread / (r * (3 - r * r));
}

void lost_variances(View<const float> means, int y, std::span<float> row) {
    for (int x = 0; x < means.width; ++x) {
        const float a = means(x, y, 0), b = means(x, y, 1), c = means(x, y, 2);
        row[static_cast<std::size_t>(x)] = lost_variance(std::sqrt(a * a + b * b + c * c));
    }
}

}  // namespace bandlimit
