#include "bandlimit/sampling/sequence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

TEST(Sequence, RadicalInverseMirrorsDigits) {
    EXPECT_EQ(radical_inverse(2, 0), 0);
    EXPECT_EQ(radical_inverse(2, 6), 3 / 8.0);  // 110 to 0.011
    EXPECT_EQ(radical_inverse(3, 5), 7 / 9.0);  // 12 to 0.21
    EXPECT_EQ(radical_inverse(10, 1234), 0.4321);
    EXPECT_THROW(radical_inverse(1, 1), Error);
}

TEST(Sequence, HaltonFillsEachBoxOfPowersOfItsBases) {
    constexpr int columns = 8, rows = 9;
    std::set<std::pair<int, int>> boxes;
    for (std::uint64_t i = 100; i < 100 + columns * rows; ++i) {
        const Point p = halton_point(i);
        boxes.emplace(std::floor((p.x + 0.5) * columns + 1e-9), std::floor((p.y + 0.5) * rows + 1e-9));
    }
    EXPECT_EQ(boxes.size(), columns * rows);
}

TEST(Sequence, R2StepsByPowersOfThePlasticNumber) {
    EXPECT_EQ(r2_point(0).x, 0);
    EXPECT_EQ(r2_point(0).y, 0);
    const double g = 1 / (r2_point(1).x + 1);  // 1/g > 1/2 wraps around
    EXPECT_NEAR(g * g * g, g + 1, 1e-12);
    EXPECT_NEAR(r2_point(1).y + 1, 1 / (g * g), 1e-12);
}

TEST(Sequence, ScrambledSobolIsANetInBaseTwo) {
    // Every box of 2^k columns and 2^(m - k) rows holds one of the first 2^m points, whatever the seed.
    for (const std::uint64_t seed : {1u, 2u, 99u})
        for (int k = 0; k <= 6; ++k) {
            std::set<std::pair<int, int>> boxes;
            for (std::uint32_t i = 0; i < 64; ++i) {
                const Point p = sobol_point(i, seed);
                boxes.emplace(std::floor(std::ldexp(p.x + 0.5, k)), std::floor(std::ldexp(p.y + 0.5, 6 - k)));
            }
            EXPECT_EQ(boxes.size(), 64u) << "seed " << seed << ", " << (1 << k) << " columns";
        }
    EXPECT_NE(sobol_point(0, 1).x, sobol_point(0, 2).x);
    EXPECT_NE(sobol_point(0, 1).x, sobol_point(0, 1).y);
}

constexpr std::array kinds{JitterKind::halton, JitterKind::r2, JitterKind::rotated_grid, JitterKind::sobol};

TEST(Jitter, IsNeverZeroAndStaysInThePixel) {
    for (const JitterKind kind : kinds)
        for (int length = 1; length <= 130; ++length) {
            const std::vector<Point> points = jitter_sequence(kind, length);
            ASSERT_EQ(static_cast<int>(points.size()), length);
            for (const Point& p : points) {
                EXPECT_GT(std::hypot(p.x, p.y), 1e-9) << name_of(kind) << " of " << length;
                EXPECT_TRUE(p.x >= -0.5 && p.x < 0.5 && p.y >= -0.5 && p.y < 0.5) << name_of(kind) << " of " << length;
            }
        }
}

TEST(Jitter, RotatedGridHasOnePointPerRowAndColumn) {
    for (int length = 2; length <= 80; ++length) {
        std::set<long> columns, rows;
        for (const Point& p : jitter_sequence(JitterKind::rotated_grid, length)) {
            columns.insert(std::lround(std::floor((p.x + 0.5) * length)));
            rows.insert(std::lround(std::floor((p.y + 0.5) * length)));
        }
        EXPECT_EQ(static_cast<int>(columns.size()), length);
        EXPECT_EQ(static_cast<int>(rows.size()), length);
    }
    // Of four, the rotated grid of the hardware: (1, 3), (3, -1) ... eighths of a pixel.
    std::set<std::pair<double, double>> four;
    for (const Point& p : jitter_sequence(JitterKind::rotated_grid, 4)) four.emplace(std::abs(p.x), std::abs(p.y));
    EXPECT_EQ(four, (std::set<std::pair<double, double>>{{1 / 8.0, 3 / 8.0}, {3 / 8.0, 1 / 8.0}}));
}

TEST(Jitter, LengthIsEightSamplesPerOutputPixel) {
    EXPECT_EQ(jitter_length(1), 8);
    EXPECT_EQ(jitter_length(1.5), 18);
    EXPECT_EQ(jitter_length(std::sqrt(2)), 16);
    EXPECT_EQ(jitter_length(3), 72);
    EXPECT_THROW(jitter_length(0), Error);
    EXPECT_THROW(jitter_sequence(JitterKind::r2, 0), Error);
    for (const JitterKind kind : kinds) EXPECT_EQ(parse_jitter(name_of(kind)), kind);
    EXPECT_THROW(parse_jitter("hammersley"), Error);
}

}  // namespace
}  // namespace bandlimit
