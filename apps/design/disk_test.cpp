// Discs out of phasors, from outside.
#include <numbers>

#include "apps/run_program_test.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit {
namespace {

TEST(DesignDisk, WritesComponentsAndTheirWeights) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome made = shell("design disk --components 2 --radius 6 --json -o disk.json --plot disk.svg");
    ASSERT_TRUE(succeeds(made));
    EXPECT_EQ(bytes_of(shell / "disk.json"), made.out);
    EXPECT_GT(bytes_of(shell / "disk.svg").size(), 1000u);

    const TapsFile file = read_taps(shell / "disk.json");
    EXPECT_EQ(file.kind, "disk");
    EXPECT_EQ(file.components.size(), 2u);
    EXPECT_LT(file.error.value(), 0.039);
    EXPECT_EQ(file.radius.value(), 6);
    const WeightGrid grid = expanded(file.terms);
    ASSERT_EQ(grid.width, grid.height);
    ASSERT_EQ(grid.width % 2, 1);
    const int middle = grid.width / 2;
    for (const int x : {0, 2, 5, middle})
        EXPECT_NEAR(grid.at(middle + x, middle), value_at(file.components, x / 6.0), 1e-12) << x;
    // One read a weight in the first pass, one a weight of each of its four pictures in the second.
    EXPECT_EQ(file.cost.value(), 5.0 * grid.width);
    EXPECT_EQ(file.multiply_adds.value(), 8.0 * grid.width);
    // What is cut is 1 % of the sum at most.
    EXPECT_NEAR(sum(file.terms) / 36, integral(file.components), 0.01 * std::numbers::pi);
}

TEST(DesignDisk, PublishedOnesComeWithTheirReach) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome made = shell("design disk --components 1 --preset published --radius 100 --json");
    ASSERT_TRUE(succeeds(made));
    const TapsFile file = parse_taps(made.out, "stdout");
    EXPECT_NEAR(file.error.value(), 0.104, 5e-4);
    // 1.4 where the disc has the radius 1.10179.
    EXPECT_EQ(file.terms.at(0).row.size(), 2u * 127 + 1);
}

TEST(DesignDisk, WithoutARadiusThereAreNoWeights) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome made = shell("design disk --components 5 --json");
    ASSERT_TRUE(succeeds(made));
    const TapsFile file = parse_taps(made.out, "stdout");
    EXPECT_EQ(file.components.size(), 5u);
    EXPECT_LT(file.error.value(), 0.013);
    EXPECT_EQ(file.radius.value(), 1);
    EXPECT_TRUE(file.terms.empty());
}

TEST(DesignDisk, RefusesWhatIsNotThere) {
    const Shell shell(BANDLIMIT_PROGRAM);
    EXPECT_TRUE(fails(2, shell("design disk --components 6"), "1 to 5"));
    EXPECT_TRUE(fails(2, shell("design disk --components 3 --preset published"), "1 and 2"));
    EXPECT_TRUE(fails(2, shell("design disk --preset best"), "fit or published"));
    EXPECT_TRUE(fails(2, shell("design disk --reach 9"), "--radius"));
}

}  // namespace
}  // namespace bandlimit
