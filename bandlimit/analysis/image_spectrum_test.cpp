#include "bandlimit/analysis/image_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

Image<float> noise(int width, int height, int channels = 1) {
    Random random(7);
    Image<float> image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = static_cast<float>(random.uniform());
    return image;
}

double variance_of(View<const float> v) {
    double total = 0, squares = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) {
            total += double(v(x, y));
            squares += double(v(x, y)) * double(v(x, y));
        }
    const double n = double(v.width) * v.height;
    return squares / n - total / n * (total / n);
}

double total(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

TEST(RadialSpectrum, Parseval) {
    for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {7, 3}, {16, 16}, {31, 64}, {45, 20}}) {
        const Image<float> image = noise(w, h);
        const RadialSpectrum s = radial_spectrum(image.view(), Window::none);
        EXPECT_NEAR(total(s.power), variance_of(image.view()), 1e-12) << w << " x " << h;
        EXPECT_EQ(std::accumulate(s.coefficients.begin(), s.coefficients.end(), 0), w * h);
    }
}

TEST(RadialSpectrum, OfWhiteNoiseIsFlatAtItsVariance) {
    const Image<float> image = noise(256, 256);
    for (const Window window : {Window::none, Window::hann}) {
        const RadialSpectrum s = radial_spectrum(image.view(), window);
        for (int b = 20; b < 120; b += 20) {
            double density = 0;
            for (int i = b; i < b + 20; ++i) density += s.density[static_cast<std::size_t>(i)] / 20;
            // 20 rings hold more than 3500 coefficients, each with a deviation of its mean: 10 % is over four of
            // theirs.
            EXPECT_NEAR(density, 1.0 / 12, 0.1 / 12) << "bin " << b;
        }
    }
}

TEST(RadialSpectrum, OfACosineLiesInItsBin) {
    const int n = 64;
    Image<float> image(n, n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            image.view()(x, y) =
                static_cast<float>(3 + std::cos(2 * std::numbers::pi * (6.0 * x + 8.0 * y) / n));  // |f| = 10 / 64
    const RadialSpectrum plain = radial_spectrum(image.view(), Window::none);
    EXPECT_NEAR(plain.power[10], 0.5, 1e-6);  // of a cosine; in float
    EXPECT_NEAR(total(plain.power), 0.5, 1e-6);
    EXPECT_NEAR(plain.frequency(10), 10.0 / 64, 1e-15);
    const RadialSpectrum tapered = radial_spectrum(image.view());
    EXPECT_NEAR(total(tapered.power), 0.5, 1e-3);
    EXPECT_GT(tapered.power[9] + tapered.power[10] + tapered.power[11], 0.49);
}

TEST(RadialSpectrum, IsTheMeanOverChannels) {
    const Image<float> image = noise(20, 12, 3);
    const RadialSpectrum all = radial_spectrum(image.view());
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += radial_spectrum(channels_of(image.view(), c)).power[4];
    EXPECT_NEAR(all.power[4], sum / 3, 1e-15);
}

TEST(RadialSpectrum, NotFiniteIsZeroAndEmptyIsRefused) {
    Image<float> image = noise(8, 8), zeroed = image.clone();
    image.view()(3, 2) = std::numeric_limits<float>::quiet_NaN();
    image.view()(4, 4) = std::numeric_limits<float>::infinity();
    zeroed.view()(3, 2) = zeroed.view()(4, 4) = 0;
    EXPECT_EQ(radial_spectrum(image.view()).power, radial_spectrum(zeroed.view()).power);
    EXPECT_THROW(radial_spectrum(Image<float>(0, 4).view()), Error);
}

}  // namespace
}  // namespace bandlimit
