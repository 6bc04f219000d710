#include "bandlimit/sampling/sequence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

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
    // Every box of 2^k columns and 2^(m - k) rows holds one of the first 2^m points, and of every 2^m that follow,
    // whatever the seed.
    for (const std::uint64_t seed : {0u, 1u, 2u, 99u})
        for (int m = 0; m <= 8; ++m)
            for (const std::uint32_t first : {0u, 5u << m})
                for (int k = 0; k <= m; ++k) {
                    std::set<std::pair<int, int>> boxes;
                    for (std::uint32_t i = 0; i < 1u << m; ++i) {
                        const Point p = sobol_point(first + i, seed);
                        boxes.emplace(std::floor(std::ldexp(p.x + 0.5, k)), std::floor(std::ldexp(p.y + 0.5, m - k)));
                    }
                    EXPECT_EQ(boxes.size(), 1u << m) << "seed " << seed << ", " << (1 << k) << " columns";
                }
    EXPECT_NE(sobol_point(0, 1).x, sobol_point(0, 1).y);
}

/// Pearson's statistic of `pairs` in [0, 1)^2 over 8 x 8 equal cells. Of even pairs its mean is 63, its deviation
/// sqrt(126) = 11.2.
double chi_square(const std::vector<std::pair<double, double>>& pairs) {
    constexpr int side = 8;
    std::array<int, side * side> counts{};
    for (const auto& [a, b] : pairs)
        ++counts[static_cast<std::size_t>(static_cast<int>(a * side) * side + static_cast<int>(b * side))];
    const double expected = double(pairs.size()) / (side * side);
    double sum = 0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

constexpr double least_chi_square = 63 - 4 * 11.2, most_chi_square = 63 + 5 * 11.2;

TEST(Sequence, ScrambledSobolOfManySeedsIsUniform) {
    constexpr int seeds = 8192;
    const double deviation = std::sqrt(1 / 12.0 / seeds);  // of the mean of so many
    for (const std::uint32_t index : {0u, 1u, 2u, 7u, 100u, 4095u}) {
        std::vector<std::pair<double, double>> places;
        std::set<std::pair<double, double>> distinct;
        double x = 0, y = 0;
        for (int seed = 0; seed < seeds; ++seed) {
            const Point p = sobol_point(index, static_cast<std::uint64_t>(seed));
            x += p.x, y += p.y;
            places.emplace_back(p.x + 0.5, p.y + 0.5);
            distinct.emplace(p.x, p.y);
        }
        EXPECT_EQ(distinct.size(), places.size()) << index;
        EXPECT_NEAR(x / seeds, 0, 5 * deviation) << index;
        EXPECT_NEAR(y / seeds, 0, 5 * deviation) << index;
        const double found = chi_square(places);
        EXPECT_TRUE(found > least_chi_square && found < most_chi_square) << index << ": " << found;
    }
}

TEST(Sequence, ScrambledSobolMovesPointsOfAStratumAlone) {
    // Points 2 i and 2 i + 1 lie in different halves; where in these, each says nothing about the other. (One shift for
    // all points would move both alike.)
    for (const std::uint32_t index : {0u, 6u, 50u}) {
        std::vector<std::pair<double, double>> columns, rows;
        const auto in_half = [](double v) { return 2 * (v + 0.5) - std::floor(2 * (v + 0.5)); };
        for (std::uint64_t seed = 0; seed < 8192; ++seed) {
            const Point a = sobol_point(index, seed), b = sobol_point(index + 1, seed);
            EXPECT_TRUE(a.x < 0 ? b.x >= 0 : b.x < 0);
            columns.emplace_back(in_half(a.x), in_half(b.x));
            rows.emplace_back(in_half(a.y), in_half(b.y));
        }
        for (const double found : {chi_square(columns), chi_square(rows)})
            EXPECT_TRUE(found > least_chi_square && found < most_chi_square) << index << ": " << found;
    }
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
