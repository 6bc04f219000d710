// Convolution and bokeh by the program, from outside.
#include <cmath>
#include <fstream>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

/// One bright sample in the middle of black.
void save_impulse(const Shell& shell, const std::string& name) {
    AnyImage impulse = image_of<float>(31, 31, 1, [](int x, int y, int) { return x == 15 && y == 15 ? 1 : 0; });
    save(shell / name, impulse);
}

constexpr const char* lopsided = R"({"version": 1, "kind": "test", "terms": [
    {"column": [1, 2, 3], "row": [4, 0, 2]}, {"column": [0, 1, 0], "row": [0, 5, 0]}]})";

TEST(Convolve, RunsTermsAsTheFileHasThem) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_impulse(shell, "in.exr");
    write_text(shell / "terms.json", lopsided);
    const auto weight = [](int x, int y) {
        const int column[] = {1, 2, 3}, row[] = {4, 0, 2};
        return column[y] * row[x] + (x == 1 && y == 1 ? 5 : 0);
    };
    for (const std::string method : {"", " --exact", " --fft", " --rank 2"}) {
        const Outcome run = shell("convolve in.exr out.exr --taps terms.json --edge zero --depth f32 --json" + method);
        ASSERT_TRUE(succeeds(run)) << method;
        const nlohmann::json report = run.json();
        EXPECT_EQ(report["weights"]["width"], 3);
        EXPECT_EQ(report["method"], method == " --fft" ? "fft" : "direct");
        const Image<float> out = load<float>(shell / "out.exr");
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)  // a light becomes the weights, turned by half a turn; divided by their sum
                EXPECT_NEAR(out.view()(16 - x, 16 - y), weight(x, y) / 41.0, 1e-6) << method;
    }
    ASSERT_TRUE(succeeds(shell("convolve in.exr out.exr --taps terms.json --keep-sum --depth f32")));
    EXPECT_NEAR(load<float>(shell / "out.exr").view()(15, 15), 5, 1e-5);
}

TEST(Convolve, RefusesWhatDoesNotFit) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_impulse(shell, "in.exr");
    write_text(shell / "half.json",
               R"({"version": 1, "kind": "a", "factor": 2, "taps": {"first": 0, "weights": [1, 1]}})");
    write_text(shell / "slope.json", R"({"version": 1, "kind": "a", "taps": {"first": -1, "weights": [-1, 0, 1]}})");
    write_text(shell / "disk.json", R"({"version": 1, "kind": "a", "components": [{"a": 1, "b": 1, "A": 1, "B": 0}]})");
    write_text(shell / "terms.json", lopsided);
    struct Case {
        int code;
        std::string command, word;
    };
    for (const Case& c : std::vector<Case>{
             {2, "convolve in.exr out.exr", "--taps"},
             {2, "convolve in.exr out.exr --taps half.json --image in.exr", "exactly one place"},
             {2, "convolve in.exr out.exr --taps half.json", "factor of 2"},
             {2, "convolve in.exr out.exr --taps disk.json", "pass a radius"},
             {2, "convolve in.exr out.exr --taps terms.json --axis x", "leave the axis out"},
             {2, "convolve in.exr out.exr --taps terms.json --radius 3", "leave the radius out"},
             {2, "convolve in.exr out.exr --taps terms.json --rank 2 --fft", "--fft"},
             {1, "convolve in.exr out.exr --taps terms.json --rank 4", "at most 3"},
             {1, "convolve in.exr out.exr --taps slope.json", "keep their sum"},
             {1, "convolve in.exr out.exr --taps none.json", "none.json"},
             {1, "convolve in.exr out.exr --image none.png", "none.png"},
             {2, "bokeh in.exr out.exr", "--radius"},
             {2, "bokeh in.exr out.exr --radius 0", "0.5"},
             {2, "bokeh in.exr out.exr --radius 5 --shape circus", "circus"},
             {2, "bokeh in.exr out.exr --radius 5 --shape star:5:0.9:0.4:0 --components 2", "use a rank"},
             {2, "bokeh in.exr out.exr --radius 5 --hdr 0", "hdr: "},
             {1, "bokeh in.exr out.exr --radius 5 --rank 12", "at most 11"},
             {1, "bokeh in.exr out.exr --radius 5 --shape none.png", "none.png"},
         })
        EXPECT_TRUE(fails(c.code, shell(c.command), c.word)) << c.command;
    EXPECT_FALSE(shell.files().count("out.exr"));
    // Along one axis, with its sum, a derivative is fine: reflected at the border, where there is nothing to rescale.
    const Outcome slope = shell("convolve in.exr out.exr --taps slope.json --axis x --keep-sum --depth f32 --json");
    ASSERT_TRUE(succeeds(slope));
    EXPECT_EQ(slope.json()["edge"], "reflect");
    const Image<float> out = load<float>(shell / "out.exr");
    EXPECT_EQ(out.view()(14, 15), 1);
    EXPECT_EQ(out.view()(16, 15), -1);
    EXPECT_EQ(out.view()(15, 14), 0);
}

TEST(Convolve, SaysOnceThatEvenWeightsShift) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_impulse(shell, "in.exr");
    AnyImage two = image_of<float>(2, 2, 1, [](int, int, int) { return 1; });
    save(shell / "two.exr", two);
    const Outcome run = shell("convolve in.exr out.exr --image two.exr --depth f32");
    ASSERT_EQ(run.code, 0) << run;
    ASSERT_EQ(stderr_lines(run).size(), 1u) << run;
    EXPECT_NE(run.err.find("moves by 0.5, 0.5"), std::string::npos) << run;
    const Image<float> out = load<float>(shell / "out.exr");  // to the right and down
    EXPECT_NEAR(out.view()(16, 16), 0.25, 1e-6);
    EXPECT_NEAR(out.view()(14, 14), 0, 1e-6);
    EXPECT_TRUE(shell("convolve in.exr out.exr --image two.exr --quiet").err.empty());
}

TEST(Bokeh, GivesLightsTheShapeAsItIsDrawn) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_impulse(shell, "in.exr");
    // Bright in one corner: it must come out there.
    AnyImage corner = image_of<float>(9, 9, 1, [](int x, int y, int) { return x < 5 && y < 5 ? 1 : 0; });
    save(shell / "corner.exr", corner);
    ASSERT_TRUE(succeeds(shell("bokeh in.exr out.exr --shape corner.exr --radius 4.5 --depth f32")));
    const Image<float> out = load<float>(shell / "out.exr");
    EXPECT_NEAR(out.view()(12, 12), 1 / 25.0, 1e-6);
    EXPECT_NEAR(out.view()(18, 18), 0, 1e-6);
}

TEST(Bokeh, ApproximationsAreNearAndSayWhatTheyAre) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage light = image_of<float>(41, 41, 3, [](int x, int y, int) { return x == 20 && y == 20 ? 50 : 0.1; });
    save(shell / "in.exr", light);
    const auto blurred = [&](const std::string& how) {
        const Outcome run = shell("bokeh in.exr out.exr --radius 6 --depth f32 --json " + how);
        EXPECT_TRUE(succeeds(run)) << how;
        return std::pair{load<float>(shell / "out.exr"), run.json()};
    };
    const auto [exact, direct] = blurred("--exact");
    EXPECT_EQ(direct["method"], "direct");
    EXPECT_EQ(direct["multiply_adds"], 169);
    const double plateau = static_cast<double>(exact.view()(20, 20));
    // The largest difference, in parts of the height of the disc of light.
    const auto difference = [&, expected = exact.view()](const Image<float>& image) {
        double most = 0;
        for (int y = 0; y < 41; ++y)
            for (int x = 0; x < 41; ++x)
                most = std::max(most, std::abs(double(image.view()(x, y)) - double(expected(x, y))) / plateau);
        return most;
    };
    EXPECT_LT(difference(blurred("").first), 1e-5);
    EXPECT_LT(difference(blurred("--fft").first), 1e-5);
    const auto [products, rank] = blurred("--rank 4");
    EXPECT_EQ(rank["rank"], 4);
    EXPECT_LT(difference(products), 0.3);
    const auto [phasors, components] = blurred("--components 2");
    EXPECT_EQ(components["components"], 2);
    EXPECT_EQ(components["rank"], 4);
    EXPECT_LT(difference(phasors), 0.7);  // at the edge of the disc, which phasors soften
    EXPECT_GT(difference(phasors), difference(products));
    // Raised, the light outshines what surrounds it.
    EXPECT_GT(blurred("--hdr 7").first.view()(20, 20), 5 * exact.view()(20, 20));
}

}  // namespace
}  // namespace bandlimit
