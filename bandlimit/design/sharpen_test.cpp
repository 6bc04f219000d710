#include "bandlimit/design/sharpen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

double error_of(const Taps& taps, const Kernel& kernel, const SharpenOptions& options) {
    const auto rest = [&](double f) {
        return std::norm(response(taps, f) * kernel_response(kernel, options.phase, f) - 1.0);
    };
    return integrate(rest, 0, options.band, 6) / options.band;
}

TEST(Sharpen, UndoesTheKernelInItsBandAsWellAsItSays) {
    for (const Kernel& kernel : {bspline(), quadratic_bspline(), tent(), mitchell(), gaussian(0.5)})
        for (const std::optional<double> phase : {std::optional<double>{}, std::optional(0.0), std::optional(0.5)}) {
            const SharpenOptions options{.taps = 7, .band = 0.3, .phase = phase};
            const SharpenDesign design = design_sharpen(kernel, options);
            const auto& w = design.taps.weights;
            ASSERT_EQ(w.size(), 7u);
            EXPECT_EQ(design.taps.first, -3);
            EXPECT_NEAR(sum(design.taps), 1, 1e-13);
            for (std::size_t j = 0; j < w.size(); ++j) EXPECT_EQ(w[j], w[6 - j]);
            EXPECT_NEAR(design.error, error_of(design.taps, kernel, options), 1e-12) << kernel.name;
            double largest = 0;
            for (int i = 0; i <= 300; ++i)
                largest = std::max(
                    largest,
                    std::abs(response(design.taps, i * 0.001) * kernel_response(kernel, phase, i * 0.001) - 1.0));
            EXPECT_LE(largest, design.droop + 1e-9);
            EXPECT_GE(largest, 0.99 * design.droop);
            EXPECT_LT(design.droop, 0.02) << kernel.name;
        }
}

TEST(Sharpen, MoreTapsUndoMore) {
    double before = 1;
    for (int taps = 3; taps <= 21; taps += 2) {
        const SharpenDesign design = design_sharpen(bspline(), {.taps = taps, .band = 0.4});
        EXPECT_LT(design.error, before);
        before = design.error;
    }
    EXPECT_LT(before, 1e-7);
}

TEST(Sharpen, OfABSplineAtItsSamplesIsTheInterpolatingPrefilter) {
    // 1 / (2/3 + 1/3 cos) is sqrt(3) z^|k| with the pole z = sqrt(3) - 2, of which 31 taps hold all but z^16.
    const SharpenDesign design = design_sharpen(bspline(), {.taps = 31, .band = 0.5, .phase = 0});
    const double pole = std::sqrt(3.0) - 2;
    for (int k = 0; k < 16; ++k)
        EXPECT_NEAR(design.taps.weights[static_cast<std::size_t>(15 + k)], std::sqrt(3.0) * std::pow(pole, k), 1e-8);
    EXPECT_NEAR(design.gain, 3, 1e-6);
}

TEST(Sharpen, LeavesAloneWhatNeedsNothing) {
    const SharpenDesign design = design_sharpen(catmull_rom(), {.phase = 0});
    for (std::size_t j = 0; j < 7; ++j) EXPECT_NEAR(design.taps.weights[j], j == 3 ? 1 : 0, 1e-13);
    EXPECT_NEAR(design.droop, 0, 1e-12);
}

TEST(Sharpen, NoTapsNearbyAreBetter) {
    Random random(9);
    for (const double max_gain : {std::numeric_limits<double>::infinity(), 2.0}) {
        const SharpenOptions options{.taps = 9, .band = 0.35, .max_gain = max_gain};
        const SharpenDesign design = design_sharpen(bspline(), options);
        for (int trial = 0; trial < 60; ++trial) {
            Taps near = design.taps;
            double total = 0;
            for (std::size_t j = 0; j < 5; ++j) {
                near.weights[j] += 0.003 * (random.uniform() - 0.5);
                near.weights[8 - j] = near.weights[j];
            }
            for (const double w : near.weights) total += w;
            near.weights[4] += 1 - total;
            if (stopband_leakage(near, 0, 0.5) <= max_gain) {
                EXPECT_GE(error_of(near, bspline(), options), design.error - 1e-12);
            }
        }
    }
}

TEST(Sharpen, GainStaysBelowItsLimit) {
    double before = design_sharpen(bspline(), {.taps = 15}).error;
    for (const double max_gain : {3.0, 2.0, 1.5, 1.1}) {
        const SharpenDesign design = design_sharpen(bspline(), {.taps = 15, .max_gain = max_gain});
        // Between the frequencies where it is kept: (pi / 512 * 7)^2 / 8 of the height.
        EXPECT_LE(design.gain, max_gain * 1.0003);
        EXPECT_GT(design.error, before) << "each bound costs something";
        before = design.error;
    }
}

TEST(Sharpen, RefusesOptionsOutOfRange) {
    for (const int taps : {-1, 1, 4, 65}) EXPECT_THROW(design_sharpen(bspline(), {.taps = taps}), Error);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double band : {0.0, 0.6, nan}) EXPECT_THROW(design_sharpen(bspline(), {.band = band}), Error);
    for (const double gain : {1.0, 0.0, nan}) EXPECT_THROW(design_sharpen(bspline(), {.max_gain = gain}), Error);
    for (const double phase : {-0.1, 1.0, nan}) EXPECT_THROW(design_sharpen(bspline(), {.phase = phase}), Error);
    EXPECT_THROW(design_sharpen(jinc_lanczos(2)), Error);
}

}  // namespace
}  // namespace bandlimit
