// Numbers that look random and belong to a cell of a grid.
// Stability: inner.
#pragma once
#include <cmath>
#include <cstdint>

#include "bandlimit/math/random.h"

namespace bandlimit {

/// 64 bits for the cell (i, j) of the grid number `salt`.
inline std::uint64_t hash_bits(std::int64_t i, std::int64_t j, std::uint64_t salt = 0) {
    return Random(static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15u ^
                  Random(static_cast<std::uint64_t>(j) + (salt << 32)).bits())
        .bits();
}
/// Uniform in [0, 1).
inline double hash_unit(std::int64_t i, std::int64_t j, std::uint64_t salt = 0) {
    return static_cast<double>(hash_bits(i, j, salt) >> 11) * 0x1p-53;
}

/// Smooth noise in [0, 1): random values at whole numbers, between them interpolated without a jump of the slope.
inline double smooth_noise(double x, double y, std::uint64_t salt = 0) {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const double u = ease(x - fx), v = ease(y - fy);
    const double top = hash_unit(i, j, salt) * (1 - u) + hash_unit(i + 1, j, salt) * u;
    const double bottom = hash_unit(i, j + 1, salt) * (1 - u) + hash_unit(i + 1, j + 1, salt) * u;
    return top * (1 - v) + bottom * v;
}

/// The whole part of x modulo 2: 0 or 1.
inline int parity(double x) { return static_cast<int>(static_cast<std::int64_t>(std::floor(x)) & 1); }

}  // namespace bandlimit
