#include "bandlimit/job/supersample.h"

#include <gtest/gtest.h>

#include "bandlimit/io/files_test.h"
#include "bandlimit/job/analyze.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

TEST(SupersampleJob, WritesWhatTheLibraryDraws) {
    const Folder folder;
    SupersampleJob job{.scene = "edge", .width = 20, .height = 12, .frame = 2, .out = folder / "edge.exr"};
    job.options = {d3d_pattern(8), mitchell()};
    std::vector<double> progress;
    Context context;
    context.progress = [&](const Progress& p) { progress.push_back(p.done / p.total); };
    const SupersampleSummary summary = supersample(job, context);
    EXPECT_EQ(summary.samples_per_pixel, 8);
    EXPECT_EQ(progress.back(), 1);
    const Image<float> image = read_picture(job.out);
    const Image<float> wanted = bandlimit::supersample(make_scene("edge", 20, 12), 20, 12, 2, job.options);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 20; ++x)
            for (int c = 0; c < 4; ++c) EXPECT_EQ(image.view()(x, y, c), wanted.view()(x, y, c));
}

TEST(SupersampleJob, MoreSamplesAliasLess) {
    // One sample and no filter: the aliases have all the energy of the plate.
    EXPECT_NEAR(alias_energy({regular_pattern(1), box()}), 1, 0.05);
    const double grid = alias_energy({regular_pattern(16), box()});
    const double lanczos_grid = alias_energy({regular_pattern(16), lanczos(3)});
    EXPECT_LT(grid, 0.15);
    EXPECT_LT(lanczos_grid, grid / 2);  // a box lets through what lies beyond Nyquist's frequency
}

TEST(SupersampleJob, OptionsAreChecked) {
    EXPECT_THROW(check({.scene = "hills", .width = 8, .height = 8, .out = "a.png"}), OptionError);
    EXPECT_THROW(check({.scene = "edge", .width = 0, .height = 8, .out = "a.png"}), OptionError);
    EXPECT_THROW(check({.scene = "edge", .width = 8, .height = 8, .out = "a.xyz"}), Error);
    EXPECT_NO_THROW(check({.scene = "edge", .width = 8, .height = 8, .out = "a.png"}));
}

TEST(AnalyzeJob, PatternsOutsideThePixelHaveNoDiscrepancy) {
    EXPECT_TRUE(analyze_pattern(rotated_pattern(4)).star_discrepancy);
    EXPECT_FALSE(analyze_pattern(rotated_pattern(16)).star_discrepancy);
}

}  // namespace
}  // namespace bandlimit::job
