#include "apps/page/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace bandlimit::app {
namespace {

using Color = std::array<double, 3>;
constexpr Color no_number{0, 0.8, 0.2};

/// Between colours at equal distances; t from 0 to 1.
template <std::size_t N>
Color between(const std::array<Color, N>& colors, double t) {
    const double at = std::clamp(t, 0.0, 1.0) * (N - 1);
    const auto i = std::min(static_cast<std::size_t>(at), N - 2);
    const double share = at - static_cast<double>(i);
    Color color{};
    for (std::size_t c = 0; c < 3; ++c) color[c] = (1 - share) * colors[i][c] + share * colors[i + 1][c];
    return color;
}

Color ramp(double t) {
    constexpr std::array<Color, 6> colors{
        {{0, 0, 0}, {0.22, 0.06, 0.40}, {0.55, 0.13, 0.42}, {0.87, 0.30, 0.22}, {0.98, 0.62, 0.10}, {1, 0.97, 0.70}}};
    return between(colors, t);
}

Color divergence(double t) {
    constexpr std::array<Color, 5> colors{
        {{0.03, 0.19, 0.42}, {0.40, 0.66, 0.85}, {1, 1, 1}, {0.96, 0.60, 0.36}, {0.50, 0.03, 0.10}}};
    return between(colors, 0.5 + t / 2);
}

/// A hue at an angle of the full circle 1, of full strength.
Color hue(double turn) {
    Color color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double distance = std::abs(std::remainder(turn - static_cast<double>(c) / 3, 1.0));
        color[c] = std::clamp(2 - 6 * distance, 0.0, 1.0);
    }
    return color;
}

template <class ColorAt>
Image<float> painted(int width, int height, const ColorAt& color_at) {
    Image<float> picture(width, height, 3, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Color color = color_at(x, y);
            for (int c = 0; c < 3; ++c)
                picture.view()(x, y, c) = static_cast<float>(color[static_cast<std::size_t>(c)]);
        }
    return picture;
}

double length_at(View<const float> values, int x, int y) {
    double square = 0;
    for (int c = 0; c < values.channels; ++c) square += std::pow(static_cast<double>(values(x, y, c)), 2);
    return std::sqrt(square);
}

}  // namespace

Image<float> ramp_of(View<const float> values, double peak) {
    return painted(values.width, values.height, [&](int x, int y) {
        const auto v = static_cast<double>(values(x, y));
        return std::isfinite(v) ? ramp(v / peak) : no_number;
    });
}

Image<float> divergence_of(View<const float> values, double peak) {
    return painted(values.width, values.height, [&](int x, int y) {
        const auto v = static_cast<double>(values(x, y));
        return std::isfinite(v) ? divergence(v / peak) : no_number;
    });
}

Image<float> directions_of(View<const float> vectors, double peak) {
    return painted(vectors.width, vectors.height, [&](int x, int y) {
        const double length = length_at(vectors, x, y);
        if (!std::isfinite(length)) return no_number;
        const double angle = std::atan2(static_cast<double>(vectors(x, y, 1)), static_cast<double>(vectors(x, y, 0)));
        Color color = hue(angle / (2 * std::numbers::pi));
        for (double& v : color) v *= std::min(1.0, length / peak);
        return color;
    });
}

double peak_of(View<const float> values, double share, double least) {
    std::vector<double> lengths;
    for (int y = 0; y < values.height; ++y)
        for (int x = 0; x < values.width; ++x)
            if (const double length = length_at(values, x, y); std::isfinite(length)) lengths.push_back(length);
    if (lengths.empty()) return least;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(lengths.size() - 1));
    std::nth_element(lengths.begin(), lengths.begin() + at, lengths.end());
    return std::max(least, lengths[static_cast<std::size_t>(at)]);
}

}  // namespace bandlimit::app
