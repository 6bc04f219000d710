// Bilateral filters by the program, from outside.
#include <cmath>
#include <fstream>

#include "apps/run_program_test.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// Saves and returns noise.
Image<float> save_noise(const std::string& path, int width, int height, int channels, std::uint64_t seed) {
    Random random(seed);
    AnyImage noise = image_of<float>(width, height, channels, [&](int, int, int) { return random.uniform(); });
    save(path, noise);
    return load<float>(path);
}

double largest_difference(const Image<float>& a, const Image<float>& b) {
    EXPECT_TRUE(same_shape(a.view(), b.view()));
    double worst = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < a.channels(); ++c)
                worst = std::max(worst, std::abs(static_cast<double>(a.view()(x, y, c) - b.view()(x, y, c))));
    return worst;
}

TEST(Bilateral, IsWhatItsDefinitionSays) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const int width = 14, height = 11, radius = 2;
    const Image<float> in = save_noise(shell / "in.exr", width, height, 1, 1);
    const Image<float> guide = save_noise(shell / "guide.exr", width, height, 3, 2);
    const Outcome run = shell(
        "bilateral in.exr out.exr --sigma-space 1.5 --sigma-range 0.3 --radius 2 --guide guide.exr --edge reflect "
        "--json");
    ASSERT_TRUE(succeeds(run));
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["radius"], radius);
    EXPECT_EQ(report["weights"], 25);
    EXPECT_EQ(report["guide"], "guide.exr");
    EXPECT_EQ(report["guide_channels"], 3);
    EXPECT_EQ(report["edge"], "reflect");
    const Image<float> out = load<float>(shell / "out.exr");
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double weights = 0, sum = 0;
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i) {
                    const int u = resolve(x + i, width, Edge::reflect), v = resolve(y + j, height, Edge::reflect);
                    double square = 0;
                    for (int c = 0; c < 3; ++c)
                        square += std::pow(static_cast<double>(guide.view()(u, v, c) - guide.view()(x, y, c)), 2);
                    const double weight = std::exp(-(i * i + j * j) / 4.5 - square / 0.18);
                    weights += weight, sum += weight * static_cast<double>(in.view()(u, v));
                }
            EXPECT_NEAR(out.view()(x, y), sum / weights, 1e-6);
        }
}

TEST(Bilateral, FloatFilesKeepFullPrecision) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Image<float> in = save_noise(shell / "in.exr", 20, 15, 3, 1);
    for (const std::string sigmas : {"--sigma-space 2 --sigma-range 0", "--sigma-space 0 --sigma-range inf"})
        for (const std::string out : {"out.exr", "out.pfm"}) {
            ASSERT_TRUE(succeeds(shell("bilateral in.exr " + out + " " + sigmas)));
            EXPECT_EQ(largest_difference(load<float>(shell / out), in), 0) << sigmas << " " << out;
        }
}

TEST(Bilateral, AtInfinityItIsTheGaussian) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in.exr", 24, 18, 2, 1);
    std::ofstream(shell / "flat.json") << R"({"version": 1, "kind": "a", "taps": {"first": -1, "weights": [1, 1, 1]}})";
    ASSERT_TRUE(succeeds(shell("convolve in.exr mean.exr --taps flat.json")));
    for (const std::string separable : {"", " --separable"}) {
        ASSERT_TRUE(
            succeeds(shell("bilateral in.exr out.exr --sigma-space inf --sigma-range inf --radius 1" + separable)));
        EXPECT_LT(largest_difference(load<float>(shell / "out.exr"), load<float>(shell / "mean.exr")), 1e-6);
    }
}

TEST(Bilateral, UpsamplesASceneOfConstantsExactly) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const auto region = [](double x, double y) { return x + 0.4 * y < 0.6; };
    const auto draw = [&](const std::string& name, int width, int height, double inside, double outside) {
        AnyImage image = image_of<float>(width, height, 1, [&](int x, int y, int) {
            return region((x + 0.5) / width, (y + 0.5) / height) ? inside : outside;
        });
        save(shell / name, image);
    };
    draw("signal.exr", 16, 12, 0.25, 0.75), draw("depth.exr", 16, 12, 3, 9);
    draw("full.exr", 32, 24, 3, 9), draw("truth.exr", 32, 24, 0.25, 0.75);
    for (const std::string window : {"", " --bilinear"}) {
        const Outcome run = shell(
            "bilateral signal.exr out.exr --sigma-space 1 --sigma-range 0.1 --guide depth.exr "
            "--guide-full full.exr --json" +
            window);
        ASSERT_TRUE(succeeds(run));
        EXPECT_EQ(run.json()["output"]["width"], 32);
        EXPECT_EQ(run.json()["weights"], window.empty() ? 49 : 4);
        EXPECT_EQ(largest_difference(load<float>(shell / "out.exr"), load<float>(shell / "truth.exr")), 0);
    }
}

TEST(Bilateral, RefusesInOneLine) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_noise(shell / "in.exr", 8, 6, 1, 1);
    save_noise(shell / "small.exr", 4, 3, 1, 1);
    save_noise(shell / "colour.exr", 8, 6, 3, 1);
    struct Case {
        int code;
        std::string options, word;
    };
    for (const Case& c : std::vector<Case>{
             {2, "", "--sigma-space"},
             {2, "--sigma-space 1", "--sigma-range"},
             {2, "--sigma-space -1 --sigma-range 1", "--sigma-space: \"-1\""},
             {2, "--sigma-space nan --sigma-range 1", "--sigma-space: \"nan\""},
             {2, "--sigma-space 1 --sigma-range -2", "--sigma-range: \"-2\""},
             {2, "--sigma-space 1 --sigma-range 1,nan", "--sigma-range: \"nan\""},
             {2, "--sigma-space 1 --sigma-range 1,", "--sigma-range"},
             {2, "--sigma-space inf --sigma-range 1", "pass a radius"},
             {2, "--sigma-space 1e9 --sigma-range 1", "pass a radius"},
             {2, "--sigma-space 1 --sigma-range 1 --radius -1", "--radius"},
             {2, "--sigma-space 1 --sigma-range 1 --radius 1001", "--radius"},
             {2, "--sigma-space 1 --sigma-range 1,2", "2 values for a guide of 1 channels"},
             {2, "--sigma-space 1 --sigma-range 1 --separable --guide-full in.exr", "--separable"},
             {2, "--sigma-space 1 --sigma-range 1 --bilinear", "--guide-full"},
             {1, "--sigma-space 1 --sigma-range 1 --guide none.exr", "none.exr"},
             {1, "--sigma-space 1 --sigma-range 1 --guide small.exr", "small.exr is 4 x 3 and in.exr is 8 x 6"},
             {1, "--sigma-space 1 --sigma-range 1 --guide colour.exr --guide-full in.exr", "colour.exr has 3 channels"},
             {1, "--sigma-space 1 --sigma-range 1 --guide-full colour.exr", "in.exr has 1 channels"},
         }) {
        const Outcome run = shell("bilateral in.exr out.exr " + c.options);
        EXPECT_TRUE(fails(c.code, run, c.word)) << c.options;
    }
    EXPECT_FALSE(shell.files().count("out.exr"));
}

}  // namespace
}  // namespace bandlimit
