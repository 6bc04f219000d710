#include "bandlimit/antialias/temporal_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bandlimit/color/transfer.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Codes = std::function<double(int x, int y, int c)>;

/// Linear light of these codes.
Image<float> picture(int width, int height, const Codes& codes) {
    Image<float> image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.view()(x, y, c) = static_cast<float>(srgb_to_linear(codes(x, y, c)));
    return image;
}

Image<float> constant(int width, int height, int channels, std::initializer_list<float> values) {
    Image<float> image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.view()(x, y, c) = values.begin()[c];
    return image;
}

// A pixel that is a + d and a - d in turn has the standard deviation d.
TEST(TemporalMeter, FlickerIsTheDeviationOfCodesOverFrames) {
    TemporalMeter meter(8, 6);
    for (int f = 0; f < 8; ++f) {
        const double sign = f % 2 == 0 ? 1 : -1;
        const Image<float> shown =
            picture(8, 6, [&](int x, int, int c) { return 0.5 + sign * (x < 4 ? 0.02 : 0) * (c == 0 ? 3 : 0); });
        meter.add({.shown = shown.view()}, {3});
    }
    const TemporalMeasures m = meter.measures();
    EXPECT_NEAR(*m.flicker, 0.02 / 2, 1e-6) << "half of the pixels, a third of the channels, three times the deviation";
    EXPECT_NEAR(*m.warped_difference, 2 * 0.02 / 2, 1e-6);
    EXPECT_EQ(m.still, 1);
    EXPECT_FALSE(m.error_elsewhere) << "without a truth";
}

TEST(TemporalMeter, HighlightsAreAsADisplayShowsThem) {
    TemporalMeter meter(2, 2);
    for (int f = 0; f < 4; ++f) meter.add({.shown = constant(2, 2, 4, {2 + float(f), 1, -float(f), 0}).view()});
    EXPECT_EQ(*meter.measures().flicker, 0);
    EXPECT_EQ(*meter.measures().warped_difference, 0);
}

// A linear ramp that moves is its own past, where bilinear reading finds it.
TEST(TemporalMeter, WhatMovesIsComparedWithWhereItWas) {
    const auto ramp_at = [](double offset) {
        return [offset](int x, int y, int) { return 0.1 + 0.02 * (x + offset) + 0.01 * y; };
    };
    const Image<float> motion = constant(16, 8, 2, {-0.5f, 0.25f});
    TemporalMeter right(16, 8), wrong(16, 8);
    for (int f = 0; f < 3; ++f) {
        // now(x, y) = before(x - 0.5, y + 0.25): the ramp shifts by -0.5 * 0.02 + 0.25 * 0.01 per frame
        const Image<float> shown = picture(16, 8, ramp_at(f * (-0.5 + 0.25 * 0.5)));
        right.add({.shown = shown.view(), .motion = motion.view()}, {2});
        wrong.add({.shown = shown.view()});
    }
    EXPECT_NEAR(*right.measures().warped_difference, 0, 1e-6);
    EXPECT_NEAR(*wrong.measures().warped_difference, 0.02 * 0.375, 1e-6);
    EXPECT_FALSE(right.measures().flicker) << "nothing stood still";
    EXPECT_EQ(right.measures().still, 0);
}

TEST(TemporalMeter, ErrorsAreSplitByDisocclusion) {
    Image<float> disocclusion(10, 4);
    for (int y = 0; y < 4; ++y) disocclusion.view()(2, y) = 1;
    const Image<float> shown = constant(10, 4, 3, {0.5f, 0.5f, 0.5f});
    Image<float> truth = constant(10, 4, 3, {0.4f, 0.5f, 0.5f});
    for (int y = 0; y < 4; ++y)
        for (int c = 0; c < 3; ++c) truth.view()(2, y, c) = 0.8f;
    TemporalMeter meter(10, 4);
    meter.add({.shown = shown.view(), .truth = truth.view(), .disocclusion = disocclusion.view()});
    const TemporalMeasures m = meter.measures();
    EXPECT_NEAR(*m.error_disoccluded, 0.3, 1e-6);
    EXPECT_NEAR(*m.error_elsewhere, 0.1 / std::sqrt(3), 1e-6);
    EXPECT_FALSE(m.flicker) << "one frame does not flicker";
    EXPECT_FALSE(m.warped_difference);
}

TEST(TemporalMeter, HasTheSameBitsForAnyThreads) {
    Random random(7);
    TemporalMeter one(40, 33), four(40, 33);
    for (int f = 0; f < 4; ++f) {
        Image<float> shown(40, 33, 3), motion(40, 33, 2);
        for (int y = 0; y < 33; ++y)
            for (int x = 0; x < 40; ++x) {
                for (int c = 0; c < 3; ++c) shown.view()(x, y, c) = static_cast<float>(random.uniform());
                motion.view()(x, y, 0) = x < 20 ? 0 : 3 * static_cast<float>(random.uniform());
            }
        const ShownFrame frame{.shown = shown.view(), .truth = shown.view(), .motion = motion.view()};
        one.add(frame, {1});
        four.add(frame, {4});
    }
    EXPECT_EQ(*one.measures().flicker, *four.measures().flicker);
    EXPECT_EQ(*one.measures().warped_difference, *four.measures().warped_difference);
    EXPECT_EQ(*one.measures().error_elsewhere, 0);
    EXPECT_NEAR(one.measures().still, 0.5, 1e-12);
}

TEST(TemporalMeter, RefusesOtherShapes) {
    EXPECT_THROW(TemporalMeter(0, 4), Error);
    TemporalMeter meter(4, 4);
    const Image<float> good(4, 4, 3), small(3, 4, 3), grey(4, 4, 1);
    EXPECT_THROW(meter.add({.shown = small.view()}), Error);
    EXPECT_THROW(meter.add({.shown = grey.view()}), Error);
    EXPECT_THROW(meter.add({.shown = good.view(), .truth = small.view()}), Error);
    EXPECT_THROW(meter.add({.shown = good.view(), .motion = grey.view()}), Error);
}

// A wave below the limit has nothing above it, one beyond it all; of white noise, the part of the plane that is there.
TEST(EnergyAboveHalfNyquist, IsAShareOfThePlaneOfFrequencies) {
    const auto wave = [](double frequency) {
        Image<float> image(64, 64, 3);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    image.view()(x, y, c) = static_cast<float>(0.5 + 0.3 * std::cos(2 * M_PI * frequency * x));
        return energy_above_half_nyquist(image.view());
    };
    EXPECT_NEAR(wave(0.125), 0, 1e-6);
    EXPECT_NEAR(wave(0.4), 1, 1e-3);
    Random random(3);
    Image<float> noise(96, 96, 1);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) noise.view()(x, y) = static_cast<float>(random.uniform());
    EXPECT_NEAR(energy_above_half_nyquist(noise.view()), 1 - M_PI / 16, 0.03);
    EXPECT_EQ(energy_above_half_nyquist(constant(8, 8, 3, {1, 1, 1}).view()), 0);
}

}  // namespace
}  // namespace bandlimit
