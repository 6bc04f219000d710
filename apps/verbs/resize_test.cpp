// bandlimit resize, from outside.
#include <cmath>
#include <limits>

#include "apps/run_program_test.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// A step from 0 to 1 in the middle.
AnyImage step(int width, int height) {
    return image_of<float>(width, height, 1, [&](int x, int, int) { return x < width / 2 ? 0 : 1; });
}

AnyImage checkerboard(int width, int height) {
    return image_of<std::uint8_t>(width, height, 1, [](int x, int y, int) { return (x + y) % 2 * 255; });
}

/// Clears the colour under zero alpha, the last channel.
template <class T>
void clear_transparent(View<T> v) {
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x)
            for (int c = 0; c + 1 < v.channels; ++c)
                if (v(x, y, v.channels - 1) == T{}) v(x, y, c) = T{};
}

TEST(Resize, TheSameSizeIsTheSamePixels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const Depth depth : {Depth::u8, Depth::u16})
        for (const int channels : {1, 3, 4}) {
            AnyImage image = noise(depth, 33, 21, channels);
            save(shell / "in.png", image);
            if (channels == 4) {
                ASSERT_TRUE(succeeds(shell("resize in.png straight.png --size 33x21 --alpha straight")));
                AnyImage straight = read_image(shell / "straight.png");
                EXPECT_TRUE(equal(pixels(image), pixels(straight))) << channels;
                std::visit([](const auto& v) { clear_transparent(v); }, view_of(image));
            }
            ASSERT_TRUE(succeeds(shell("resize in.png same.png --scale 1")));
            AnyImage same = read_image(shell / "same.png");
            EXPECT_TRUE(equal(pixels(image), pixels(same))) << name_of(depth) << ", channels " << channels;
        }
}

TEST(Resize, FiltersLinearLightUnlessToldOtherwise) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage board = checkerboard(16, 12);
    save(shell / "board.png", board);
    // Half the light has the code 255 * 1.055 * 0.5^(1/2.4) - 0.055 = 187.5; half the code is 127.5, which rounds up.
    for (const auto& [space, code] : {std::pair{"auto", 188}, {"srgb", 188}, {"linear", 128}, {"data", 128}}) {
        ASSERT_TRUE(succeeds(shell(std::string("resize board.png half.png --size 8x6 --kernel box --space ") + space)));
        const Image<std::uint8_t> half = load<std::uint8_t>(shell / "half.png");
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 8; ++x) ASSERT_EQ(int(half.view()(x, y)), code) << space;
    }
}

TEST(Resize, NothingBleedsOutOfTransparentTexels) {
    const Shell shell(BANDLIMIT_PROGRAM);
    // Opaque green on the left; on the right, and in spots among it, magenta that nobody may ever see.
    AnyImage image = image_of<std::uint8_t>(24, 16, 4, [](int x, int y, int c) {
        const bool is_clear = x >= 13 || (x % 5 == 2 && y % 4 == 1);
        const int green[] = {0, 200, 0, 255}, poison[] = {255, 0, 255, 0};
        return is_clear ? poison[c] : green[c];
    });
    save(shell / "in.png", image);
    for (const std::string options :
         {"--scale 0.5", "--scale 1/3 --kernel box", "--scale 2.3 --kernel mitchell", "--scale 0.5 --kernel jinc2",
          "--size 31x7 --kernel lanczos3 --edge wrap --antiring 1"}) {
        SCOPED_TRACE(options);
        ASSERT_TRUE(succeeds(shell("resize in.png out.png " + options)));
        const Image<std::uint8_t> out = load<std::uint8_t>(shell / "out.png");
        const View<const std::uint8_t> v = out.view();
        int clear = 0;
        for (int y = 0; y < v.height; ++y)
            for (int x = 0; x < v.width; ++x) {
                const bool is_clear = v(x, y, 3) == 0;
                clear += is_clear;
                ASSERT_EQ(int(v(x, y, 0)), 0);
                ASSERT_EQ(int(v(x, y, 1)), is_clear ? 0 : 200) << x << ", " << y << ": alpha " << int(v(x, y, 3));
                ASSERT_EQ(int(v(x, y, 2)), 0);
            }
        EXPECT_GT(clear, 0);
    }
    ASSERT_TRUE(succeeds(shell("resize in.png kept.png --size 12x8 --kernel nearest --alpha straight")));
    EXPECT_EQ(int(load<std::uint8_t>(shell / "kept.png").view()(11, 7, 0)), 255);
}

TEST(Resize, ARegionIsTheCropOfTheWhole) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage codes = noise(Depth::u8, 40, 30, 3), floats = noise(Depth::f32, 40, 30, 3);
    save(shell / "in.png", codes);
    save(shell / "in.exr", floats);
    for (const std::string kernel : {"auto", "box", "jinc2"})
        for (const std::string format : {"png", "exr"}) {
            if (kernel != "auto" && format == "exr") continue;
            SCOPED_TRACE(kernel + " " + format);
            const std::string in = "resize in." + format + " ", k = " --kernel " + kernel;
            const auto check = [&](int x, int y, int width, int height) {
                AnyImage whole = read_image(shell / ("whole." + format)), part = read_image(shell / ("part." + format));
                const AnyConstView crop = std::visit(
                    [&](const auto& v) { return AnyConstView(cropped(v, x, y, width, height)); }, pixels(whole));
                EXPECT_TRUE(equal(crop, pixels(part)));
            };
            ASSERT_TRUE(succeeds(shell(in + "whole." + format + " --scale 0.5" + k)));
            ASSERT_TRUE(succeeds(shell(in + "part." + format + " --region 8,6,16,12 --scale 1/2" + k)));
            check(4, 3, 8, 6);
            ASSERT_TRUE(succeeds(shell(in + "whole." + format + " --size 60x45" + k)));
            ASSERT_TRUE(succeeds(shell(in + "part." + format + " --region 10,20,30,10 --scale 1.5" + k)));
            check(15, 30, 45, 15);
        }
}

TEST(Resize, CentersShareTheFirstAndTheLastSample) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage pair = step(2, 1);
    save(shell / "pair.exr", pair);
    ASSERT_TRUE(succeeds(shell("resize pair.exr out.exr --size 4x1 --align centers --kernel tent")));
    const Image<float> out = load<float>(shell / "out.exr");
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(out.view()(x, 0), x / 3.0, 1e-7) << x;  // an ulp below 1 is 6e-8
    ASSERT_TRUE(succeeds(shell("resize pair.exr out.pfm --size 4x1 --align corners --kernel tent")));
    const Image<float> corners = load<float>(shell / "out.pfm");
    for (int x = 0; x < 4; ++x)
        EXPECT_EQ(corners.view()(x, 0), std::clamp(0.5f * static_cast<float>(x) - 0.25f, 0.0f, 1.0f)) << x;
}

TEST(Resize, ThreadsDoNotChangeTheResult) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage codes = noise(Depth::u8, 150, 320, 4), floats = noise(Depth::f32, 150, 320, 3);
    save(shell / "in.png", codes);
    save(shell / "in.exr", floats);
    for (const std::string format : {"png", "exr"}) {
        const std::string in = "resize in." + format + " ";
        ASSERT_TRUE(succeeds(shell(in + "one." + format + " --size 97x211 --threads 1")));
        AnyImage one = read_image(shell / ("one." + format));
        for (const std::string threads : {"2", "3"}) {
            ASSERT_TRUE(succeeds(shell(in + "more." + format + " --size 97x211 --threads " + threads)));
            AnyImage more = read_image(shell / ("more." + format));
            EXPECT_TRUE(equal(pixels(one), pixels(more))) << format << ", threads " << threads;
        }
    }
}

TEST(Resize, AntiringTakesOvershootAway) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage edge = step(32, 8);
    save(shell / "edge.exr", edge);
    const auto range = [&](const std::string& options) {
        EXPECT_TRUE(succeeds(shell("resize edge.exr out.exr --scale 3 --kernel lanczos3 " + options)));
        const Image<float> out = load<float>(shell / "out.exr");
        float low = 0, high = 0;
        for (int x = 0; x < 96; ++x) low = std::min(low, out.view()(x, 0)), high = std::max(high, out.view()(x, 0));
        return std::pair(low, high);
    };
    const auto [low, high] = range("");
    EXPECT_LT(low, -0.05f);
    EXPECT_GT(high, 1.05f);
    const auto [half_low, half_high] = range("--antiring 0.5");
    EXPECT_NEAR(half_low, low / 2, 1e-6);
    EXPECT_NEAR(half_high, (1 + high) / 2, 1e-6);
    EXPECT_EQ(range("--antiring 1"), std::pair(0.0f, 1.0f));
}

TEST(Resize, SizesFollowFromWhatIsGiven) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 40, 30, 1), small = noise(Depth::u8, 5, 3, 1);
    save(shell / "in.png", image);
    save(shell / "small.png", small);
    const auto expect = [&](const std::string& options, int width, int height) {
        ASSERT_TRUE(succeeds(shell("resize " + options + " out.png"))) << options;
        const ImageReader reader(shell / "out.png", 1);
        EXPECT_EQ(reader.info().width, width) << options;
        EXPECT_EQ(reader.info().height, height) << options;
    };
    expect("in.png --size 7x9", 7, 9);
    expect("in.png --width 20", 20, 15);
    expect("in.png --height 15", 20, 15);
    expect("in.png --width 7", 7, 5);   // 5.25
    expect("in.png --width 6", 6, 5);   // 4.5
    expect("in.png --height 1", 1, 1);  // 1.33
    expect("in.png --width 5 --height 5", 5, 5);
    expect("in.png --width 20 --region 0,0,20,10", 20, 10);
    expect("small.png --scale 0.5", 3, 2);  // 2.5 and 1.5
    expect("small.png --scale 1/3", 2, 1);
    expect("small.png --scale 0.001", 1, 1);
    expect("small.png --scale 1.5", 8, 5);  // 7.5 and 4.5
}

TEST(Resize, BlackAndWhiteSurviveEveryChangeOfDepth) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = image_of<std::uint8_t>(4, 4, 1, [](int x, int, int) { return x % 2 * 255; });
    save(shell / "u8.png", image);
    struct Step {
        std::string from, to, depth;
    };
    for (const auto& [from, to, depth] : {Step{"u8.png", "u16.png", "u16"},
                                          {"u16.png", "f16.exr", "f16"},
                                          {"f16.exr", "f32.tif", "f32"},
                                          {"f32.tif", "f32.exr", "f32"},
                                          {"f32.exr", "u16.tif", "u16"},
                                          {"u16.tif", "u8.tif", "u8"},
                                          {"u8.tif", "f16b.exr", "f16"},
                                          {"f16b.exr", "last.png", "u8"}}) {
        ASSERT_TRUE(succeeds(shell("resize " + from + " " + to + " --scale 1 --kernel box --depth " + depth)));
        EXPECT_EQ(name_of(ImageReader(shell / to, 1).info().depth), depth);
    }
    AnyImage last = read_image(shell / "last.png");
    EXPECT_TRUE(equal(pixels(image), pixels(last)));
    const Image<float> middle = load<float>(shell / "f32.exr");
    for (int x = 0; x < 4; ++x) EXPECT_EQ(middle.view()(x, 0), static_cast<float>(x % 2));
    EXPECT_TRUE(fails(2, shell("resize u8.png no.png --scale 1 --depth f32"), "u8"));
}

TEST(Resize, FloatFormatsHoldLinearLight) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage codes = image_of<std::uint8_t>(16, 16, 1, [](int x, int y, int) { return y * 16 + x; });
    save(shell / "codes.png", codes);
    ASSERT_TRUE(succeeds(shell("resize codes.png light.exr --scale 1 --depth f32")));
    const Image<float> light = load<float>(shell / "light.exr");
    for (int i = 0; i < 256; ++i)
        EXPECT_FLOAT_EQ(light.view()(i % 16, i / 16), static_cast<float>(srgb_to_linear(i / 255.0)));
    ASSERT_TRUE(succeeds(shell("resize light.exr back.png --scale 1 --depth u8")));
    AnyImage back = read_image(shell / "back.png");
    EXPECT_TRUE(equal(pixels(codes), pixels(back)));
}

TEST(Resize, AlphaNeedsAFormatThatHoldsItOrABackground) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = image_of<std::uint8_t>(16, 16, 4, [](int, int, int c) { return c == 3 ? 0 : 77; });
    save(shell / "clear.png", image);
    EXPECT_TRUE(fails(1, shell("resize clear.png out.jpg --scale 0.5"), "a background colour"));
    EXPECT_EQ(shell.files(), std::set<std::string>{"clear.png"});
    ASSERT_TRUE(succeeds(shell("resize clear.png out.png --scale 0.5 --background ff8000")));
    const Image<std::uint8_t> laid = load<std::uint8_t>(shell / "out.png");
    ASSERT_EQ(laid.channels(), 3);
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(int(laid.view()(3, 3, c)), (std::array{255, 128, 0}[static_cast<std::size_t>(c)]));
    EXPECT_TRUE(succeeds(shell("resize clear.png out.jpg --scale 0.5 --background #ffffff")));
    EXPECT_TRUE(fails(2, shell("resize clear.png out.jpg --scale 0.5 --background white"), "RRGGBB"));
}

TEST(Resize, TapsAreAKernelForTheirFactor) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::f32, 20, 14, 2);
    save(shell / "in.exr", image);
    write_taps(shell / "box.json", {.kind = "downsample", .factor = 2, .taps = Taps{0, {0.5, 0.5}, 2}});
    ASSERT_TRUE(succeeds(shell("resize in.exr taps.exr --scale 0.5 --kernel box.json")));
    ASSERT_TRUE(succeeds(shell("resize in.exr box.exr --scale 0.5 --kernel box")));
    AnyImage taps = read_image(shell / "taps.exr"), box = read_image(shell / "box.exr");
    EXPECT_TRUE(equal(pixels(taps), pixels(box)));
    const std::set<std::string> before = shell.files();
    EXPECT_TRUE(fails(2, shell("resize in.exr no.exr --scale 1/3 --kernel box.json"), "box.json"));
    EXPECT_TRUE(fails(2, shell("resize in.exr no.exr --scale 1 --kernel box.json"), "box.json"));
    EXPECT_TRUE(fails(1, shell("resize in.exr no.exr --scale 0.5 --kernel none.json"), "none.json"));
    EXPECT_EQ(shell.files(), before);
    write_bytes(shell / "cut.json", bytes_of(shell / "box.json").substr(0, 30));
    EXPECT_TRUE(fails(1, shell("resize in.exr no.exr --scale 0.5 --kernel cut.json"), "cut.json"));
    // A derivative has nothing to renormalise to: what lies outside is reflected, unless the user insists.
    write_taps(shell / "slope.json", {.kind = "derivative", .factor = 1, .taps = Taps{-1, {-0.5, 0, 0.5}, 1}});
    EXPECT_TRUE(succeeds(shell("resize in.exr slope.exr --scale 1 --kernel slope.json")));
    EXPECT_TRUE(fails(2, shell("resize in.exr no.exr --scale 1 --kernel slope.json --edge renormalize"), "reflect"));
}

TEST(Resize, TheReportNamesWhatWasDone) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 40, 30, 3);
    save(shell / "in.png", image);
    const Outcome run = shell("resize in.png out.png --size 20x60 --threads 2 --json");
    ASSERT_TRUE(succeeds(run));
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["input"]["width"], 40);
    EXPECT_EQ(report["input"]["height"], 30);
    EXPECT_EQ(report["output"]["width"], 20);
    EXPECT_EQ(report["output"]["height"], 60);
    EXPECT_EQ(report["kernel"]["x"], "shrink3");  // shrinks
    EXPECT_EQ(report["kernel"]["y"], "grow3");    // grows
    EXPECT_EQ(report["threads"], 2);
    for (const char* key : {"read", "filter", "write"}) {
        ASSERT_TRUE(report["seconds"][key].is_number()) << key;
        EXPECT_GE(report["seconds"][key].get<double>(), 0);
        EXPECT_LT(report["seconds"][key].get<double>(), run.seconds);
    }
    const Outcome silent = shell("resize in.png out.png --size 20x60");
    EXPECT_TRUE(succeeds(silent) && silent.out.empty()) << silent;
}

TEST(Resize, NotANumberIsWrittenAsZeroAndSaidOnce) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = image_of<float>(24, 24, 3, [](int x, int y, int) {
        return x == 10 && y == 12 ? not_a_number : x == 3 ? std::numeric_limits<float>::infinity() : 0.5f;
    });
    save(shell / "in.exr", image);
    const Outcome run = shell("resize in.exr out.png --scale 1 --depth u8");
    EXPECT_EQ(run.code, 0);
    ASSERT_EQ(stderr_lines(run).size(), 1u) << run;
    EXPECT_TRUE(stderr_lines(run)[0].starts_with("bandlimit: note: ")) << run;
    const Image<std::uint8_t> out = load<std::uint8_t>(shell / "out.png");
    EXPECT_EQ(int(out.view()(10, 12, 1)), 0);
    EXPECT_EQ(int(out.view()(3, 5, 0)), 0);
    EXPECT_EQ(int(out.view()(11, 12, 0)), 188);
    EXPECT_TRUE(succeeds(shell("resize in.exr out.png --scale 1 --quiet")));
    EXPECT_TRUE(succeeds(shell("resize in.exr out.exr --scale 1")));  // a float file loses nothing
}

TEST(Resize, NotANumberStaysWithinTheFootprint) {
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr int at_x = 21, at_y = 17;
    AnyImage image =
        image_of<float>(48, 40, 3, [](int x, int y, int) { return x == at_x && y == at_y ? not_a_number : 0.25f; });
    save(shell / "in.exr", image);
    for (const auto& [kernel, radius] : {std::pair{"lanczos3", 3.0}, {"box", 0.5}, {"jinc2", 2.2331}}) {
        ASSERT_TRUE(succeeds(shell(std::string("resize in.exr out.exr --scale 0.5 --depth f32 --kernel ") + kernel)));
        const Image<float> out = load<float>(shell / "out.exr");
        int lost = 0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x) {
                // In target pixels, where the radius holds; a box reaches as far as the cell that it overlaps.
                const double dx = std::abs((at_x + 0.5) / 2 - (x + 0.5)), dy = std::abs((at_y + 0.5) / 2 - (y + 0.5));
                if (std::max(dx, dy) > radius + 0.25)
                    ASSERT_FLOAT_EQ(out.view()(x, y), 0.25f) << kernel << x << ", " << y;
                else lost += std::isnan(out.view()(x, y));
            }
        EXPECT_GE(lost, 1) << kernel;
    }
}

TEST(Resize, EveryEdgeKeepsAConstantButZero) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = image_of<std::uint8_t>(3, 2, 3, [](int, int, int c) { return 50 + 60 * c; });
    save(shell / "in.png", image);  // smaller than the kernel
    for (const std::string edge : {"clamp", "reflect", "wrap", "renormalize", "zero"}) {
        ASSERT_TRUE(succeeds(shell("resize in.png out.png --kernel lanczos3 --size 7x1 --edge " + edge)));
        const Image<std::uint8_t> out = load<std::uint8_t>(shell / "out.png");
        bool is_constant = true;
        for (int x = 0; x < 7; ++x)
            for (int c = 0; c < 3; ++c) is_constant = is_constant && out.view()(x, 0, c) == 50 + 60 * c;
        EXPECT_EQ(is_constant, edge != "zero") << edge;
    }
}

}  // namespace
}  // namespace bandlimit
