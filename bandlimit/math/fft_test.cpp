#include "bandlimit/math/fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Complex = std::complex<double>;

std::vector<Complex> noise(int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Complex> x;
    for (int n = 0; n < count; ++n) x.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1));
    return x;
}

/// The definition; k n is reduced modulo N so that the angle is exact to a rounding.
std::vector<Complex> dft(const std::vector<Complex>& x) {
    const std::size_t count = x.size();
    std::vector<Complex> result(count);
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t n = 0; n < count; ++n)
            result[k] += x[n] * std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k * n % count) /
                                                    static_cast<double>(count));
    return result;
}

double energy(const std::vector<Complex>& x) {
    double sum = 0;
    for (const Complex z : x) sum += std::norm(z);
    return sum;
}

/// Sums of N terms below sqrt 2 each, in both the definition and the transform: N 2^-50 leaves a factor of 4.
double bound(std::size_t count) { return static_cast<double>(count) * 0x1p-50; }

TEST(Fft, AgreesWithItsDefinition) {
    for (int count = 1; count <= 64; ++count) {
        const std::vector<Complex> x = noise(count, 1), fast = fft(x), slow = dft(x);
        ASSERT_EQ(fast.size(), x.size());
        for (std::size_t k = 0; k < x.size(); ++k) ASSERT_LE(std::abs(fast[k] - slow[k]), bound(x.size())) << count;
    }
}

TEST(Fft, InverseBringsBackTheInput) {
    for (const int count : {1, 2, 3, 5, 7, 31, 60, 127, 1000, 1024}) {
        const std::vector<Complex> x = noise(count, 2), back = inverse_fft(fft(x));
        for (std::size_t n = 0; n < x.size(); ++n) ASSERT_LE(std::abs(back[n] - x[n]), bound(x.size())) << count;
    }
}

TEST(Fft, Parseval) {
    for (const int count : {1, 2, 17, 40, 360, 1021}) {
        const std::vector<Complex> x = noise(count, 3);
        ASSERT_NEAR(energy(fft(x)) / count, energy(x), energy(x) * bound(x.size())) << count;
    }
}

TEST(Fft, EmptyIsEmpty) { EXPECT_TRUE(fft({}).empty()); }

TEST(Fft, GridTransformsRowsAndColumns) {
    for (const auto& [w, h] : {std::pair{1, 1}, {5, 1}, {1, 6}, {7, 4}, {8, 8}}) {
        ComplexGrid grid(w, h);
        grid.values = noise(w * h, 4);
        const ComplexGrid before = grid;
        fft(grid);
        for (int v = 0; v < h; ++v)
            for (int u = 0; u < w; ++u) {
                Complex sum = 0;
                for (int y = 0; y < h; ++y)
                    for (int x = 0; x < w; ++x)
                        sum += before.at(x, y) *
                               std::polar(1.0, -2 * std::numbers::pi * (double(u * x) / w + double(v * y) / h));
                ASSERT_LE(std::abs(grid.at(u, v) - sum), 8 * bound(grid.values.size())) << w << 'x' << h;
            }
        inverse_fft(grid);
        for (std::size_t i = 0; i < grid.values.size(); ++i)
            ASSERT_LE(std::abs(grid.values[i] - before.values[i]), bound(grid.values.size()));
    }
}

TEST(Fft, BinFrequenciesCoverTheHalfOpenBand) {
    EXPECT_EQ(bin_frequency(0, 8), 0);
    EXPECT_EQ(bin_frequency(3, 8), 0.375);
    EXPECT_EQ(bin_frequency(4, 8), -0.5);
    EXPECT_EQ(bin_frequency(7, 8), -0.125);
    EXPECT_EQ(bin_frequency(2, 5), 0.4);
    EXPECT_EQ(bin_frequency(3, 5), -0.4);
    EXPECT_EQ(bin_frequency(0, 1), 0);
}

}  // namespace
}  // namespace bandlimit
