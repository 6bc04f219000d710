// Guided filtering: what a signal is, locally, as a polynomial of a guide.
//
//     Image<float> clean = guided_filter(noisy.view(), depth.view(), {.radius = 8, .epsilon = 1e-3});
//
// The polynomials are a value: fitted at one resolution, they apply to a guide of another.
//
//     LocalModels models = fit_local_models(small_occlusion.view(), small_depth.view(), {.radius = 4, .epsilon = 1e-3});
//     Image<float> large = apply_local_models(models, depth.view());
//
// Stability: evolving.
#pragma once
#include <string_view>
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// What a fit weighs its samples by.
enum class WindowShape {
    box,      ///< the (2 radius + 1)^2 samples alike
    gaussian  ///< a Gaussian as wide: its sigma is gaussian_sigma(), and it ends at 4 sigma
};
std::string_view name_of(WindowShape shape);
/// "box" or "gaussian". Throws Error, listing them, for any other name.
WindowShape parse_window_shape(std::string_view name);
/// sqrt(radius (radius + 1) / 3) samples: the standard deviation of a box of 2 radius + 1.
double gaussian_sigma(int radius);

struct LocalModelOptions {
    int radius = 8;         ///< of the window, in samples; 0 to 32767, of Gaussians to 255
    double epsilon = 1e-3;  ///< added to the variance of each guide; 0 to infinity
    WindowShape window = WindowShape::box;
    int order = 1;  ///< 1: linear in the guides; 2: with their squares and products
    /// A sample's model is the mean, by the same window, of those about it (He, Sun & Tang 2010), instead of its own.
    bool averages = false;
    Edge edge = Edge::renormalize;  ///< windows at borders keep what lies inside
};

/// A polynomial per sample and signal: signal = constant + sum of coefficient * term. The terms of guides u, each less
/// its offset, are u0, u1, ..., and for order 2 then u0 u0, u0 u1, ..., u1 u1, ....
struct LocalModels {
    static constexpr int most_terms = 44;  ///< 44 guides of order 1, 8 of order 2

    int guides = 0, signals = 0, order = 1;
    std::vector<double> offsets;  ///< [guides]
    /// [signals * (1 + terms())], planar: of each signal the constant, then the coefficients. NaN where a window had no
    /// sample.
    Image<float> coefficients;

    /// 2 for two guides and order 1, 5 for order 2.
    int terms() const { return order == 1 ? guides : guides + guides * (guides + 1) / 2; }
};

/// Fits a model to the window about each sample.
///
/// Weighted least squares on the terms less their means. epsilon is added to the variance of each guide, as if the guide
/// had noise of that variance: so to the variance of a product of two guides whose variances are v and w, (v + w) epsilon
/// + epsilon^2 is added, and to that of a square 4 v epsilon + 2 epsilon^2. Terms that do not vary in the window, or only as
/// those before them do, are left out: a constant guide gives the window's mean. A sample of which the signal or the guide
/// is not finite is a hole: it is in no fit, and the model says what the signal is there.
///
/// shapes   signal and guide of one size, with any strides and numbers of channels
/// range    any finite floats. What lies outside a window leaves no trace in it: depths of 1e10 in a sky do not harm
/// error    box: sums in doubles about the value nearest to 0 that the guide has, so |error| of the model's values is some
///          1e-6 of the signal for variances above 1e-9 of the square of that distance. Gaussian: sums in floats about the
///          value nearest to 0 in each tile of about 32 x 32, some 1e-5 for order 1, 1e-3 for order 2, where the
///          guide varies by a hundredth of its range there. Same bits for any number of threads
/// cost     box: hardly depends on the radius. Gaussian: grows with it. A guide of n terms has (n + 1) (n + 2) / 2 sums
///          besides the n + 1 of each signal
/// throws   Error for sizes that differ or are 0, more than most_terms terms, and options out of range; Stopped
/// source   K. He, J. Sun, X. Tang, Guided image filtering, 2010
LocalModels fit_local_models(View<const float> signal, View<const float> guide, const LocalModelOptions& options = {},
                             const Parallel& parallel = {});

/// What `models` say of a guide of any size, which covers the same interval: coefficients are interpolated linearly; a model
/// that is missing is left out, and where all are, the result is NaN, as where the guide is not finite.
///
/// shapes   as many channels of the guide as models.guides; the result is planar, [guide's size * models.signals]
/// memory   for another size, the coefficients at that size too
/// throws   Error for another number of channels, models that are not complete, and a size of 0; Stopped
Image<float> apply_local_models(const LocalModels& models, View<const float> guide, const Parallel& parallel = {});

/// Both at one resolution: what the model of each sample says of the guide there. Without options.averages, models are
/// not stored.
///
/// shapes   the result is planar, of the signal's shape
/// throws   as fit_local_models()
Image<float> guided_filter(View<const float> signal, View<const float> guide, const LocalModelOptions& options = {},
                           const Parallel& parallel = {});

}  // namespace bandlimit
