#include "bandlimit/kernel/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

std::vector<Kernel> all_kernels() {
    std::vector<Kernel> kernels;
    for (const KernelInfo& info : kernel_list()) kernels.push_back(parse_kernel(info.example));
    for (const int lobes : {1, 2, 4, 8}) {
        kernels.push_back(lanczos(lobes));
        kernels.push_back(jinc_lanczos(lobes));
        kernels.push_back(jinc_lanczos_unscaled(lobes));
        kernels.push_back(radial_lanczos(lobes));
    }
    for (const auto& [b, c] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {-0.5, 0.2}, {1.5, -0.25}})
        kernels.push_back(cubic(b, c));
    kernels.push_back(truncated_sinc(2.5));
    kernels.push_back(kaiser(2.25, 0));
    kernels.push_back(gaussian(1.25));
    return kernels;
}

/// Integral over the whole support, in panels between the knots.
double integral(const Kernel& kernel) {
    std::vector<double> borders{0};
    borders.insert(borders.end(), kernel.knots.begin(), kernel.knots.end());
    borders.push_back(kernel.radius);
    double sum = 0;
    for (std::size_t i = 1; i < borders.size(); ++i) sum += 2 * integrate(kernel.value, borders[i - 1], borders[i]);
    return sum;
}

TEST(Kernel, IsEvenAndZeroPastItsRadius) {
    for (const Kernel& kernel : all_kernels()) {
        ASSERT_GT(kernel.radius, 0) << kernel.name;
        for (double x = 0; x <= kernel.radius + 2; x += 0x1p-7)
            ASSERT_EQ(kernel.value(-x), kernel.value(x)) << kernel.name << ' ' << x;
        const double beyond = std::nextafter(kernel.radius, std::numeric_limits<double>::infinity());
        for (const double x : {beyond, kernel.radius + 0.5, 2 * kernel.radius, 1e6, 1e300})
            ASSERT_EQ(kernel.value(x), 0) << kernel.name << ' ' << x;
    }
}

TEST(Kernel, IsNotZeroJustInsideItsRadius) {
    // The flattest end is that of B-splines, (distance)^3 / 6 for the cubic one: 2e-10 at a thousandth.
    for (const Kernel& kernel : all_kernels()) {
        if (kernel.name == "cubic:0:0") continue;  // its outer piece vanishes: the radius is that of the family
        EXPECT_GT(std::abs(kernel.value(kernel.radius - 1e-3)), 1e-10) << kernel.name;
    }
}

TEST(Kernel, IsTheMeanOfBothSidesWhereItJumps) {
    for (const Kernel& kernel : all_kernels()) {
        if (kernel.name.ends_with("-unscaled")) continue;  // published as 0 there
        const double r = kernel.radius;
        const double inside = kernel.value(std::nextafter(r, 0)), at = kernel.value(r);
        EXPECT_NEAR(at, inside / 2, 1e-12) << kernel.name;
    }
    EXPECT_EQ(box().value(0.5), 0.5);
    EXPECT_EQ(box().value(std::nextafter(0.5, 0)), 1);
}

TEST(Kernel, InterpolatingOnesAreExactAtIntegers) {
    for (const Kernel& kernel : {nearest(), box(), tent(), quadratic_interpolating(), catmull_rom(), cubic(0, 1),
                                 cubic(0, 0), lanczos(1), lanczos(2), lanczos(3), lanczos(7), truncated_sinc(4),
                                 truncated_sinc(2.5), kaiser(4, 6), kaiser(2.5, 9), radial_lanczos(2), grow3()}) {
        EXPECT_EQ(kernel.value(0), 1) << kernel.name;
        for (int k = 1; k <= 9; ++k) EXPECT_EQ(kernel.value(k), 0) << kernel.name << ' ' << k;
    }
}

TEST(Kernel, SumOfShiftedCopiesIsOneForTheSplinesAndCubics) {
    for (const Kernel& kernel :
         {tent(), quadratic_bspline(), quadratic_interpolating(), bspline(), catmull_rom(), mitchell(),
          cubic(0.7, -0.2), box(), magic_sharp_2013(), magic_sharp_2021(), shrink3(), grow3()})
        for (double phase = 0; phase < 1; phase += 0x1p-6) {
            double sum = 0;
            for (int k = -5; k <= 5; ++k) sum += kernel.value(k - phase);
            ASSERT_NEAR(sum, 1, 1e-15) << kernel.name << ' ' << phase;
        }
}

TEST(Kernel, IntegralIsOneWhereItShouldBe) {
    for (const Kernel& kernel :
         {nearest(), box(), tent(), quadratic_bspline(), quadratic_interpolating(), bspline(), catmull_rom(),
          mitchell(), cubic(0.3, 0.6), magic_sharp_2013(), magic_sharp_2021(), shrink3(), grow3()})
        EXPECT_NEAR(integral(kernel), 1, 1e-14) << kernel.name;
    // Of a Gaussian erf(4 / sqrt 2) lies within 4 sigma.
    EXPECT_NEAR(integral(gaussian(0.5)), 0.5 * std::sqrt(2 * std::numbers::pi) * std::erf(4 / std::sqrt(2.0)), 1e-14);
    // Si(4 pi) 2 / pi, from Si by its own integral.
    const auto integrand = [](double t) { return t == 0 ? 1 : std::sin(t) / t; };
    EXPECT_NEAR(integral(truncated_sinc(4)), 2 / std::numbers::pi * integrate(integrand, 0, 4 * std::numbers::pi, 16),
                1e-14);
}

TEST(Kernel, KnotsLieInsideAndMarkEveryJumpOfPiecewisePolynomials) {
    for (const Kernel& kernel : all_kernels())
        for (std::size_t i = 0; i < kernel.knots.size(); ++i) {
            ASSERT_GT(kernel.knots[i], i == 0 ? 0 : kernel.knots[i - 1]) << kernel.name;
            ASSERT_LT(kernel.knots[i], kernel.radius) << kernel.name;
        }
    // Fourth differences vanish, to rounding, within a piece of degree 3 or less, and across a knot they do not.
    const double h = 0x1p-10;
    for (const Kernel& kernel : {tent(), quadratic_bspline(), quadratic_interpolating(), bspline(), catmull_rom(),
                                 mitchell(), magic_sharp_2013(), magic_sharp_2021()}) {
        const auto fourth = [&](double x) {
            const auto& f = kernel.value;
            return f(x - 2 * h) - 4 * f(x - h) + 6 * f(x) - 4 * f(x + h) + f(x + 2 * h);
        };
        for (double x = 0.25; x + 2 * h < kernel.radius; x += h / 2) {
            const bool near_knot = std::any_of(kernel.knots.begin(), kernel.knots.end(),
                                               [&](double knot) { return std::abs(x - knot) <= 2 * h; });
            ASSERT_TRUE(near_knot || std::abs(fourth(x)) <= 1e-14) << kernel.name << ' ' << x;
        }
        // Off its middle, where the difference of a jump of the second derivative is zero by symmetry.
        for (const double knot : kernel.knots) EXPECT_GT(std::abs(fourth(knot + h / 2)), 1e-10) << kernel.name;
    }
}

TEST(Kernel, KnownValues) {
    EXPECT_EQ(tent().value(0.25), 0.75);
    EXPECT_EQ(quadratic_bspline().value(0), 0.75);
    EXPECT_EQ(quadratic_bspline().value(1), 0.125);
    // Dodgson: -2 x^2 + 1 up to 1/2, x^2 - 5/2 x + 3/2 up to 3/2.
    EXPECT_EQ(quadratic_interpolating().value(0.25), 0.875);
    EXPECT_EQ(quadratic_interpolating().value(0.5), 0.5);
    EXPECT_EQ(quadratic_interpolating().value(1.25), -0.0625);
    EXPECT_NEAR(bspline().value(0), 2.0 / 3, 1e-16);
    EXPECT_NEAR(bspline().value(1), 1.0 / 6, 1e-16);
    EXPECT_NEAR(mitchell().value(0), 8.0 / 9, 1e-15);
    EXPECT_NEAR(mitchell().value(1), 1.0 / 18, 1e-16);
    EXPECT_EQ(catmull_rom().value(0.5), 9.0 / 16);
    EXPECT_EQ(catmull_rom().value(1.5), -1.0 / 16);
    const double half = 2 / std::numbers::pi;
    EXPECT_NEAR(lanczos(2).value(0.5), half * std::sin(std::numbers::pi / 4) / (std::numbers::pi / 4), 1e-15);
    EXPECT_NEAR(gaussian(0.5).value(0.5), std::exp(-0.5), 1e-15);
    EXPECT_NEAR(blackman_harris().value(1), std::exp(-2.29), 1e-15);
    // The quadratic B-spline behind -1/4, 3/2, -1/4.
    for (double x = 0; x < 3; x += 0x1p-5) {
        const auto spline = quadratic_bspline().value;
        ASSERT_NEAR(magic_sharp_2013().value(x), 1.5 * spline(x) - 0.25 * (spline(x - 1) + spline(x + 1)), 1e-15) << x;
    }
}

TEST(Kernel, BlackmanHarrisFitsItsWindow) {
    // The largest difference of the usual fit, computed independently: 0.0205.
    double worst = 0;
    for (double x = 0; x < 1.65; x += 1e-4)
        worst = std::max(worst, std::abs(blackman_harris().value(x) - blackman_harris_window().value(x)));
    EXPECT_NEAR(worst, 0.0205, 5e-5);
    EXPECT_NEAR(blackman_harris_window().value(0), 1, 1e-15);
    EXPECT_NEAR(blackman_harris_window().value(std::nextafter(1.65, 0)), 6e-5, 1e-12);
}

TEST(Kernel, KaiserWithoutWindowIsTheSinc) {
    for (double x = 0; x < 4; x += 0.01) ASSERT_EQ(kaiser(4, 0).value(x), truncated_sinc(4).value(x));
    EXPECT_NEAR(kaiser(4, 6).value(2.5), sinc(2.5) * bessel_i0(6 * std::sqrt(1 - 0.390625)) / bessel_i0(6), 1e-15);
}

TEST(Radial, ScaledJincEndsContinuouslyAtItsZero) {
    for (const auto& [lobes, zero] : {std::pair{1, 1.2197}, {2, 2.2331}, {3, 3.2383}}) {
        const Kernel kernel = jinc_lanczos(lobes);
        EXPECT_TRUE(is_radial(kernel));
        EXPECT_NEAR(kernel.radius, zero, 1e-4);
        EXPECT_EQ(kernel.value(0), 0.25);  // jinc(0)^2
        EXPECT_NEAR(kernel.value(kernel.radius - 1e-9), 0, 1e-9);
        EXPECT_NEAR(kernel.value(1.2197), 0, 1e-4) << "the first zero of jinc";
    }
}

TEST(Radial, UnscaledJincJumpsAtItsEdge) {
    EXPECT_NEAR(jinc_lanczos_unscaled(2).value(2 - 1e-12), -0.00962, 5e-6);
    EXPECT_NEAR(jinc_lanczos_unscaled(3).value(3 - 1e-12), 0.00534, 5e-6);
    EXPECT_NEAR(jinc_lanczos_unscaled(2).value(0), std::numbers::pi / 4, 1e-15);
    EXPECT_EQ(jinc_lanczos_unscaled(2).radius, 2);
    EXPECT_EQ(jinc_lanczos_unscaled(2).value(2), 0) << "as published, for r < 2";
}

TEST(Radial, WrongLanczosIsTheOneDimensionalOne) {
    for (double x = 0; x < 3; x += 0.01) ASSERT_EQ(radial_lanczos(2).value(x), lanczos(2).value(x));
    EXPECT_TRUE(is_radial(radial_lanczos(2)));
    EXPECT_FALSE(is_radial(lanczos(2)));
}

TEST(Kernel, RefusesParametersOutOfRange) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const int lobes : {-1, 0, 1001}) {
        EXPECT_THROW(lanczos(lobes), Error);
        EXPECT_THROW(jinc_lanczos(lobes), Error);
        EXPECT_THROW(jinc_lanczos_unscaled(lobes), Error);
        EXPECT_THROW(radial_lanczos(lobes), Error);
    }
    for (const double bad : {nan, infinity, -infinity, -1.0, 1e9}) {
        EXPECT_THROW(truncated_sinc(bad), Error);
        EXPECT_THROW(gaussian(bad), Error);
        EXPECT_THROW(kaiser(bad, 4), Error);
        EXPECT_THROW(kaiser(4, bad), Error);
    }
    EXPECT_THROW(cubic(nan, 0), Error);
    EXPECT_THROW(cubic(0, infinity), Error);
}

}  // namespace
}  // namespace bandlimit
