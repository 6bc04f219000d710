// Files of both kinds: what goes in comes out, and nothing that is damaged does harm.
#include "bandlimit/texture/container.h"

#include <array>

#include "bandlimit/core/error.h"
#include "bandlimit/texture/textures_test.h"

namespace bandlimit {
namespace {

constexpr std::array containers{Container::ktx2, Container::dds};

bool holds(Container container, const TexelFormat& format) {
    return container == Container::ktx2 || !format.srgb || format.channels == 4;
}

TEST(Container, PathsAndFirstBytesNameIt) {
    EXPECT_EQ(container_of_path("a.ktx2"), Container::ktx2);
    EXPECT_EQ(container_of_path("a/b.c.DDS"), Container::dds);
    for (const char* path : {"a.ktx", "dds", ".dds", "a.dds.png", "", "ktx2"})
        EXPECT_FALSE(container_of_path(path)) << path;
    const Texture texture = noise_texture({}, {});
    for (const Container container : containers) {
        const FileContent file = written(texture, container);
        EXPECT_EQ(container_of_bytes(file), container);
        EXPECT_FALSE(container_of_bytes(std::span(file).first(3)));
        EXPECT_FALSE(container_of_bytes(std::span(file).subspan(1)));
    }
    EXPECT_TRUE(is_refused({}, "neither"));
    EXPECT_TRUE(is_refused(FileContent(200), "neither"));
}

TEST(Container, EveryFormatComesBack) {
    for (const Container container : containers)
        for (const TexelFormat& format : all_texel_formats()) {
            if (!holds(container, format)) {
                EXPECT_THROW(check_container(container, format), Error) << format;
                EXPECT_THROW(written(noise_texture(format, {}), container), Error) << format;
                continue;
            }
            check_container(container, format);
            const Texture texture = noise_texture(format, {7, 3, 3});
            EXPECT_TRUE(same_texture(read_container(written(texture, container), "t"), texture)) << format;
        }
}

TEST(Container, EveryShapeComesBack) {
    std::vector<Shape> shapes{{1, 1, 1},          {1, 17, 5},          {17, 1, 2},           {6, 6, 3, true},
                              {5, 5, 1, true, 3}, {9, 4, 4, false, 7}, {1, 1, 1, false, 200}};
    for (int width = 1; width <= 9; ++width)
        for (int height = 1; height <= 9; ++height) shapes.push_back({width, height, mip_count(width, height)});
    for (const Container container : containers)
        for (const Shape& shape : shapes)
            for (const TexelFormat format : {TexelFormat{1, Depth::u8}, TexelFormat{4, Depth::u8, true, true}}) {
                const Texture texture = noise_texture(format, shape);
                const FileContent file = written(texture, container);
                EXPECT_TRUE(same_texture(read_container(file, "t"), texture))
                    << shape.width << " x " << shape.height << ", " << shape.levels << " levels";
                const ContainerInfo info = container_info(file, "t");
                EXPECT_EQ(info.container, container);
                EXPECT_EQ(info.texels, format);
                EXPECT_EQ(info.width, shape.width);
                EXPECT_EQ(info.height, shape.height);
                EXPECT_EQ(info.levels, shape.levels);
                EXPECT_EQ(info.layers, std::max(1, shape.layers));
                EXPECT_EQ(info.is_cube, shape.is_cube);
                EXPECT_EQ(info.is_array, shape.layers > 0);
            }
}

TEST(Container, OnlyKtx2TellsAnArrayOfOneLayer) {
    Texture texture = noise_texture({}, {3, 2, 1, false, 1});
    EXPECT_TRUE(same_texture(read_container(written(texture, Container::ktx2), "t"), texture));
    const Texture read = read_container(written(texture, Container::dds), "t");
    EXPECT_FALSE(read.is_array);
    texture.is_array = false;
    EXPECT_TRUE(same_texture(read, texture));
}

TEST(Container, WhatIsNoTextureIsNotWritten) {
    Texture texture = noise_texture({}, {4, 4, 2});
    texture.levels[1].clear();
    for (const Container container : containers) EXPECT_THROW(written(texture, container), Error);
}

TEST(Container, WhatASinkThrowsComesOut) {
    const Texture texture = noise_texture({}, {4, 4, 2});
    for (const Container container : containers)
        EXPECT_THROW(write_container(texture, container, [](auto) { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST(Container, EveryTruncationIsRefused) {
    for (const Container container : containers)
        for (const Shape& shape : {Shape{5, 3, 2}, Shape{2, 2, 2, true, 2}}) {
            const FileContent file = written(noise_texture({4, Depth::u8, true}, shape), container);
            for (std::size_t length = 0; length < file.size(); ++length)
                EXPECT_TRUE(is_refused({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length)}, ""))
                    << length;
        }
}

TEST(Container, TheBeginningIsEnoughForTheHeader) {
    for (const Container container : containers) {
        const FileContent file = written(noise_texture({2, Depth::u16}, {40, 30, 3}), container);
        const std::span<const std::byte> start = std::span(file).first(500);
        const ContainerInfo info = container_info(start, file.size(), "t");
        EXPECT_EQ(info.width, 40);
        EXPECT_EQ(info.levels, 3);
        EXPECT_EQ(info.texel_bytes, 4);
        EXPECT_THROW(container_info(start, file.size() - 1, "t"), std::runtime_error);
        EXPECT_THROW(container_info(start.first(100), file.size(), "t"), std::runtime_error);
    }
}

TEST(Container, TrailingBytesDoNoHarm) {
    const Texture texture = noise_texture({}, {5, 3, 2});
    for (const Container container : containers) {
        FileContent file = written(texture, container);
        file.resize(file.size() + 100);
        EXPECT_TRUE(same_texture(read_container(file, "t"), texture));
    }
}

/// Reads a file that may be damaged: a texture that holds together, or the one error.
void read_damaged(const FileContent& file) {
    try {
        check_texture(read_container(file, "t"));
    } catch (const std::runtime_error&) {
    }
}

TEST(Container, DamagedHeadersGiveATextureOrAnError) {
    for (const Container container : containers)
        for (const Shape& shape : {Shape{5, 3, 2}, Shape{2, 2, 2, true, 2}}) {
            const FileContent file = written(noise_texture({4, Depth::u8, true}, shape), container);
            const std::size_t header = file.size() - std::min<std::size_t>(file.size() / 2, 40);
            for (std::size_t offset = 0; offset + 8 <= header; ++offset) {
                for (const std::uint32_t value :
                     {0u, 1u, 3u, 0x7fu, 0xffu, 0xffffu, 0x7fffffffu, 0x80000000u, 0xffffffffu})
                    ASSERT_NO_THROW(read_damaged(patched(file, offset, value))) << offset << " " << value;
                // Two damages at once: lengths of 64 bits, sizes of both axes.
                ASSERT_NO_THROW(read_damaged(patched(patched(file, offset, 0xffffffff), offset + 4, 0x7fffffff)));
            }
        }
}

TEST(Container, DamageByChanceGivesATextureOrAnError) {
    Random random(7);
    for (const Container container : containers) {
        const FileContent file = written(noise_texture({1, Depth::u8}, {8, 8, 4}), container);
        for (int i = 0; i < 3000; ++i) {
            FileContent damaged = file;
            for (int k = random.integer(1, 4); k > 0; --k)
                damaged[static_cast<std::size_t>(random.integer(0, 200))] =
                    static_cast<std::byte>(random.integer(0, 255));
            ASSERT_NO_THROW(read_damaged(damaged));
        }
    }
}

}  // namespace
}  // namespace bandlimit
