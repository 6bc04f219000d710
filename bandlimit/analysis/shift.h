// How far two images are shifted relative to each other.
// Stability: evolving.
#pragma once
#include <optional>

#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

/// A shift in samples: above 0 where the content of the second image lies right of, or below, that of the first.
struct Shift {
    std::optional<double> x, y;  ///< empty if undefined
    /// The share of the second image's power, below a tenth of the sampling rate, that the first one does not explain
    /// when shifted and put through a symmetric filter; 1 where nothing is defined, or the image too small to tell.
    double residual = 1;
};

/// The part of an image that estimate_shift() looks at: at most 1024 x 1024 samples around the centre.
struct ShiftWindow {
    int x = 0, y = 0, width = 0, height = 0;
};
ShiftWindow shift_window(int width, int height);

/// The shift between two images of the same scene, even if each went through its own symmetric filter.
///
/// Mean over channels; correlation to the nearest sample; then b is shifted back, and the plane through the phases of
/// the cross-spectrum below a quarter of the sampling rate (least squares, weighted by cross-power and coherence) says
/// by how much that was wrong, until it is less than 1e-4. A second round compares b with what a looks like through b's
/// filter: at the end both tapered images agree, so that the taper adds no bias.
///
/// none     along an axis of less than 4 samples, or along which an image does not vary; along both for images that
///          vary in one oblique direction only (stripes: the aperture problem), and for unrelated images: where the
///          phases of the cross-spectrum C of the gradients agree too little, Re sum C / sum |C| < 0.5, or less than
///          five standard deviations of what unrelated images of so few independent frequencies would give (at most
///          0.95)
/// accuracy 0.01 samples for images of 100 x 100 and more that differ by a shift and symmetric filters of a few taps;
///          under noise, whatever their gradients allow. Shifts up to about a third of the window
/// range    samples that are not finite count as 0; the scale of values does not matter
/// cost     at most about twenty FFTs of the window, in double
/// throws   Error if the shapes differ
/// source   Kuglin & Hines 1975 (phase correlation); the fit of a plane as in Stone et al. 2001
Shift estimate_shift(View<const float> a, View<const float> b, Parallel parallel = {});

}  // namespace bandlimit
