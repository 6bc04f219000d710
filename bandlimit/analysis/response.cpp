#include "bandlimit/analysis/response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// sum_j w_j (x_j)^power e^{2 pi i f x_j}, x_j relative to the output.
std::complex<double> moment(const PlacedWeights& w, double f, int power) {
    std::complex<double> total = 0;
    for (std::size_t j = 0; j < w.weights.size(); ++j) {
        const double x = w.first + static_cast<double>(j);
        total += w.weights[j] * (power == 0 ? 1 : x) * std::polar(1.0, two_pi * f * x);
    }
    return total;
}

double sum_of_squares(const std::vector<double>& w) { return std::inner_product(w.begin(), w.end(), w.begin(), 0.0); }

/// Enough steps to meet every lobe of H, which has at most one per weight over a period.
int steps_for(const PlacedWeights& w, double begin, double end) {
    return 16 + static_cast<int>(std::ceil(16 * (end - begin) * static_cast<double>(w.weights.size())));
}

void check_band(const char* function, double begin, double end) {
    if (!(begin >= 0 && end >= begin && std::isfinite(end)))
        fail(function, ": band [", begin, ", ", end,
             "]; pass frequencies of at least 0, in cycles per sample, in order");
}

}  // namespace

PlacedWeights::PlacedWeights(const Bank& bank, int output, double position) {
    if (output < 0 || output >= bank.output_count())
        fail("PlacedWeights: output ", output, " of a bank of ", bank.output_count());
    first = bank.first(output) - position;
    const std::span<const float> row = bank.row(output);
    weights.assign(row.begin(), row.end());
}

std::complex<double> response(const PlacedWeights& weights, double f) { return moment(weights, f, 0); }

double gain(const PlacedWeights& weights, double f) { return std::abs(response(weights, f)); }

double group_delay(const PlacedWeights& weights, double f) {
    const std::complex<double> h = response(weights, f);
    if (std::abs(h) < 1e-14) return std::numeric_limits<double>::quiet_NaN();
    return -(moment(weights, f, 1) / h).real();
}

double sum(const PlacedWeights& weights) {
    return std::accumulate(weights.weights.begin(), weights.weights.end(), 0.0);
}

double variance(const PlacedWeights& weights) { return sum_of_squares(weights.weights); }

double centroid(const PlacedWeights& weights) {
    const double total = sum(weights);
    return total == 0 ? std::numeric_limits<double>::quiet_NaN() : moment(weights, 0, 1).real() / total;
}

double passband_ripple(const PlacedWeights& weights, double pass_end) {
    check_band("passband_ripple", 0, pass_end);
    const auto deviation = [&](double f) { return std::abs(gain(weights, f) - 1); };
    return largest_value(deviation, 0, pass_end, steps_for(weights, 0, pass_end));
}

double stopband_leakage(const PlacedWeights& weights, double stop_begin, double stop_end) {
    check_band("stopband_leakage", stop_begin, stop_end);
    const auto leakage = [&](double f) { return gain(weights, f); };
    return largest_value(leakage, stop_begin, stop_end, steps_for(weights, stop_begin, stop_end));
}

double alias_energy(const PlacedWeights& weights, int factor) {
    if (factor < 1) fail("alias_energy: factor = ", factor, "; pass 1 or more");
    const std::vector<double>& w = weights.weights;
    const double total = sum_of_squares(w);
    if (total == 0) fail("alias_energy: all weights are 0 and have no energy to divide by");
    if (factor == 1) return 0;
    // |H|^2 is the cosine series of the autocorrelation r, which integrates over |f| < b to 2 b r_d sinc(2 b d) each.
    double kept = total / factor;
    for (std::size_t d = 1; d < w.size(); ++d) {
        const double r = std::inner_product(w.begin() + static_cast<std::ptrdiff_t>(d), w.end(), w.begin(), 0.0);
        kept += 2 * r * sinc(static_cast<double>(d) / factor) / factor;
    }
    return std::max(0.0, 1 - kept / total);
}

PlacedWeights2D::PlacedWeights2D(const PlacedWeights& x, const PlacedWeights& y)
    : first_x(x.first), first_y(y.first), width(static_cast<int>(x.weights.size())) {
    for (const double wy : y.weights)
        for (const double wx : x.weights) weights.push_back(wx * wy);
}

PlacedWeights2D::PlacedWeights2D(const RadialWeights& radial, double phase_x, double phase_y)
    : first_x(radial.first_x - phase_x),
      first_y(radial.first_y - phase_y),
      width(radial.width),
      weights(radial.weights) {}

std::complex<double> response(const PlacedWeights2D& w, double fx, double fy) {
    std::complex<double> total = 0;
    const auto width = static_cast<std::size_t>(w.width);
    for (std::size_t i = 0; i < w.weights.size(); ++i) {
        const double x = w.first_x + static_cast<double>(i % width), y = w.first_y + static_cast<double>(i / width);
        total += w.weights[i] * std::polar(1.0, two_pi * (fx * x + fy * y));
    }
    return total;
}

double variance(const PlacedWeights2D& weights) { return sum_of_squares(weights.weights); }

ComplexGrid response_grid(const PlacedWeights2D& weights, const Axis& fx, const Axis& fy) {
    if (fx.count < 1 || fy.count < 1)
        fail("response_grid: ", fx.count, " x ", fy.count, " frequencies; pass at least one per axis");
    ComplexGrid grid(fx.count, fy.count);
    for (int j = 0; j < fy.count; ++j)
        for (int i = 0; i < fx.count; ++i) grid.at(i, j) = response(weights, fx.position(i), fy.position(j));
    return grid;
}

double largest_value(const std::function<double(double)>& f, double begin, double end, int samples) {
    const double step = (end - begin) / samples;
    double best = begin, height = f(begin);
    for (int i = 1; i <= samples; ++i)
        if (const double x = begin + i * step, value = f(x); value > height) best = x, height = value;
    // Golden sections of the two steps around the best sample.
    constexpr double golden = std::numbers::phi - 1;
    double low = std::max(begin, best - step), high = std::min(end, best + step);
    for (int i = 0; i < 40; ++i) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        const double at_left = f(left), at_right = f(right);
        height = std::max({height, at_left, at_right});
        if (at_left > at_right) high = right;
        else low = left;
    }
    return height;
}

}  // namespace bandlimit
