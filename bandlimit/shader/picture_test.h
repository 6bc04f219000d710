// Procedural textures, and what a sampler reads from them, in double.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bandlimit/color/half.h"
#include "bandlimit/core/axis.h"
#include "bandlimit/core/edge.h"

namespace bandlimit::test {

using Colour = std::array<double, 4>;

/// The edges that samplers have: clamp to edge, repeat, mirrored repeat, and a border of zeros.
inline constexpr std::array sampler_edges{Edge::clamp, Edge::wrap, Edge::reflect, Edge::zero};

/// An RGBA texture whose values, multiples of 1/1024, are exact in half and in float.
struct Picture {
    int width = 0, height = 0;
    std::vector<float> texels;  // RGBA, row after row

    Colour texel(int x, int y, Edge edge) const {
        const int i = resolve(x, width, edge), j = resolve(y, height, edge);
        if (i < 0 || j < 0) return {};
        const float* p = texels.data() + (static_cast<std::ptrdiff_t>(j) * width + i) * 4;
        return {p[0], p[1], p[2], p[3]};
    }
};

/// Smooth waves and noise, different in each channel and for each `seed`.
inline Picture procedural(int width, int height, std::uint32_t seed) {
    Picture p{width, height, {}};
    std::uint32_t state = seed * 2654435761u + 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) {
                state = state * 1664525u + 1013904223u;
                const double noise = (state >> 8) / double(1 << 24);
                const double wave = 0.5 + 0.5 * std::sin(0.31 * (c + 1) * x + 0.23 * (4 - c) * y + seed);
                p.texels.push_back(static_cast<float>(std::floor((0.6 * wave + 0.4 * noise) * 1024) / 1024));
            }
    return p;
}

/// Its texels as GPUs get them, exactly.
inline std::vector<Half> halves_of(const Picture& picture) {
    std::vector<Half> out;
    for (const float v : picture.texels) out.push_back(to_half(v));
    return out;
}

/// The same as bytes, or its floats as they are.
inline std::string bytes_of(const Picture& picture, bool as_floats) {
    if (as_floats) return {reinterpret_cast<const char*>(picture.texels.data()), picture.texels.size() * sizeof(float)};
    const std::vector<Half> halves = halves_of(picture);
    return {reinterpret_cast<const char*>(halves.data()), halves.size() * sizeof(Half)};
}

inline double largest_step(const Colour& a, const Colour& b) {
    double step = 0;
    for (std::size_t c = 0; c < 4; ++c) step = std::max(step, std::abs(a[c] - b[c]));
    return step;
}

/// The largest difference of horizontal and of vertical neighbours, added, among the texels within `reach` of what a
/// linear read at (x, y) reads: how much a read changes per texel that its position changes.
inline double slope(const Picture& p, Edge edge, double x, double y, int reach) {
    const int i0 = static_cast<int>(std::floor(Axis{p.width, 0, double(p.width)}.index(x))) - reach;
    const int j0 = static_cast<int>(std::floor(Axis{p.height, 0, double(p.height)}.index(y))) - reach;
    const int n = 2 * reach + 2;
    double across = 0, down = 0;
    for (int j = j0; j < j0 + n; ++j)
        for (int i = i0; i < i0 + n; ++i) {
            const Colour here = p.texel(i, j, edge);
            if (i + 1 < i0 + n) across = std::max(across, largest_step(here, p.texel(i + 1, j, edge)));
            if (j + 1 < j0 + n) down = std::max(down, largest_step(here, p.texel(i, j + 1, edge)));
        }
    return across + down;
}

inline void add(Colour& sum, double weight, const Colour& value) {
    for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * value[c];
}

/// What an exact bilinear sampler reads at (x, y), in texels. With `bits` > 0 its fractions are rounded to so many, as
/// those of GPUs are.
inline Colour bilinear(const Picture& p, Edge edge, double x, double y, int bits = 0) {
    const auto rounded = [&](double v) { return bits > 0 ? std::round(std::ldexp(v, bits)) / std::ldexp(1, bits) : v; };
    const double i = rounded(Axis{p.width, 0, double(p.width)}.index(x));
    const double j = rounded(Axis{p.height, 0, double(p.height)}.index(y));
    const int i0 = static_cast<int>(std::floor(i)), j0 = static_cast<int>(std::floor(j));
    const double s = i - i0, t = j - j0;
    Colour sum{};
    add(sum, (1 - s) * (1 - t), p.texel(i0, j0, edge));
    add(sum, s * (1 - t), p.texel(i0 + 1, j0, edge));
    add(sum, (1 - s) * t, p.texel(i0, j0 + 1, edge));
    add(sum, s * t, p.texel(i0 + 1, j0 + 1, edge));
    return sum;
}

}  // namespace bandlimit::test
