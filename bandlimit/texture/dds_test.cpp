// DDS files byte by byte against Microsoft's description, and those that others write.
#include <array>
#include <string_view>

#include "bandlimit/texture/textures_test.h"

namespace bandlimit {
namespace {

using Words = std::vector<std::uint32_t>;
using Masks = std::array<std::uint32_t, 4>;

constexpr std::uint32_t dds = 0x20534444, dx10 = 0x30315844;  // "DDS ", "DX10"
constexpr std::size_t at_pixel_format = 76, at_dxgi = 128;

FileContent dds_file(const TexelFormat& format, const Shape& shape) {
    return written(noise_texture(format, shape), Container::dds);
}

TEST(Dds, HeaderSaysWhatTheDescriptionAsks) {
    const FileContent file = dds_file({4, Depth::u8, true}, {5, 3, 2});
    // Size; caps, height, width, pitch, pixel format, mip count; height, width, pitch, depth, levels; 11 reserved.
    EXPECT_EQ(words(file, 0, 8), (Words{dds, 124, 0x2100f, 3, 5, 20, 0, 2}));
    EXPECT_EQ(words(file, 32, 11), Words(11, 0));
    EXPECT_EQ(words(file, at_pixel_format, 8), (Words{32, 4, dx10, 0, 0, 0, 0, 0}));
    // Caps: texture, complex, mipmap.
    EXPECT_EQ(words(file, 108, 5), (Words{0x401008, 0, 0, 0, 0}));
    // Format, two dimensions, no cube, one layer, straight alpha.
    EXPECT_EQ(words(file, at_dxgi, 5), (Words{29, 3, 0, 1, 1}));
    EXPECT_EQ(file.size(), 148u + 60 + 8);

    const FileContent cubes = dds_file({4, Depth::f16, false, true}, {4, 4, 1, true, 3});
    EXPECT_EQ(words(cubes, 0, 8), (Words{dds, 124, 0x2100f, 4, 4, 32, 0, 1}));
    EXPECT_EQ(words(cubes, 108, 5), (Words{0x1008, 0xfe00, 0, 0, 0}));
    EXPECT_EQ(words(cubes, at_dxgi, 5), (Words{10, 3, 4, 3, 2}));
    EXPECT_EQ(cubes.size(), 148u + 128 * 18);
}

TEST(Dds, OlderHeadersSayAllThatTheyCan) {
    const FileContent color = dds_file({4, Depth::u8}, {5, 3, 2});
    EXPECT_EQ(words(color, at_pixel_format, 8), (Words{32, 0x41, 0, 32, 0xff, 0xff00, 0xff0000, 0xff000000}));
    EXPECT_EQ(color.size(), 128u + 60 + 8);
    EXPECT_EQ(container_info(color, "t").format, "DXGI_FORMAT_R8G8B8A8_UNORM");
    const FileContent grey = dds_file({1, Depth::u8}, {4, 4, 1, true});
    EXPECT_EQ(words(grey, 0, 8), (Words{dds, 124, 0x2100f, 4, 4, 4, 0, 1}));
    EXPECT_EQ(words(grey, at_pixel_format, 8), (Words{32, 0x20000, 0, 8, 0xff, 0, 0, 0}));
    EXPECT_EQ(words(grey, 108, 5), (Words{0x1008, 0xfe00, 0, 0, 0}));
    EXPECT_EQ(container_info(grey, "t").format, "DXGI_FORMAT_R8_UNORM");
    // What they cannot say needs the newer one: arrays and premultiplied alpha.
    EXPECT_EQ(words(dds_file({4, Depth::u8}, {4, 4, 1, false, 2}), at_dxgi, 5), (Words{28, 3, 0, 2, 1}));
    EXPECT_EQ(words(dds_file({4, Depth::u8, false, true}, {}), at_dxgi, 5), (Words{28, 3, 0, 1, 2}));
}

TEST(Dds, EveryFormatHasItsNumber) {
    struct Case {
        int channels;
        Depth depth;
        bool srgb;
        std::uint32_t number, alpha;
        std::string_view name;
    };
    for (const Case& c : {Case{2, Depth::u8, false, 49, 0, "DXGI_FORMAT_R8G8_UNORM"},
                          {4, Depth::u8, true, 29, 1, "DXGI_FORMAT_R8G8B8A8_UNORM_SRGB"},
                          {1, Depth::u16, false, 56, 0, "DXGI_FORMAT_R16_UNORM"},
                          {2, Depth::u16, false, 35, 0, "DXGI_FORMAT_R16G16_UNORM"},
                          {4, Depth::u16, false, 11, 1, "DXGI_FORMAT_R16G16B16A16_UNORM"},
                          {1, Depth::f16, false, 54, 0, "DXGI_FORMAT_R16_FLOAT"},
                          {2, Depth::f16, false, 34, 0, "DXGI_FORMAT_R16G16_FLOAT"},
                          {4, Depth::f16, false, 10, 1, "DXGI_FORMAT_R16G16B16A16_FLOAT"},
                          {1, Depth::f32, false, 41, 0, "DXGI_FORMAT_R32_FLOAT"},
                          {2, Depth::f32, false, 16, 0, "DXGI_FORMAT_R32G32_FLOAT"},
                          {4, Depth::f32, false, 2, 1, "DXGI_FORMAT_R32G32B32A32_FLOAT"}}) {
        const FileContent file = dds_file({c.channels, c.depth, c.srgb}, {3, 1});
        EXPECT_EQ(words(file, at_dxgi, 5), (Words{c.number, 3, 0, 1, c.alpha}));
        EXPECT_EQ(word(file, 20),
                  3u * static_cast<std::uint32_t>(c.channels) * static_cast<std::uint32_t>(size_of(c.depth)));
        EXPECT_EQ(container_info(file, "t").format, c.name);
    }
}

TEST(Dds, TexelsLieLayerByLayerFaceByFaceLevelByLevel) {
    const Texture texture = noise_texture({1, Depth::u8}, {4, 4, 2, true, 2});
    const FileContent file = written(texture, Container::dds);
    std::size_t at = 148;
    for (int layer = 0; layer < 2; ++layer)
        for (int face = 0; face < 6; ++face)
            for (int level = 0; level < 2; ++level) {
                const auto view = std::get<Image<std::uint8_t>>(texture.image(level, layer, face)).view();
                for (int y = 0; y < 4 >> level; ++y)
                    for (int x = 0; x < 4 >> level; ++x)
                        EXPECT_EQ(std::to_integer<int>(file.at(at++)), int(view(x, y)));
            }
    EXPECT_EQ(at, file.size());
}

/// A row of 12 samples behind the given pixel format: flags, code, bits, masks.
template <class T>
FileContent row_of(Depth depth, std::uint32_t width, const Words& pixel_format, Image<T>& samples) {
    const Texture texture = noise_texture({1, depth}, {12, 1});
    samples = std::get<Image<T>>(texture.image(0)).clone();
    FileContent file = patched(written(texture, Container::dds), 16, width);
    if (depth != Depth::u8) file.erase(file.begin() + 128, file.begin() + 148);
    for (std::size_t i = 0; i < pixel_format.size(); ++i)
        file = patched(file, at_pixel_format + 4 + 4 * i, pixel_format[i]);
    return file;
}

template <class T>
void expect_row(Depth depth, const Words& pixel_format, int pitch, const std::vector<int>& sources, T opaque,
                std::string_view name) {
    Image<T> samples;
    const FileContent file = row_of<T>(depth, static_cast<std::uint32_t>(12 / pitch), pixel_format, samples);
    const Texture read = read_container(file, "t");
    const auto channels = static_cast<int>(sources.size());
    EXPECT_EQ(read.format, (TexelFormat{channels, depth}));
    EXPECT_EQ(container_info(file, "t").format, name);
    const auto view = std::get<Image<T>>(read.image(0)).view();
    ASSERT_EQ(view.width, 12 / pitch);
    for (int x = 0; x < view.width; ++x)
        for (int c = 0; c < channels; ++c) {
            const int source = sources[static_cast<std::size_t>(c)];
            EXPECT_EQ(view(x, 0, c), source < 0 ? opaque : samples.view()(x * pitch + source, 0)) << name << " " << c;
        }
}

TEST(Dds, MasksOfOthersAreRead) {
    const auto bytes = [](const Words& pixel_format, int pitch, const std::vector<int>& sources,
                          std::string_view name) {
        expect_row<std::uint8_t>(Depth::u8, pixel_format, pitch, sources, 255, name);
    };
    constexpr std::uint32_t rgb = 0x40, rgba = 0x41, grey = 0x20000, grey_alpha = 0x20001, a = 0xff000000, b = 0xff0000,
                            g = 0xff00, r = 0xff;
    bytes({rgba, 0, 32, r, g, b, a}, 4, {0, 1, 2, 3}, "DXGI_FORMAT_R8G8B8A8_UNORM");
    bytes({rgba, 0, 32, b, g, r, a}, 4, {2, 1, 0, 3}, "DXGI_FORMAT_B8G8R8A8_UNORM");
    bytes({rgb, 0, 32, b, g, r, 0}, 4, {2, 1, 0, -1}, "DXGI_FORMAT_B8G8R8X8_UNORM");
    bytes({rgb, 0, 32, b, g, r, a}, 4, {2, 1, 0, -1}, "DXGI_FORMAT_B8G8R8X8_UNORM");  // a mask that no flag announces
    bytes({rgba, 0, 32, a, b, g, r}, 4, {3, 2, 1, 0}, "A8B8G8R8");
    bytes({rgb, 0, 24, b, g, r, 0}, 3, {2, 1, 0, -1}, "B8G8R8");
    bytes({rgb, 0, 24, r, g, b, 0}, 3, {0, 1, 2, -1}, "R8G8B8");
    bytes({grey, 0, 8, r, 0, 0, 0}, 1, {0}, "DXGI_FORMAT_R8_UNORM");
    bytes({rgb, 0, 8, r, 0, 0, 0}, 1, {0}, "DXGI_FORMAT_R8_UNORM");
    bytes({grey_alpha, 0, 16, r, 0, 0, g}, 2, {0, 1}, "DXGI_FORMAT_R8G8_UNORM");
    bytes({grey_alpha, 0, 16, r, r, r, g}, 2, {0, 1}, "DXGI_FORMAT_R8G8_UNORM");
    bytes({rgb, 0, 16, r, g, 0, 0}, 2, {0, 1}, "DXGI_FORMAT_R8G8_UNORM");
    expect_row<std::uint16_t>(Depth::u16, {grey, 0, 16, 0xffff, 0, 0, 0}, 1, {0}, 0, "DXGI_FORMAT_R16_UNORM");
    expect_row<std::uint16_t>(Depth::u16, {rgb, 0, 32, 0xffff, 0xffff0000, 0, 0}, 2, {0, 1}, 0,
                              "DXGI_FORMAT_R16G16_UNORM");
}

TEST(Dds, NumbersOfDirect3D9AreRead) {
    expect_row<std::uint16_t>(Depth::u16, {4, 36, 0, 0, 0, 0, 0}, 4, {0, 1, 2, 3}, 0, "DXGI_FORMAT_R16G16B16A16_UNORM");
    expect_row<Half>(Depth::f16, {4, 111, 0, 0, 0, 0, 0}, 1, {0}, {}, "DXGI_FORMAT_R16_FLOAT");
    expect_row<Half>(Depth::f16, {4, 112, 0, 0, 0, 0, 0}, 2, {0, 1}, {}, "DXGI_FORMAT_R16G16_FLOAT");
    expect_row<Half>(Depth::f16, {4, 113, 0, 0, 0, 0, 0}, 4, {0, 1, 2, 3}, {}, "DXGI_FORMAT_R16G16B16A16_FLOAT");
    expect_row<float>(Depth::f32, {4, 114, 0, 0, 0, 0, 0}, 1, {0}, 0, "DXGI_FORMAT_R32_FLOAT");
    expect_row<float>(Depth::f32, {4, 115, 0, 0, 0, 0, 0}, 2, {0, 1}, 0, "DXGI_FORMAT_R32G32_FLOAT");
    expect_row<float>(Depth::f32, {4, 116, 0, 0, 0, 0, 0}, 4, {0, 1, 2, 3}, 0, "DXGI_FORMAT_R32G32B32A32_FLOAT");
}

TEST(Dds, FormatsOfOthersAreRead) {
    const Texture texture = noise_texture({4, Depth::u8, true}, {5, 3, 2});
    const FileContent file = written(texture, Container::dds);
    const auto source = std::get<Image<std::uint8_t>>(texture.image(1)).view();
    struct Case {
        std::uint32_t number;
        bool srgb, has_alpha;
    };
    for (const Case& c : {Case{87, false, true}, {88, false, false}, {91, true, true}, {93, true, false}}) {
        const Texture read = read_container(patched(file, at_dxgi, c.number), "t");
        EXPECT_EQ(read.format, (TexelFormat{4, Depth::u8, c.srgb}));
        const auto view = std::get<Image<std::uint8_t>>(read.image(1)).view();
        for (int x = 0; x < 2; ++x)
            for (int k = 0; k < 4; ++k)
                EXPECT_EQ(int(view(x, 0, k)), k < 3         ? int(source(x, 0, 2 - k))
                                              : c.has_alpha ? int(source(x, 0, 3))
                                                            : 255);
    }
    // Three floats: twelve bytes a texel.
    FileContent floats = patched(dds_file({1, Depth::f32}, {12, 1}), at_dxgi, 6);
    EXPECT_EQ(read_container(patched(floats, 16, 4), "t").format, (TexelFormat{4, Depth::f32}));
    // No level count is one level; flags of the header tell nothing that the rest does not.
    EXPECT_EQ(container_info(patched(file, 28, 0), "t").levels, 1);
    EXPECT_TRUE(same_texture(read_container(patched(file, 8, 0), "t"), texture));
}

TEST(Dds, WhatIsNotReadIsNamed) {
    const FileContent file = dds_file({4, Depth::u8, true}, {5, 3, 2}), old = dds_file({4, Depth::u8}, {4, 4, 1, true});
    EXPECT_TRUE(is_refused(patched(file, 4, 123), "124"));
    EXPECT_TRUE(is_refused(patched(file, at_pixel_format, 24), "32"));
    EXPECT_TRUE(is_refused(patched(file, 12, 0), "0 rows"));
    EXPECT_TRUE(is_refused(patched(file, 16, 0xffffffff), "columns"));
    EXPECT_TRUE(is_refused(patched(file, 28, 4), "at most 3"));
    EXPECT_TRUE(is_refused(patched(file, 84, 0x35545844), "DXT5"));
    EXPECT_TRUE(is_refused(patched(file, 84, 117), "D3DFMT_CxV8U8"));
    EXPECT_TRUE(is_refused(patched(file, 84, 118), "kind 118,"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi, 31), "DXGI_FORMAT_R8G8B8A8_SNORM,"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi, 98), "DXGI_FORMAT_BC7_UNORM,"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi, 116), "DXGI_FORMAT 116,"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 4, 4), "dimension"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 8, 4), "squares"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 12, 0), "0 layers"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 12, 16385), "layers"));
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 12, 2), "cut short"));
    EXPECT_TRUE(is_refused(patched(file, 112, 0x200000), "volume"));
    EXPECT_TRUE(is_refused(patched(old, 112, 0x7e00), "some of its faces"));
    EXPECT_TRUE(is_refused(patched(old, 80, 0), "masks"));
    EXPECT_TRUE(is_refused(patched(old, 88, 31), "31 bits"));
    EXPECT_TRUE(is_refused(patched(old, 92, 0xf800), "masks f800"));  // five bits
    EXPECT_TRUE(is_refused(patched(old, 92, 0xff0), "masks ff0"));    // not at a byte
    EXPECT_TRUE(is_refused(patched(old, 96, 0xff), "masks ff ff"));   // red twice
    EXPECT_TRUE(is_refused(patched(old, 96, 0), "masks ff 0"));       // no green
    EXPECT_TRUE(is_refused(patched(old, 92, 0), "masks 0"));
    EXPECT_TRUE(is_refused(patched(patched(old, 88, 16), 92, 0xff), "16 bits"));  // blue lies beyond
}

TEST(Dds, SizesWhoseProductOverflowsAreRefused) {
    FileContent file = dds_file({4, Depth::f32}, {4, 4, 1, true, 2});
    for (const std::size_t offset : {12, 16}) file = patched(file, offset, 0x7fffffff);
    EXPECT_TRUE(is_refused(patched(file, at_dxgi + 12, 16384), "2147483647"));
}

}  // namespace
}  // namespace bandlimit
