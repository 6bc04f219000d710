#include "bandlimit/design/slanted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

WeightGrid noise(int width, int height, std::uint64_t seed) {
    Random random(seed);
    WeightGrid grid(width, height);
    for (double& w : grid.weights) w = random.uniform(-1, 1);
    return grid;
}

WeightGrid transposed(const WeightGrid& grid) {
    WeightGrid result(grid.height, grid.width);
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) result.at(y, x) = grid.at(x, y);
    return result;
}

/// The smallest number of axis-aligned terms that are as near to `kernel` as `error`.
int rank_as_near(const WeightGrid& kernel, double error) { return rank_for_energy(svd_of(kernel).values, 1 - error); }

/// `image`, 0 outside, read linearly: the definition of a texture unit.
double linear_read(const WeightGrid& image, double x, double y) {
    double sum = 0;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i)
            sum += image.at(i, j) * std::max(0.0, 1 - std::abs(x - i)) * std::max(0.0, 1 - std::abs(y - j));
    return sum;
}

WeightGrid run(const SlantedPass& pass, const WeightGrid& image) {
    WeightGrid out(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (std::size_t j = 0; j < pass.taps.weights.size(); ++j) {
                const double at = pass.taps.first + static_cast<double>(j);
                out.at(x, y) += pass.taps.weights[j] * linear_read(image, x + at * pass.step.x, y + at * pass.step.y);
            }
    return out;
}

TEST(SlantedPasses, ExpandToWhatTheyDoToAnImage) {
    const SlantedPasses passes{{{0.8, 0.6}, {-1, {0.3, 1, -0.4}}}, {{-0.3, 1}, {0, {1, 0.5}}}};
    const WeightGrid image = noise(15, 15, 1), out = run(passes.second, run(passes.first, image));
    const WeightGrid weights = expanded(passes, 9, 9);
    for (const int y : {6, 7, 8}) {
        for (const int x : {6, 7, 8}) {  // nothing that these read lies outside
            double sum = 0;
            for (int j = 0; j < 9; ++j)
                for (int i = 0; i < 9; ++i)
                    sum += weights.at(i, j) * image.at(x + centred_first(9) + i, y + centred_first(9) + j);
            EXPECT_NEAR(sum, out.at(x, y), 1e-14);
        }
    }
}

TEST(PrincipalAxes, AreThoseOfTheGaussian) {
    for (const int degrees : {-75, -30, 0, 8, 45, 90}) {
        const PrincipalAxes axes = principal_axes(parse_shape("oriented-gaussian:6:60:" + std::to_string(degrees), 50));
        EXPECT_NEAR(axes.x, 24.5, 1e-9);
        EXPECT_NEAR(axes.y, 24.5, 1e-9);
        EXPECT_NEAR(axes.degrees, degrees, 0.01);
        // The square of exp(-rate u^2) has the variance 1 / (4 rate), in units of 24.5 samples.
        EXPECT_NEAR(axes.along, 24.5 / std::sqrt(4 * 6.0), 0.01);
        EXPECT_NEAR(axes.across, 24.5 / std::sqrt(4 * 60.0), 0.01);
    }
    const PrincipalAxes round = principal_axes(parse_shape("disc:50:0.8"));
    EXPECT_EQ(round.degrees, 0);
    EXPECT_NEAR(round.along, round.across, 1e-9);
    WeightGrid one(5, 4);
    one.at(3, 2) = -2;
    EXPECT_EQ(principal_axes(one).x, 3);
    EXPECT_EQ(principal_axes(one).along, 0);
}

TEST(FitSlanted, FindsPassesAgain) {
    const SlantedPasses passes{{{1, 0}, {-3, {0.2, 0.5, 1, 1.2, 0.7, 0.3, 0.1}}},
                               {{0.6, 1}, {-2, {0.3, 1, 0.8, -0.4, 0.2}}}};
    const WeightGrid kernel = expanded(passes, 17, 17);
    const SlantedFit fit = fit_slanted(kernel, {1, 0}, {0.6, 1});
    EXPECT_LT(fit.error, 1e-5);
    const WeightGrid again = expanded(fit.passes, 17, 17);
    for (std::size_t i = 0; i < kernel.weights.size(); ++i) EXPECT_NEAR(again.weights[i], kernel.weights[i], 0.01);
    EXPECT_EQ(fit.passes.first.taps.first, -3);
    EXPECT_EQ(fit.passes.second.taps.weights.size(), 5u);
}

TEST(FitSlanted, IsTheBestTermWhereStepsFollowTheGrid) {
    const WeightGrid kernel = noise(9, 6, 2);
    const auto values = svd_of(kernel).values;
    // Alternating least squares is the power iteration here; it ends where a round gains less than a hundredth.
    EXPECT_NEAR(fit_slanted(kernel, {1, 0}, {0, 1}).error, 1 - cumulative_energy(values)[0], 0.01);
}

// Every Gaussian is a product along rows and slanted against them, and along its axes.
TEST(FitSlanted, MakesOrientedGaussiansOfTwoPasses) {
    for (const int degrees : {-60, 30, 80}) {
        const WeightGrid kernel = parse_shape("oriented-gaussian:4:40:" + std::to_string(degrees), 40);
        const SlantedFit fit = fit_slanted(kernel);
        EXPECT_LT(fit.error, 1e-4) << degrees;
        EXPECT_EQ(fit.rank, 1);
        EXPECT_GE(rank_as_near(kernel, fit.error), 4) << degrees;
        const PrincipalAxes axes = principal_axes(kernel);
        EXPECT_LT(fit_slanted(kernel, {1, 0}, {axes.xy / axes.yy, 1}).error, 1e-3);
        const double angle = axes.degrees * 3.14159265358979 / 180, c = std::cos(angle), s = std::sin(angle);
        EXPECT_LT(fit_slanted(kernel, {c, s}, {-s, c}).error, 1e-3);
    }
}

TEST(FitSlanted, MakesSkewedBoxesOfTwoPasses) {
    const WeightGrid kernel = parse_shape("skewed-box:50:0.5:0.6");
    const SlantedFit fit = fit_slanted(kernel);
    EXPECT_NEAR(fit.passes.second.step.x, 0.6, 0.01);
    EXPECT_LT(fit.error, 0.01);  // its border is a staircase that reads between samples soften
    EXPECT_GT(rank_as_near(kernel, fit.error), 10);
    EXPECT_NEAR(fit_slanted(transposed(kernel)).error, fit.error, 1e-9);
    EXPECT_NEAR(fit_slanted(transposed(kernel)).passes.second.step.y, 0.6, 0.01);
}

TEST(FitSlanted, ErrorIsWhatIsMissing) {
    const WeightGrid kernel = parse_shape("oriented-gaussian:6:60:30", 41);
    const SlantedFit fit = fit_slanted(kernel);
    const WeightGrid wide = expanded(fit.passes, 121, 121);
    double missing = 0, all = 0;
    for (int y = 0; y < 121; ++y) {
        for (int x = 0; x < 121; ++x) {
            const bool inside = std::abs(x - 60) <= 20 && std::abs(y - 60) <= 20;
            const double wanted = inside ? kernel.at(x - 40, y - 40) : 0;
            missing += std::pow(wide.at(x, y) - wanted, 2);
            all += wanted * wanted;
        }
    }
    EXPECT_NEAR(fit.error, missing / all, 1e-9);
}

TEST(FitSlanted, TakesKernelsOfOneLine) {
    WeightGrid line(9, 1);
    line.weights = {1, 2, 3, 4, 5, 4, 3, 2, 1};
    EXPECT_LT(fit_slanted(line).error, 1e-9);
    EXPECT_LT(fit_slanted(transposed(line)).error, 1e-9);
}

TEST(FitSlanted, RefusesWhatCannotBeRun) {
    const WeightGrid kernel = noise(5, 5, 3);
    EXPECT_THROW(fit_slanted(kernel, {1, 0}, {2, 0}), Error);
    EXPECT_THROW(fit_slanted(kernel, {1, 0}, {0, 0.4}), Error);
    EXPECT_THROW(fit_slanted(kernel, {1, 0}, {std::nan(""), 1}), Error);
    EXPECT_THROW(fit_slanted(kernel, {1, 0}, {9, 1}), Error);
    EXPECT_THROW(fit_slanted(noise(129, 5, 3)), Error);
    EXPECT_THROW(fit_slanted(WeightGrid(5, 5)), Error);
    EXPECT_THROW(expanded(SlantedPasses{}, 0, 5), Error);
    WeightGrid broken = kernel;
    broken.at(2, 2) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(principal_axes(broken), Error);
}

}  // namespace
}  // namespace bandlimit
