#include "bandlimit/kernel/low_rank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

double squared_distance(const WeightGrid& a, const WeightGrid& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.weights.size(); ++i) sum += std::pow(a.weights[i] - b.weights[i], 2);
    return sum;
}

double energy(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return sum;
}

TEST(LowRank, WhatIsMissingIsTheEnergyOfTheOtherValues) {
    Random random(7);
    WeightGrid grid(9, 6);
    for (double& w : grid.weights) w = random.uniform(-1, 1);
    const Svd found = svd_of(grid);
    for (int rank = 1; rank <= 6; ++rank) {
        const Terms terms = low_rank(grid, rank);
        ASSERT_EQ(terms.size(), static_cast<std::size_t>(rank));
        double missing = 0;
        for (auto k = static_cast<std::size_t>(rank); k < found.values.size(); ++k)
            missing += found.values[k] * found.values[k];
        EXPECT_NEAR(squared_distance(expanded(terms), grid), missing, 1e-13 * energy(grid.weights)) << rank;
        EXPECT_NEAR(cumulative_energy(found.values)[static_cast<std::size_t>(rank) - 1],
                    1 - missing / energy(grid.weights), 1e-13);
    }
}

TEST(LowRank, ColumnAndRowShareTheSingularValue) {
    const Svd found = svd_of(parse_shape("disc:50:0.8"));
    const Terms terms = low_rank(found, 4);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(energy(terms[k].column), found.values[k], 1e-13 * found.values[0]);
        EXPECT_NEAR(energy(terms[k].row), found.values[k], 1e-13 * found.values[0]);
    }
}

TEST(LowRank, ProductsOfRoundingAreLeftOut) {
    EXPECT_EQ(low_rank(parse_shape("disc:50:0.8"), 50).size(), 14u);
    EXPECT_EQ(low_rank(parse_shape("gaussian:50:5"), 4).size(), 1u);
    const WeightGrid disc = parse_shape("disc:50:0.8");
    EXPECT_LT(squared_distance(expanded(low_rank(disc, 50)), disc), 1e-24);
    const Terms nothing = low_rank(WeightGrid(4, 3), 2);
    ASSERT_EQ(nothing.size(), 1u);
    EXPECT_EQ(energy(nothing[0].column), 0);
}

// Wronski 2020 prints the share of the sum, and calls it energy: .755 for the circle at rank 4. Its energy is .9766.
TEST(LowRank, TheCirclesSharesAreThePublishedOnes) {
    const std::vector<double> values = svd_of(parse_shape("disc:50:0.8")).values;
    EXPECT_NEAR(cumulative_sum(values)[3], 0.755, 0.0005);
    EXPECT_NEAR(cumulative_energy(values)[3], 0.9766, 0.00005);
    EXPECT_EQ(numerical_rank(values, 50, 50), 14);
    EXPECT_EQ(rank_for_energy(values, 0.9765), 4);
    EXPECT_EQ(rank_for_energy(values, 0.9766), 5);
    const int rank = rank_for_energy(values, 0.999);
    EXPECT_GE(cumulative_energy(values)[static_cast<std::size_t>(rank) - 1], 0.999);
    EXPECT_LT(cumulative_energy(values)[static_cast<std::size_t>(rank) - 2], 0.999);
}

TEST(LowRank, RefusesRanksAndSharesThatDoNotExist) {
    const WeightGrid grid = parse_shape("box:5:0.7");
    EXPECT_THROW(low_rank(grid, 0), Error);
    EXPECT_THROW(low_rank(grid, 6), Error);
    EXPECT_THROW(low_rank(WeightGrid(), 1), Error);
    EXPECT_THROW(rank_for_energy(std::vector<double>{1}, 1), Error);
    EXPECT_THROW(rank_for_energy(std::vector<double>{1}, 0), Error);
    EXPECT_THROW(rank_for_energy({}, 0.5), Error);
    EXPECT_EQ(rank_for_energy(std::vector<double>{0, 0}, 0.5), 1);
}

TEST(NumericalRank, CountsWhatIsSmallAndNotWhatIsRounding) {
    // 8 * 2^-52 is 1.8e-15.
    EXPECT_EQ(numerical_rank(std::vector{1.0, 1e-6, 1e-12, 1e-16}, 8, 8), 3);
    EXPECT_EQ(numerical_rank(std::vector{1e-20, 1e-34}, 2, 8), 2);
    EXPECT_EQ(numerical_rank(std::vector{0.0, 0.0}, 2, 2), 0);
}

}  // namespace
}  // namespace bandlimit
