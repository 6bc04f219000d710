// Discrete weights that are the same for every output.
// Stability: stable.
#pragma once
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace bandlimit {

/// Shift-invariant weights: out[i] = sum_j weights[j] * in[i * factor + first + j].
///
/// `factor` >= 1 input samples lie under one output sample, whose position is therefore (factor - 1) / 2 samples to the
/// right of input sample i * factor: taps that are symmetric about that point have zero phase.
struct Taps {
    int first = 0;
    std::vector<double> weights;
    int factor = 1;
};

/// Where the output of `taps` lies, in input samples relative to input sample i * factor.
inline double output_offset(const Taps& taps) { return (taps.factor - 1) / 2.0; }

/// Whether weights of this sum, and this sum of magnitudes, cancel: nothing is to be divided by such a sum, which is
/// mostly what rounding left of it (floats round each weight by up to 6e-8). The one rule, for all that normalises.
inline bool cancels(double sum, double magnitude) { return !(std::abs(sum) > 1e-6 * magnitude); }
inline bool cancels(std::span<const double> weights) {
    double sum = 0, magnitude = 0;
    for (const double w : weights) sum += w, magnitude += std::abs(w);
    return cancels(sum, magnitude);
}

}  // namespace bandlimit
