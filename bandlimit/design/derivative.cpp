#include "bandlimit/design/derivative.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/least_squares.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

using std::numbers::pi;
using Coefficients = std::vector<double>;  ///< c_1, c_2, ...

/// s_1, s_2, ...: where the taps lie.
std::vector<double> distances(int taps) {
    std::vector<double> s;
    for (int k = 1; k <= taps / 2; ++k) s.push_back(taps % 2 == 1 ? k : k - 0.5);
    return s;
}

double ramp_gain(const Coefficients& c, const std::vector<double>& s) {
    double sum = 0;
    for (std::size_t k = 0; k < c.size(); ++k) sum += 2 * c[k] * s[k];
    return sum;
}

/// H(f) / i.
double response_at(const Coefficients& c, const std::vector<double>& s, double f) {
    double sum = 0;
    for (std::size_t k = 0; k < c.size(); ++k) sum += 2 * c[k] * std::sin(2 * pi * f * s[k]);
    return sum;
}

/// Points for integrals over the band: at most two periods of the squared response to a panel.
Quadrature band_points(const DerivativeOptions& options) {
    return quadrature(0, options.band, 1 + static_cast<int>(std::ceil(options.band * options.taps)));
}

/// c_k s_k are the values at 0 of Lagrange's polynomials in s^2: exact for the odd powers up to 2 s.size() - 1.
Coefficients taylor(const std::vector<double>& s) {
    Coefficients c;
    for (std::size_t k = 0; k < s.size(); ++k) {
        double product = 1;
        for (std::size_t n = 0; n < s.size(); ++n)
            if (n != k) product *= s[n] * s[n] / ((s[n] - s[k]) * (s[n] + s[k]));
        c.push_back(product / (2 * s[k]));
    }
    return c;
}

Coefficients least_squares(const DerivativeOptions& options, const std::vector<double>& s) {
    LeastSquares problem(static_cast<int>(s.size()));
    std::vector<double> row(s.size());
    const Quadrature points = band_points(options);
    for (std::size_t i = 0; i < points.at.size(); ++i) {
        for (std::size_t k = 0; k < s.size(); ++k) row[k] = 2 * std::sin(2 * pi * points.at[i] * s[k]);
        problem.minimise(row, 2 * pi * points.at[i], points.weights[i]);
    }
    for (std::size_t k = 0; k < s.size(); ++k) row[k] = 2 * s[k];
    if (options.exact_ramp) problem.equal(row, 1);
    return problem.solve();
}

double relative_error(const DerivativeOptions& options, const Coefficients& c, const std::vector<double>& s) {
    const Quadrature points = band_points(options);
    double error = 0, ideal = 0;
    for (std::size_t i = 0; i < points.at.size(); ++i) {
        const double f = points.at[i];
        error += points.weights[i] * std::pow(response_at(c, s, f) - 2 * pi * f, 2);
        ideal += points.weights[i] * std::pow(2 * pi * f, 2);
    }
    return error / ideal;
}

}  // namespace

DerivativeDesign design_derivative(const DerivativeOptions& options) {
    if (options.taps < 2 || options.taps > 255)
        fail("design_derivative: ", options.taps, " taps; pass 2 to 255 (5 are usual)");
    if (!(options.band >= 0.05 && options.band <= 0.5))
        fail("design_derivative: band = ", options.band, "; pass 0.05 to 0.5 cycles per sample");
    const std::vector<double> s = distances(options.taps);
    const Coefficients c =
        options.optimal == DerivativeOptions::Optimal::taylor ? taylor(s) : least_squares(options, s);

    const bool is_odd = options.taps % 2 == 1;
    DerivativeDesign design{
        {1 - (options.taps + 1) / 2, {}, 1}, is_odd ? 0 : 0.5, relative_error(options, c, s), ramp_gain(c, s)};
    for (std::size_t k = c.size(); k-- > 0;) design.taps.weights.push_back(-c[k]);
    if (is_odd) design.taps.weights.push_back(0);
    design.taps.weights.insert(design.taps.weights.end(), c.begin(), c.end());
    return design;
}

}  // namespace bandlimit
