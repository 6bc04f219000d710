#include "bandlimit/analysis/kernel_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

/// The integral over [0, radius] of a function that is smooth between the kernel's knots, apart from an oscillation of
/// frequency f. Four panels at least, since a window may be much narrower than the distance of two knots.
double integrate_pieces(const Kernel& kernel, double f, const std::function<double(double)>& function) {
    double total = 0, begin = 0;
    const auto add_up_to = [&](double end) {
        total += integrate(function, begin, end, 4 + static_cast<int>(std::ceil(f * (end - begin))));
        begin = end;
    };
    for (const double knot : kernel.knots) add_up_to(knot);
    add_up_to(kernel.radius);
    return total;
}

/// The integral of k^2 over the line or the plane.
double energy(const Kernel& kernel) {
    return integrate_pieces(kernel, 0, [&](double x) {
        const double k = kernel.value(x);
        return k * k * (is_radial(kernel) ? 2 * pi * x : 2);
    });
}

/// Length of the part of the circle of radius f that lies in the square |fx|, |fy| < 1/2.
double arc_in_band(double f) { return f <= 0.5 ? 2 * pi * f : (2 * pi - 8 * std::acos(0.5 / f)) * f; }

/// Enough steps for a spectrum, whose lobes are at least 1 / (2 radius) wide.
int steps_for(const Kernel& kernel, double begin, double end) {
    return 16 + static_cast<int>(std::ceil(32 * (end - begin) * kernel.radius));
}

void check_band(const char* function, double begin, double end) {
    if (!(begin >= 0 && end >= begin && std::isfinite(end)))
        fail(function, ": band [", begin, ", ", end,
             "]; pass frequencies of at least 0, in cycles per pitch, in order");
}

}  // namespace

double spectrum(const Kernel& kernel, double f) {
    constexpr double limit = 1e6;  // a panel of quadrature for each period
    if (!(std::abs(f) <= limit)) fail("spectrum: f = ", f, "; pass at most ", limit, " cycles per pitch");
    f = std::abs(f);
    return integrate_pieces(kernel, f, [&](double x) {
        if (is_radial(kernel)) return 2 * pi * x * kernel.value(x) * bessel_j0(2 * pi * f * x);
        return 2 * kernel.value(x) * std::cos(2 * pi * f * x);
    });
}

double relative_spectrum(const Kernel& kernel, double f) { return spectrum(kernel, f) / spectrum(kernel, 0); }

double passband_ripple(const Kernel& kernel, double pass_end) {
    check_band("passband_ripple", 0, pass_end);
    const double at_zero = spectrum(kernel, 0);
    const auto deviation = [&](double f) { return std::abs(std::abs(spectrum(kernel, f) / at_zero) - 1); };
    return largest_value(deviation, 0, pass_end, steps_for(kernel, 0, pass_end));
}

double stopband_leakage(const Kernel& kernel, double stop_begin, double stop_end) {
    check_band("stopband_leakage", stop_begin, stop_end);
    const double at_zero = spectrum(kernel, 0);
    const auto leakage = [&](double f) { return std::abs(spectrum(kernel, f) / at_zero); };
    return largest_value(leakage, stop_begin, stop_end, steps_for(kernel, stop_begin, stop_end));
}

double alias_energy(const Kernel& kernel) {
    const auto squared = [&](double f) {
        const double k = spectrum(kernel, f);
        return k * k;
    };
    const int panels = 4 + static_cast<int>(std::ceil(kernel.radius));
    if (!is_radial(kernel)) return 1 - 2 * integrate(squared, 0, 0.5, panels) / energy(kernel);
    const double disc = integrate([&](double f) { return squared(f) * arc_in_band(f); }, 0, 0.5, panels);
    // In the corners f = 1/2 sec(t), which takes the square root out of the arc's slope at 1/2.
    const double corners = integrate(
        [&](double t) {
            const double f = 0.5 / std::cos(t);
            return squared(f) * arc_in_band(f) * f * std::tan(t);
        },
        0, pi / 4, panels);
    return 1 - (disc + corners) / energy(kernel);
}

ComplexGrid relative_spectrum_grid(const Kernel& kernel, const Axis& fx, const Axis& fy) {
    const auto along = [&](const Axis& axis) {
        std::vector<double> values;
        for (int i = 0; i < axis.count; ++i) values.push_back(relative_spectrum(kernel, axis.position(i)));
        return values;
    };
    ComplexGrid grid(fx.count, fy.count);
    const bool radial = is_radial(kernel);
    const std::vector<double> x = radial ? std::vector<double>{} : along(fx), y = radial ? x : along(fy);
    for (int j = 0; j < fy.count; ++j)
        for (int i = 0; i < fx.count; ++i)
            grid.at(i, j) = radial ? relative_spectrum(kernel, std::hypot(fx.position(i), fy.position(j)))
                                   : x[static_cast<std::size_t>(i)] * y[static_cast<std::size_t>(j)];
    return grid;
}

}  // namespace bandlimit
