// Numbers as colours.
#pragma once
#include "bandlimit/core/image.h"

namespace bandlimit::app {

/// sRGB codes from 0 to 1, [w x h x 3], for a channel of numbers; what is not finite is green.
///
/// ramp        black at 0 and below, through violet and orange to a pale yellow at `peak`; equal steps look alike
/// divergence  white at 0, through orange to dark red at `peak`, through light to dark blue at -`peak`
Image<float> ramp_of(View<const float> values, double peak);
Image<float> divergence_of(View<const float> values, double peak);

/// Of vectors [w x h x 2]: the hue is their direction (red to the right, yellow-green down, cyan left, violet up), the
/// brightness their length, full at `peak`.
Image<float> directions_of(View<const float> vectors, double peak);

/// The |value|, or length of a vector, that so many of all do not exceed, the finite ones; `least` at least.
/// example  ramp_of(errors, peak_of(errors, 0.995, 1e-6)), so that a few outliers do not make all others black
double peak_of(View<const float> values, double share, double least);

}  // namespace bandlimit::app
