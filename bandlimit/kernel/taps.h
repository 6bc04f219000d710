// Discrete weights that are the same for every output.
#pragma once
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

}  // namespace bandlimit
