// The weights by which the history is read between its samples.
// Stability: inner.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "bandlimit/antialias/temporal.h"

namespace bandlimit {

/// The weights of four samples -1, 0, 1, 2, for a place t in [0, 1) from sample 0, as cubic polynomials of t in each of
/// so many equal parts of [0, 1): by powers of the way through the part, the weights of all four samples. They sum to 1,
/// and for t = 0 all kernels but bspline read sample 0 alone.
using CubicPart = std::array<std::array<float, 4>, 4>;

/// One part where the kernel itself is cubic; for lanczos2, of sum 1, so many that the error is below 1e-6. Lives for
/// ever.
std::span<const CubicPart> history_weights(HistoryKernel kernel);

}  // namespace bandlimit
