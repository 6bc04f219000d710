#include "bandlimit/design/disk.h"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

using Complex = std::complex<double>;

constexpr double infinite = std::numeric_limits<double>::infinity();

// With p = a - ib and c = A - iB the kernel is K(s) = Re sum c exp(-p s), and an integral over the plane is pi times
// one over s. Integrals below are in parts of pi, the integral of disc^2. Products of real parts follow from Re u Re v
// = Re(u v + u conj v) / 2.

Complex p_of(const Component& component) { return {component.a, -component.b}; }
Complex c_of(const Component& component) { return {component.A, -component.B}; }

/// The integral of exp(-p s) over the disc.
Complex over_disc(Complex p) { return (1.0 - std::exp(-p)) / p; }
/// Its derivative to p.
Complex over_disc_slope(Complex p) { return (std::exp(-p) * (1.0 + p) - 1.0) / (p * p); }

struct Products {
    double with_disc = 0, with_itself = 0;
};

Products products_of(const Components& components) {
    Products products;
    for (const Component& i : components) {
        products.with_disc += std::real(c_of(i) * over_disc(p_of(i)));
        for (const Component& j : components)
            products.with_itself += std::real(c_of(i) * c_of(j) / (p_of(i) + p_of(j)) +
                                              c_of(i) * std::conj(c_of(j)) / (p_of(i) + std::conj(p_of(j)))) /
                                    2;
    }
    return products;
}

double error_of(const Products& products) { return 1 - 2 * products.with_disc + products.with_itself; }

/// Gives `components` the A and B that are nearest to the disc for their a and b: linear least squares in the products
/// of Re exp(-p s) and Im exp(-p s), whose factors they are.
void fit_amplitudes(Components& components) {
    const auto n = static_cast<Eigen::Index>(components.size());
    Eigen::MatrixXd normal(2 * n, 2 * n);
    Eigen::VectorXd right(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Complex p = p_of(components[static_cast<std::size_t>(i)]), disc = over_disc(p);
        right(2 * i) = disc.real();
        right(2 * i + 1) = disc.imag();
        for (Eigen::Index j = 0; j < n; ++j) {
            const Complex q = p_of(components[static_cast<std::size_t>(j)]);
            const Complex plain = 0.5 / (p + q), conjugate = 0.5 / (p + std::conj(q));
            normal(2 * i, 2 * j) = conjugate.real() + plain.real();
            normal(2 * i + 1, 2 * j + 1) = conjugate.real() - plain.real();
            normal(2 * i, 2 * j + 1) = plain.imag() - conjugate.imag();
            normal(2 * i + 1, 2 * j) = plain.imag() + conjugate.imag();
        }
    }
    const Eigen::VectorXd amplitudes = normal.ldlt().solve(right);
    for (Eigen::Index i = 0; i < n; ++i) {
        components[static_cast<std::size_t>(i)].A = amplitudes(2 * i);
        components[static_cast<std::size_t>(i)].B = amplitudes(2 * i + 1);
    }
}

/// Components of these log a and b, first all a and then all b, with their best amplitudes.
Components components_at(const double* parameters, int count) {
    Components components;
    for (int i = 0; i < count; ++i) components.push_back({std::exp(parameters[i]), parameters[count + i]});
    fit_amplitudes(components);
    return components;
}

/// The error over log a and b. Amplitudes are solved for, and as the error is stationary in them it changes with a and
/// b as if they stood still.
class ErrorOfPhasors : public ceres::FirstOrderFunction {
public:
    explicit ErrorOfPhasors(int count) : count_(count) {}

    int NumParameters() const override { return 2 * count_; }

    bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
        const Components components = components_at(parameters, count_);
        *cost = error_of(products_of(components));
        if (!gradient) return std::isfinite(*cost);
        for (int i = 0; i < count_; ++i) {
            const Component& component = components[static_cast<std::size_t>(i)];
            const Complex p = p_of(component), c = c_of(component);
            // The error is the real part of what is analytic in p: a step dp changes it by Re(slope dp).
            Complex slope = -2.0 * c * over_disc_slope(p);
            for (const Component& other : components) {
                const Complex plain = p + p_of(other), conjugate = p + std::conj(p_of(other));
                slope -= c * c_of(other) / (plain * plain) + c * std::conj(c_of(other)) / (conjugate * conjugate);
            }
            gradient[i] = slope.real() * component.a;  // by log a
            gradient[count_ + i] = slope.imag();       // dp = -i db
        }
        return std::isfinite(*cost);
    }

private:
    int count_;
};

/// Up to where exp(-rate x^2) is not below 1e-16.
double end_of_bell(double rate) { return std::sqrt(-std::log(1e-16) / rate); }

/// The first place on the way from `begin` to `end`, in that many steps, where f changes its sign; infinite if none.
double sign_change(const std::function<double(double)>& f, double begin, double end, int steps) {
    const auto at = [&](int i) { return begin + (end - begin) * i / steps; };
    const bool is_negative = std::signbit(f(begin));
    for (int i = 1; i <= steps; ++i) {
        if (std::signbit(f(at(i))) == is_negative) continue;
        double before = at(i - 1), after = at(i);
        for (int halving = 0; halving < 50; ++halving) {
            const double middle = (before + after) / 2;
            (std::signbit(f(middle)) == is_negative ? before : after) = middle;
        }
        return after;
    }
    return infinite;
}

double largest_size(const std::function<double(double)>& f, double begin, double end, int steps) {
    return largest_value([&](double x) { return std::abs(f(x)); }, begin, end, steps);
}

}  // namespace

Components fit_disk(int count) {
    if (count < 1 || count > most_disk_components)
        fail("fit_disk: ", count, " components; pass 1 to ", most_disk_components);
    // Fits are like Fourier series in s: frequencies at even distances, the faster ones with the wider bells.
    std::vector<double> parameters;
    for (int i = 0; i < count; ++i) parameters.push_back(std::log(1.3 + 0.6 * (count - 1 - i)));
    for (int i = 0; i < count; ++i) parameters.push_back(2.2 + 5.3 * i);

    ceres::GradientProblemSolver::Options options;
    options.line_search_direction_type = ceres::BFGS;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-15;
    options.gradient_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(options, ceres::GradientProblem(new ErrorOfPhasors(count)), parameters.data(), &summary);

    Components components = components_at(parameters.data(), count);
    std::ranges::sort(components, {}, &Component::b);
    return components;
}

PublishedDisk published_disk(int count) {
    // The radii are those of the least error over radius and height.
    if (count == 1) return {{{0.862325, 1.624835, 0.767583, 1.862321}}, 1.10179, 1.4};
    if (count == 2)
        return {{{0.886528, 5.268909, 0.411259, -0.548794}, {1.960518, 1.558213, 0.513282, 4.56111}}, 1.10744, 1.2};
    fail("published_disk: ", count, " components; pass 1 or 2, or take fit_disk for more");
}

Components fitted_to_disk(const Components& components, double radius) {
    if (!(radius > 0) || !std::isfinite(radius)) fail("fitted_to_disk: radius = ", radius, "; pass one above 0");
    value_at(components, 0);  // checks them
    Components scaled = components;
    for (Component& component : scaled) {
        component.a *= radius * radius;
        component.b *= radius * radius;
    }
    const Products products = products_of(scaled);
    if (!(products.with_itself > 0)) fail("fitted_to_disk: components that sum to 0; pass others");
    const double height = products.with_disc / products.with_itself;
    for (Component& component : scaled) {
        component.A *= height;
        component.B *= height;
    }
    return scaled;
}

double disk_error(const Components& components) {
    value_at(components, 0);  // checks them
    return error_of(products_of(components));
}

DiskProfile disk_profile(const Components& components) {
    const auto value = [&](double r) { return value_at(components, r); };
    DiskProfile profile;
    profile.centre = value(0);
    double slowest = infinite, fastest = 0;
    for (const Component& component : components) {
        slowest = std::min(slowest, component.a);
        fastest = std::max(fastest, std::abs(component.b));
    }
    const double end = end_of_bell(slowest);
    // 16 steps and more in each period of what turns the fastest, at its fastest.
    const int steps = 256 + static_cast<int>(std::min(1e6, 16 * fastest * end * end / std::numbers::pi));
    profile.zero_from = sign_change(value, 0, end, steps);
    const double outer = std::min(profile.zero_from, end);
    const double flat = sign_change([&](double r) { return value(r) - 1; }, outer, 0, steps);
    profile.flat_until = std::isfinite(flat) ? flat : 0;
    profile.inner_ringing = std::abs(profile.centre - 1);
    if (profile.flat_until > 0)
        profile.inner_ringing = largest_size([&](double r) { return value(r) - 1; }, 0, profile.flat_until, steps);
    if (outer < end) profile.outer_ringing = largest_size(value, outer, end, steps);
    return profile;
}

double disk_response(const Components& components, double cycles_per_radius) {
    const double whole = integral(components);
    if (whole == 0) fail("disk_response: components of integral 0; pass some that sum to more");
    const double w = std::numbers::pi * cycles_per_radius;
    Complex sum;
    for (const Component& component : components)
        sum += c_of(component) / p_of(component) * std::exp(-w * w / p_of(component));
    return std::numbers::pi * sum.real() / whole;
}

double disc_response(double cycles_per_radius) { return 2 * jinc(2 * cycles_per_radius); }

DiskBand disk_band(const std::function<double(double)>& response) {
    constexpr double end = 4;
    constexpr int steps = 512;
    DiskBand band;
    band.half = sign_change([&](double f) { return response(f) - 0.5; }, 0, end, steps);
    band.zero = sign_change(response, 0, end, steps);
    if (band.zero < end) band.leakage = largest_size(response, band.zero, end, steps);
    return band;
}

}  // namespace bandlimit
