// The program's design separable, from outside.
#include <cmath>

#include "apps/run_program_test.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

TEST(DesignSeparable, TheCircleOfTheSourceIsOptimised) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell(
        "design separable disc:50:0.8 --rank 4 --optimise --keep-zeros 0.3 --non-negative 0.5 --json -o disc.json "
        "--plot disc.svg");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(shell.files(), (std::set<std::string>{"disc.json", "disc.svg"}));
    EXPECT_EQ(bytes_of(shell / "disc.json"), run.out);
    const TapsFile file = parse_taps(run.out, "stdout");
    EXPECT_EQ(file.kind, "separable");
    EXPECT_LE(*file.loss, 0.02141);
    ASSERT_EQ(file.singular_values.size(), 50u);
    EXPECT_NEAR(file.singular_values[0], 36.744, 0.0005);
    EXPECT_NEAR(file.singular_values[3], 3.765, 0.0005);
    ASSERT_EQ(file.terms.size(), 4u);
    EXPECT_EQ(file.terms[0].column.size(), 50u);
    EXPECT_EQ(file.cost, 50 + 4 * 50);
    EXPECT_EQ(file.multiply_adds, 4 * 100);
    const WeightGrid weights = expanded(file.terms);
    EXPECT_NEAR(weights.at(25, 25), 1, 0.2);  // as high as the shape
    double missing = 0;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 50; ++x)
            missing += std::pow(weights.at(x, y) - (std::hypot(2 * x - 49, 2 * y - 49) / 49 < std::sqrt(0.8)), 2);
    EXPECT_NEAR(*file.error, missing / 1508, 1e-9);  // so many weights of the circle are 1
}

TEST(DesignSeparable, ReportsForPeople) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome slanted = shell("design separable oriented-gaussian:50:3:30:30 --rank 8");
    ASSERT_TRUE(succeeds(slanted));
    for (const char* words : {"rank 29", "99.9 % of the energy", "sum of values", "relative error", "30.0 degrees",
                              "3.16 times as long", "two passes", "step (0.0000, 1.0000)", "half a sample"})
        EXPECT_NE(slanted.out.find(words), std::string::npos) << words << "\n" << slanted.out;
}

TEST(DesignSeparable, TakesPicturesOfKernels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    // Two products on 24 x 16 samples, and noise.
    Random random(3);
    AnyImage image = image_of<std::uint8_t>(24, 16, 1, [&](int x, int y, int) {
        const double u = (x - 12) / 6.0, v = (y - 8) / 4.0;
        return std::lround(20 + 200 * (std::exp(-u * u - v * v) - 0.4 * std::exp(-4 * u * u - 4 * v * v)) +
                           random.uniform(-4, 4));
    });
    save(shell / "kernel.png", image);
    const Outcome run = shell("design separable kernel.png --json");
    ASSERT_TRUE(succeeds(run));
    const TapsFile file = parse_taps(run.out, "stdout");
    EXPECT_EQ(file.terms.size(), 3u);  // the ground is a product too
    EXPECT_EQ(file.terms[0].row.size(), 24u);
    EXPECT_EQ(file.terms[0].column.size(), 16u);
    EXPECT_LT(*file.error, 2e-3);
    EXPECT_TRUE(fails(1, shell("design separable kernel.png --rank 17"), "pass at most 16"));
    AnyImage wide = image_of<std::uint8_t>(600, 4, 1, [](int, int, int) { return 1; });
    save(shell / "wide.png", wide);
    EXPECT_TRUE(fails(1, shell("design separable wide.png --rank 1"), "600 x 4 samples are too many"));
    AnyImage veiled = image_of<std::uint8_t>(4, 4, 2, [](int, int, int) { return 9; });
    save(shell / "veiled.png", veiled);
    EXPECT_TRUE(succeeds(shell("design separable veiled.png --rank 1")));  // weights are colour times alpha
}

TEST(DesignSeparable, RefusesWhatTheCommandLineShows) {
    const Shell shell(BANDLIMIT_PROGRAM);
    EXPECT_TRUE(fails(2, shell("design separable disc:50 --rank 2"), "write disc:SIZE:LIMIT"));
    EXPECT_TRUE(fails(2, shell("design separable disc:50:0.8 --rank 0"), "--rank: 0; pass 1 to 50"));
    EXPECT_TRUE(fails(2, shell("design separable disc:50:0.8 --rank 51"), "--rank: 51; pass 1 to 50"));
    EXPECT_TRUE(fails(2, shell("design separable disc:50:0.8 --keep-zeros -1"), "--keep-zeros: -1"));
    EXPECT_TRUE(fails(2, shell("design separable disc:600:0.8 --rank 2"), "pass at most 512"));
    EXPECT_TRUE(fails(2, shell("design separable blob --rank 2"), "is unknown"));
    EXPECT_TRUE(fails(1, shell("design separable missing.png --rank 2"), "missing.png"));
    EXPECT_TRUE(shell.files().empty());
}

}  // namespace
}  // namespace bandlimit
