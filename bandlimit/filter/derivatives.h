// Operators that differentiate pictures, in units in which a ramp of slope 1 has gradient 1.
//
// Positions are relative to the sample (x, y) that an output is stored at: x runs right and y down, so that dx is above 0
// where values grow to the right and dy where they grow downward.
// Stability: evolving.
#pragma once
#include <string>
#include <string_view>
#include <variant>

#include "bandlimit/kernel/taps.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// Where a derivative is taken, in samples to the right of and below (x, y).
struct GradientPosition {
    double x = 0, y = 0;
};

/// First derivatives: dx has `along` in x and `across` in y, and dy has them the other way round.
struct Gradient {
    std::string name;
    Taps along;   ///< sums to 0
    Taps across;  ///< sums to 1
    /// Gradients are averaged by these along both axes, and magnitudes and tensors are those of the average of their
    /// squares: what cancels in the mean of gradients still counts.
    Taps mean = {0, {1}, 1};
};

/// The sum of both second derivatives: `terms` centred on the sample. A parabola x^2 / 2 becomes 1.
struct Laplacian {
    std::string name;
    Terms terms;
};

using DerivativeOperator = std::variant<Gradient, Laplacian>;

/// The operator that `text` names:
///
///     forward      f(x + 1) - f(x); dx at (1/2, 0), dy at (0, 1/2)
///     central      (f(x + 1) - f(x - 1)) / 2; at (0, 0), as all below but diagonal; blind to stripes of one sample
///     sobel        central, across [1 2 1] / 4
///     scharr       central, across [3 10 3] / 16: directions of smooth pictures are nearly exact
///     prewitt      central, across [1 1 1] / 3
///     diagonal     the differences along both diagonals of 2 x 2 samples (Roberts), turned to x and y; at (1/2, 1/2);
///                  sees stripes of one sample, but not the checkerboard
///     diagonal3    the four of diagonal about the sample; their squares are averaged
///     laplacian4   of the four nearest samples
///     laplacian8   of all eight, each with the same weight
///     log:S        Laplacian of a Gaussian of sigma S
///     gaussian:S   derivative of a Gaussian of sigma S
///
/// range    0.1 <= S <= 250 samples; Gaussians are cut off at 4 S and scaled so that ramps (and parabolas) are exact
/// throws   Error for other names, listing them, and for S out of range
DerivativeOperator parse_derivative(std::string_view text);

/// Taps as `design derivative` makes them, along the axis; nothing across.
///
/// throws   Error unless their factor is 1 and they sum to 0, see cancels()
Gradient gradient_by(const Taps& along, std::string name);

/// Samples of a Gaussian, cut off at ceil(4 sigma), with sum 1.
Taps gaussian_taps(double sigma);
/// 2 radius + 1 equal weights.
Taps box_taps(int radius);

GradientPosition position_of_dx(const Gradient& gradient);
GradientPosition position_of_dy(const Gradient& gradient);
/// What the operator makes of a ramp of slope 1: 1 for all that have a name.
double ramp_gain(const Gradient& gradient);

/// What `a` and `b` do one after the other. Both have the factor 1.
Taps convolved(const Taps& a, const Taps& b);

}  // namespace bandlimit
