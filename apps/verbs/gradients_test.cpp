// Gradients by the program, from outside.
#include <cmath>
#include <fstream>
#include <map>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

/// 0.02 x - 0.01 y of 40 x 30 samples.
void save_ramp(const Shell& shell, const std::string& name, int channels = 1) {
    AnyImage ramp = image_of<float>(40, 30, channels, [](int x, int y, int) { return 0.5 + 0.02 * x - 0.01 * y; });
    save(shell / name, ramp);
}

double middle(const Shell& shell, const std::string& name, int channel = 0) {
    return static_cast<double>(load<float>(shell / name).view()(20, 15, channel));
}

TEST(GradientsVerb, EveryOperatorMeasuresARamp) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_ramp(shell, "in.exr", 3);
    ASSERT_TRUE(succeeds(shell("design derivative --taps 6 -o taps.json")));
    for (const std::string name : {"forward", "central", "sobel", "scharr", "prewitt", "diagonal", "diagonal3",
                                   "gaussian:1.5", "taps:taps.json"}) {
        const std::string line = "gradients in.exr out.exr --operator " + name + " --result ";
        ASSERT_TRUE(succeeds(shell(line + "dx"))) << name;
        EXPECT_NEAR(middle(shell, "out.exr", 2), 0.02, 1e-7) << name;
        ASSERT_TRUE(succeeds(shell(line + "dy"))) << name;
        EXPECT_NEAR(middle(shell, "out.exr", 1), -0.01, 1e-7) << name;
        ASSERT_TRUE(succeeds(shell(line + "magnitude"))) << name;
        EXPECT_NEAR(middle(shell, "out.exr"), std::hypot(0.02, 0.01), 1e-7) << name;
    }
    for (const std::string name : {"laplacian4", "laplacian8", "log:1.5"}) {
        ASSERT_TRUE(succeeds(shell("gradients in.exr out.exr --operator " + name)));
        EXPECT_NEAR(middle(shell, "out.exr"), 0, 1e-6) << name;
    }
    // Half a sample beside the sample: an even number of taps.
    const Outcome run = shell("gradients in.exr out.exr --operator taps:taps.json --json");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(run.json()["position"]["dx"], nlohmann::json({0.5, 0.0}));
    EXPECT_NEAR(run.json()["ramp_gain"].get<double>(), 1, 1e-9);
}

TEST(GradientsVerb, DefaultsAreScharrMagnitudeAndReflect) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 33, 21, 3);
    save(shell / "in.png", image);
    const Outcome run = shell("gradients in.png a.png --json");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(run.json()["operator"], "scharr");
    EXPECT_EQ(run.json()["result"], "magnitude");
    EXPECT_EQ(run.json()["edge"], "reflect");
    ASSERT_TRUE(
        succeeds(shell("gradients in.png b.png --operator scharr --result magnitude --edge reflect --threads 1")));
    EXPECT_EQ(bytes_of(shell / "a.png"), bytes_of(shell / "b.png"));
}

TEST(GradientsVerb, ATensorHasSixNamedChannels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_ramp(shell, "in.exr", 3);
    ASSERT_TRUE(succeeds(shell("gradients in.exr out.exr --result tensor")));
    const nlohmann::json info = shell("info out.exr --json").json();
    const Image<float> out = load<float>(shell / "out.exr");
    ASSERT_EQ(out.channels(), 6);
    const double xx = 3 * 0.02 * 0.02, xy = -3 * 0.02 * 0.01, yy = 3 * 0.01 * 0.01;  // summed over three channels
    const std::map<std::string, double> expected{
        {"xx", xx},      {"xy", xy}, {"yy", yy}, {"strength", std::sqrt(xx + yy)}, {"angle", std::atan2(-0.01, 0.02)},
        {"coherence", 1}};
    for (int c = 0; c < 6; ++c) {
        const std::string name = info["channel_names"][static_cast<std::size_t>(c)];
        ASSERT_TRUE(expected.contains(name)) << name;
        EXPECT_NEAR(static_cast<double>(out.view()(20, 15, c)), expected.at(name), 1e-5) << name;
    }
    ASSERT_TRUE(succeeds(shell("gradients in.exr out.tif --result tensor --box 2 --coherence sqrt")));
    EXPECT_NEAR(middle(shell, "out.tif", 0), xx, 1e-6);
    EXPECT_NEAR(middle(shell, "out.tif", 4), std::atan2(-0.01, 0.02), 1e-4);
    ASSERT_TRUE(succeeds(shell("gradients in.exr out.pfm --result coherence --sigma 3")));
    EXPECT_NEAR(middle(shell, "out.pfm"), 1, 1e-5);
}

TEST(GradientsVerb, NormalsTakeCodesAsHeights) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage ramp = image_of<std::uint8_t>(40, 30, 1, [](int x, int y, int) { return 4 * x + 2 * y; });
    save(shell / "in.png", ramp);
    const double x = -4.0 / 255 * 20, y = 2.0 / 255 * 20, length = std::sqrt(x * x + y * y + 1);
    ASSERT_TRUE(succeeds(shell("gradients in.png out.exr --result normals --scale 20")));
    EXPECT_NEAR(middle(shell, "out.exr", 0), x / length, 1e-6);
    EXPECT_NEAR(middle(shell, "out.exr", 1), y / length, 1e-6);
    EXPECT_NEAR(middle(shell, "out.exr", 2), 1 / length, 1e-6);
    ASSERT_TRUE(succeeds(shell("gradients in.png out.png --result normals --scale 20 --convention directx")));
    const Image<std::uint8_t> codes = load<std::uint8_t>(shell / "out.png");
    ASSERT_EQ(codes.channels(), 3);
    EXPECT_EQ(codes.view()(20, 15, 1), std::lround((1 - y / length) / 2 * 255));
}

TEST(GradientsVerb, CornersOfASquareAreWritten) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage square = image_of<std::uint8_t>(
        48, 40, 1, [](int x, int y, int) { return x >= 14 && x < 34 && y >= 10 && y < 30 ? 255 : 0; });
    save(shell / "in.png", square);
    for (const std::string measure : {"shi-tomasi", "harris"}) {
        const Outcome run = shell("gradients in.png out.png --corners corners.json --json --measure " + measure);
        ASSERT_TRUE(succeeds(run));
        EXPECT_EQ(run.json()["corners"]["found"], 4);
        const nlohmann::json corners = nlohmann::json::parse(bytes_of(shell / "corners.json"))["corners"];
        ASSERT_EQ(corners.size(), 4u);
        for (const nlohmann::json& c : corners) {
            const double x = c["x"], y = c["y"];
            EXPECT_NEAR(std::abs(x - 24), 10, 0.03) << measure;
            EXPECT_NEAR(std::abs(y - 20), 10, 0.03) << measure;
        }
    }
    ASSERT_TRUE(succeeds(shell("gradients in.png out.png --corners corners.csv --least 0.5")));
    const std::string csv = bytes_of(shell / "corners.csv");
    EXPECT_TRUE(csv.starts_with("x,y,strength\n"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    EXPECT_TRUE(fails(2, shell("gradients in.png out.png --corners corners.txt"), ".json"));
    EXPECT_TRUE(fails(2, shell("gradients in.png out.png --measure harris"), "--corners"));
}

TEST(GradientsVerb, AlphaIsNoObstacle) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 20, 16, 4);
    save(shell / "in.png", image);
    for (const std::string result : {"magnitude", "direction", "coherence", "normals"})
        EXPECT_TRUE(succeeds(shell("gradients in.png out.png --result " + result))) << result;
    EXPECT_TRUE(succeeds(shell("gradients in.png out.jpg --result direction")));
    EXPECT_TRUE(fails(1, shell("gradients in.png out.jpg"), "alpha"));
}

TEST(GradientsVerb, RefusesWhatDoesNotFit) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_ramp(shell, "in.exr");
    std::ofstream(shell / "sum.json") << R"({"version": 1, "kind": "a", "taps": {"first": 0, "weights": [1, 1]}})";
    struct Case {
        int code;
        std::string options, word;
    };
    for (const Case& c : std::vector<Case>{{2, "--operator roberts", "diagonal3"},
                                           {2, "--operator gaussian:0", "0.1"},
                                           {2, "--operator log", "log:1.5"},
                                           {2, "--operator log:1 --result dx", "magnitude or value"},
                                           {2, "--operator sobel --result value", "Laplacians"},
                                           {2, "--result length", "magnitude, dx, dy"},
                                           {2, "--edge renormalize", "reflect"},
                                           {2, "--edge mirror", "mirror"},
                                           {2, "--sigma 2", "--result tensor"},
                                           {2, "--result tensor --sigma 0", "--sigma"},
                                           {2, "--result tensor --sigma 1 --box 1", "--sigma"},
                                           {2, "--result tensor --coherence squared", "sqrt"},
                                           {2, "--result dx --scale 3", "normals"},
                                           {2, "--result normals --convention vulkan", "directx"},
                                           {2, "--operator taps:sum.json", "sum"},
                                           {1, "--operator taps:none.json", "none.json"}})
        EXPECT_TRUE(fails(c.code, shell("gradients in.exr out.exr " + c.options), c.word)) << c.options;
    EXPECT_TRUE(fails(1, shell("gradients in.exr out.pfm --result tensor"), "TIFF or EXR"));
    EXPECT_TRUE(fails(1, shell("gradients none.exr out.exr"), "none.exr"));
    EXPECT_EQ(shell.files(), (std::set<std::string>{"in.exr", "sum.json"}));
    // What integers cannot hold is said, not silently lost.
    const Outcome signs = shell("gradients in.exr out.png --result dy");
    EXPECT_EQ(signs.code, 0);
    EXPECT_NE(signs.err.find("below 0"), std::string::npos) << signs;
}

}  // namespace
}  // namespace bandlimit
