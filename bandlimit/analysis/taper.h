// Windows that fade an image out towards its borders.
// Stability: inner.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

namespace bandlimit {

/// The Hann window at the centres of `count` cells: sin^2(pi (i + 1/2) / count), symmetric, nowhere 0; 1 for one cell.
inline std::vector<double> hann(int count) {
    std::vector<double> weights;
    for (int i = 0; i < count; ++i) {
        const double s = std::sin(std::numbers::pi * (i + 0.5) / count);
        weights.push_back(s * s);
    }
    return weights;
}

}  // namespace bandlimit
