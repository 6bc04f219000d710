// Multisampling, as graphics hardware does it, beside supersampling: visibility at each sample, shading once a pixel.
//
// Multisampling removes jagged outlines, and nothing of what aliases inside a surface; that is what filtering before
// shading (mip maps) removes. Supersampling takes away some of both, and with a filter before shading, most.
// Stability: evolving.
#pragma once
#include <functional>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/sampling/pattern.h"

namespace bandlimit {

/// Surfaces that can be shaded where they are not seen: multisampling shades at the centre of the pixel what covers any
/// sample of it. One channel. Called from several threads at once.
///
/// units   positions and footprints in pixels of the image
struct ShadedSurfaces {
    std::function<int(double x, double y)> visible;  ///< which surface a point shows, from 0 on
    /// The colour of a surface: its mean over a square of side `footprint` around the point, 0 for the point itself.
    std::function<double(int surface, double x, double y, double footprint)> shade;
};

/// Each pixel is the mean of its samples, each of the surface that it sees, shaded once per pixel at its centre.
///
/// footprint   of each shading; 1, the pixel, is what mip maps do, 0 no filter at all
/// throws      Error for sizes below 1, no points, and a footprint below 0
Image<float> multisample(const ShadedSurfaces& surfaces, int width, int height, const SamplePattern& pattern,
                         double footprint = 1, const Parallel& parallel = {});

/// Each pixel is the mean of its samples, each shaded for itself. A footprint of 1 / sqrt(count) is what mip maps do
/// with as much more resolution. Else as multisample().
Image<float> supersample(const ShadedSurfaces& surfaces, int width, int height, const SamplePattern& pattern,
                         double footprint = 0, const Parallel& parallel = {});

}  // namespace bandlimit
