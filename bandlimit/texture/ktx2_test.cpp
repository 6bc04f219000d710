// KTX2 files byte by byte against the specification, and those that others write.
#include <array>
#include <string_view>

#include "bandlimit/texture/textures_test.h"

namespace bandlimit {
namespace {

using Words = std::vector<std::uint32_t>;

FileContent ktx2(const TexelFormat& format, const Shape& shape) {
    return written(noise_texture(format, shape), Container::ktx2);
}

/// Where the key/value data end.
std::size_t keys_end(const FileContent& file) { return word(file, 56) + word(file, 60); }

TEST(Ktx2, HeaderSaysWhatTheSpecificationAsks) {
    const FileContent file = ktx2({4, Depth::u8, true}, {3, 2, 2});
    // «KTX 20» CR LF SUB LF.
    EXPECT_EQ(words(file, 0, 3), (Words{0x58544bab, 0xbb303220, 0x0a1a0a0d}));
    // VkFormat, type size, width, height, depth, layers, faces, levels, supercompression.
    EXPECT_EQ(words(file, 12, 9), (Words{43, 1, 3, 2, 0, 0, 1, 2, 0}));
    // The descriptor follows the level index, the keys the descriptor; nothing global.
    EXPECT_EQ(words(file, 48, 3), (Words{128, 92, 220}));
    EXPECT_EQ(words(file, 64, 4), (Words{0, 0, 0, 0}));
    EXPECT_EQ(word(file, 128), 92u);
    // 220 and the keys are multiples of 4: level 1 follows at once, then level 0, and the file ends.
    const auto keys = static_cast<std::uint32_t>(keys_end(file));
    EXPECT_EQ(keys % 4, 0u);
    EXPECT_EQ(words(file, 80, 12), (Words{keys + 4, 0, 24, 0, 24, 0, keys, 0, 4, 0, 4, 0}));
    EXPECT_EQ(file.size(), keys + 28);

    const FileContent cubes = ktx2({2, Depth::f16}, {4, 4, 1, true, 3});
    EXPECT_EQ(words(cubes, 12, 9), (Words{83, 2, 4, 4, 0, 3, 6, 1, 0}));
    EXPECT_EQ(word(cubes, 88), 4u * 4 * 4 * 6 * 3);
    EXPECT_EQ(words(ktx2({4, Depth::f32}, {7, 1, 3, false, 1}), 12, 9), (Words{109, 4, 7, 1, 0, 1, 1, 3, 0}));
}

TEST(Ktx2, EveryFormatHasItsNumber) {
    struct Case {
        int channels;
        Depth depth;
        bool srgb;
        std::uint32_t number, type_size;
        std::string_view name;
    };
    for (const Case& c : {Case{1, Depth::u8, false, 9, 1, "VK_FORMAT_R8_UNORM"},
                          {1, Depth::u8, true, 15, 1, "VK_FORMAT_R8_SRGB"},
                          {2, Depth::u8, false, 16, 1, "VK_FORMAT_R8G8_UNORM"},
                          {2, Depth::u8, true, 22, 1, "VK_FORMAT_R8G8_SRGB"},
                          {4, Depth::u8, false, 37, 1, "VK_FORMAT_R8G8B8A8_UNORM"},
                          {4, Depth::u8, true, 43, 1, "VK_FORMAT_R8G8B8A8_SRGB"},
                          {1, Depth::u16, false, 70, 2, "VK_FORMAT_R16_UNORM"},
                          {2, Depth::u16, false, 77, 2, "VK_FORMAT_R16G16_UNORM"},
                          {4, Depth::u16, false, 91, 2, "VK_FORMAT_R16G16B16A16_UNORM"},
                          {1, Depth::f16, false, 76, 2, "VK_FORMAT_R16_SFLOAT"},
                          {2, Depth::f16, false, 83, 2, "VK_FORMAT_R16G16_SFLOAT"},
                          {4, Depth::f16, false, 97, 2, "VK_FORMAT_R16G16B16A16_SFLOAT"},
                          {1, Depth::f32, false, 100, 4, "VK_FORMAT_R32_SFLOAT"},
                          {2, Depth::f32, false, 103, 4, "VK_FORMAT_R32G32_SFLOAT"},
                          {4, Depth::f32, false, 109, 4, "VK_FORMAT_R32G32B32A32_SFLOAT"}}) {
        const FileContent file = ktx2({c.channels, c.depth, c.srgb}, {});
        EXPECT_EQ(words(file, 12, 2), (Words{c.number, c.type_size}));
        EXPECT_EQ(container_info(file, "t").format, c.name);
    }
}

TEST(Ktx2, DescriptorsSayWhatTheFormatsAre) {
    struct Case {
        TexelFormat format;
        Words descriptor;
    };
    const std::vector<Case> cases{
        // Version 2, length; RGBSDA, BT.709, linear, straight; 1 x 1 texel; 1 byte. Red: 8 bits at 0, 0 to 255.
        {{1, Depth::u8}, {44, 0, 40u << 16 | 2, 0x00010101, 0, 1, 0, 0x00070000, 0, 0, 255}},
        // sRGB, premultiplied; the alpha channel, 15, is linear, 0x10.
        {{4, Depth::u8, true, true}, {92,         0,          88u << 16 | 2,
                                      0x01020101, 0,          4,
                                      0,  //
                                      0x00070000, 0,          0,
                                      255,        0x01070008, 0,
                                      0,          255,  //
                                      0x02070010, 0,          0,
                                      255,        0x1f070018, 0,
                                      0,          255}},  //
        {{4, Depth::u8},                                  //
         {92,         0,          88u << 16 | 2,
          0x00010101, 0,          4,
          0,  //
          0x00070000, 0,          0,
          255,        0x01070008, 0,
          0,          255,  //
          0x02070010, 0,          0,
          255,        0x0f070018, 0,
          0,          255}},  //
        // The second of two channels of sRGB is green, and sRGB too.
        {{2, Depth::u8, true},
         {60, 0, 56u << 16 | 2, 0x00020101, 0, 2, 0, 0x00070000, 0, 0, 255, 0x01070008, 0, 0, 255}},
        {{1, Depth::u16}, {44, 0, 40u << 16 | 2, 0x00010101, 0, 2, 0, 0x000f0000, 0, 0, 65535}},
        // Floats are signed, 0x40, and float, 0x80; -1.0f to 1.0f.
        {{2, Depth::f16},
         {60, 0, 56u << 16 | 2, 0x00010101, 0, 4, 0,  //
          0xc00f0000, 0, 0xbf800000, 0x3f800000, 0xc10f0010, 0, 0xbf800000, 0x3f800000}},
        {{4, Depth::f32, false, true},
         {92,         0, 88u << 16 | 2, 0x01010101, 0,          16, 0,                       //
          0xc01f0000, 0, 0xbf800000,    0x3f800000, 0xc11f0020, 0,  0xbf800000, 0x3f800000,  //
          0xc21f0040, 0, 0xbf800000,    0x3f800000, 0xcf1f0060, 0,  0xbf800000, 0x3f800000}},
    };
    for (const Case& c : cases) {
        const FileContent file = ktx2(c.format, {});
        EXPECT_EQ(word(file, 48), 104u);  // behind one level
        EXPECT_EQ(words(file, 104, word(file, 52) / 4), c.descriptor) << c.format;
    }
}

TEST(Ktx2, KeysAreSortedAndPadded) {
    const FileContent file = ktx2({}, {});
    const std::size_t start = word(file, 56);
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    using namespace std::string_view_literals;
    EXPECT_EQ(word(file, start), 18u);
    EXPECT_EQ(text.substr(start + 4, 20), "KTXorientation\0rd\0\0\0"sv);
    const std::size_t writer = start + 24, length = word(file, writer);
    EXPECT_TRUE(text.substr(writer + 4, length).starts_with("KTXwriter\0bandlimit "sv));
    EXPECT_EQ(text.substr(writer + 4, length).find('\0', 10), length - 1);
    const std::size_t end = writer + 4 + (length + 3) / 4 * 4;
    EXPECT_EQ(keys_end(file), end);
    for (std::size_t i = writer + 4 + length; i < end; ++i) EXPECT_EQ(file[i], std::byte{0});
}

TEST(Ktx2, LevelsAreAlignedAndTheSmallestIsFirst) {
    for (const TexelFormat& format : all_texel_formats()) {
        const std::uint32_t texel =
            static_cast<std::uint32_t>(format.channels) * static_cast<std::uint32_t>(size_of(format.depth));
        const FileContent file = ktx2(format, {7, 5, 3});
        std::size_t end = keys_end(file);
        const std::array<std::uint32_t, 3> texels{7 * 5, 3 * 2, 1};
        for (std::size_t level = 3; level-- > 0;) {
            const std::size_t start = word(file, 80 + 24 * level);
            EXPECT_EQ(words(file, 84 + 24 * level, 5), (Words{0, texels[level] * texel, 0, texels[level] * texel, 0}));
            // lcm(2^k, 4)
            EXPECT_EQ(start % std::max(texel, 4u), 0u) << format;
            EXPECT_LT(start - end, std::max(texel, 4u)) << format;
            for (; end < start; ++end) EXPECT_EQ(file[end], std::byte{0});
            end += texels[level] * texel;
        }
        EXPECT_EQ(file.size(), end);
    }
}

TEST(Ktx2, TexelsLieLayerByLayerFaceByFaceRowByRow) {
    const Texture texture = noise_texture({1, Depth::u8}, {4, 4, 2, true, 2});
    const FileContent file = written(texture, Container::ktx2);
    for (int level = 0; level < 2; ++level)
        for (int layer = 0; layer < 2; ++layer)
            for (int face = 0; face < 6; ++face) {
                const auto view = std::get<Image<std::uint8_t>>(texture.image(level, layer, face)).view();
                const int side = 4 >> level;
                const std::size_t start = word(file, 80 + 24 * static_cast<std::size_t>(level));
                for (int y = 0; y < side; ++y)
                    for (int x = 0; x < side; ++x)
                        EXPECT_EQ(
                            std::to_integer<int>(
                                file[start + static_cast<std::size_t>(((layer * 6 + face) * side + y) * side + x)]),
                            int(view(x, y)));
            }
}

/// One row of texels of `channels` samples, from a file whose row has as many texels as samples: it says so afterwards.
template <class T>
void expect_row(const TexelFormat& samples, std::uint32_t vk_format, const std::vector<int>& sources, T opaque) {
    const Texture texture = noise_texture({1, samples.depth}, {12, 1, 1});
    const auto stored = std::get<Image<T>>(texture.image(0)).view();
    const auto channels = static_cast<int>(sources.size()), pitch = samples.channels;
    FileContent file = patched(written(texture, Container::ktx2), 12, vk_format);
    file = patched(file, 20, static_cast<std::uint32_t>(12 / pitch));
    const Texture read = read_container(file, "t");
    EXPECT_EQ(read.format, (TexelFormat{channels, samples.depth, samples.srgb}));
    ASSERT_EQ(read.width(), 12 / pitch);
    const auto view = std::get<Image<T>>(read.image(0)).view();
    for (int x = 0; x < view.width; ++x)
        for (int c = 0; c < channels; ++c) {
            const int source = sources[static_cast<std::size_t>(c)];
            EXPECT_EQ(view(x, 0, c), source < 0 ? opaque : stored(x * pitch + source, 0)) << vk_format << " " << c;
        }
}

TEST(Ktx2, OrdersOfOthersAreTurnedAndAlphaIsAdded) {
    const std::uint8_t byte = 255;
    expect_row<std::uint8_t>({4, Depth::u8}, 44, {2, 1, 0, 3}, byte);        // B8G8R8A8
    expect_row<std::uint8_t>({4, Depth::u8, true}, 50, {2, 1, 0, 3}, byte);  // its sRGB
    expect_row<std::uint8_t>({4, Depth::u8}, 51, {0, 1, 2, 3}, byte);        // packed A8B8G8R8
    expect_row<std::uint8_t>({3, Depth::u8}, 23, {0, 1, 2, -1}, byte);       // R8G8B8
    expect_row<std::uint8_t>({3, Depth::u8, true}, 29, {0, 1, 2, -1}, byte);
    expect_row<std::uint8_t>({3, Depth::u8}, 30, {2, 1, 0, -1}, byte);  // B8G8R8
    expect_row<std::uint8_t>({3, Depth::u8, true}, 36, {2, 1, 0, -1}, byte);
    expect_row<std::uint16_t>({3, Depth::u16}, 84, {0, 1, 2, -1}, 65535);
    expect_row<Half>({3, Depth::f16}, 90, {0, 1, 2, -1}, Half{0x3c00});
    expect_row<float>({3, Depth::f32}, 106, {0, 1, 2, -1}, 1.0f);
}

TEST(Ktx2, NoLevelIsOneLevel) {
    const Texture texture = noise_texture({}, {5, 3, 1});
    EXPECT_TRUE(same_texture(read_container(patched(written(texture, Container::ktx2), 40, 0), "t"), texture));
}

TEST(Ktx2, RowsThatGoUpAreTurned) {
    const Texture texture = noise_texture({1, Depth::u16}, {3, 5, 2});
    FileContent file = written(texture, Container::ktx2);
    const std::size_t value = word(file, 56) + 4 + std::string_view("KTXorientation").size() + 1;
    ASSERT_EQ(file[value + 1], std::byte{'d'});
    file[value + 1] = std::byte{'u'};
    const Texture read = read_container(file, "t");
    for (int level = 0; level < 2; ++level) {
        const auto a = std::get<Image<std::uint16_t>>(texture.image(level)).view();
        const auto b = flipped_y(std::get<Image<std::uint16_t>>(read.image(level)).view());
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) EXPECT_EQ(a(x, y), b(x, y));
    }
    file[value] = std::byte{'l'};
    EXPECT_TRUE(is_refused(file, "orientation"));
    FileContent cube = ktx2({4, Depth::u8}, {4, 4, 1, true});  // whose faces lie as the specification says
    cube[word(cube, 56) + 4 + std::string_view("KTXorientation").size() + 2] = std::byte{'u'};
    EXPECT_TRUE(is_refused(cube, "orientation"));
    // Without any key, the top is first.
    const FileContent plain = patched(patched(written(texture, Container::ktx2), 56, 0), 60, 0);
    EXPECT_TRUE(same_texture(read_container(plain, "t"), texture));
}

TEST(Ktx2, WhatIsNotReadIsNamed) {
    const FileContent file = ktx2({4, Depth::u8}, {5, 3, 2}), cube = ktx2({4, Depth::u8}, {4, 4, 2, true});
    EXPECT_TRUE(is_refused(patched(file, 44, 2), "Zstandard"));
    EXPECT_TRUE(is_refused(patched(file, 44, 99), "unknown scheme"));
    EXPECT_TRUE(is_refused(patched(file, 12, 0), "VK_FORMAT_UNDEFINED,"));
    EXPECT_TRUE(is_refused(patched(file, 12, 38), "VK_FORMAT_R8G8B8A8_SNORM,"));
    EXPECT_TRUE(is_refused(patched(file, 12, 145), "VK_FORMAT_BC7_UNORM_BLOCK,"));
    EXPECT_TRUE(is_refused(patched(file, 12, 185), "VkFormat 185,"));
    EXPECT_TRUE(is_refused(patched(file, 20, 0), "0 columns"));
    EXPECT_TRUE(is_refused(patched(file, 20, 0x80000000), "columns"));
    EXPECT_TRUE(is_refused(patched(file, 24, 0), "one dimension"));
    EXPECT_TRUE(is_refused(patched(file, 28, 1), "volume"));
    EXPECT_TRUE(is_refused(patched(file, 32, 16385), "layers"));
    EXPECT_TRUE(is_refused(patched(file, 32, 2), "must be 120"));
    EXPECT_TRUE(is_refused(patched(file, 36, 0), "0 faces"));
    EXPECT_TRUE(is_refused(patched(file, 36, 6), "squares"));
    EXPECT_TRUE(is_refused(patched(cube, 36, 1), "must be 64"));
    EXPECT_TRUE(is_refused(patched(file, 40, 4), "at most 3"));
    EXPECT_TRUE(is_refused(patched(file, 40, 0xffffffff), "levels"));
    EXPECT_TRUE(is_refused(patched(file, 48, 0xfffffff0), "descriptor"));
    EXPECT_TRUE(is_refused(patched(file, 52, 20), "descriptor"));
    EXPECT_TRUE(is_refused(patched(file, 60, 0xfffffff0), "key/value"));
    EXPECT_TRUE(is_refused(patched(file, word(file, 56), 0xffffffff), "key/value"));
    EXPECT_TRUE(is_refused(patched(file, 60, 20), "runs out"));  // the first entry takes 24
    EXPECT_TRUE(is_refused(patched(file, 84, 1), "level 0"));    // beyond 4 GiB
    EXPECT_TRUE(is_refused(patched(file, 108, 0xffffffff), "level 1"));
    // An offset whose sum with a length that is right overflows.
    EXPECT_TRUE(is_refused(patched(patched(file, 80, 0xfffffff0), 84, 0xffffffff), "level 0"));
    EXPECT_TRUE(is_refused(patched(file, 88, 59), "must be 60"));
}

TEST(Ktx2, KeysBeyondTheHeaderAreRefused) {
    FileContent file = ktx2({4, Depth::u8}, {});
    file.resize(most_header_bytes + 100);
    EXPECT_TRUE(is_refused(patched(patched(file, 56, most_header_bytes), 60, 8), "1048576"));
}

TEST(Ktx2, SizesWhoseProductOverflowsAreRefused) {
    // 2^31 - 1 squared times 4 bytes times 6 faces times 16384 layers is far beyond 64 bits.
    FileContent file = ktx2({4, Depth::u8}, {4, 4, 1, true, 1});
    for (const std::size_t offset : {20, 24}) file = patched(file, offset, 0x7fffffff);
    EXPECT_TRUE(is_refused(patched(file, 32, 16384), "2147483647"));
}

}  // namespace
}  // namespace bandlimit
