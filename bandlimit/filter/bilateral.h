// Bilateral filters: means of the samples about a place that leave out what is unlike it.
//
//     Image<float> smooth = bilateral(photo.view(), {.sigma_space = 3, .sigma_range = {0.1}});
//     Image<float> occlusion = joint_bilateral(noisy.view(), depth.view(), {.sigma_space = 2, .sigma_range = {0.02}});
//     Image<float> full = bilateral_upsampled(occlusion.view(), depth.view(), full_depth.view(), {.sigma_range = {0.02}});
//
// An output is the mean of the signal over a square of (2 radius + 1)^2 samples, each weighted by exp(-d^2 / (2 sigma^2))
// of its distance in space, and again of the distance of its guide from the guide in the middle, each channel of which
// has a sigma of its own: a Euclidean distance in range.
//
// A sample with a channel of the guide that is NaN, or of the signal that is not finite, is missing: it has no weight.
// Where only some channels of the signal are missing, the others count. An output whose own sample is missing is made of
// those about it, by those channels of its guide that it has. NaN is what has no sample of any weight.
// Stability: evolving.
#pragma once
#include <optional>
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// The largest radius, in samples.
inline constexpr int most_bilateral_radius = 1000;

struct BilateralOptions {
    /// In samples, 0 to infinity. 0 leaves the middle alone; infinity is a mean over the square, which needs a radius.
    double sigma_space = 2;
    /// In the units of the guide, 0 to infinity: one for all of its channels, or one for each. 0 takes only what is equal;
    /// infinity leaves a channel out, and if all are, the filter is a Gaussian of the window.
    std::vector<double> sigma_range = {0.1};
    std::optional<int> radius{};  ///< default: 3 sigma_space, rounded up
    /// A pass along x, then one along y on what it gave, by the same guide. This is another filter, which leaves streaks
    /// where the guide is not a product; 2 (2 radius + 1) weights instead of their square.
    bool separable = false;
    /// Under Edge::renormalize, what lies outside is missing.
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    bool premultiply = true;  ///< colours of the signal are filtered multiplied by alpha
};

/// Throws Error for a sigma below 0 or NaN, no sigma of the range, and a radius below 0 or above the largest, given or not.
void check_bilateral(const BilateralOptions& options);
/// The radius that is used. Throws as check_bilateral().
int bilateral_radius(const BilateralOptions& options);

/// The filter on images of width x height.
///
/// guide   of that size, any number of channels; it must outlive the filter. None (of width 0): the signal itself, as it is
///         decoded, alpha one of its channels and colour not multiplied by it unless it is stored so
/// range   any; infinite values of the guide are like each other
/// error   weights 3e-7; sums are in float, per row of the window and then of rows. Constants and what is alone keep their
///         bits; same bits for any number of threads, and where multiply-add is fused
/// cost    a weight takes about 18 operations on vectors of floats. Each run of samples that misses some channels of the
///         signal and has others takes as long for each
/// memory  per thread a tile of 512 columns by 64 rows, or twice the radius if that is more
/// throws  Error as check_bilateral(), for sizes below 1 or a guide of another size, and for more or fewer sigmas than
///         one or the channels of the guide (where the signal is its own, when it runs)
RowFilter bilateral_filter(int width, int height, const BilateralOptions& options, View<const float> guide = {});

/// Filters a whole image by itself, or by a guide of its size.
Image<float> bilateral(View<const float> signal, const BilateralOptions& options, const Parallel& parallel = {});
Image<float> joint_bilateral(View<const float> signal, View<const float> guide, const BilateralOptions& options,
                             const Parallel& parallel = {});

}  // namespace bandlimit
