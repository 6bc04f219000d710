// The weights of kernels of the distance.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/kernel/kernel.h"

namespace bandlimit {

/// Weights of a radial kernel on the grid of the source: sample (first_x + i, first_y + j) has weights[j * width + i].
struct RadialWeights {
    int first_x = 0, first_y = 0, width = 0, height = 0;
    std::vector<double> weights;  ///< sum 1
    double sum = 1;               ///< their sum before that
};

/// What an output reads that lies (phase_x, phase_y) to the right of and below sample (0, 0), at equal pitches.
/// Throws Error for a kernel that is not radial, or where the weights sum to 0.
RadialWeights radial_weights_at(const Kernel& kernel, double phase_x, double phase_y);

}  // namespace bandlimit
