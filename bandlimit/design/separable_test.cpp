#include "bandlimit/design/separable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

TEST(SeparableLoss, IsTheSumOfThreeMeans) {
    WeightGrid shape(2, 2), weights(2, 2);
    shape.weights = {1, 0, 0, 2};
    weights.weights = {0.5, 0.25, -1, -2};
    const double squares = (0.25 + 0.0625 + 1 + 16) / 4, negative = 3.0 / 4, leaked = 1.25 / 4;
    EXPECT_DOUBLE_EQ(separable_loss(shape, weights, {}), squares);
    EXPECT_DOUBLE_EQ(separable_loss(shape, weights, {0.5, 0}), squares + 0.5 * negative);
    EXPECT_DOUBLE_EQ(separable_loss(shape, weights, {0, 3}), squares + 3 * leaked);
}

TEST(OptimiseSeparable, ReachesLessThanGradientDescent) {
    const WeightGrid circle = parse_shape("disc:50:0.8");
    const Terms start = low_rank(circle, 4);
    const SeparableFit fit = optimise_separable(circle, start, {.non_negative = 0.5, .keep_zeros = 0.3});
    EXPECT_LT(fit.loss, 0.02137);  // gradient descent stops at 0.02167
    EXPECT_NEAR(fit.start_loss, 0.02527, 0.00001);
    EXPECT_EQ(fit.loss, separable_loss(circle, expanded(fit.terms), {0.5, 0.3}));
    ASSERT_EQ(fit.terms.size(), 4u);
    // What the loss is for: both the deepest negative weight and the highest one in a corner shrink.
    const WeightGrid before = expanded(start), after = expanded(fit.terms);
    const auto lowest = [](const WeightGrid& g) { return *std::min_element(g.weights.begin(), g.weights.end()); };
    EXPECT_LT(lowest(before), -0.19);
    EXPECT_GT(lowest(after), -0.01);
    EXPECT_GT(std::abs(before.at(3, 3)), 10 * std::abs(after.at(3, 3)));
}

TEST(OptimiseSeparable, IsAStationaryPoint) {
    // A small shape, so that steps of every parameter are quick: none to either side lowers the loss by more than the
    // smoothing left over could, 1e-5 of the peak times the factors.
    const WeightGrid shape = parse_shape("disc:13:0.7");
    const SeparableLoss loss{0.5, 0.3};
    const SeparableFit fit = optimise_separable(shape, low_rank(shape, 2), loss);
    for (const double step : {-1e-3, 1e-3}) {
        for (std::size_t i = 0; i < 2 * 26; ++i) {
            Terms moved = fit.terms;
            auto& values = i % 2 == 0 ? moved[i / 26].column : moved[i / 26].row;
            values[(i / 2) % 13] += step;
            EXPECT_GT(separable_loss(shape, expanded(moved), loss), fit.loss - 1e-5 * 0.8) << i;
        }
    }
}

TEST(OptimiseSeparable, KeepsTheBestOfSquaresWhenNothingElseCounts) {
    const WeightGrid shape = parse_shape("disc:20:0.8");
    const Terms best = low_rank(shape, 3);
    const SeparableFit fit = optimise_separable(shape, best, {});
    EXPECT_LE(fit.loss, fit.start_loss);
    EXPECT_NEAR(fit.loss, fit.start_loss, 1e-14);  // Eckart and Young: there is none better
}

TEST(OptimiseSeparable, FindsTheBestOfSquaresFromElsewhere) {
    const WeightGrid shape = parse_shape("exponential:16:3");
    Random random(5);
    Terms start(2, {std::vector<double>(16), std::vector<double>(16)});
    for (Term& term : start)
        for (std::vector<double>* values : {&term.column, &term.row})
            for (double& v : *values) v = random.uniform(0, 1);
    const double best = separable_loss(shape, expanded(low_rank(shape, 2)), {});
    EXPECT_NEAR(optimise_separable(shape, start, {}).loss, best, 1e-8);
}

TEST(OptimiseSeparable, GrowsWithTheShape) {
    // Squares and magnitudes scale differently: with factors times the scale, all do by its square. A power of 2 leaves
    // the rounding of every step alike but for the solver's own tolerances.
    WeightGrid shape = parse_shape("disc:12:0.8");
    const double loss = optimise_separable(shape, low_rank(shape, 2), {0.5, 0.3}).loss;
    for (double& w : shape.weights) w *= 256;
    EXPECT_NEAR(optimise_separable(shape, low_rank(shape, 2), {128, 76.8}).loss / 65536, loss, 1e-4 * loss);
}

TEST(OptimiseSeparable, SaysHowFarItIs) {
    const WeightGrid shape = parse_shape("disc:12:0.8");
    std::vector<double> done;
    optimise_separable(shape, low_rank(shape, 2), {0.5, 0.3}, [&](double part) { done.push_back(part); });
    ASSERT_FALSE(done.empty());
    EXPECT_GT(done.front(), 0);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
    EXPECT_EQ(done.back(), 1);
}

TEST(OptimiseSeparable, RefusesWhatHasNoLoss) {
    const WeightGrid shape = parse_shape("disc:12:0.8");
    const Terms terms = low_rank(shape, 2);
    EXPECT_THROW(optimise_separable(parse_shape("disc:13:0.8"), terms, {}), Error);
    EXPECT_THROW(optimise_separable(shape, {}, {}), Error);
    EXPECT_THROW(optimise_separable(shape, terms, {-1, 0}), Error);
    EXPECT_THROW(optimise_separable(shape, terms, {0, std::numeric_limits<double>::infinity()}), Error);
    Terms broken = terms;
    broken[0].row[3] = std::nan("");
    EXPECT_THROW(optimise_separable(shape, broken, {}), Error);
}

}  // namespace
}  // namespace bandlimit
