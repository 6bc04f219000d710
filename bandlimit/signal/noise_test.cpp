#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/math/random.h"
#include "bandlimit/signal/render.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

/// The spectrum of signal - 1/2 at the centres of pixels, scaled to Fourier coefficients.
ComplexGrid spectrum_of(const Signal& signal, int width, int height) {
    ComplexGrid grid(width, height);
    const Axis columns{width, 0, double(width)}, rows{height, 0, double(height)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            grid.at(x, y) = (signal.value(columns.position(x), rows.position(y)) - 0.5) / (double(width) * height);
    fft(grid);
    return grid;
}

double frequency(const ComplexGrid& grid, int x, int y) {
    return std::hypot(bin_frequency(x, grid.width), bin_frequency(y, grid.height));
}

TEST(WhiteNoise, DependsOnThePixelAndTheSeedAlone) {
    const Image<float> small = render(white_noise({.seed = 7}), 13, 9),
                       large = render(white_noise({.seed = 7}), 64, 50);
    const Image<float> other = render(white_noise({.seed = 8}), 13, 9);
    int equal = 0;
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 13; ++x) {
            EXPECT_EQ(small.view()(x, y), large.view()(x, y));
            equal += small.view()(x, y) == other.view()(x, y);
        }
    EXPECT_EQ(equal, 0);
}

TEST(WhiteNoise, IsUniformAndUncorrelated) {
    constexpr int n = 256;
    const Image<float> image = render(white_noise({.seed = 1}), n, n);
    double sum = 0, squares = 0, right = 0, down = 0, diagonal = 0;
    for (int y = 0; y + 1 < n; ++y)
        for (int x = 0; x + 1 < n; ++x) {
            const auto at = [&](int dx, int dy) { return double(image.view()(x + dx, y + dy)) - 0.5; };
            sum += at(0, 0);
            squares += at(0, 0) * at(0, 0);
            right += at(0, 0) * at(1, 0);
            down += at(0, 0) * at(0, 1);
            diagonal += at(1, 0) * at(0, 1);
        }
    // Five standard deviations of the estimates from n^2 values of variance 1/12 each.
    const double count = (n - 1.0) * (n - 1.0), bound = 5 / std::sqrt(count);
    EXPECT_NEAR(sum / count, 0, bound * std::sqrt(1.0 / 12));
    EXPECT_NEAR(squares / count, 1.0 / 12, bound * std::sqrt(1.0 / 180));
    for (const double correlation : {right, down, diagonal}) EXPECT_NEAR(correlation / count, 0, bound / 12);
}

TEST(BandLimitedNoise, HasNothingAboveTheCutoff) {
    for (const double cutoff : {0.06, 0.25, 0.3, 0.5}) {
        const ComplexGrid grid = spectrum_of(band_limited_noise(64, 40, {.seed = 2, .cutoff = cutoff}), 64, 40);
        double inside = 0, outside = 0;
        for (int y = 0; y < grid.height; ++y)
            for (int x = 0; x < grid.width; ++x)
                (frequency(grid, x, y) <= cutoff ? inside : outside) += std::norm(grid.at(x, y));
        EXPECT_LT(outside, 1e-28 * inside) << cutoff;
    }
}

TEST(BandLimitedNoise, FillsTheBandEvenly) {
    const ComplexGrid grid = spectrum_of(band_limited_noise(256, 256, {.seed = 3, .cutoff = 0.4}), 256, 256);
    double power[4] = {};
    int count[4] = {};
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            const double f = frequency(grid, x, y);
            if (f == 0 || f > 0.4) continue;
            const auto ring = static_cast<std::size_t>(f < 0.4 ? f * 10 : 3);
            power[ring] += std::norm(grid.at(x, y));
            ++count[ring];
        }
    const double mean = 0.01 / (count[0] + count[1] + count[2] + count[3]);
    // The mean of n exponentially distributed powers has the relative deviation 1 / sqrt(n / 2): pairs are conjugate.
    for (std::size_t ring = 0; ring < 4; ++ring)
        EXPECT_NEAR(power[ring] / count[ring] / mean, 1, 5 / std::sqrt(count[ring] / 2.0)) << ring;
}

TEST(BandLimitedNoise, HasMeanAndRms) {
    for (const double cutoff : {0.1, 0.45}) {
        const ComplexGrid grid =
            spectrum_of(band_limited_noise(50, 31, {.seed = 5, .cutoff = cutoff, .rms = 0.07}), 50, 31);
        double power = 0;
        for (const std::complex<double>& value : grid.values) power += std::norm(value);
        EXPECT_NEAR(std::abs(grid.at(0, 0)), 0, 1e-15);
        EXPECT_NEAR(std::sqrt(power), 0.07, 1e-14);
    }
}

TEST(BandLimitedNoise, IsPeriodic) {
    const Signal noise = band_limited_noise(20, 12, {.seed = 6, .cutoff = 0.3});
    for (double x = 0.5; x < 20; x += 1.7) EXPECT_NEAR(noise.value(x, 3.25), noise.value(x - 40, 3.25 + 12), 1e-12);
}

TEST(BandLimitedNoise, BetweenPixelsItIsItsFourierSeries) {
    constexpr int width = 16, height = 12;
    const Signal noise = band_limited_noise(width, height, {.seed = 7, .cutoff = 0.3, .rms = 0.1});
    const ComplexGrid grid = spectrum_of(noise, width, height);
    Random random(1);
    for (int k = 0; k < 50; ++k) {
        const double px = random.uniform(0, width), py = random.uniform(0, height);
        // The first sample lies half a pixel from the begin.
        std::complex<double> series = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                series +=
                    grid.at(x, y) *
                    std::polar(1.0, 2 * std::numbers::pi *
                                        (bin_frequency(x, width) * (px - 0.5) + bin_frequency(y, height) * (py - 0.5)));
        EXPECT_NEAR(noise.value(px, py), 0.5 + series.real(), 1e-7);  // 1e-6 of the RMS
    }
}

TEST(BandLimitedNoise, AboveNyquistItIsThereToBeFiltered) {
    const Signal noise = band_limited_noise(16, 16, {.seed = 8, .cutoff = 2});
    EXPECT_NE(noise.value(3.5, 3.5), noise.value(3.75, 3.5));
    EXPECT_TRUE(std::isfinite(noise.value(3.3, 3.4)));
}

TEST(BandLimitedNoise, RefusesWrongOptions) {
    EXPECT_THROW(band_limited_noise(0, 5), Error);
    EXPECT_THROW(band_limited_noise(5, 5, {.cutoff = 0}), Error);
    EXPECT_THROW(band_limited_noise(5, 5, {.cutoff = 20}), Error);
    EXPECT_THROW(band_limited_noise(5, 5, {.cutoff = 0.1}), Error);  // below one period in the frame
    EXPECT_THROW(band_limited_noise(5, 5, {.rms = 0}), Error);
    EXPECT_THROW(band_limited_noise(2147483647, 1, {}), Error);
    EXPECT_THROW(band_limited_noise_bytes(5, -5), Error);
}

TEST(BandLimitedNoise, TellsItsMemory) {
    EXPECT_EQ(band_limited_noise_bytes(100, 50), 100u * 50 * 16);
    EXPECT_EQ(band_limited_noise_bytes(100, 50, {.cutoff = 0.5}), 4u * 100 * 50 * 16);
    EXPECT_EQ(band_limited_noise_bytes(1 << 20, 1 << 20), std::uint64_t{16} << 40);
}

}  // namespace
}  // namespace bandlimit
