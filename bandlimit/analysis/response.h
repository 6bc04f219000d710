// What weights do to a frequency.
//
// Sign and reference, once for this room: a cosine at position x is e^{+2 pi i f x}, f in cycles per source sample, and
// an output at position o that reads it comes out as H(f) e^{+2 pi i f o}. So H(f) = sum_j w_j e^{+2 pi i f (x_j - o)}:
// weights that are symmetric about their output have a real H.
// Stability: evolving.
#pragma once
#include <complex>
#include <functional>
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/kernel/radial_weights.h"
#include "bandlimit/kernel/taps.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// Weights, and where the first of them lies relative to the output, in source samples. Taps convert by themselves.
struct PlacedWeights {
    double first = 0;
    std::vector<double> weights;

    PlacedWeights(double first, std::vector<double> weights) : first(first), weights(std::move(weights)) {}
    /// The output lies where output_offset(taps) says.
    PlacedWeights(const Taps& taps) : PlacedWeights(taps, output_offset(taps)) {}
    /// The output lies `phase` to the right of input sample i * factor.
    PlacedWeights(const Taps& taps, double phase) : PlacedWeights(taps.first - phase, taps.weights) {}
    /// Row `output` of a bank, an output that lies at source index `position` (0 is the centre of the first sample).
    /// Throws Error if the bank does not have that output.
    PlacedWeights(const Bank& bank, int output, double position);
};

/// H(f). Error below 1e-14 sum |w|. Cost: a complex exponential per weight.
std::complex<double> response(const PlacedWeights& weights, double cycles_per_sample);

/// |H(f)|.
double gain(const PlacedWeights& weights, double cycles_per_sample);

/// How far content of frequency f moves to the right, in source samples: -1 / (2 pi) times the slope of the phase of H.
/// 0 for symmetric weights, minus the centroid at f = 0, NaN where H is 0.
double group_delay(const PlacedWeights& weights, double cycles_per_sample);

double sum(const PlacedWeights& weights);
/// Sum of squares: the factor by which the variance of white noise changes.
double variance(const PlacedWeights& weights);
/// Centre of the weights relative to the output, in source samples; NaN if they sum to 0.
double centroid(const PlacedWeights& weights);

/// The largest deviation of |H| from 1 on [0, pass_end]. Error below 1e-9 sum |w|. Throws Error unless 0 <= pass_end.
double passband_ripple(const PlacedWeights& weights, double pass_end);

/// The largest |H| on [stop_begin, stop_end]. Error and throws as above.
double stopband_leakage(const PlacedWeights& weights, double stop_begin, double stop_end = 0.5);

/// The share of the output's energy that is alias, where the weights keep every `factor`-th sample of white noise: the
/// integral of |H|^2 over 1 / (2 factor) < |f| < 1/2, which folds, divided by that over |f| < 1/2. 0 for factor 1.
///
/// error   1e-14: a sum over pairs of weights, no quadrature
/// throws  Error for factor < 1 or if all weights are 0
double alias_energy(const PlacedWeights& weights, int factor);

/// Weights on a grid, and where the first of them lies relative to the output; row after row.
struct PlacedWeights2D {
    double first_x = 0, first_y = 0;
    int width = 0;
    std::vector<double> weights;

    PlacedWeights2D(double first_x, double first_y, int width, std::vector<double> weights)
        : first_x(first_x), first_y(first_y), width(width), weights(std::move(weights)) {}
    /// weight(x, y) = x.weights * y.weights.
    PlacedWeights2D(const PlacedWeights& x, const PlacedWeights& y);
    /// The output lies at (phase_x, phase_y), as in radial_weights_at().
    PlacedWeights2D(const RadialWeights& radial, double phase_x, double phase_y);
};

/// H(fx, fy), as above in two dimensions.
std::complex<double> response(const PlacedWeights2D& weights, double fx, double fy);
double variance(const PlacedWeights2D& weights);

/// The response at the positions of two axes of frequencies: at(i, j) holds H(fx.position(i), fy.position(j)).
/// Cost: a complex exponential per weight and frequency.
/// example  response_grid(weights, Axis{129, -0.5, 0.5}, Axis{129, -0.5, 0.5})   // an odd count has its middle at 0
ComplexGrid response_grid(const PlacedWeights2D& weights, const Axis& fx, const Axis& fy);

/// The largest value of f on [begin, end], found among `samples` equal steps and refined around the best of them.
/// f must be smooth between them; error about 1e-10 of its height then.
double largest_value(const std::function<double(double)>& f, double begin, double end, int samples);

}  // namespace bandlimit
