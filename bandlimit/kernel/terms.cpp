#include "bandlimit/kernel/terms.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {
namespace {

constexpr int longest_reach = 1'000'000;

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double magnitude_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0, [](double s, double v) { return s + std::abs(v); });
}

void check(const Components& components, const char* function) {
    if (components.empty()) fail(function, ": no components; pass at least one");
    for (const Component& c : components)
        if (!(c.a > 0) || !std::isfinite(c.a) || !std::isfinite(c.b) || !std::isfinite(c.A) || !std::isfinite(c.B))
            fail(function, ": a component of a = ", c.a, ", b = ", c.b, ", A = ", c.A, ", B = ", c.B,
                 "; pass finite numbers and a > 0");
}

void check_radius(double radius, const char* function) {
    if (!(radius > 0) || !std::isfinite(radius))
        fail(function, ": radius = ", radius, "; pass the radius of the disc in samples, above 0");
}

/// The integral of exp(-a r^2) over the plane outside the square of half side `reach`.
double outside_square(double a, double reach) {
    const double rest = std::erfc(std::sqrt(a) * reach);
    return std::numbers::pi / a * rest * (2 - rest);  // 1 - erf^2, without its cancellation
}

}  // namespace

WeightSize size_of(const Terms& terms) {
    if (terms.empty()) fail("terms: there are none; pass at least one");
    const std::size_t height = terms[0].column.size(), width = terms[0].row.size();
    for (const Term& term : terms)
        if (term.column.size() != height || term.row.size() != width || height == 0 || width == 0)
            fail("terms: one of ", term.column.size(), " x ", term.row.size(), " weights among those of ", height,
                 " x ", width, "; pass equal lengths of at least 1");
    return {static_cast<int>(width), static_cast<int>(height)};
}

WeightGrid expanded(const Terms& terms) {
    const WeightSize size = size_of(terms);
    WeightGrid grid(size.width, size.height);
    const std::size_t width = terms[0].row.size(), height = terms[0].column.size();
    for (const Term& term : terms)
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x) grid.weights[y * width + x] += term.column[y] * term.row[x];
    return grid;
}

double sum(const Terms& terms) {
    double total = 0;
    for (const Term& term : terms) total += sum_of(term.column) * sum_of(term.row);
    return total;
}

double magnitude(const Terms& terms) {
    double total = 0;
    for (const Term& term : terms) total += magnitude_of(term.column) * magnitude_of(term.row);
    return total;
}

Terms with_unit_sum(Terms terms) {
    const double total = sum(terms);
    if (cancels(total, magnitude(terms)))
        fail("with_unit_sum: weights that sum to ", total, " cannot be divided by it; keep their sum");
    for (Term& term : terms)
        for (double& weight : term.column) weight /= total;
    return terms;
}

double value_at(const Components& components, double r) {
    check(components, "value_at");
    double value = 0;
    for (const Component& c : components)
        value += std::exp(-c.a * r * r) * (c.A * std::cos(c.b * r * r) + c.B * std::sin(c.b * r * r));
    return value;
}

double integral(const Components& components) {
    check(components, "integral");
    std::complex<double> total;
    for (const Component& c : components) total += std::complex(c.A, -c.B) / std::complex(c.a, -c.b);
    return std::numbers::pi * total.real();
}

int reach_for(const Components& components, double radius, double share) {
    const double whole = integral(components);
    check_radius(radius, "reach_for");
    if (!(share > 0 && share < 1)) fail("reach_for: share = ", share, "; pass a part of 1, such as 0.01");
    if (!(whole > 0)) fail("reach_for: components of integral ", whole, "; pass some that sum to more than 0");
    // Weights up to `reach` stand for the plane up to half a sample further.
    const auto is_enough = [&](int reach) {
        double cut = 0;
        for (const Component& c : components) cut += std::hypot(c.A, c.B) * outside_square(c.a, (reach + 0.5) / radius);
        return cut <= share * whole;
    };
    int too_short = -1, enough = 1;
    while (!is_enough(enough)) {
        if (enough >= longest_reach)
            fail("reach_for: radius = ", radius, " needs weights beyond ", longest_reach, " samples; pass less");
        too_short = enough;
        enough *= 2;
    }
    while (enough - too_short > 1) {
        const int middle = std::midpoint(too_short, enough);
        (is_enough(middle) ? enough : too_short) = middle;
    }
    return enough;
}

Terms separable_terms(const Components& components, double radius, int reach) {
    check(components, "separable_terms");
    check_radius(radius, "separable_terms");
    if (reach < 0 || reach > longest_reach)
        fail("separable_terms: reach = ", reach, "; pass 0 to ", longest_reach, ", or what reach_for gives");
    const std::size_t count = 2 * static_cast<std::size_t>(reach) + 1;
    Terms terms;
    for (const Component& c : components) {
        Term real{std::vector<double>(count), std::vector<double>(count)}, imaginary = real;
        for (std::size_t j = 0; j < count; ++j) {
            const double x = (static_cast<double>(j) - reach) / radius, bell = std::exp(-c.a * x * x);
            const double g = bell * std::cos(c.b * x * x), h = bell * std::sin(c.b * x * x);
            real.row[j] = g;
            real.column[j] = c.A * g + c.B * h;
            imaginary.row[j] = h;
            imaginary.column[j] = c.B * g - c.A * h;
        }
        terms.push_back(std::move(real));
        terms.push_back(std::move(imaginary));
    }
    return terms;
}

}  // namespace bandlimit
