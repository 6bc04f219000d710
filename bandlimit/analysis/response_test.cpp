#include "bandlimit/analysis/response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-14;  // of a few dozen operations in double on values near 1

PlacedWeights at_phase(const Kernel& kernel, double phase) { return {weights_at(kernel, phase).taps, phase}; }

Taps random_taps(Random& random, int factor) {
    Taps taps{random.integer(-4, 2), {}, factor};
    const int count = random.integer(1, 9);
    for (int i = 0; i < count; ++i) taps.weights.push_back(random.uniform(-1, 1));
    return taps;
}

// The fact that defines a response: e^{2 pi i f x} goes in, H(f) e^{2 pi i f o} comes out at o. A complex wave is two
// real ones: a cosine and a sine, in two channels.
TEST(Response, PredictsWhatABankDoesToACosine) {
    Random random(1);
    for (int trial = 0; trial < 50; ++trial) {
        const int factor = random.integer(1, 3), count = 60 * factor;
        const Taps taps = random_taps(random, factor);
        const double f = random.uniform(0, 0.5);
        Image<float> in(count, 1, 2), out(count / factor, 1, 2);
        for (int x = 0; x < count; ++x) {
            in.view()(x, 0, 0) = static_cast<float>(std::cos(2 * pi * f * x));
            in.view()(x, 0, 1) = static_cast<float>(std::sin(2 * pi * f * x));
        }
        apply(make_bank(taps, count, Edge::reflect), in.view(), out.view());
        for (int i = 10; i < count / factor - 10; ++i) {
            const double position = i * factor + (factor - 1) / 2.0;
            const std::complex<double> expected = response(taps, f) * std::polar(1.0, 2 * pi * f * position);
            EXPECT_NEAR(double(out.view()(i, 0, 0)), expected.real(), 1e-5);  // floats: 9 taps of at most 1
            EXPECT_NEAR(double(out.view()(i, 0, 1)), expected.imag(), 1e-5);
        }
    }
}

TEST(Response, OfABankRowIsThatOfItsPhase) {
    const Axis src{12, 0, 12}, dst{30, 0, 12};
    const Bank bank = make_bank(catmull_rom(), src, dst, Edge::reflect);
    for (int i = 0; i < 30; ++i) {
        const double position = src.index(dst.position(i)), phase = position - std::floor(position);
        for (const double f : {0.0, 0.1, 0.37, 0.5}) {
            const auto row = response(PlacedWeights(bank, i, position), f);
            EXPECT_LT(std::abs(row - response(at_phase(catmull_rom(), phase), f)), 1e-6);  // weights in float
        }
    }
}

TEST(Response, OfSymmetricWeightsIsReal) {
    EXPECT_EQ(response(Taps{-1, {0.25, 0.5, 0.25}}, 0.5), 0.0);
    EXPECT_NEAR(response(Taps{-1, {0.25, 0.5, 0.25}}, 0.25).real(), 0.5, rounding);
    EXPECT_NEAR(response(Taps{0, {0.5, 0.5}, 2}, 0.2).real(), std::cos(0.2 * pi), rounding);
    EXPECT_NEAR(response(Taps{0, {0.5, 0.5}, 2}, 0.2).imag(), 0, rounding);
}

TEST(Response, GroupDelayIsAShiftOfTheContentToTheRight) {
    for (const double f : {0.0, 0.1, 0.3, 0.5}) {
        EXPECT_NEAR(group_delay(Taps{-2, {1}}, f), 2, rounding) << "out[i] = in[i - 2]";
        EXPECT_NEAR(group_delay(Taps{-1, {0.25, 0.5, 0.25}}, f == 0.5 ? 0.4 : f), 0, rounding);
    }
    EXPECT_NEAR(group_delay(Taps{0, {0.5, 0.5}}, 0.2), -0.5, rounding);
    EXPECT_TRUE(std::isnan(group_delay(Taps{0, {0.5, 0.5}}, 0.5)));
    // The slope of the phase, by differences.
    const Taps taps{-1, {0.1, 0.6, 0.5, -0.2}};
    const double f = 0.21, h = 1e-6;
    const double slope = std::arg(response(taps, f + h) / response(taps, f - h)) / (2 * h);
    EXPECT_NEAR(group_delay(taps, f), -slope / (2 * pi), 1e-8);  // h^2, and rounding over h
}

TEST(Weights, SumVarianceAndCentroid) {
    const Taps taps{-1, {0.25, 0.5, 0.5}};
    EXPECT_EQ(sum(taps), 1.25);
    EXPECT_EQ(variance(taps), 0.5625);
    EXPECT_NEAR(centroid(taps), 0.2, rounding);
    EXPECT_TRUE(std::isnan(centroid(Taps{-1, {-1, 0, 1}})));
    EXPECT_NEAR(centroid(Taps{0, {0.5, 0.5}, 2}), 0, rounding) << "an output of factor 2 lies between its samples";
}

TEST(Weights, VarianceOfTheUsualKernelsOverPhase) {
    EXPECT_NEAR(variance(at_phase(tent(), 0)), 1, rounding);
    EXPECT_NEAR(variance(at_phase(tent(), 0.5)), 0.5, rounding);
    EXPECT_NEAR(variance(at_phase(tent(), 0.25)), 0.625, rounding);  // [1/4 3/4]
    EXPECT_NEAR(variance(at_phase(bspline(), 0)), 0.5, rounding);
    EXPECT_NEAR(variance(at_phase(bspline(), 0.5)), 0.46007, 5e-6);  // as published, to its digits
    EXPECT_NEAR(variance(at_phase(quadratic_bspline(), 0)), 0.59375, rounding);
    EXPECT_NEAR(variance(at_phase(quadratic_bspline(), 0.5)), 0.5, rounding);
    EXPECT_NEAR(gain(at_phase(quadratic_bspline(), 0), 0.5), 0.5, rounding);
    EXPECT_NEAR(gain(at_phase(quadratic_bspline(), 0.5), 0.5), 0, rounding);
}

TEST(Weights, CentroidOfKernelsThatReproduceRampsIsTheOutput) {
    for (const Kernel& kernel : {tent(), quadratic_bspline(), bspline(), catmull_rom(), mitchell()})
        for (const double phase : {0.0, 1.0 / 6, 0.5, 0.9})
            EXPECT_NEAR(centroid(at_phase(kernel, phase)), 0, rounding) << kernel.name << " at " << phase;
}

TEST(Weights, ParsevalOverOnePeriod) {
    Random random(2);
    for (int trial = 0; trial < 20; ++trial) {
        const Taps taps = random_taps(random, 1);
        const auto energy = [&](double f) { return std::norm(response(taps, f)); };
        EXPECT_NEAR(integrate(energy, -0.5, 0.5, 16), variance(taps), 1e-13);
    }
}

TEST(Bands, OfFiltersWithKnownGain) {
    const Taps binomial{-1, {0.25, 0.5, 0.25}};  // cos^2(pi f), which falls
    EXPECT_NEAR(passband_ripple(binomial, 0.1), 1 - std::pow(std::cos(0.1 * pi), 2), 1e-9);
    EXPECT_NEAR(stopband_leakage(binomial, 0.4), std::pow(std::cos(0.4 * pi), 2), 1e-9);
    // Nine equal weights have the gain |sin 9 pi f / (9 sin pi f)|. Its first side lobe is highest near f = 1.43 / 9.
    const Taps mean{-4, std::vector<double>(9, 1.0 / 9)};
    double highest = 0;
    for (double f = 0.12; f < 0.2; f += 1e-6)
        highest = std::max(highest, std::abs(std::sin(9 * pi * f) / (9 * std::sin(pi * f))));
    EXPECT_NEAR(stopband_leakage(mean, 1.0 / 9), highest, 1e-9);
}

TEST(AliasEnergy, IsTheFoldedPartOfTheIntegral) {
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const int factor = random.integer(2, 4);
        const Taps taps = random_taps(random, factor);
        const auto energy = [&](double f) { return std::norm(response(taps, f)); };
        const double folded = 2 * integrate(energy, 0.5 / factor, 0.5, 16);
        EXPECT_NEAR(alias_energy(taps, factor), folded / variance(taps), 1e-12);
    }
    EXPECT_EQ(alias_energy(Taps{0, {1}}, 1), 0);
    EXPECT_NEAR(alias_energy(Taps{0, {1}}, 2), 0.5, rounding) << "every second sample: half of white noise is alias";
    EXPECT_NEAR(alias_energy(Taps{0, {0.5, 0.5}, 2}, 2), 0.5 - 1 / pi, rounding);  // cos^2(pi f) by hand
}

TEST(Response2D, OfSeparableWeightsIsTheProduct) {
    Random random(4);
    const Taps x = random_taps(random, 1), y = random_taps(random, 2);
    const PlacedWeights2D both{x, y};
    for (const double fx : {0.0, 0.2, -0.4})
        for (const double fy : {0.1, 0.5})
            EXPECT_LT(std::abs(response(both, fx, fy) - response(x, fx) * response(y, fy)), rounding);
    EXPECT_NEAR(variance(both), variance(x) * variance(y), rounding);
}

// The published figures have three digits.
TEST(Response2D, OfRadialKernelsOnAPixelCentre) {
    const PlacedWeights2D jinc{radial_weights_at(jinc_lanczos_unscaled(2), 0, 0), 0, 0};
    EXPECT_NEAR(std::abs(response(jinc, 0.5, 0)), 0.897, 5e-4);
    EXPECT_NEAR(std::abs(response(jinc, 0.5, 0.5)), 0.214, 5e-4);
    const PlacedWeights2D wrong{radial_weights_at(radial_lanczos(2), 0, 0), 0, 0};
    EXPECT_NEAR(std::abs(response(wrong, 0.5, 0)), 1.902, 5e-4);
    EXPECT_NEAR(std::abs(response(wrong, 0.5, 0.5)), 1.0, 5e-4);
}

TEST(Response2D, RadialWeightsTurnedByAQuarterSwapFrequencies) {
    const PlacedWeights2D w{radial_weights_at(jinc_lanczos(2), 0.3, 0.1), 0.3, 0.1};
    const PlacedWeights2D turned{radial_weights_at(jinc_lanczos(2), 0.1, 0.3), 0.1, 0.3};
    EXPECT_LT(std::abs(response(w, 0.2, 0.35) - response(turned, 0.35, 0.2)), rounding);
    EXPECT_NEAR(response(w, 0, 0).real(), 1, rounding);
}

TEST(Response2D, GridHoldsTheFrequenciesOfItsAxes) {
    const PlacedWeights2D w{Taps{-1, {0.25, 0.5, 0.25}}, Taps{0, {1, 2}}};
    const Axis fx{5, -0.5, 0.5}, fy{4, 0, 0.5};
    const ComplexGrid grid = response_grid(w, fx, fy);
    EXPECT_EQ(grid.width, 5);
    EXPECT_EQ(grid.at(3, 2), response(w, fx.position(3), fy.position(2)));
    EXPECT_NEAR(fx.position(2), 0, rounding);
}

TEST(Response, RefusesWhatMakesNoSense) {
    const Taps taps{0, {1}};
    EXPECT_THROW(alias_energy(taps, 0), Error);
    EXPECT_THROW(alias_energy(Taps{0, {0, 0}}, 2), Error);
    EXPECT_THROW(passband_ripple(taps, -0.1), Error);
    EXPECT_THROW(stopband_leakage(taps, 0.5, 0.4), Error);
    const Bank bank = make_bank(tent(), Axis{4}, Axis{8}, Edge::clamp);
    EXPECT_THROW(PlacedWeights(bank, 8, 0), Error);
    EXPECT_THROW(PlacedWeights(bank, -1, 0), Error);
}

}  // namespace
}  // namespace bandlimit
