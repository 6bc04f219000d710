#include "bandlimit/design/sharpen.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/least_squares.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

/// The limit holds at this many frequencies, and between them to a part in a thousand: the steepest term has 31
/// periods.
constexpr int limit_steps = 512;

void check(const Kernel& kernel, const SharpenOptions& options) {
    if (is_radial(kernel))
        fail("design_sharpen: ", kernel.name, " is radial; pass a kernel that acts along one axis, as bspline");
    if (options.taps < 3 || options.taps > 63 || options.taps % 2 == 0)
        fail("design_sharpen: ", options.taps, " taps; pass an odd number from 3 to 63");
    if (!(options.band >= 0.05 && options.band <= 0.5))
        fail("design_sharpen: band = ", options.band, "; pass 0.05 to 0.5 cycles per sample");
    if (!(options.max_gain > 1)) fail("design_sharpen: max_gain = ", options.max_gain, "; pass more than 1");
    if (options.phase && !(*options.phase >= 0 && *options.phase < 1))
        fail("design_sharpen: phase = ", *options.phase, "; pass 0 to 1, without 1");
}

/// What each weight w_0, w_1, ... adds to H(f); that at k stands for those at k and -k.
std::vector<double> terms_at(double f, int taps) {
    std::vector<double> row{1};
    for (int k = 1; k <= taps / 2; ++k) row.push_back(2 * std::cos(2 * pi * f * k));
    return row;
}

}  // namespace

std::complex<double> kernel_response(const Kernel& kernel, std::optional<double> phase, double f) {
    if (!phase) return relative_spectrum(kernel, f);
    return response(PlacedWeights(weights_at(kernel, *phase).taps, *phase), f);
}

SharpenDesign design_sharpen(const Kernel& kernel, const SharpenOptions& options) {
    check(kernel, options);
    LeastSquares problem(options.taps / 2 + 1);
    const Quadrature points = quadrature(0, options.band, 1 + static_cast<int>(std::ceil(options.band * options.taps)));
    std::vector<std::complex<double>> kernel_at;
    for (const double f : points.at) kernel_at.push_back(kernel_response(kernel, options.phase, f));
    for (std::size_t i = 0; i < points.at.size(); ++i) {
        std::vector<double> real = terms_at(points.at[i], options.taps), imaginary = real;
        for (double& term : real) term *= kernel_at[i].real();
        for (double& term : imaginary) term *= kernel_at[i].imag();
        problem.minimise(real, 1, points.weights[i]);
        problem.minimise(imaginary, 0, points.weights[i]);
    }
    problem.equal(terms_at(0, options.taps), 1);
    if (std::isfinite(options.max_gain))
        for (int i = 1; i <= limit_steps; ++i) {
            std::vector<double> row = terms_at(0.5 * i / limit_steps, options.taps);
            problem.at_most(row, options.max_gain);
            for (double& term : row) term = -term;
            problem.at_most(row, options.max_gain);
        }
    const std::vector<double> half = problem.solve();

    SharpenDesign design{{-(options.taps / 2), {half.rbegin(), half.rend()}, 1}};
    design.taps.weights.insert(design.taps.weights.end(), half.begin() + 1, half.end());
    const PlacedWeights placed(design.taps);
    for (std::size_t i = 0; i < points.at.size(); ++i)
        design.error +=
            points.weights[i] * std::norm(response(placed, points.at[i]) * kernel_at[i] - 1.0) / options.band;
    const auto deviation = [&](double f) {
        return std::abs(response(placed, f) * kernel_response(kernel, options.phase, f) - 1.0);
    };
    design.droop = largest_value(deviation, 0, options.band, 64 + 4 * options.taps);
    design.gain = stopband_leakage(placed, 0, 0.5);
    design.variance = variance(placed);
    return design;
}

}  // namespace bandlimit
