// Designs as a library user makes them.
#include "bandlimit/job/designs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "bandlimit/job/option_error.h"

namespace bandlimit::job {
namespace {

double sum_of(const Taps& taps) { return std::accumulate(taps.weights.begin(), taps.weights.end(), 0.0); }

TEST(DesignJobs, FilesSayWhatRunsCost) {
    const GaussianDesign gaussian = design_gaussian({.sigma = 2, .fetches = 3});
    const TapsFile blur = taps_file(gaussian);
    EXPECT_EQ(blur.kind, "gaussian");
    EXPECT_EQ(blur.cost, 6);  // three reads along each axis
    EXPECT_EQ(blur.fetches.size(), 3u);
    EXPECT_NEAR(sum_of(*blur.taps), 1, 1e-9);
    const TapsFile slope = taps_file(design_derivative({.taps = 5}));
    EXPECT_EQ(slope.kind, "derivative");
    EXPECT_NEAR(sum_of(*slope.taps), 0, 1e-12);
    const TapsFile sharp = taps_file(design_sharpen(bspline()));
    EXPECT_EQ(sharp.kind, "sharpen");
    EXPECT_NEAR(sum_of(*sharp.taps), 1, 1e-6);
    const TapsFile kernel = taps_file(fit_kernel({.radius = 2}));
    EXPECT_TRUE(is_kernel(kernel));
    EXPECT_EQ(kernel.cost, 8);  // four weights along each axis
    for (const TapsFile& file : {blur, slope, sharp, kernel})
        EXPECT_EQ(parse_taps(taps_text(file), file.kind).error, file.error);
}

TEST(DesignJobs, DiscsHaveTermsForARadius) {
    const DiskReport shape = design_disk({.components = 1});
    EXPECT_TRUE(shape.file.terms.empty());
    EXPECT_EQ(shape.file.components.size(), 1u);
    const DiskReport disk = design_disk({.components = 2, .radius = 12});
    EXPECT_EQ(disk.file.terms.size(), 4u);
    EXPECT_NEAR(sum(disk.file.terms), std::numbers::pi * 144, 0.05 * std::numbers::pi * 144);
    EXPECT_LT(*disk.file.error, *shape.file.error);
    EXPECT_GT(design_disk({.components = 1, .is_published = true}).published_radius, 0);
    for (const DiskJob& job : {DiskJob{.components = 0}, {.components = 3, .is_published = true}, {.reach = 3}})
        EXPECT_THROW(design_disk(job), OptionError);
}

TEST(DesignJobs, MoreFetchesHaveLessError) {
    const DownsampleReport usual = design_downsample({});
    EXPECT_EQ(usual.file.fetches.size(), 8u);
    EXPECT_EQ(usual.file.kind, "downsample");
    const DownsampleReport few = design_downsample({.fetches = 4});
    EXPECT_GT(*few.file.error, *usual.file.error);
    ASSERT_GE(usual.curve.size(), 2u);
    for (std::size_t i = 1; i < usual.curve.size(); ++i) EXPECT_LT(usual.curve[i].error, usual.curve[i - 1].error);
    const DownsampleReport taps = design_downsample({.where = {.taps = 8}});
    ASSERT_TRUE(taps.file.taps);
    EXPECT_NEAR(sum_of(*taps.file.taps), 1, 1e-9);
    const DownsampleReport folded = design_downsample({.where = {.taps = 8, .threshold = 0.02}});
    EXPECT_FALSE(folded.file.fetches.empty());
    EXPECT_THROW(design_downsample({.goal = {.factor = 1}}), Error);
    EXPECT_THROW(design_downsample({.where = {.layout = FetchLayout::cross, .taps = 8, .threshold = 0.02}}),
                 OptionError);
}

TEST(DesignJobs, AProductIsOneTerm) {
    WeightGrid product(5, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) product.at(x, y) = (1 + x) * (3 - 0.5 * y);
    const SeparableReport one = design_separable({.kernel = product});
    EXPECT_EQ(one.exact, 1);
    EXPECT_EQ(one.rank(), 1);
    EXPECT_LT(one.error, 1e-25);
    EXPECT_EQ(*one.file.multiply_adds, 9);
    product.weights[7] += 2;
    EXPECT_EQ(design_separable({.kernel = product}).exact, 2);
    EXPECT_GT(design_separable({.kernel = product, .rank = 1}).error, 0);
    EXPECT_THROW(design_separable({.kernel = product, .rank = 5}), std::runtime_error);
    EXPECT_THROW(design_separable({.kernel = WeightGrid(2, 2)}), std::runtime_error);
}

}  // namespace
}  // namespace bandlimit::job
