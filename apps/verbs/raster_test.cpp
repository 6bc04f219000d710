// Rasterizing by the program, from outside.
#include <cmath>
#include <fstream>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

constexpr const char* lines = R"({"width": 90, "height": 40, "filter": "FILTER", "background": [0, 0, 0], "shapes": [
    {"type": "line", "from": [10.5, -50], "to": [10.5, 90], "width": 1, "color": [1, 1, 1]},
    {"type": "line", "from": [25.75, -50], "to": [25.75, 90], "width": 1, "color": [1, 1, 1]},
    {"type": "line", "from": [40, -50], "to": [40, 90], "width": 1, "color": [1, 1, 1]},
    {"type": "line", "from": [55.25, -50], "to": [55.25, 90], "width": 1, "color": [1, 1, 1]},
    {"type": "line", "from": [71.5, -50], "to": [71.5, 90], "width": 1, "color": [1, 1, 1]},
    {"type": "line", "from": [86.75, -50], "to": [86.75, 90], "width": 1, "color": [1, 1, 1]}]})";

std::string lines_through(const std::string& filter) {
    std::string text = lines;
    return text.replace(text.find("FILTER"), 6, filter);
}

TEST(Raster, WhiteOnBlackIsTheCoverage) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const float cone[] = {.7799f, .7032f, .5000f, .2757f, .1101f, .0210f},
                gaussian[] = {.6827f, .6247f, .4772f, .3023f, .1573f, .0666f};
    const int pixels[] = {10, 25, 39, 54, 70, 85};  // at distances 0 to 1.25 from the axes
    for (const bool is_cone : {true, false}) {
        write_text(shell / "lines.json", lines_through(is_cone ? "cone:1" : "gaussian:0.5"));
        const Outcome run = shell("raster lines.json out.exr --json");
        ASSERT_TRUE(succeeds(run));
        EXPECT_EQ(run.json()["shapes"], 6);
        EXPECT_EQ(run.json()["depth"], "f32");
        const Image<float> out = load<float>(shell / "out.exr");
        ASSERT_EQ(out.channels(), 3);
        for (int i = 0; i < 6; ++i)
            EXPECT_NEAR(out.view()(pixels[i], 20, 1), is_cone ? cone[i] : gaussian[i], 6e-5f) << i;
    }
}

TEST(Raster, ComparesWithTheTruthAndDrawsIt) {
    const Shell shell(BANDLIMIT_PROGRAM);
    write_text(shell / "lines.json", lines_through("cone:1"));
    const Outcome compared = shell("raster lines.json fast.exr --compare 32 --json");
    ASSERT_TRUE(succeeds(compared));
    EXPECT_LT(compared.json()["difference"]["rms"], 0.005);
    ASSERT_TRUE(succeeds(shell("raster lines.json slow.exr --truth 32")));
    const Image<float> fast = load<float>(shell / "fast.exr"), slow = load<float>(shell / "slow.exr");
    double sum = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 90; ++x)
            for (int c = 0; c < 3; ++c) sum += std::pow(double(fast.view()(x, y, c)) - double(slow.view()(x, y, c)), 2);
    EXPECT_NEAR(compared.json()["difference"]["rms"], std::sqrt(sum / (40 * 90 * 3)), 1e-6);
    EXPECT_GT(sum, 0);
    const Outcome told = shell("raster lines.json fast.exr --compare 8");
    ASSERT_TRUE(succeeds(told));
    EXPECT_NE(told.out.find("8 x 8 samples: RMS"), std::string::npos) << told.out;
}

TEST(Raster, BytesAreSrgbAndAlphaIsKept) {
    const Shell shell(BANDLIMIT_PROGRAM);
    write_text(shell / "half.json", R"({"width": 8, "height": 8, "background": [0, 0, 0, 0], "shapes": [
        {"type": "polygon", "points": [[-9, -9], [4.5, -9], [4.5, 20], [-9, 20]], "color": [1, 0.5, 0]}]})");
    ASSERT_TRUE(succeeds(shell("raster half.json half.png")));
    const Image<std::uint8_t> out = load<std::uint8_t>(shell / "half.png");
    ASSERT_EQ(out.channels(), 4);
    EXPECT_EQ(out.view()(4, 4, 0), 255);  // colour is not multiplied by alpha in PNG
    EXPECT_EQ(out.view()(4, 4, 1), 188);
    EXPECT_EQ(out.view()(4, 4, 3), 128);
    EXPECT_EQ(out.view()(6, 4, 3), 0);
}

TEST(Raster, SaysWhatIsWrongAndLeavesNothing) {
    const Shell shell(BANDLIMIT_PROGRAM);
    write_text(shell / "ok.json", lines_through("cone:1"));
    write_text(shell / "bad.json", "{\"width\": 8, \"height\": 8, \"shapes\": [\n{\"type\": \"line\", \"widht\": 1}]}");
    struct Case {
        int code;
        std::string command, words;
    };
    for (const Case& c : std::vector<Case>{{1, "raster bad.json out.png", "bad.json, line 2: a line has no \"widht\""},
                                           {1, "raster none.json out.png", "none.json"},
                                           {1, "raster ok.json nowhere/out.png", "nowhere"},
                                           {2, "raster ok.json out.xyz", "out.xyz"},
                                           {2, "raster ok.json out.png --filter cone:0", "--filter: cone:0"},
                                           {2, "raster ok.json out.png --truth 65", "--truth"},
                                           {2, "raster ok.json out.png --truth 4 --compare 4", "--truth"},
                                           {2, "raster ok.json out.png --truth 2 --filter cone:0.2", "--truth: "},
                                           {2, "raster ok.json", "OUT"}}) {
        const Outcome run = shell(c.command);
        EXPECT_EQ(run.code, c.code) << c.command << run;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << c.command << run;
        EXPECT_NE(run.err.find(c.words), std::string::npos) << c.command << run;
        EXPECT_FALSE(std::filesystem::exists(shell / "out.png")) << c.command;
    }
}

}  // namespace
}  // namespace bandlimit
