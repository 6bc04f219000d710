// bandlimit mips, from outside: one texture at a time.
#include <cmath>

#include "apps/run_program_test.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/texture/container.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {
namespace {

using nlohmann::json;

Texture texture_in(const std::string& path) {
    const std::string bytes = bytes_of(path);
    return read_container(std::as_bytes(std::span(bytes)), path);
}

/// The samples of an image of a texture, without those channels that a picture of fewer lacks.
AnyConstView first_channels(const AnyImage& image, int channels) {
    return std::visit(
        [&](const auto& i) -> AnyConstView {
            auto view = i.view();
            view.channels = channels;
            return view;
        },
        image);
}
AnyConstView samples(const AnyImage& image) {
    return std::visit([](const auto& i) { return AnyConstView(i.view()); }, image);
}

/// Writes a picture all of whose pixels are `color`.
void save_constant(const std::string& path, int width, int height, const std::vector<int>& color) {
    AnyImage image = image_of<std::uint8_t>(width, height, static_cast<int>(color.size()),
                                            [&](int, int, int c) { return color[static_cast<std::size_t>(c)]; });
    save(path, image);
}

TEST(Mips, TheLevelsAreThoseOfTheLibraryInEveryKindOfFile) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 21, 13, 3);
    save(shell / "in.png", image);
    const std::string options = " --role color --filter mitchell --edge wrap,clamp --json";
    const Outcome images = shell("mips in.png level_%d.png" + options);
    ASSERT_TRUE(succeeds(images));
    ASSERT_TRUE(succeeds(shell("mips in.png out.ktx2" + options)));
    ASSERT_TRUE(succeeds(shell("mips out.ktx2 copy.dds --keep-levels")));
    ASSERT_TRUE(succeeds(shell("mips copy.dds kept_%d.png --keep-levels --quiet")));
    ASSERT_TRUE(succeeds(shell("mips copy.dds again.ktx2" + options)));
    const TexelFormat format{.channels = 4, .depth = Depth::u8, .srgb = true};
    const MipChain chain = make_mips(pixels(image), {.transfer = Transfer::srgb}, format,
                                     {.filter = mitchell(), .edge_x = Edge::wrap, .edge_y = Edge::clamp});
    const Texture ktx2 = texture_in(shell / "out.ktx2"), dds = texture_in(shell / "copy.dds"),
                  again = texture_in(shell / "again.ktx2");
    EXPECT_EQ(ktx2.format, format);
    ASSERT_EQ(chain.images.size(), 5u);
    ASSERT_EQ(ktx2.levels.size(), 5u);
    const json report = images.json();
    for (int level = 0; level < 5; ++level) {
        SCOPED_TRACE(level);
        const AnyImage& expected = chain.images[static_cast<std::size_t>(level)];
        AnyImage png = read_image(shell / ("level_" + std::to_string(level) + ".png"));
        EXPECT_TRUE(equal(pixels(png), first_channels(expected, 3)));
        for (const Texture* texture : {&ktx2, &dds, &again})
            EXPECT_TRUE(equal(samples(texture->image(level)), samples(expected)));
        AnyImage kept = read_image(shell / ("kept_" + std::to_string(level) + ".png"));
        EXPECT_TRUE(equal(pixels(kept), samples(expected)));
        EXPECT_EQ(report["levels"][static_cast<std::size_t>(level)]["width"], mip_length(21, level));
        EXPECT_EQ(report["levels"][static_cast<std::size_t>(level)]["file"], "level_" + std::to_string(level) + ".png");
    }
    EXPECT_EQ(report["filter"]["x"], "mitchell");
    EXPECT_EQ(report["edge"], json({{"x", "wrap"}, {"y", "clamp"}}));
    EXPECT_EQ(report["output"]["channels"], 3);
    EXPECT_EQ(report["role_from"], "option");
}

TEST(Mips, BandsOfRowsAndThreadsDoNotChangeATexel) {
    // Several bands of every one of the larger levels, for any number of threads; bands of a PNG are read in order,
    // those of tiles anywhere. Under Edge::wrap all rows are in memory.
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr int width = 19, height = 3001;
    AnyImage image = noise(Depth::u8, width, height, 4);
    save(shell / "in.png", image);
    ImageTarget target = target_of(Depth::u8, width, height, 4);
    target.tile = 48;
    write_image(shell / "in.tif", target, pixels(image));
    const TexelFormat format{.channels = 4, .depth = Depth::u8, .srgb = true};
    for (const std::string edge : {"renormalize", "wrap"}) {
        const Edge by_y = parse_edge(edge);
        const MipChain chain =
            make_mips(pixels(image), {Transfer::srgb, 3}, format, {.edge_x = Edge::clamp, .edge_y = by_y});
        for (const std::string files :
             {"in.png out.ktx2 --threads 1", "in.png out.dds --threads 3", "in.tif out.ktx2 --threads 2"}) {
            ASSERT_TRUE(succeeds(shell("mips --quiet --role color --edge clamp," + edge + " " + files)));
            const Texture made = texture_in(shell / files.substr(7, files.find(' ', 7) - 7));
            ASSERT_EQ(made.levels.size(), chain.images.size());
            for (int level = 0; level < static_cast<int>(chain.images.size()); ++level)
                EXPECT_TRUE(equal(samples(made.image(level)), samples(chain.images[static_cast<std::size_t>(level)])))
                    << files << ", edge " << edge << ", level " << level;
        }
    }
}

TEST(Mips, SayWhichValuesWereLost) {
    // Both ways: by rows, and whole levels.
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image =
        image_of<float>(9, 700, 1, [](int x, int y, int) { return x == 4 && y == 650 ? std::nanf("") : 0.5f; });
    save(shell / "in.exr", image);
    for (const std::string from : {"previous", "base"}) {
        const std::string line = "mips in.exr out.ktx2 --role data --from " + from;
        EXPECT_NE(shell(line + " --depth u8").err.find("in.exr holds NaN"), std::string::npos) << from;
        EXPECT_EQ(shell(line).err.find("NaN"), std::string::npos) << from;  // halves or floats hold it
    }
}

TEST(Mips, TexelsAreWhatPictureAndRoleNeed) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage grey = noise(Depth::u8, 8, 8, 1), grey_alpha = noise(Depth::u8, 8, 8, 2), rgb = noise(Depth::u8, 8, 8, 3),
             rgb16 = noise(Depth::u16, 8, 8, 3), half = noise(Depth::f16, 8, 8, 3), floats = noise(Depth::f32, 8, 8, 1);
    save(shell / "grey.png", grey);
    save(shell / "grey-alpha.png", grey_alpha);
    save(shell / "rgb.png", rgb);
    save(shell / "rgb16.png", rgb16);
    save(shell / "half.exr", half);
    save(shell / "float.exr", floats);
    struct Case {
        std::string line, format;
    };
    for (const auto& [line, format] : {
             Case{"grey.png OUT --role height", "R8_UNORM"},
             {"grey.png OUT --role color", "R8G8B8A8_SRGB"},
             {"grey.png OUT --role color-linear", "R8_UNORM"},
             {"grey-alpha.png OUT --role color", "R8G8B8A8_SRGB"},
             {"grey-alpha.png OUT --role data", "R8G8_UNORM"},
             {"rgb.png OUT --role mask", "R8G8B8A8_UNORM"},
             {"rgb.png OUT --role mask --channels 1", "R8_UNORM"},
             {"rgb.png OUT --role normal --two-channel", "R8G8_UNORM"},
             {"rgb.png OUT --role color --depth f16", "R16G16B16A16_SFLOAT"},
             {"rgb16.png OUT --role color", "R16G16B16A16_UNORM"},
             {"rgb16.png OUT --role color --depth u8 --premultiplied", "R8G8B8A8_SRGB"},
             {"half.exr OUT --role color", "R16G16B16A16_SFLOAT"},
             {"float.exr OUT --role height", "R32_SFLOAT"},
         }) {
        std::string arguments = line;
        arguments.replace(arguments.find("OUT"), 3, "out.ktx2");
        const Outcome run = shell("mips " + arguments + " --json");
        ASSERT_TRUE(succeeds(run)) << line;
        EXPECT_EQ(run.json()["output"]["format"], "VK_FORMAT_" + format) << line;
    }
    // 16-bit texels have no curve: the codes of the picture are decoded.
    ASSERT_TRUE(succeeds(shell("mips rgb16.png out.dds --role color --levels 1")));
    const Texture texture = texture_in(shell / "out.dds");
    EXPECT_EQ(texture.levels.size(), 1u);
    const auto from = std::get<Image<std::uint16_t>>(rgb16).view();
    const auto to = std::get<Image<std::uint16_t>>(texture.image(0)).view();
    EXPECT_EQ(to(3, 5, 1), to_code<std::uint16_t>(srgb_to_linear(from(3, 5, 1) / 65535.0)));
    // Images of 16 bits have one, and keep the picture.
    ASSERT_TRUE(succeeds(shell("mips rgb16.png out_%d.png --role color")));
    AnyImage level = read_image(shell / "out_0.png");
    EXPECT_TRUE(equal(pixels(level), pixels(rgb16)));
    ASSERT_TRUE(succeeds(shell("mips grey-alpha.png ga_%d.png --role color")));
    EXPECT_EQ(ImageReader(shell / "ga_1.png", 1).info().channels(), 2);
}

TEST(Mips, CubesAndArraysKeepTheirPicturesApart) {
    const Shell shell(BANDLIMIT_PROGRAM);
    std::string faces;
    for (int face = 0; face < 6; ++face) {
        save_constant(shell / ("face" + std::to_string(face) + ".png"), 8, 8, {40 * face, 10, 200});
        faces += " face" + std::to_string(face) + ".png";
    }
    const Outcome array = shell("mips" + faces + " array.ktx2 --array --role data --json");
    ASSERT_TRUE(succeeds(array));
    EXPECT_EQ(array.json()["output"]["layers"], 6);
    const Texture layers = texture_in(shell / "array.ktx2");
    ASSERT_EQ(layers.layers, 6);
    for (int level = 0; level < 4; ++level)
        for (int layer = 0; layer < 6; ++layer)
            EXPECT_EQ(std::get<Image<std::uint8_t>>(layers.image(level, layer)).view()(0, 0), 40 * layer);

    const Outcome cube = shell("mips" + faces + " cube.dds --cube --role data --json");
    ASSERT_TRUE(succeeds(cube));
    EXPECT_EQ(cube.json()["output"]["faces"], 6);
    ASSERT_TRUE(succeeds(shell("mips cube.dds again.ktx2 --role data")));
    const Texture again = texture_in(shell / "again.ktx2");
    ASSERT_TRUE(again.is_cube);
    for (int face = 0; face < 6; ++face)
        EXPECT_EQ(std::get<Image<std::uint8_t>>(again.image(0, 0, face)).view()(3, 3), 40 * face);
    // The last level is one texel a face; what is on the other side of the cube does not reach it whole.
    EXPECT_LT(std::get<Image<std::uint8_t>>(again.image(3, 0, 0)).view()(0, 0), 100);
    EXPECT_TRUE(fails(1, shell("mips cube.dds face_%d.png --role data"), "cube.dds"));
    save_constant(shell / "wide.png", 9, 8, {0, 0, 0});
    EXPECT_TRUE(fails(1, shell("mips face0.png wide.png out.ktx2 --array --role data"), "wide.png"));
}

TEST(Mips, RolesAreGuessedFromNamesAndSaidAloud) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_constant(shell / "wall_n.png", 8, 8, {128, 128, 255});
    save_constant(shell / "wall.png", 8, 8, {128, 128, 255});
    const Outcome guess = shell("mips wall_n.png out.ktx2 --json");
    ASSERT_EQ(guess.code, 0) << guess;
    EXPECT_EQ(guess.json()["role"], "normal");
    EXPECT_EQ(guess.json()["role_from"], "name");
    ASSERT_EQ(stderr_lines(guess).size(), 1u);
    EXPECT_NE(guess.err.find("role normal"), std::string::npos) << guess;
    const Outcome quiet = shell("mips wall.png srgb.ktx2 --json --quiet");
    ASSERT_TRUE(succeeds(quiet));
    EXPECT_EQ(quiet.json()["role"], "color");
    EXPECT_EQ(quiet.json()["role_from"], "default");
    // Texels without a curve are not taken for codes with one.
    ASSERT_TRUE(succeeds(shell("mips wall.png plain.ktx2 --role data")));
    EXPECT_EQ(shell("mips plain.ktx2 out.ktx2 --json --quiet").json()["role"], "color-linear");
    EXPECT_EQ(shell("mips srgb.ktx2 out.ktx2 --json --quiet").json()["role"], "color");
}

TEST(Mips, CoverageAndRoughnessNeedTheirOptions) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage leaves = image_of<std::uint8_t>(64, 64, 4, [](int x, int y, int c) {
        return c < 3 ? 90 : std::hypot(x % 16 - 7.5, y % 16 - 7.5) < 5 ? 255 : (x * 37 + y * 91) % 100;
    });
    save(shell / "leaves.png", leaves);
    const Outcome tested = shell("mips leaves.png out.ktx2 --role alpha-tested --alpha-threshold 0.6 --json");
    ASSERT_TRUE(succeeds(tested));
    const json levels = tested.json()["levels"];
    const double share = levels[0]["coverage"];
    EXPECT_GT(share, 0.2);
    for (std::size_t level = 1; level < 4; ++level) {  // then the leaves are smaller than a texel, and all alike
        const double texels = levels[level]["width"].get<double>() * levels[level]["height"].get<double>();
        EXPECT_NEAR(levels[level]["coverage"], share, std::max(0.005, 0.5 / texels)) << level;
    }

    AnyImage bumps = image_of<std::uint8_t>(32, 32, 3, [](int x, int y, int c) {
        return c == 2 ? 220 : c == 0 ? (x % 2 != 0 ? 60 : 195) : (y % 2 != 0 ? 60 : 195);
    });
    save(shell / "bumps.png", bumps);
    save_constant(shell / "rough.png", 32, 32, {50});
    const auto roughness_at_level_1 = [&](const std::string& options) {
        EXPECT_TRUE(succeeds(shell("mips rough.png rough_%d.png --role roughness " + options)));
        return int(load<std::uint8_t>(shell / "rough_1.png").view()(5, 5));
    };
    EXPECT_EQ(roughness_at_level_1(""), 50);
    EXPECT_GT(roughness_at_level_1("--normal bumps.png"), 60);
}

// A start of the program takes a while: one mistake of each kind.
TEST(Mips, WhatTheCommandLineAloneShowsToBeWrongIsExitCode2) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::string mips = "mips in.png out.ktx2 ";
    struct Case {
        std::string line, word;
    };
    for (const auto& [line, word] : {
             Case{"mips", "FILES"},
             {"mips in.png", "IN and OUT"},
             {"mips in.png out.png", "%d"},
             {"mips in.png out_%d_%d.png", "twice"},
             {"mips in.png out_%d.png --channels 1", "--channels"},
             {"mips a.png b.png out.ktx2", "an array or a cube"},
             {"mips a.png b.png out.ktx2 --cube", "six faces"},
             {"mips a b c d e f out.dds --cube --edge wrap", "--edge"},
             {"mips a b c d e f out.dds --cube --role roughness --normal n.png", "--normal"},
             {mips + "--role colour", "color, color-linear, normal"},
             {mips + "--role color --normal n.png", "the role roughness"},
             {mips + "--role mask --two-channel", "the role normal"},
             {mips + "--role color --space data", "--space: "},
             {mips + "--alpha-threshold nan", "--alpha-threshold"},
             {mips + "--role color --alpha-threshold 0.5", "the role alpha-tested"},
             {mips + "--filter none", "nearest, box, tent"},
             {mips + "--filter downsample8 --from base", "--from: base"},
             {mips + "--edge wrap,mirror", "clamp, reflect, wrap"},
             {mips + "--channels 3", "1, 2 or 4"},
             {mips + "--keep-levels --filter box", "--keep-levels"},
             {mips + "--rules rules.json", "--batch"},
             {"mips --batch in", "OUTDIR"},
             {"mips --batch in out --format png", "ktx2 or dds"},
             {"mips --batch in out --cube", "--cube"},
             {"mips --batch in out --memory 4X", "4X"},
         })
        EXPECT_TRUE(fails(2, shell(line), word)) << "bandlimit " << line;
    EXPECT_TRUE(shell.files().empty());
}

TEST(Mips, WhatFilesShowToBeWrongIsExitCode1AndNothingIsWritten) {
    const Shell shell(BANDLIMIT_PROGRAM);
    save_constant(shell / "in.png", 9, 6, {1, 2, 3, 4});
    save_constant(shell / "grey.png", 9, 6, {1});
    write_bytes(shell / "text.png", "no picture");
    write_bytes(shell / "text.dds", "DDS no texture");
    TapsFile taps;
    taps.factor = 3;
    taps.taps = Taps{-1, {0.2, 0.2, 0.2, 0.2, 0.2}, 3};
    write_taps(shell / "third.json", taps);
    taps.factor = 2;
    taps.taps = Taps{0, {0.5, 0.5}, 2};
    write_taps(shell / "half.json", taps);
    const std::set<std::string> before = shell.files();
    struct Case {
        std::string line, word;
    };
    for (const auto& [line, word] : {
             Case{"mips none.png out.ktx2 --role color", "none.png"},
             {"mips text.png out.ktx2 --role color", "text.png"},
             {"mips text.dds out.ktx2 --role color", "text.dds"},
             {"mips in.png none/out.ktx2 --role color", "none"},
             {"mips in.png out_%d.jpg --role color", "alpha channel"},
             {"mips grey.png out.ktx2 --role normal", "one channel"},
             {"mips in.png out.ktx2 --role color --levels 5", "has 4 levels"},
             {"mips in.png out.ktx2 --role color --channels 1", "they need 4"},
             {"mips in.png out.ktx2 --keep-levels", "no levels"},
             {"mips grey.png grey.png grey.png grey.png grey.png grey.png out.ktx2 --cube --role data", "square"},
             {"mips in.png out.ktx2 --role color --filter half.json", "halve"},
             {"mips in.png out.ktx2 --role roughness --normal none.png", "none.png"},
         })
        EXPECT_TRUE(fails(1, shell(line), word)) << "bandlimit " << line;
    EXPECT_TRUE(fails(2, shell("mips in.png out.ktx2 --role color --filter third.json"), "factor"));
    // No level appears if one of them cannot be written.
    AnyImage large = noise(Depth::u8, 256, 256, 3);
    save(shell / "in.png", large);
    EXPECT_TRUE(fails(1, shell("mips in.png out_%d.png --role color", {.limits = {{RLIMIT_FSIZE, 60000}}}), "out_"));
    EXPECT_TRUE(fails(1, shell("mips in.png out.dds --role color", {.limits = {{RLIMIT_FSIZE, 60000}}}), "out.dds"));
    EXPECT_EQ(shell.files(), before);
}

}  // namespace
}  // namespace bandlimit
