#include "bandlimit/design/noise_rank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// Adds normally distributed noise (Box & Muller 1958).
WeightGrid noisy(WeightGrid grid, double deviation, std::uint64_t seed) {
    Random random(seed);
    for (double& w : grid.weights)
        w += deviation * std::sqrt(-2 * std::log(1 - random.uniform())) *
             std::cos(2 * std::numbers::pi * random.uniform());
    return grid;
}

int suggested(const WeightGrid& grid) { return rank_above_noise(svd_of(grid).values, grid.height, grid.width); }

double squared_distance(const WeightGrid& a, const WeightGrid& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.weights.size(); ++i) sum += std::pow(a.weights[i] - b.weights[i], 2);
    return sum;
}

// 2.858, and the fit 0.56 b^3 - 0.95 b^2 + 1.82 b + 1.43, are from the paper, which says the fit is within 0.02.
TEST(NoiseRank, ThresholdsAreThePublishedOnes) {
    EXPECT_NEAR(noise_threshold(50, 50), 2.858, 0.0005);
    for (int rows = 5; rows <= 100; rows += 5) {
        const double b = rows / 100.0, fit = 0.56 * b * b * b - 0.95 * b * b + 1.82 * b + 1.43;
        EXPECT_NEAR(noise_threshold(rows, 100), fit, 0.021) << b;
        EXPECT_EQ(noise_threshold(rows, 100), noise_threshold(100, rows));
    }
}

TEST(NoiseRank, FindsTheRankUnderNoise) {
    const WeightGrid three = expanded(low_rank(parse_shape("disc:50:0.8"), 3));
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        // The third value is 5.0; those of noise reach 2 sqrt(50) = 14 deviations.
        EXPECT_EQ(suggested(noisy(three, 0.1, seed)), 3) << seed;
        EXPECT_EQ(suggested(noisy(parse_shape("gaussian:50:5"), 0.1, seed)), 1) << seed;
    }
    EXPECT_EQ(suggested(noisy(WeightGrid(40, 30), 1, 1)), 1);  // nothing but noise: there is no rank 0
}

TEST(NoiseRank, ThatRankIsNearestToTheTruth) {
    const WeightGrid truth = expanded(low_rank(parse_shape("disc:50:0.8"), 3)), measured = noisy(truth, 0.1, 2);
    const double found = squared_distance(expanded(low_rank(measured, suggested(measured))), truth);
    for (const int rank : {1, 2, 4, 5, 8, 50})
        EXPECT_LT(found, squared_distance(expanded(low_rank(measured, rank)), truth)) << rank;
    EXPECT_LT(found, 0.2 * squared_distance(measured, truth));
}

TEST(NoiseRank, WithoutNoiseItIsTheExactRank) {
    EXPECT_EQ(suggested(parse_shape("disc:50:0.8")), 14);
    EXPECT_EQ(suggested(parse_shape("gaussian:50:5")), 1);
    EXPECT_EQ(suggested(parse_shape("dog:51:5:6")), 2);
}

TEST(NoiseRank, RefusesWhatIsNoMatrix) {
    EXPECT_THROW(noise_threshold(0, 3), Error);
    EXPECT_THROW(rank_above_noise(std::vector<double>{1, 0.5}, 3, 3), Error);
}

}  // namespace
}  // namespace bandlimit
