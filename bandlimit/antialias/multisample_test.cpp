#include "bandlimit/antialias/multisample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

constexpr int size = 64;

/// White with fine stripes on one side of a slanted line, black on the other.
ShadedSurfaces striped_half(double period) {
    const Signal wave = stripes({.period = period, .angle = 20, .sinusoid = true});
    return {[](double x, double y) { return x + 0.3 * y < 40 ? 1 : 0; },
            [wave](int surface, double x, double y, double footprint) {
                if (surface == 0) return 0.0;
                if (footprint == 0) return wave.value(x, y);
                const double half = footprint / 2;
                return wave.mean({x - half, y - half, x + half, y + half});
            }};
}

double rms(const Image<float>& a, const Image<float>& b) {
    double sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += std::pow(a.view()(x, y) - b.view()(x, y), 2);
    return std::sqrt(sum / (size * size));
}

TEST(Multisample, OfOneColourEqualsSupersampling) {
    ShadedSurfaces flat = striped_half(3);
    flat.shade = [](int surface, double, double, double) { return surface == 0 ? 0.0 : 1.0; };
    const SamplePattern pattern = d3d_pattern(8);
    EXPECT_EQ(rms(multisample(flat, size, size, pattern), supersample(flat, size, size, pattern)), 0);
}

TEST(Multisample, SmoothsOutlinesAndLeavesWhatAliasesInside) {
    const ShadedSurfaces scene = striped_half(1.3);
    const SamplePattern centre = regular_pattern(1);
    const Image<float> point = multisample(scene, size, size, centre, 0);
    const Image<float> multi = multisample(scene, size, size, d3d_pattern(8), 0);
    int inside = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (x + 0.3 * y < 38) {
                EXPECT_EQ(multi.view()(x, y), point.view()(x, y));
                ++inside;
            }
    EXPECT_GT(inside, size * size / 4);
}

TEST(Multisample, MipsHelpMultisamplingAsMuchAsManySamples) {
    const ShadedSurfaces scene = striped_half(1.3);
    const SamplePattern pattern = d3d_pattern(8);
    const Image<float> truth = supersample(scene, size, size, regular_pattern(1024));
    const double multi = rms(multisample(scene, size, size, pattern, 0), truth);
    const double multi_mips = rms(multisample(scene, size, size, pattern, 1), truth);
    const double super = rms(supersample(scene, size, size, pattern, 0), truth);
    const double super_mips = rms(supersample(scene, size, size, pattern, 1 / std::sqrt(8)), truth);
    EXPECT_LT(multi_mips, multi / 5);
    EXPECT_LT(super, multi / 2);
    EXPECT_LT(super_mips, super);
}

TEST(Multisample, WrongArgumentsAreRefused) {
    EXPECT_THROW(multisample(striped_half(3), 0, 1, d3d_pattern(2)), Error);
    EXPECT_THROW(multisample(striped_half(3), 1, 1, {"none", {}}), Error);
    EXPECT_THROW(supersample(striped_half(3), 1, 1, d3d_pattern(2), -1), Error);
}

}  // namespace
}  // namespace bandlimit
