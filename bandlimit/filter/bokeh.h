// Blur as lenses make it: every bright spot becomes a picture of the aperture.
// Stability: evolving.
#pragma once
#include <string_view>

#include "bandlimit/filter/convolve.h"

namespace bandlimit {

/// The shape that `text` describes without its size, as "disc:1" or "polygon:6:0.9:15" (see parse_shape()), on samples:
/// 1 of the shape's unit are `radius` samples. Each sample is the mean of the shape over its square, so edges are
/// antialiased and radii need not be whole.
///
/// shapes   2 ceil(radius - 1/2) + 1 samples a side; what lies outside -1 to 1 is cut off, as on any grid of shapes
/// range    0.5 <= radius <= 1000
/// error    the shape is sampled at 16 x 16 points per sample, fewer above a radius of 64: about 0.002 per sample
/// throws   Error as parse_shape, and for a radius out of range
WeightGrid aperture(std::string_view text, double radius);

/// A convolution of colours raised to the power `gamma`, and the root of what comes out: lights become as bright as they
/// are in the world, though the picture has them at white. Of negative values the sign stays. Alpha is left alone, and
/// is divided out of colours before they are raised; the last channels see no difference otherwise.
///
/// memory   the rows of source and target as floats, beside those of the convolution
/// throws   Error unless gamma is finite and above 0
/// source   Wronski 2020, who takes 7 ("Separate your filters!"); 2.2 and less is what tone curves commonly hide
RowFilter boosted(const Convolution& convolution, double gamma, bool premultiply);

}  // namespace bandlimit
