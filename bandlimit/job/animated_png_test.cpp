#include "bandlimit/job/animated_png.h"

#include <gtest/gtest.h>

#include "bandlimit/core/error.h"
#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

std::vector<Image<std::uint8_t>> frames(int count) {
    std::vector<Image<std::uint8_t>> all;
    for (int f = 0; f < count; ++f) {
        Image<std::uint8_t> picture(40, 24, 3, Layout::interleaved);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 40; ++x)
                for (int c = 0; c < 3; ++c) picture.view()(x, y, c) = static_cast<std::uint8_t>(x * 5 + y * f + c * 31);
        all.push_back(std::move(picture));
    }
    return all;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

struct Chunk {
    std::string type, data;
    std::uint32_t crc;
};

std::vector<Chunk> chunks_of(const std::string& bytes) {
    std::vector<Chunk> chunks;
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t length = number_at(bytes, at);
        chunks.push_back({bytes.substr(at + 4, 4), bytes.substr(at + 8, length), number_at(bytes, at + 8 + length)});
        at += length + 12;
    }
    return chunks;
}

/// A PNG file with the image data of one frame.
std::string single(const std::string& animation, int frame) {
    const auto bytes = [](std::uint32_t v) {
        std::string text;
        for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(v >> shift & 0xff);
        return text;
    };
    const auto crc = [](const std::string& data) {  // bit by bit
        std::uint32_t c = ~0u;
        for (const char byte : data) {
            c ^= static_cast<unsigned char>(byte);
            for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ c >> 1 : c >> 1;
        }
        return ~c;
    };
    std::string file = animation.substr(0, 8);
    const auto add = [&](const std::string& type, const std::string& data) {
        file += bytes(static_cast<std::uint32_t>(data.size())) + type + data + bytes(crc(type + data));
    };
    int at = -1;
    for (const Chunk& c : chunks_of(animation)) {
        EXPECT_EQ(c.crc, crc(c.type + c.data)) << c.type;
        if (c.type == "fcTL") ++at;
        if (c.type == "IHDR") add(c.type, c.data);
        if (at == frame && c.type == "IDAT") add("IDAT", c.data);
        if (at == frame && c.type == "fdAT") add("IDAT", c.data.substr(4));
    }
    add("IEND", "");
    return file;
}

TEST(AnimatedPng, HoldsAllFramesInOrder) {
    const Folder folder;
    std::vector<Image<std::uint8_t>> pictures = frames(5);
    job::write_animated_png(folder / "a.png", pictures, 80);
    EXPECT_EQ(folder.count(), 1);
    const std::string file = bytes_of(folder / "a.png");
    std::uint32_t sequence = 0;
    for (const Chunk& c : chunks_of(file)) {
        if (c.type == "acTL") {
            EXPECT_EQ(number_at(c.data, 0), 5u);
            EXPECT_EQ(number_at(c.data, 4), 0u) << "without end";
        }
        if (c.type != "fcTL" && c.type != "fdAT") continue;
        EXPECT_EQ(number_at(c.data, 0), sequence++);
        if (c.type == "fcTL") {
            EXPECT_EQ(number_at(c.data, 4), 40u);
            EXPECT_EQ(number_at(c.data, 20), 80u << 16 | 1000u);
        }
    }
    EXPECT_EQ(chunks_of(file).back().type, "IEND");
    for (int f = 0; f < 5; ++f) {
        write_bytes(folder / "one.png", single(file, f));
        const AnyImage read = read_image(folder / "one.png");
        EXPECT_TRUE(equal(const_view(view_of(const_cast<AnyImage&>(read))),
                          AnyConstView(View<const std::uint8_t>(pictures[static_cast<std::size_t>(f)].view()))))
            << f;
    }
}

TEST(AnimatedPng, AnyReaderSeesItsFirstPicture) {
    const Folder folder;
    std::vector<Image<std::uint8_t>> pictures = frames(3);
    job::write_animated_png(folder / "a.png", pictures, 40);
    AnyImage read = read_image(folder / "a.png");
    EXPECT_TRUE(equal(pixels(read), AnyConstView(View<const std::uint8_t>(pictures[0].view()))));
}

TEST(AnimatedPng, RefusesWhatIsNoAnimation) {
    const Folder folder;
    std::vector<Image<std::uint8_t>> pictures = frames(2);
    EXPECT_THROW(job::write_animated_png(folder / "a.png", {}, 40), Error);
    EXPECT_THROW(job::write_animated_png(folder / "a.png", pictures, 0), Error);
    pictures.emplace_back(8, 8, 3, Layout::interleaved);
    EXPECT_THROW(job::write_animated_png(folder / "a.png", pictures, 40), Error);
    EXPECT_EQ(folder.count(), 0);
    EXPECT_THROW(job::write_animated_png(folder / "no/a.png", frames(1), 40), std::runtime_error);
}

}  // namespace
}  // namespace bandlimit
