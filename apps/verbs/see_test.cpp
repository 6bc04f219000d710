// What the program says about images, kernels and differences: pattern, compare, analyze, info, from outside.
#include <cmath>
#include <numbers>

#include "apps/run_program_test.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/kernel/kernel.h"

namespace bandlimit {
namespace {

using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.insert(key);
    return keys;
}

/// Whether `keys` are among those of the object.
bool has_all(const json& object, const std::set<std::string>& keys) {
    const std::set<std::string> present = keys_of(object);
    return std::includes(present.begin(), present.end(), keys.begin(), keys.end());
}

json report(const Shell& shell, const std::string& line) {
    const Outcome run = shell(line + " --json");
    EXPECT_TRUE(succeeds(run)) << line;
    return json::parse(run.out, nullptr, false);
}

// ---- analyze
// ---------------------------------------------------------------------------------------------------------

TEST(Analyze, ReportsHaveTheirKeys) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json r =
        report(shell, "analyze lanczos2 --phase 1/2 --frequency 0,0.25 --at 0,1.5 --from 9 --to 4 --rows 0,3");
    EXPECT_EQ(keys_of(r),
              (std::set<std::string>{"kernel", "radius", "separable", "values", "phases", "profile", "rows"}));
    EXPECT_EQ(r["kernel"], "lanczos2");
    EXPECT_EQ(r["radius"], 2);
    EXPECT_EQ(r["separable"], true);
    ASSERT_EQ(r["values"].size(), 2u);
    EXPECT_EQ(keys_of(r["values"][0]), (std::set<std::string>{"x", "value"}));
    EXPECT_EQ(r["values"][0]["value"], 1);
    EXPECT_EQ(keys_of(r["phases"][0]),
              (std::set<std::string>{"phase", "first", "weights", "sum", "variance", "centroid", "response"}));
    EXPECT_EQ(keys_of(r["phases"][0]["response"][0]), (std::set<std::string>{"f", "re", "im", "gain"}));
    EXPECT_EQ(keys_of(r["profile"][0]), (std::set<std::string>{"f", "gain"}));
    ASSERT_EQ(r["rows"].size(), 2u);
    EXPECT_EQ(keys_of(r["rows"][0]), (std::set<std::string>{"output", "first", "weights"}));
    EXPECT_EQ(r["rows"][1]["output"], 3);
}

TEST(Analyze, Lanczos2AtOneHalf) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json phase = report(shell, "analyze lanczos2 --phase 1/2 --frequency 0,0.25")["phases"][0];
    EXPECT_EQ(phase["first"], -1);
    const std::vector<double> weights = phase["weights"];
    ASSERT_EQ(weights.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(weights[i], (i % 3 == 0 ? -1 : 9) / 16.0, 1e-15);
    // sinc(x) sinc(x/2) at 1/2 and 3/2 is 4 sqrt(2) / pi^2 and 1/9 of it, negative: the sum is 2 (1 - 1/9) of that.
    EXPECT_NEAR(phase["sum"].get<double>(), 2 * (8 / 9.0) * 4 * std::sqrt(2.0) / (std::numbers::pi * std::numbers::pi),
                1e-14);
    EXPECT_NEAR(phase["variance"].get<double>(), 164 / 256.0, 1e-15);
    EXPECT_NEAR(phase["centroid"].get<double>(), 0.5, 1e-15);
    // Symmetric about its output: real. 2 (9 cos(pi f) - cos(3 pi f)) / 16.
    EXPECT_NEAR(phase["response"][1]["re"].get<double>(), 2 * (9 + 1) * std::sqrt(0.5) / 16, 1e-15);
    EXPECT_NEAR(phase["response"][1]["im"].get<double>(), 0, 1e-15);
    EXPECT_NEAR(phase["response"][0]["gain"].get<double>(), 1, 1e-15);
}

TEST(Analyze, VarianceOfInterpolation) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const auto variance = [&](const std::string& kernel, std::size_t phase) {
        return report(shell, "analyze " + kernel + " --phase 0,1/2")["phases"][phase]["variance"].get<double>();
    };
    EXPECT_EQ(variance("tent", 0), 1);
    EXPECT_EQ(variance("tent", 1), 0.5);
    EXPECT_NEAR(variance("bspline", 0), 0.5, 1e-15);       // [1 4 1]/6
    EXPECT_NEAR(variance("bspline", 1), 0.46007, 0.5e-5);  // [1 23 23 1]/48
}

TEST(Analyze, TheWrongRadialLanczosPeaks) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const auto& [kernel, f, gain] :
         {std::tuple{"radial-lanczos2", 0.296, 1.233}, {"radial-lanczos3", 0.380, 1.644}}) {
        std::string frequencies = "0";
        for (int i = 1; i <= 100; ++i) frequencies += "," + std::to_string(i * 0.005);
        frequencies += "," + std::to_string(f);
        const json r = report(shell, std::string("analyze ") + kernel + " --frequency " + frequencies);
        EXPECT_EQ(r["separable"], false);
        double peak = 0, at = 0;
        for (const json& p : r["profile"])
            if (p["gain"].get<double>() > peak) peak = p["gain"], at = p["f"];
        EXPECT_NEAR(peak, gain, 0.0005) << kernel;
        EXPECT_NEAR(at, f, 0.0051) << kernel;
        EXPECT_NEAR(r["profile"][0]["gain"].get<double>(), 1, 1e-12);
    }
}

TEST(Analyze, ZerosOfJinc) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json r = report(shell, "analyze jinc3 --at 1.2197,2.2331");
    EXPECT_NEAR(r["radius"].get<double>(), 3.2383, 0.5e-4);
    for (const json& v : r["values"]) EXPECT_NEAR(v["value"].get<double>(), 0, 0.5e-4);  // slope below 1, four digits
}

TEST(Analyze, RowsOfTheExactBox) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json all = report(shell, "analyze box --from 903 --to 451")["rows"];
    ASSERT_EQ(all.size(), 451u);
    for (int i = 0; i < 451; ++i) {
        const json& row = all[static_cast<std::size_t>(i)];
        EXPECT_EQ(row["first"], 2 * i);
        ASSERT_EQ(row["weights"].size(), 3u);
        const double expected[] = {451.0 - i, 451, i + 1.0};
        for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR(row["weights"][j].get<double>(), expected[j] / 903, 3e-8);  // half an ulp of 1/2
    }
    const json five = report(shell, "analyze box --from 5 --to 2 --rows 0")["rows"][0]["weights"];
    ASSERT_EQ(five.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(five[j].get<double>(), j < 2 ? 0.4 : 0.2, 3e-8);
}

TEST(Analyze, TapsFiles) {
    const Shell shell(BANDLIMIT_PROGRAM);
    write_taps(shell / "taps.json",
               {.kind = "downsample", .factor = 2, .taps = Taps{-1, {0.125, 0.375, 0.375, 0.125}, 2}});
    const json r = report(shell, "analyze taps.json --frequency 0,0.5 --from 8 --to 4 --rows 1");
    EXPECT_TRUE(r["radius"].is_null());
    const json& phase = r["phases"][0];
    EXPECT_EQ(phase["phase"], 0.5);  // the output lies between samples 0 and 1
    EXPECT_EQ(phase["first"], -1);
    EXPECT_EQ(phase["centroid"], 0.5);
    EXPECT_EQ(phase["variance"], 0.3125);
    EXPECT_NEAR(phase["response"][1]["gain"].get<double>(), 0, 1e-15);
    EXPECT_EQ(r["rows"][0]["first"], 1);
    EXPECT_TRUE(fails(2, shell("analyze taps.json --from 9 --to 3"), "factor 2"));
    EXPECT_TRUE(fails(2, shell("analyze taps.json --phase 0"), "--phase"));
    EXPECT_TRUE(fails(1, shell("analyze none.json"), "none.json"));
    write_bytes(shell / "bad.json", "{\"version\": 1, \"factor\": ");
    EXPECT_TRUE(fails(1, shell("analyze bad.json"), "bad.json"));
}

TEST(Analyze, ListsKernels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome list = shell("analyze --list");
    ASSERT_TRUE(succeeds(list));
    EXPECT_EQ(static_cast<std::size_t>(std::count(list.out.begin(), list.out.end(), '\n')), kernel_list().size());
    const json kernels = report(shell, "analyze --list")["kernels"];
    EXPECT_EQ(kernels.size(), kernel_list().size());
    for (const json& k : kernels) EXPECT_NE(list.out.find(k["name"].get<std::string>()), std::string::npos);
}

TEST(Analyze, EmitsShadersOfAKernelOrOneByItsName) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome both = shell("analyze bspline --emit wgsl");
    EXPECT_TRUE(succeeds(both));
    for (const char* part :
         {"fn sample_bspline(", "fn sample_bspline_1d(", "Made by: bandlimit analyze bspline --emit wgsl"})
        EXPECT_NE(both.out.find(part), std::string::npos) << part;
    EXPECT_NE(shell("analyze srgb --emit glsl").out.find("vec4 linear_from_srgb("), std::string::npos);
    for (const char* line : {"lanczos3 --emit glsl", "bspline --emit metal", "bspline --emit wgsl --json"})
        EXPECT_EQ(shell(std::string("analyze ") + line).code, 2) << line;
}

TEST(Analyze, PlotsToSvgAndPng) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("analyze mitchell --plot plot.svg")));
    ASSERT_TRUE(succeeds(shell("analyze jinc2 --plot plot.png")));
    EXPECT_NE(bytes_of(shell / "plot.svg").find("<svg"), std::string::npos);
    EXPECT_GT(ImageReader(shell / "plot.png", 1).info().width, 500);
    EXPECT_EQ(shell.files(), (std::set<std::string>{"plot.svg", "plot.png"}));
}

// ---- compare
// ---------------------------------------------------------------------------------------------------------

const std::set<std::string> compare_keys{"mse",     "psnr",  "max_abs", "ssim",    "shift_x",
                                         "shift_y", "width", "height",  "channels"};

TEST(Compare, IdenticalImages) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern noise a.png --size 96x64 --cutoff 0.3")));
    const json r = report(shell, "compare a.png a.png");
    EXPECT_TRUE(has_all(r, compare_keys)) << r;
    EXPECT_EQ(r["psnr"], "inf");
    EXPECT_EQ(r["mse"], 0);
    EXPECT_EQ(r["max_abs"], 0);
    EXPECT_EQ(r["ssim"], 1);
    EXPECT_NEAR(r["shift_x"].get<double>(), 0, 0.01);
    EXPECT_NEAR(r["shift_y"].get<double>(), 0, 0.01);
    EXPECT_EQ(r["width"], 96);
    EXPECT_EQ(r["height"], 64);
    EXPECT_EQ(r["channels"], 1);
}

TEST(Compare, MeasuresAgreeWithTheirDefinitions) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage a = image_of<std::uint8_t>(20, 10, 1, [](int, int, int) { return 100; });
    AnyImage b = image_of<std::uint8_t>(20, 10, 1, [](int x, int y, int) { return x == 4 && y == 3 ? 151 : 100; });
    save(shell / "a.png", a);
    save(shell / "b.png", b);
    const json encoded = report(shell, "compare a.png b.png");
    EXPECT_NEAR(encoded["max_abs"].get<double>(), 0.2, 1e-7);  // 51 / 255
    EXPECT_NEAR(encoded["mse"].get<double>(), 0.04 / 200, 1e-9);
    EXPECT_NEAR(encoded["psnr"].get<double>(), 10 * std::log10(200 / 0.04), 1e-5);
    EXPECT_TRUE(encoded["shift_x"].is_null()) << "a constant image lies nowhere";
    const json linear = report(shell, "compare a.png b.png --measure linear");
    EXPECT_NEAR(linear["max_abs"].get<double>(), srgb_to_linear(151 / 255.0) - srgb_to_linear(100 / 255.0), 1e-6);
    EXPECT_EQ(report(shell, "compare a.png b.png --border 4")["psnr"], "inf");
    // Data is measured as it is stored, and float files on linear values.
    EXPECT_NEAR(report(shell, "compare a.png b.png --measure linear --space data")["max_abs"].get<double>(), 0.2, 1e-7);
    ASSERT_TRUE(succeeds(shell("resize a.png a.exr --scale 1 --depth f32")));
    ASSERT_TRUE(succeeds(shell("resize b.png b.exr --scale 1 --depth f32")));
    EXPECT_NEAR(report(shell, "compare a.exr b.exr")["max_abs"].get<double>(), linear["max_abs"].get<double>(), 1e-6);
    EXPECT_NEAR(report(shell, "compare a.exr b.exr --measure encoded")["max_abs"].get<double>(), 0.2, 1e-6);
}

TEST(Compare, ShiftAboveZeroMeansRightAndBelow) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern noise big.png --size 140x130 --cutoff 0.2 --depth u16")));
    ASSERT_TRUE(succeeds(shell("resize big.png a.png --scale 1 --region 8,8,120,110")));
    ASSERT_TRUE(succeeds(shell("resize big.png b.png --scale 1 --region 5,6.5,120,110 --kernel lanczos6")));
    const json r = report(shell, "compare a.png b.png");
    EXPECT_NEAR(r["shift_x"].get<double>(), 3, 0.02);
    EXPECT_NEAR(r["shift_y"].get<double>(), 1.5, 0.02);
}

TEST(Compare, DownAndUpStaysInPlace) {
    // A box halves, bilinear [1/4 3/4] doubles: nothing moves. Taking samples in place of the box's middles moves half
    // a pixel.
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern noise a.exr --size 128x96 --cutoff 0.1")));
    ASSERT_TRUE(succeeds(shell("resize a.exr half.exr --scale 0.5 --kernel box")));
    ASSERT_TRUE(succeeds(shell("resize half.exr again.exr --scale 2 --kernel tent")));
    const json r = report(shell, "compare a.exr again.exr --border 4");
    EXPECT_NEAR(r["shift_x"].get<double>(), 0, 0.005);
    EXPECT_NEAR(r["shift_y"].get<double>(), 0, 0.005);
    // Copies and midpoints: pixel 2i is sample i, so that everything lies half a pixel to the left and up.
    AnyImage half = read_image(shell / "half.exr");
    const View<const float> s = std::get<View<const float>>(pixels(half));
    const auto at = [&](int x, int y) { return s(std::min(x, s.width - 1), std::min(y, s.height - 1)); };
    AnyImage odd = image_of<float>(128, 96, 1, [&](int x, int y, int) {
        const int x0 = x / 2, y0 = y / 2, x1 = x0 + x % 2, y1 = y0 + y % 2;
        return (at(x0, y0) + at(x1, y0) + at(x0, y1) + at(x1, y1)) / 4;
    });
    save(shell / "odd.exr", odd);
    const json shifted = report(shell, "compare a.exr odd.exr --border 4");
    EXPECT_NEAR(shifted["shift_x"].get<double>(), -0.5, 0.01);
    EXPECT_NEAR(shifted["shift_y"].get<double>(), -0.5, 0.01);
}

TEST(Compare, WritesTheDifference) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage a = noise(Depth::u8, 9, 7, 4), b = image_of<std::uint8_t>(9, 7, 4, [](int, int, int) { return 100; });
    save(shell / "a.png", a);
    save(shell / "b.png", b);
    EXPECT_EQ(report(shell, "compare a.png b.png --diff d.png")["channels"], 4);
    const Image<std::uint8_t> d = load<std::uint8_t>(shell / "d.png");
    ASSERT_EQ(d.channels(), 3);
    const auto v = std::get<View<const std::uint8_t>>(pixels(a));
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) EXPECT_EQ(int(d.view()(x, y, 1)), std::abs(int(v(x, y, 1)) - 100));
}

TEST(Compare, WhatCannotBeComparedIsExitCode1) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage a = noise(Depth::u8, 9, 7, 3), b = noise(Depth::u8, 9, 8, 3), c = noise(Depth::u8, 9, 7, 1);
    save(shell / "a.png", a);
    save(shell / "b.png", b);
    save(shell / "c.png", c);
    EXPECT_TRUE(fails(1, shell("compare a.png b.png --diff d.png --json"), "9 x 8"));
    EXPECT_TRUE(fails(1, shell("compare a.png c.png --json"), "channels"));
    EXPECT_TRUE(fails(1, shell("compare a.png none.png"), "none.png"));
    EXPECT_TRUE(fails(1, shell("compare a.png a.png --border 4"), "a border of 4"));
    EXPECT_TRUE(fails(1, shell("compare a.png a.png --diff none/d.png"), "none"));
    EXPECT_TRUE(fails(1, shell("compare a.png a.png --diff /dev/null"), "/dev/null"));
    EXPECT_EQ(shell.files(), (std::set<std::string>{"a.png", "b.png", "c.png"}));
}

// ---- pattern, info
// ---------------------------------------------------------------------------------------------------

TEST(Pattern, ValuesAreLightAndCodesEncodeThem) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(
        succeeds(shell("pattern box a.exr --size 8x4 --region 1.5,1,3,2 --antialias exact --low 0.25 --high 2")));
    const Image<float> light = load<float>(shell / "a.exr");
    EXPECT_EQ(light.view()(0, 1), 0.25f);
    EXPECT_EQ(light.view()(1, 1), 1.125f);  // half covered
    EXPECT_EQ(light.view()(2, 1), 2.0f);
    ASSERT_TRUE(succeeds(shell("pattern box a.png --size 8x4 --region 1.5,1,3,2 --antialias exact")));
    EXPECT_EQ(int(load<std::uint8_t>(shell / "a.png").view()(1, 1)), 188);
    ASSERT_TRUE(
        succeeds(shell("pattern box a.png --size 8x4 --region 1.5,1,3,2 --antialias exact --space data --depth u16")));
    EXPECT_EQ(int(load<std::uint16_t>(shell / "a.png").view()(1, 1)), 32768);
    const json r = report(shell, "pattern noise n.png --size 5x6 --seed 3");
    EXPECT_EQ(r["width"], 5);
    EXPECT_EQ(r["height"], 6);
    EXPECT_EQ(r["kind"], "noise");
}

TEST(Info, SaysWhatTheFileSays) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage codes = noise(Depth::u16, 9, 7, 4), floats = noise(Depth::f16, 5, 6, 3);
    save(shell / "a.png", codes);
    save(shell / "a.exr", floats);
    const json png = report(shell, "info a.png"), exr = report(shell, "info a.exr");
    EXPECT_TRUE(has_all(png, {"width", "height", "channels", "depth", "color_hint", "levels"})) << png;
    EXPECT_EQ(png["width"], 9);
    EXPECT_EQ(png["height"], 7);
    EXPECT_EQ(png["channels"], 4);
    EXPECT_EQ(png["depth"], "u16");
    EXPECT_EQ(png["transfer"], "srgb");
    EXPECT_EQ(png["levels"], 1);
    EXPECT_EQ(exr["depth"], "f16");
    EXPECT_EQ(exr["transfer"], "linear");
    EXPECT_TRUE(exr["alpha"].is_null());
    EXPECT_TRUE(fails(1, shell("info none.png --json"), "none.png"));
}

}  // namespace
}  // namespace bandlimit
