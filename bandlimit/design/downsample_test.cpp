#include "bandlimit/design/downsample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

double sum_of(const std::vector<double>& w) { return std::accumulate(w.begin(), w.end(), 0.0); }

double sum_of(const Fetches& fetches) {
    return std::accumulate(fetches.begin(), fetches.end(), 0.0, [](double s, const Fetch& f) { return s + f.weight; });
}

/// Is there, for each fetch, one of the same weight at that image of it?
template <class Image>
bool has_images(const Fetches& fetches, Image image) {
    return std::all_of(fetches.begin(), fetches.end(), [&](const Fetch& f) {
        const auto [x, y] = image(f.x, f.y);
        return std::any_of(fetches.begin(), fetches.end(), [x = x, y = y, &f](const Fetch& g) {
            return std::abs(g.x - x) < 1e-12 && std::abs(g.y - y) < 1e-12 && g.weight == f.weight;
        });
    });
}

bool is_symmetric(const Fetches& fetches) {
    return has_images(fetches,
                      [](double x, double y) {
                          return std::pair{-x, y};
                      }) &&
           has_images(fetches, [](double x, double y) {
               return std::pair{y, x};
           });
}

double goal_error(const PlacedWeights& w, const RateGoal& goal) {
    const BandError e = band_error(w, goal.factor);
    return goal.pass_weight * e.pass / goal.factor + goal.stop_weight * e.stop * (1 - 1.0 / goal.factor);
}

TEST(DownsampleTaps, AreThePublishedOnes) {
    const Taps taps = downsample_taps(8);
    const double half[] = {0.46369, 0.16358, -0.07650, -0.05078};
    ASSERT_EQ(taps.weights.size(), 8u);
    EXPECT_EQ(taps.first, -3);
    EXPECT_EQ(taps.factor, 2);
    for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(taps.weights[4 + j], half[j], 5e-6);
        EXPECT_EQ(taps.weights[3 - j], taps.weights[4 + j]);
    }
}

// No step that keeps the sum leads down, whatever the goal's weights.
TEST(DownsampleTaps, AreTheBestOfTheirSum) {
    Random random(7);
    for (const RateGoal& goal :
         {RateGoal{}, RateGoal{.factor = 3}, RateGoal{.factor = 4, .stop_weight = 5}, RateGoal{.pass_weight = 3}}) {
        const int count = 9 - (goal.factor + 1) % 2;
        const Taps taps = downsample_taps(count, goal);
        EXPECT_NEAR(sum_of(taps.weights), 1, 1e-12);
        const double least = goal_error(taps, goal);
        for (int trial = 0; trial < 100; ++trial) {
            Taps other = taps;
            double moved = 0;
            for (double& w : other.weights) {
                const double step = random.uniform(-1e-3, 1e-3);
                w += step;
                moved += step;
            }
            for (double& w : other.weights) w -= moved / count;
            EXPECT_GE(goal_error(other, goal), least - 1e-14);
        }
    }
}

// Doubling is halving backwards: each output has every other of the taps, twice as large.
TEST(DownsampleTaps, OfDoublingAreThoseOfHalving) {
    for (const int count : {1, 2, 3, 4, 5}) {
        const Taps down = downsample_taps(2 * count), up = downsample_taps(count, {.upsample = true});
        ASSERT_EQ(up.weights.size(), static_cast<std::size_t>(count));
        EXPECT_NEAR(sum_of(up.weights), 1, 1e-12);
        for (int k = 0; k < count; ++k) {
            // Texel first + k lies 2 (first + k) - 1/2 from the output on the finer grid, and that is down's weight.
            const int j = 2 * (up.first + k) - 1 - (down.first - 1);
            EXPECT_NEAR(up.weights[static_cast<std::size_t>(k)], 2 * down.weights[static_cast<std::size_t>(j)], 1e-12);
        }
        const BandError a = band_error(down, 2), b = band_error(whole_filter(up, {.upsample = true}), 2);
        EXPECT_NEAR(a.whole, b.whole, 1e-12);
    }
}

TEST(DownsampleTaps, KeepLimits) {
    const RateGoal flat{.max_gain = 1.01}, positive{.factor = 3, .non_negative = true};
    EXPECT_GT(max_gain(downsample_taps(12)), 1.05);
    const Taps taps = downsample_taps(12, flat);
    for (int i = 0; i <= 5000; ++i) EXPECT_LE(gain(taps, 0.5 * i / 5000), 1.01 + 1e-8);
    EXPECT_GT(band_error(taps, 2).whole, band_error(downsample_taps(12), 2).whole);
    EXPECT_LT(band_error(taps, 2).whole, band_error(downsample_taps(2), 2).whole);
    for (const double w : downsample_taps(15, positive).weights) EXPECT_GE(w, -1e-12);
}

TEST(DownsampleWeights, ThresholdLeavesThePublishedCross) {
    const SparseWeights found = downsample_weights(8, 0.02);
    const auto kept =
        std::count_if(found.optimized.weights.begin(), found.optimized.weights.end(), [](double w) { return w != 0; });
    EXPECT_EQ(kept, 32);
    EXPECT_NEAR(band_error(found.optimized, 2).whole, 0.02778, 5e-6);
    EXPECT_LT(band_error(found.all, 2).whole, band_error(found.optimized, 2).whole);
    EXPECT_LT(band_error(found.optimized, 2).whole, band_error(found.dropped, 2).whole);
    for (const PlacedWeights2D* w : {&found.all, &found.dropped, &found.optimized})
        EXPECT_NEAR(sum_of(w->weights), 1, 1e-12);
}

TEST(DownsampleFolded, ComesCloseToItsWeights) {
    // Weights of the plane's own best filter are the least error that fetches over them can have.
    const FetchDesign cross = downsample_folded(8, 0.02);
    EXPECT_EQ(cross.fetches.size(), 8u);
    EXPECT_LE(cross.error, 0.02780);
    EXPECT_GE(cross.error, band_error(downsample_weights(8, 0.02).optimized, 2).whole - 1e-12);
    const FetchDesign square = downsample_folded(8, 0);
    EXPECT_EQ(square.fetches.size(), 16u);
    EXPECT_NEAR(square.error, band_error(downsample_weights(8, 0).all, 2).whole, 1e-4);
}

TEST(DownsampleFetches, ReachTheirTargets) {
    const std::vector<FetchDesign> curve = downsample_curve(20);
    const auto error_of = [&](std::size_t count) {
        for (const FetchDesign& d : curve)
            if (d.fetches.size() == count) return d.error;
        return 1.0;
    };
    EXPECT_NEAR(error_of(1), 0.09472, 5e-6);  // the box
    EXPECT_LE(error_of(8), 0.02780);          // the published filter has 0.02779
    EXPECT_LE(error_of(12), 0.0220);
    EXPECT_LE(error_of(16), 0.0176);
    EXPECT_LE(error_of(20), 0.0158);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const FetchDesign& d = curve[i];
        EXPECT_NEAR(sum_of(d.fetches), 1, 1e-12);
        EXPECT_TRUE(is_symmetric(d.fetches));
        EXPECT_NEAR(d.error, band_error(weights_of(d.fetches, 0.5), 2).whole, 1e-14);
        EXPECT_TRUE(i == 0 || d.error < curve[i - 1].error);
    }
    EXPECT_LE(downsample_fetches(12, {}, {.layout = FetchLayout::cross}).error, 0.0220);
}

// Halving at positions that are moved, or weights that are, does worse: where each ring reads is optimal too.
TEST(DownsampleFetches, NoSmallMoveLeadsDown) {
    const FetchDesign best = downsample_fetches(12);
    for (std::size_t k = 0; k < best.fetches.size(); k += 4) {
        const Fetch at = best.fetches[k];
        for (const double step : {-0.01, 0.01}) {
            Fetches moved = best.fetches;
            for (Fetch& f : moved) {
                if (f.weight != at.weight) continue;
                if (f.x != 0) f.x += std::copysign(step, f.x);
                if (f.y != 0) f.y += std::copysign(step, f.y);
            }
            EXPECT_GT(band_error(weights_of(moved, 0.5), 2).whole, best.error);
            Fetches shifted = best.fetches;  // some weight from this ring to the next
            const double to = best.fetches[(k + 4) % best.fetches.size()].weight;
            for (Fetch& f : shifted) f.weight += f.weight == at.weight ? step : f.weight == to ? -step : 0;
            EXPECT_GT(band_error(weights_of(shifted, 0.5), 2).whole, best.error);
        }
    }
}

TEST(DownsampleFetches, OtherFactors) {
    for (const int factor : {3, 4}) {
        const RateGoal goal{.factor = factor};
        const FetchDesign design = downsample_fetches(9, goal);
        EXPECT_TRUE(is_symmetric(design.fetches));
        EXPECT_NEAR(sum_of(design.fetches), 1, 1e-12);
        // The box of all factor^2 texels, which takes (factor + 1)^2 / 4 fetches and more, is far behind.
        const double mean = 1.0 / factor / factor, first = (1 - factor) / 2.0;
        const PlacedWeights2D box(first, first, factor,
                                  std::vector<double>(static_cast<std::size_t>(factor * factor), mean));
        EXPECT_LT(design.error, 0.75 * band_error(box, factor).whole);
    }
}

TEST(DownsampleFetches, KeepLimits) {
    const FetchDesign design = downsample_fetches(12, {.max_gain = 1.05});
    const PlacedWeights2D weights = weights_of(design.fetches, 0.5);
    for (int j = 0; j <= 200; ++j)
        for (int i = 0; i <= j; ++i) EXPECT_LE(std::abs(response(weights, 0.5 * i / 200, 0.5 * j / 200)), 1.05 + 1e-8);
    EXPECT_LE(design.error, 0.0225);
    for (const Fetch& f : downsample_fetches(8, {.non_negative = true}).fetches) EXPECT_GE(f.weight, 0);
    // What passes counts more, or less.
    const auto pass_of = [](const RateGoal& goal) {
        return band_error(weights_of(downsample_fetches(8, goal).fetches, 0.5), 2).pass;
    };
    EXPECT_LT(pass_of({.pass_weight = 4}), pass_of({}));
    EXPECT_GT(pass_of({.stop_weight = 4}), pass_of({}));
}

TEST(DownsampleFetches, SquaresAndThresholds) {
    const FetchDesign square = downsample_fetches(16, {}, {.layout = FetchLayout::square});
    std::vector<double> columns;
    for (const Fetch& f : square.fetches)
        if (std::none_of(columns.begin(), columns.end(), [&](double x) { return std::abs(x - f.x) < 1e-12; }))
            columns.push_back(f.x);
    EXPECT_EQ(columns.size(), 4u);
    // Within the texels of the cross there is the published filter.
    const FetchDesign cross = downsample_fetches(8, {}, {.taps = 8, .threshold = 0.02});
    EXPECT_LE(cross.error, 0.02780);
    const PlacedWeights2D kept = downsample_weights(8, 0.02).optimized, read = weights_of(cross.fetches, 0.5);
    ASSERT_EQ(read.width, kept.width);
    for (std::size_t i = 0; i < kept.weights.size(); ++i) EXPECT_TRUE(kept.weights[i] != 0 || read.weights[i] == 0);
}

// One fetch that doubles is the tent; more let through what it takes away. Fetches are those of the output 1/4 texel
// to the right, and symmetric across the diagonal.
TEST(DownsampleFetches, OfDoubling) {
    const RateGoal up{.upsample = true};
    const std::vector<FetchDesign> curve = downsample_curve(5, up);
    ASSERT_EQ(curve.front().fetches.size(), 1u);
    EXPECT_LT(curve.back().error, 0.5 * curve.front().error);
    for (const FetchDesign& d : curve) {
        EXPECT_NEAR(sum_of(d.fetches), 1, 1e-12);
        EXPECT_TRUE(has_images(d.fetches, [](double x, double y) { return std::pair{y, x}; }));
        EXPECT_NEAR(d.error, band_error(whole_filter(d.fetches, up), 2).whole, 1e-14);
    }
    // The tent at its place: 9/16, 3/16, 3/16, 1/16 of the four texels around.
    const PlacedWeights2D tent = weights_of({{0, 0, 1}}, output_texel(up));
    EXPECT_NEAR(tent.weights[0], 9.0 / 16, 1e-15);
    EXPECT_NEAR(tent.weights[3], 1.0 / 16, 1e-15);
    EXPECT_NEAR(band_error(whole_filter(Fetches{{0, 0, 1}}, up), 2).whole,
                band_error(PlacedWeights2D(PlacedWeights(-1.5, {0.125, 0.375, 0.375, 0.125}),
                                           PlacedWeights(-1.5, {0.125, 0.375, 0.375, 0.125})),
                           2)
                    .whole,
                1e-14);
}

TEST(Downsample, RefusesWhatItCannotDo) {
    EXPECT_THROW(downsample_taps(7), Error);
    EXPECT_THROW(downsample_taps(8, {.factor = 3}), Error);
    EXPECT_THROW(downsample_taps(8, {.factor = 1}), Error);
    EXPECT_THROW(downsample_taps(8, {.factor = 4, .upsample = true}), Error);
    EXPECT_THROW(downsample_taps(8, {.max_gain = 0.9}), Error);
    EXPECT_THROW(downsample_taps(8, {.stop_weight = 0}), Error);
    EXPECT_THROW(downsample_weights(8, 1), Error);
    EXPECT_THROW(downsample_fetches(6), Error);
    EXPECT_THROW(downsample_fetches(0), Error);
    EXPECT_THROW(downsample_fetches(8, {}, {.layout = FetchLayout::square}), Error);
    EXPECT_THROW(downsample_fetches(8, {}, {.threshold = 0.02}), Error);
    EXPECT_THROW(downsample_fetches(8, {.upsample = true}, {.layout = FetchLayout::cross}), Error);
}

}  // namespace
}  // namespace bandlimit
