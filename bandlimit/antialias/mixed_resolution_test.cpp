#include "bandlimit/antialias/mixed_resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bandlimit/core/error.h"
#include "bandlimit/signal/render.h"

namespace bandlimit {
namespace {

constexpr std::array modes{MixedMode::full, MixedMode::uniform, MixedMode::interlaced, MixedMode::checkerboard};

PointValue of_signal(const Signal& signal) {
    return [value = signal.value](double x, double y, std::span<float> to) { to[0] = static_cast<float>(value(x, y)); };
}

/// A zone plate around the centre of a pixel that reaches Nyquist's frequency at distance size / 2.
Signal centred_plate(int size) {
    const double middle = Axis{1, 0, 1}.position(size / 2);
    return zone_plate({double(size), double(size)}, {.center = Point{middle, middle}, .radius = size / 2.0});
}

/// The RMS difference to the full image where the plate's frequency is below `limit`.
double error_of(int size, MixedMode mode, const Kernel& kernel, double limit) {
    const Signal plate = centred_plate(size);
    const Image<float> truth = render(plate, size, size);
    const Image<float> image = mixed_resolution(of_signal(plate), 1, size, size, mode, kernel);
    double sum = 0, count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (std::hypot(x - size / 2, y - size / 2) / size < limit) {
                sum += std::pow(image.view()(x, y) - truth.view()(x, y), 2);
                ++count;
            }
    return std::sqrt(sum / count);
}

TEST(MixedResolution, CheckerboardEqualsUniformOnTheZonePlateAndInterlacedIsWorst) {
    const double uniform = error_of(64, MixedMode::uniform, tent(), 0.35);
    const double checkerboard = error_of(64, MixedMode::checkerboard, tent(), 0.35);
    const double interlaced = error_of(64, MixedMode::interlaced, tent(), 0.35);
    EXPECT_NEAR(uniform, 0.134, 0.001);
    EXPECT_NEAR(checkerboard, 0.134, 0.001);
    EXPECT_NEAR(interlaced, 0.164, 0.001);
    EXPECT_NEAR(checkerboard / uniform, 1, 0.02);
    EXPECT_EQ(error_of(64, MixedMode::full, tent(), 0.5), 0);
}

TEST(MixedResolution, BetterKernelsReconstructBetter) {
    for (const MixedMode mode : {MixedMode::uniform, MixedMode::interlaced, MixedMode::checkerboard}) {
        const double linear = error_of(128, mode, tent(), 0.3), cubic = error_of(128, mode, catmull_rom(), 0.3);
        EXPECT_LT(cubic, linear * 0.95) << name_of(mode);
        EXPECT_LT(error_of(128, mode, lanczos(3), 0.3), cubic) << name_of(mode);
    }
}

TEST(MixedResolution, CheckerboardKeepsHorizontalWavesAndLosesDiagonalOnes) {
    const auto error = [](MixedMode mode, double angle, double frequency) {
        const Signal wave = stripes({.period = 1 / frequency, .angle = angle, .phase = 0.1, .sinusoid = true});
        const Image<float> truth = render(wave, 60, 60);
        const Image<float> image = mixed_resolution(of_signal(wave), 1, 60, 60, mode, kaiser(12, 8));
        double sum = 0;
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 60; ++x) sum += std::pow(image.view()(x, y) - truth.view()(x, y), 2);
        return std::sqrt(sum / 3600);
    };
    // Uniform rescaling ends at .354 along x and y, at .5 along the diagonals; a checkerboard the other way round.
    EXPECT_LT(error(MixedMode::checkerboard, 0, 0.42), 0.02);
    EXPECT_GT(error(MixedMode::uniform, 0, 0.42), 0.1);
    EXPECT_GT(error(MixedMode::checkerboard, 45, 0.42), 0.1);
    EXPECT_LT(error(MixedMode::uniform, 45, 0.42), 0.02);
}

TEST(MixedResolution, ConstantsStayAndSampledPixelsShowTheirSample) {
    const PointValue constant = [](double, double, std::span<float> to) { std::fill(to.begin(), to.end(), 0.3f); };
    const Signal plate = zone_plate({23, 17});
    const Image<float> truth = render(plate, 23, 17);
    for (const MixedMode mode : modes) {
        for (const char* kernel : {"box", "tent", "bspline", "mitchell", "lanczos3", "jinc3"}) {
            const Image<float> image = mixed_resolution(constant, 3, 23, 17, mode, parse_kernel(kernel));
            for (int x = 0; x < 23; ++x) ASSERT_EQ(image.view()(x, 8, 1), 0.3f) << name_of(mode) << ", " << kernel;
        }
        if (mode == MixedMode::uniform) continue;
        const Image<float> image = mixed_resolution(of_signal(plate), 1, 23, 17, mode, catmull_rom());
        for (int y = 0; y < 17; ++y)
            for (int x = 0; x < 23; ++x) {
                const bool has_sample = mode == MixedMode::full || (mode == MixedMode::interlaced ? y : x + y) % 2 == 0;
                if (!has_sample) continue;
                EXPECT_NEAR(image.view()(x, y), truth.view()(x, y), 1e-6) << name_of(mode);
            }
        EXPECT_EQ(parse_mixed(name_of(mode)), mode);
    }
}

TEST(MixedResolution, BitsDoNotDependOnThreads) {
    for (const MixedMode mode : modes) {
        const Signal plate = centred_plate(33);
        const Image<float> one = mixed_resolution(of_signal(plate), 1, 33, 33, mode, mitchell(), {.threads = 1});
        const Image<float> two = mixed_resolution(of_signal(plate), 1, 33, 33, mode, mitchell(), {.threads = 2});
        for (int y = 0; y < 33; ++y)
            for (int x = 0; x < 33; ++x) ASSERT_EQ(one.view()(x, y), two.view()(x, y));
    }
}

TEST(MixedResolution, WrongArgumentsAreRefused) {
    const PointValue one = of_signal(constant(1));
    EXPECT_THROW(mixed_resolution(one, 5, 4, 4, MixedMode::full, tent()), Error);
    EXPECT_THROW(mixed_resolution(one, 1, 0, 4, MixedMode::full, tent()), Error);
    EXPECT_THROW(mixed_resolution(one, 1, 4, 4, MixedMode::full, nearest()), Error);
    EXPECT_THROW(parse_mixed("half"), Error);
}

}  // namespace
}  // namespace bandlimit
