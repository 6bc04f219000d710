#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

TEST(Formats, ExtensionsAreKnownInAnyCase) {
    EXPECT_EQ(abilities_of("a/b.c/x.PNG").name, "png");
    EXPECT_EQ(abilities_of("x.Jpeg").name, "jpeg");
    EXPECT_TRUE(abilities_of("x.exr").associated && abilities_of("x.exr").is_linear);
    for (const std::string path : {"x", "x.", "x.gif2", "png", ".png", "x.png/y", ""}) {
        try {
            abilities_of(path);
            ADD_FAILURE() << path;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("png, jpg, tif, exr"), std::string::npos) << e.what();
        }
    }
}

TEST(Formats, NearestDepthHoldsWhatIsWantedIfItCan) {
    const auto nearest = [](const std::string& path, Depth wanted) {
        return nearest_depth(abilities_of(path), wanted);
    };
    for (const Depth depth : all_depths()) {
        EXPECT_EQ(nearest("x.jpg", depth), Depth::u8);
        EXPECT_EQ(nearest("x.hdr", depth), Depth::f32);
        EXPECT_EQ(nearest("x.png", depth), depth == Depth::u8 ? Depth::u8 : Depth::u16);
        EXPECT_EQ(nearest("x.tif", depth), depth == Depth::f16 ? Depth::f32 : depth);
    }
    EXPECT_EQ(nearest("x.exr", Depth::u8), Depth::f16);
    EXPECT_EQ(nearest("x.exr", Depth::u16), Depth::f32);  // a half has 11 bits
}

TEST(Formats, SpacesByName) {
    for (const Space space : {Space::automatic, Space::srgb, Space::linear, Space::data})
        EXPECT_EQ(parse_space(name_of(space)), space);
    EXPECT_THROW(parse_space("SRGB"), Error);
    ImageInfo info;
    info.alpha = 3, info.associated = true, info.transfer = Transfer::srgb;
    EXPECT_EQ(info.encoding(Space::automatic).transfer, Transfer::srgb);
    EXPECT_EQ(info.encoding(Space::linear).transfer, Transfer::linear);
    EXPECT_EQ(info.encoding(Space::linear).alpha, 3);
    EXPECT_TRUE(info.encoding(Space::srgb).associated);
    EXPECT_EQ(info.encoding(Space::data).alpha, -1);
    EXPECT_EQ(info.encoding(Space::data).transfer, Transfer::linear);
}

TEST(Formats, WhatAFormatCannotHoldIsRefused) {
    const Folder folder;
    const auto refuses = [&](const std::string& name, ImageTarget target, const std::string& word) {
        const std::string path = folder / name;
        return fails_for(
            path, [&] { ImageWriter writer(path, target); }, word);
    };
    EXPECT_TRUE(refuses("a.jpg", target_of(Depth::u8, 4, 4, 4), "background"));
    EXPECT_TRUE(refuses("a.webp", target_of(Depth::u8, 4, 4, 4), "background"));
    EXPECT_TRUE(refuses("a.jpg", target_of(Depth::u16, 4, 4, 3), "u8"));
    EXPECT_TRUE(refuses("a.png", target_of(Depth::u8, 4, 4, 5), "5 channels"));
    EXPECT_TRUE(refuses("a.hdr", target_of(Depth::f32, 4, 4, 1), "1 channels"));
    EXPECT_TRUE(refuses("a.jpg", target_of(Depth::u8, 65501, 1, 3), "65500"));
    EXPECT_TRUE(refuses("a.webp", target_of(Depth::u8, 16384, 1, 3), "16383"));
    ImageTarget pair = target_of(Depth::u8, 4, 4, 2);
    pair.alpha = -1, pair.channel_names = {"U", "V"};
    EXPECT_TRUE(refuses("a.png", pair, "alpha"));
    pair.is_data = true;
    EXPECT_NO_THROW(ImageWriter(folder / "a.png", pair));
    EXPECT_EQ(folder.count(), 0);

    const auto is_error = [&](ImageTarget target) { EXPECT_THROW(ImageWriter(folder / "a.png", target), Error); };
    is_error(target_of(Depth::u8, 0, 4, 3));
    is_error(target_of(Depth::u8, 4, 4, 0));
    ImageTarget target = target_of(Depth::u8, 4, 4, 3);
    target.alpha = 3;
    is_error(target);
    EXPECT_THROW(ImageWriter(folder / "a.gif2", target_of(Depth::u8, 4, 4, 3)), Error);
}

TEST(Formats, TheColourSpaceIsNotedAndUnderstood) {
    const Folder folder;
    AnyImage image = noise(Depth::u16, 8, 8, 3);
    ImageTarget target = target_of(Depth::u16, 8, 8, 3);
    for (const Transfer transfer : {Transfer::srgb, Transfer::linear}) {
        target.transfer = transfer;
        write_image(folder / "a.png", target, pixels(image));
        const ImageReader reader(folder / "a.png", 1);
        EXPECT_EQ(reader.info().transfer, transfer);
        EXPECT_EQ(reader.info().color_hint, transfer == Transfer::srgb ? "sRGB" : "linear");
        EXPECT_TRUE(abilities_of("a.png").notes_space);
    }
    target.is_data = true;
    write_image(folder / "a.png", target, pixels(image));
    const std::string bytes = bytes_of(folder / "a.png");
    EXPECT_EQ(bytes.find("sRGB"), std::string::npos);
    EXPECT_EQ(bytes.find("gAMA"), std::string::npos);

    AnyImage floats = noise(Depth::f32, 8, 8, 3);
    target = target_of(Depth::f32, 8, 8, 3);
    write_image(folder / "a.tif", target, pixels(floats));
    EXPECT_EQ(ImageReader(folder / "a.tif", 1).info().transfer, Transfer::srgb) << "as its metadata say";
    target.transfer = Transfer::linear;
    write_image(folder / "a.tif", target, pixels(floats));
    EXPECT_EQ(ImageReader(folder / "a.tif", 1).info().transfer, Transfer::linear);
    target.transfer = Transfer::srgb;
    ImageWriter exr(folder / "a.exr", target);
    EXPECT_EQ(exr.encoding().transfer, Transfer::linear) << "EXR holds linear light, whatever is asked";
}

/// A header that claims RGB or grey, and one tag, the description: as much as libpng insists on.
std::vector<std::uint8_t> profile(const std::string& space, std::string description) {
    description.resize(32);
    constexpr int header = 128, table = 4 + 12, size = 32;
    std::string text(header, '\0');
    text[3] = static_cast<char>(header + table + size);
    text.replace(8, 1, "\x02").replace(12, 8, "mntr" + space).replace(20, 4, "XYZ ").replace(36, 4, "acsp");
    text.replace(68, 12, std::string("\0\0\xf6\xd6\0\1\0\0\0\0\xd3\x2d", 12));  // D50
    text += std::string("\0\0\0\1", 4) + "desc" + std::string("\0\0\0\x90\0\0\0\x20", 8) + description;
    return {text.begin(), text.end()};
}

ImageTarget with_profile(const Folder& folder, const std::vector<std::uint8_t>& icc,
                         std::optional<ImageReader>& reader) {
    OIIO::ImageSpec spec(8, 8, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(icc.size())), icc.data());
    spec.attribute("Copyright", "somebody");
    const std::vector<std::uint8_t> codes(8 * 8 * 3, 77);
    const auto out = OIIO::ImageOutput::create("tiff");
    EXPECT_TRUE(out->open(folder / "in.tif", spec) && out->write_image(OIIO::TypeDesc::UINT8, codes.data()) &&
                out->close());
    reader.emplace(folder / "in.tif", 1);
    ImageTarget target = target_of(Depth::u8, 8, 8, 3);
    target.metadata = &reader->metadata();
    return target;
}

std::vector<std::uint8_t> profile_of(const std::string& path) {
    const auto in = OIIO::ImageInput::open(path);
    const OIIO::ParamValue* icc = in ? in->spec().find_attribute("ICCProfile") : nullptr;
    if (icc == nullptr) return {};
    const auto* bytes = static_cast<const std::uint8_t*>(icc->data());
    return {bytes, bytes + icc->datasize()};
}

TEST(Formats, ProfilesAndMetadataAreTakenOver) {
    const Folder folder;
    const auto icc = profile("RGB ", "Adobe RGB (1998)");
    std::optional<ImageReader> reader;
    ImageTarget target = with_profile(folder, icc, reader);
    EXPECT_TRUE(reader->info().has_foreign_profile);
    EXPECT_EQ(reader->info().transfer, Transfer::srgb);
    AnyImage image = noise(Depth::u8, 8, 8, 3);
    for (const std::string name : {"a.tif", "a.jpg", "a.png"}) {
        write_image(folder / name, target, pixels(image));
        EXPECT_EQ(profile_of(folder / name), icc) << name;
        EXPECT_TRUE(ImageReader(folder / name, 1).info().has_foreign_profile) << name;
    }
    EXPECT_EQ(OIIO::ImageInput::open(folder / "a.tif")->spec().get_string_attribute("Copyright"), "somebody");

    // Where codes become something else, the profile would be wrong.
    const auto is_dropped = [&](const ImageTarget& changed, const std::string& name, AnyImage& pixels_of_it) {
        write_image(folder / name, changed, pixels(pixels_of_it));
        EXPECT_TRUE(profile_of(folder / name).empty()) << name;
    };
    ImageTarget linear = target, data = target, grey = target;
    linear.transfer = Transfer::linear;
    is_dropped(linear, "b.tif", image);
    data.is_data = true;
    is_dropped(data, "c.tif", image);
    AnyImage one = noise(Depth::u8, 8, 8, 1);
    grey.channel_names = {"Y"};
    is_dropped(grey, "d.tif", one);
}

TEST(Formats, AnSrgbProfileIsNotForeign) {
    const Folder folder;
    std::optional<ImageReader> reader;
    with_profile(folder, profile("RGB ", "sRGB IEC61966-2.1"), reader);
    EXPECT_FALSE(reader->info().has_foreign_profile);
    with_profile(folder, profile("RGB ", std::string("\0s\0R\0G\0B\0", 9)), reader);
    EXPECT_FALSE(reader->info().has_foreign_profile);
}

TEST(Formats, ExrChannelNamesAreKept) {
    const Folder folder;
    ImageTarget target = target_of(Depth::f16, 6, 5, 4);
    target.channel_names = {"R", "diffuse.B", "diffuse.G", "velocity.x"};
    target.alpha = -1;
    AnyImage image = noise(Depth::f16, 6, 5, 4);
    write_image(folder / "a.exr", target, pixels(image));
    ImageReader reader(folder / "a.exr", 1);
    const auto& names = reader.info().channel_names;
    ASSERT_EQ(names.size(), 4u);
    AnyImage again = read_image(reader);
    // The file sorts its channels: each must be found under its name, with its own samples.
    for (int c = 0; c < 4; ++c) {
        const auto found = std::find(names.begin(), names.end(), target.channel_names[static_cast<std::size_t>(c)]);
        ASSERT_NE(found, names.end()) << c;
        const auto at = static_cast<int>(found - names.begin());
        const auto a = channels_of(std::get<View<Half>>(view_of(image)), c);
        const auto b = channels_of(std::get<View<Half>>(view_of(again)), at);
        EXPECT_TRUE(equal(const_view(AnyView(a)), const_view(AnyView(b))));
    }
}

TEST(Formats, TheSamePixelsMakeTheSameBytes) {
    const Folder folder;
    for (const std::string extension : {"png", "jpg", "tif", "exr", "hdr", "ppm", "webp", "tga", "bmp"}) {
        const Depth depth = abilities_of("x." + extension).depths.front();
        AnyImage image = noise(depth, 30, 20, 3);
        const std::string a = folder / ("a." + extension), b = folder / ("b." + extension);
        write_image(a, target_of(depth, 30, 20, 3), pixels(image));
        ::usleep(extension == "tif" || extension == "exr" ? 1100000 : 0);  // clocks in files tick in seconds
        write_image(b, target_of(depth, 30, 20, 3), pixels(image));
        EXPECT_TRUE(bytes_of(a) == bytes_of(b)) << extension;
    }
}

}  // namespace
}  // namespace bandlimit
