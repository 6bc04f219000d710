// Joint bilateral upsampling: a signal of few samples on the grid of a guide of many.
//
//     Image<float> full = bilateral_upsampled(occlusion.view(), half_depth.view(), full_depth.view(), {.sigma_range = {0.02}});
// Stability: evolving.
#pragma once
#include "bandlimit/filter/bilateral.h"

namespace bandlimit {

/// Which samples an output is made of, and their weights in space.
enum class UpsampleWindow {
    bilinear,  ///< the 2 x 2 about it, as bilinear interpolation weights them; sigma_space and radius are not used
    gaussian   ///< the (2 radius + 1)^2 about the nearest, by their distance in samples of the signal
};

/// The filter from images of width x height to those of the size of `full_guide`. Both cover the same rectangle: outputs
/// lie between samples as Axis has it. Each is the mean of the samples of its window, weighted in space and by how much
/// their guide is like the one at the output.
///
/// Only ratios of weights count, so that there always are some: where no guide of the window is near the output's, in
/// sigmas, it takes what is nearest in the guide ("nearest depth").
///
/// guides  `guide` is of the size of the signal and has the channels of `full_guide`; none (of width 0): the signal itself.
///         Both must outlive the filter. What is missing is as in bilateral.h
/// error   that of a float: all sums are in double
/// cost    an exponential per sample of the window; each run of samples that misses some channels of the signal and has
///         others takes as long for each
/// throws  Error as bilateral_filter(), and for options.separable
RowFilter bilateral_upsampler(int width, int height, const BilateralOptions& options, View<const float> full_guide,
                              View<const float> guide = {}, UpsampleWindow window = UpsampleWindow::bilinear);

/// Upsamples a whole image.
Image<float> bilateral_upsampled(View<const float> signal, View<const float> guide, View<const float> full_guide,
                                 const BilateralOptions& options, UpsampleWindow window = UpsampleWindow::bilinear,
                                 const Parallel& parallel = {});

}  // namespace bandlimit
