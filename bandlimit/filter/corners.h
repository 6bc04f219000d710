// Corners of pictures, to a fraction of a pixel.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

/// Where gradients of two directions meet.
struct Corner {
    double x = 0, y = 0;  ///< pixels from the picture's corner: sample i lies at i + 1/2
    double strength = 0;  ///< what was measured at the sample where it was found
};

struct CornerOptions {
    enum class Measure {
        harris,     ///< det - k trace^2 of the structure tensor
        shi_tomasi  ///< its smaller eigenvalue
    };

    Measure measure = Measure::shi_tomasi;
    double k = 0.05;            ///< of harris, 0 to below 1/4
    double sigma = 1.5;         ///< of the tensor's window, in pixels
    double least = 0.05;        ///< share of the strongest that a corner must have, 0 to 1
    double distance = 4;        ///< pixels between corners, of which the stronger one is kept
    double reach = 10;          ///< pixels about a corner from which its place is measured; fewer where
                                ///< another one is near
    Edge edge = Edge::reflect;  ///< any but renormalize
};

/// The corners of a picture, the strongest first.
///
/// They are found where the measure of the structure tensor (Scharr, summed over channels) is largest among its eight
/// neighbours; those lie inside the corner. Their place is the point that the lines through all edges about it come
/// nearest to, in the sense of least squares: at each sample q of gradient g, the line through q across g (Foerstner and
/// Guelch 1987). Gradients at the corner itself, which any blur rounds off, weigh nothing: a sample at r pixels weighs
/// t^3 (1 - t)^2 with t = (r / reach)^2. Where that does not settle within 3 pixels, the sample itself is the place.
///
/// shapes   image [w x h x any]
/// error    0.05 pixels for corners of right angles between antialiased edges that are straight for 12 pixels; 0.1 for
///          10 and 0.25 for 8
/// cost     that of a structure tensor, and pi reach^2 samples a step for each corner, 5 steps or so
/// throws   Error for an empty picture and options out of range
/// source   Harris and Stephens 1988; Shi and Tomasi 1994
std::vector<Corner> find_corners(View<const float> image, const CornerOptions& options = {}, Parallel parallel = {});

}  // namespace bandlimit
