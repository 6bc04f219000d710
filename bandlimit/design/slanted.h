// Kernels as two one-dimensional passes, of which one or both run at a slant.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/kernel/taps.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// A step from one tap to the next, in samples, y down.
struct Step {
    double x = 1, y = 0;
};

/// out(p) = sum_j taps.weights[j] * in(p + (taps.first + j) * step), where `in` is read linearly between samples, as
/// texture units do.
struct SlantedPass {
    Step step;
    Taps taps;
};

/// One pass after the other; their order does not matter but at edges.
struct SlantedPasses {
    SlantedPass first, second;
};

/// The weights that `passes` come to on a grid of this size, centred as terms are; what lies beyond is left out.
/// throws   Error for sizes < 1
WeightGrid expanded(const SlantedPasses& passes, int width, int height);

/// The middle and the spread of the squares of weights, in samples: squares, as noise beside a kernel counts little
/// then, and negative weights as positive ones.
struct PrincipalAxes {
    double x = 0, y = 0;            ///< the middle, from the first sample of the first row
    double xx = 0, xy = 0, yy = 0;  ///< covariance
    double degrees = 0;             ///< of the longer axis, from x towards y, in (-90, 90]
    double along = 0, across = 0;   ///< standard deviations, along >= across
};

/// throws   Error if all weights are 0 or one is not finite
PrincipalAxes principal_axes(const WeightGrid& kernel);

struct SlantedFit {
    SlantedPasses passes;
    int rank = 0;      ///< pairs of such passes that would hold 99.9 % of the energy of the kernel read at these steps
    double error = 0;  ///< sum of squared differences to the kernel, over the sum of its squares; also beyond its grid
};

/// Passes with these steps whose weights come as near to `kernel` as may be, by alternating least squares.
///
/// error    linear reads blur a little where a step is not a whole number: about 1e-3 for kernels a few samples wide
/// throws   Error for steps that are parallel or shorter than 1/2, a kernel of more than 128 samples to a side, and as
///          principal_axes
SlantedFit fit_slanted(const WeightGrid& kernel, const Step& first, const Step& second);

/// The best of three pairs of steps that the covariance suggests: along rows and slanted against them, along columns
/// and slanted against them, along both principal axes. The first two are exact, apart from the reads' blur, for every
/// Gaussian and every box skewed so, f(x - s y) g(y) where s = xy / yy: slanted by s per row (Geusebroek, Smeulders &
/// van de Weijer 2003, "Fast anisotropic Gauss filtering").
SlantedFit fit_slanted(const WeightGrid& kernel);

}  // namespace bandlimit
