#include "bandlimit/design/derivative.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit {
namespace {

using std::numbers::pi;
using Optimal = DerivativeOptions::Optimal;

/// The derivative that the taps find of x^n at their position.
double derivative_of_power(const DerivativeDesign& design, int n) {
    double sum = 0;
    for (std::size_t j = 0; j < design.taps.weights.size(); ++j)
        sum += design.taps.weights[j] * std::pow(design.taps.first + static_cast<double>(j) - design.position, n);
    return sum;
}

std::complex<double> response_of(const DerivativeDesign& design, double f) {
    return response(PlacedWeights(design.taps, design.position), f);
}

/// The mean of |H - ideal|^2 over the band relative to that of the ideal, from the taps alone.
double error_of(const DerivativeDesign& design, double band) {
    const auto rest = [&](double f) { return std::norm(response_of(design, f) - std::complex(0.0, 2 * pi * f)); };
    return integrate(rest, 0, band, 32) / (4 * pi * pi * band * band * band / 3);
}

/// c_1, c_2, ... as the header has them.
std::vector<double> right_half(const DerivativeDesign& design) {
    const auto& w = design.taps.weights;
    return {w.end() - static_cast<std::ptrdiff_t>(w.size() / 2), w.end()};
}

void expect_near(const std::vector<double>& actual, const std::vector<double>& expected, double tolerance) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t k = 0; k < actual.size(); ++k) EXPECT_NEAR(actual[k], expected[k], tolerance) << k;
}

TEST(Derivative, IsAntisymmetricAndSumsToNothing) {
    for (int taps = 2; taps <= 40; ++taps)
        for (const Optimal optimal : {Optimal::taylor, Optimal::least_squares}) {
            const DerivativeDesign design = design_derivative({.taps = taps, .optimal = optimal});
            const auto& w = design.taps.weights;
            ASSERT_EQ(w.size(), static_cast<std::size_t>(taps));
            for (std::size_t j = 0; j < w.size(); ++j) EXPECT_EQ(w[j], -w[w.size() - 1 - j]);
            EXPECT_EQ(design.taps.first + (taps - 1) / 2.0, design.position) << "their middle is where it is taken";
        }
}

TEST(Derivative, TaylorIsExactForPolynomialsAndForNoneAbove) {
    for (int taps = 2; taps <= 12; ++taps) {
        const DerivativeDesign design = design_derivative({.taps = taps});
        const int highest = taps % 2 == 1 ? taps - 1 : taps;  // by antisymmetry an even power comes for free
        for (int n = 0; n <= highest; ++n)
            EXPECT_NEAR(derivative_of_power(design, n), n == 1 ? 1 : 0, 1e-12 * std::pow(taps / 2.0, n))
                << taps << " taps, x^" << n;
        const int above = highest % 2 == 0 ? highest + 1 : highest + 2;
        EXPECT_GT(std::abs(derivative_of_power(design, above)), 0.1);
    }
}

TEST(Derivative, KnownWeights) {
    expect_near(design_derivative({.taps = 2}).taps.weights, {-1, 1}, 1e-15);
    expect_near(design_derivative({.taps = 3}).taps.weights, {-0.5, 0, 0.5}, 1e-15);
    expect_near(right_half(design_derivative({.taps = 4})), {9 / 8.0, -1 / 24.0}, 1e-15);
    expect_near(design_derivative({.taps = 5}).taps.weights, {1 / 12.0, -2 / 3.0, 0, 2 / 3.0, -1 / 12.0}, 1e-15);
    expect_near(right_half(design_derivative({.taps = 9})), {4 / 5.0, -1 / 5.0, 4 / 105.0, -1 / 280.0}, 1e-15);
    const auto squares = [](int taps, bool ramp) {
        return design_derivative({.taps = taps, .optimal = Optimal::least_squares, .exact_ramp = ramp});
    };
    expect_near(right_half(squares(9, false)), {1, -1 / 2.0, 1 / 3.0, -1 / 4.0}, 1e-13);
    // Sixty times the constrained ones: the unconstrained ones and k, whose squares sum to 30.
    expect_near(right_half(squares(9, true)), {61 / 60.0, -28 / 60.0, 23 / 60.0, -11 / 60.0}, 1e-13);
    // Halfway: the samples of the sinc's derivative, (-1)^(k+1) / (pi s_k^2).
    expect_near(right_half(squares(4, false)), {4 / pi, -4 / (9 * pi)}, 1e-13);
}

TEST(Derivative, RampGain) {
    const auto gain = [](DerivativeOptions options) {
        const DerivativeDesign design = design_derivative(options);
        EXPECT_NEAR(design.ramp_gain, derivative_of_power(design, 1), 1e-12);
        return design.ramp_gain;
    };
    for (int taps = 2; taps <= 24; ++taps) {
        EXPECT_NEAR(gain({.taps = taps}), 1, 1e-13);
        EXPECT_NEAR(gain({.taps = taps, .optimal = Optimal::least_squares, .exact_ramp = true}), 1, 1e-13);
    }
    EXPECT_NEAR(gain({.taps = 9, .optimal = Optimal::least_squares}), 0, 1e-12);
    EXPECT_NEAR(gain({.taps = 7, .optimal = Optimal::least_squares}), 2, 1e-12);
}

TEST(Derivative, LeastSquaresIsTheLeastNearby) {
    Random random(3);
    for (const int taps : {4, 5, 9})
        for (const double band : {0.25, 0.5})
            for (const bool ramp : {false, true}) {
                const DerivativeDesign design = design_derivative(
                    {.taps = taps, .optimal = Optimal::least_squares, .exact_ramp = ramp, .band = band});
                EXPECT_NEAR(design.error, error_of(design, band), 1e-12);
                EXPECT_LE(design.error, design_derivative({.taps = taps, .band = band}).error) << "as ramp is exact";
                for (int trial = 0; trial < 50; ++trial) {
                    DerivativeDesign near = design;
                    auto& w = near.taps.weights;
                    for (std::size_t j = 0; j < w.size() / 2; ++j) {
                        const double d = 0.01 * (random.uniform() - 0.5);
                        w[j] -= d;
                        w[w.size() - 1 - j] += d;
                    }
                    if (ramp) {
                        const double excess = derivative_of_power(near, 1) - 1;
                        const double end = near.taps.first - near.position;
                        w.front() -= excess / (2 * end), w.back() += excess / (2 * end);
                    }
                    EXPECT_GE(error_of(near, band), design.error - 1e-13);
                }
            }
}

TEST(Derivative, OfASineIsACosine) {
    // The engine runs them: the sign and the place are those of Taps.
    constexpr int count = 64;
    const double f = 4.0 / count;
    for (const int taps : {8, 9}) {
        const DerivativeDesign design = design_derivative({.taps = taps});
        Image<float> sine(count, 1, 1), slope(count, 1, 1);
        for (int i = 0; i < count; ++i) sine.view()(i, 0) = static_cast<float>(std::sin(2 * pi * f * i));
        apply(make_bank(design.taps, count, Edge::wrap), sine.view(), slope.view());
        for (int i = 0; i < count; ++i)
            // The error of order 8 is about (2 pi f)^9 c^2, here 1e-6; float adds as much.
            EXPECT_NEAR(slope.view()(i, 0), 2 * pi * f * std::cos(2 * pi * f * (i + design.position)), 3e-6);
    }
}

TEST(Derivative, OddOnesAreBlindToTheNyquistFrequency) {
    for (const Optimal optimal : {Optimal::taylor, Optimal::least_squares}) {
        EXPECT_NEAR(std::abs(response_of(design_derivative({.taps = 9, .optimal = optimal}), 0.5)), 0, 1e-14);
        EXPECT_GT(std::abs(response_of(design_derivative({.taps = 8, .optimal = optimal}), 0.5)), 2);
    }
}

TEST(Derivative, RefusesOptionsOutOfRange) {
    for (const int taps : {-1, 0, 1, 256}) EXPECT_THROW(design_derivative({.taps = taps}), Error);
    for (const double band : {0.0, -0.1, 0.6, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(design_derivative({.band = band}), Error);
}

}  // namespace
}  // namespace bandlimit
