// Files that are not what they say: one clear error, or the pixels; never a crash, never more memory than is there.
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <chrono>
#include <functional>

#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

/// Reads the file by blocks of few rows.
void read_all(const std::string& path) {
    ImageReader reader(path, 1);
    const ImageInfo& info = reader.info();
    constexpr int block = 7;
    AnyImage rows = make_image(info.depth, info.width, block, info.channels());
    for (int y = 0; y < info.height; y += block)
        reader.read_rows(y, rows_of(view_of(rows), 0, std::min(block, info.height - y)));
}

/// The lowest `bytes` bytes of a number, which has eight.
std::string number(std::uint64_t value, int bytes, bool is_big = false) {
    std::string text;
    for (int i = 0; i < bytes; ++i) {
        const int place = is_big ? bytes - 1 - i : i;
        text += static_cast<char>(place < 8 ? value >> (8 * place) & 0xff : 0);
    }
    return text;
}

/// A file of 33 x 24 pixels; with tiles if `kind` says so.
void write_small(const std::string& path, const std::string& kind, Depth depth) {
    AnyImage image = noise(depth, 33, 24, 3);
    ImageTarget target = target_of(depth, 33, 24, 3);
    if (kind.ends_with("tiles")) target.tile = 16;
    write_image(path, target, pixels(image));
}

std::string extension_of(const std::string& kind) { return kind.substr(0, kind.find(' ')); }

TEST(Hostile, CutFilesAreRefusedOrWhole) {
    const Folder folder;
    for (const std::string kind :
         {"png", "jpg", "tif", "tif tiles", "exr", "exr tiles", "hdr", "ppm", "pfm", "webp", "tga", "bmp"}) {
        SCOPED_TRACE(kind);
        const std::string extension = extension_of(kind);
        const std::string whole = folder / ("whole." + extension), cut = folder / ("cut." + extension);
        write_small(whole, kind, abilities_of(whole).depths.front());
        const AnyImage expected = read_image(whole);
        const std::string bytes = bytes_of(whole);
        Random random(1);
        for (int i = 0; i < 60; ++i) {
            const auto size = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
            write_bytes(cut, bytes.substr(0, size));
            try {
                AnyImage again = read_image(cut);
                // What lacks may be an end mark, but no pixel.
                AnyImage first = read_image(whole);
                EXPECT_TRUE(equal(pixels(first), pixels(again))) << "cut at " << size << " of " << bytes.size();
            } catch (const std::runtime_error&) {
                EXPECT_TRUE(fails_for(cut, [&] { read_all(cut); })) << "cut at " << size;
            }
        }
    }
}

TEST(Hostile, DamagedBytesNeverCrash) {
    const Folder folder;
    for (const std::string kind :
         {"png", "jpg", "tif", "tif tiles", "exr", "exr tiles", "hdr", "ppm", "webp", "tga", "bmp"}) {
        SCOPED_TRACE(kind);
        const std::string extension = extension_of(kind);
        const std::string whole = folder / ("whole." + extension), bad = folder / ("bad." + extension);
        write_small(whole, kind, abilities_of(whole).depths.back());
        const std::string bytes = bytes_of(whole);
        Random random(2);
        for (int i = 0; i < 60; ++i) {
            std::string damaged = bytes;
            const int head = std::min(200, static_cast<int>(bytes.size()) - 1);
            for (int k = 0; k < 3; ++k)
                damaged[static_cast<std::size_t>(random.integer(0, head))] = static_cast<char>(random.integer(0, 255));
            write_bytes(bad, damaged);
            try {
                const ImageReader reader(bad, 1);
                // A damaged size may be a possible one; what is tested is that reading it ends.
                if (static_cast<std::int64_t>(reader.info().width) * reader.info().height < 1 << 20) read_all(bad);
            } catch (const std::runtime_error& e) {
                EXPECT_TRUE(std::string(e.what()).starts_with(bad + ": ")) << e.what();
            }
        }
    }
}

/// Headers that promise 2^31 by 2^31 pixels or about that, with hardly anything behind them.
struct Promise {
    std::string name, bytes;
};

struct TiffEntry {
    std::uint64_t tag, type, count, value;
};

/// A TIFF of 100 bytes and a directory.
std::string tiff(const std::vector<TiffEntry>& entries) {
    std::string text = std::string("II*\0", 4) + number(108, 4) + std::string(100, 'x') + number(entries.size(), 2);
    for (const TiffEntry& e : entries)
        text += number(e.tag, 2) + number(e.type, 2) + number(e.count, 4) + number(e.value, 4);
    return text + number(0, 4);
}

std::string tiff(std::uint64_t w, std::uint64_t h, std::uint64_t rows_per_strip, std::uint64_t compression) {
    return tiff({{256, 4, 1, w},
                 {257, 4, 1, h},
                 {258, 3, 1, 8},
                 {259, 3, 1, compression},
                 {262, 3, 1, 1},
                 {273, 4, 1, 8},
                 {277, 3, 1, 1},
                 {278, 4, 1, rows_per_strip},
                 {279, 4, 1, 100}});
}

/// Tiles of `tile_w` x `tile_h`, `count` of which are listed, where the file ends if there are more than one.
std::string tiled_tiff(std::uint64_t w, std::uint64_t h, std::uint64_t tile_w, std::uint64_t tile_h,
                       std::uint64_t compression, std::uint64_t count = 1) {
    return tiff({{256, 4, 1, w},
                 {257, 4, 1, h},
                 {258, 3, 1, 8},
                 {259, 3, 1, compression},
                 {262, 3, 1, 1},
                 {277, 3, 1, 1},
                 {322, 4, 1, tile_w},
                 {323, 4, 1, tile_h},
                 {324, 4, count, 8},
                 {325, 4, count, 100}});
}

std::string exr(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1, char compression, int tile) {
    const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
        return name + '\0' + type + '\0' + number(value.size(), 4) + value;
    };
    const auto u32 = [](std::int32_t v) { return number(static_cast<std::uint32_t>(v), 4); };
    const std::string window = u32(x0) + u32(y0) + u32(x1) + u32(y1);
    std::string text = number(20000630, 4) + number(tile > 0 ? 0x202 : 2, 4);
    text += attribute("channels", "chlist", std::string("R\0", 2) + u32(1) + u32(0) + u32(1) + u32(1) + '\0');
    text += attribute("compression", "compression", std::string(1, compression));
    text += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window);
    text += attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    text += attribute("pixelAspectRatio", "float", number(0x3f800000, 4));
    text += attribute("screenWindowCenter", "v2f", number(0, 8));
    text += attribute("screenWindowWidth", "float", number(0x3f800000, 4));
    if (tile > 0) text += attribute("tiles", "tiledesc", u32(tile) + u32(tile) + '\0');
    return text + '\0' + std::string(200, '\0');
}

/// Without the right checksum libpng would look no further: CRC-32 bit by bit.
std::string png_chunk(const std::string& name_and_data) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : name_and_data) {
        crc ^= static_cast<unsigned char>(c);
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
    }
    return number(name_and_data.size() - 4, 4, true) + name_and_data + number(~crc, 4, true);
}

/// `chunks` lie between the header and the pixels.
std::string png(std::uint32_t w, std::uint32_t h, char interlace, const std::string& chunks = "") {
    const std::string head =
        "IHDR" + number(w, 4, true) + number(h, 4, true) + "\x08\x06" + std::string(2, '\0') + interlace;
    return "\x89PNG\r\n\x1a\n" + png_chunk(head) + chunks + number(1000, 4, true) + "IDAT" + std::string(1000, '\0');
}

std::vector<Promise> promises() {
    constexpr std::uint32_t most = 0x7fffffff;
    const std::string junk(100, 'x'), n = "2147483647";
    const auto bmp = [&](std::uint32_t w, std::uint32_t h, int bits) {
        return "BM" + number(1000, 4) + number(0, 4) + number(54, 4) + number(40, 4) + number(w, 4) + number(h, 4) +
               number(1, 2) + number(static_cast<std::uint64_t>(bits), 2) + number(0, 24) + junk;
    };
    const auto jpeg = [](char frame) {
        return std::string("\xff\xd8\xff") + frame + number(17, 2, true) + "\x08" + number(65500, 2, true) +
               number(65500, 2, true) + std::string("\x03\x01\x11\0\x02\x11\0\x03\x11\0", 10) + "\xff\xd9";
    };
    const std::string lossless = "VP8L" + number(10, 4) + "\x2f" + number(16383u | 16383u << 14, 4) + "xxxxx";
    return {{"png", png(most, most, 0)},
            {"png", png(1000000, 1000000, 0)},
            {"png", png(1000000, 1000000, 1)},
            {"png", png(0, 5, 0)},
            {"ppm", "P6\n" + n + " " + n + "\n255\n" + junk},
            {"ppm", "P3\n" + n + " " + n + "\n255\n1 2 3"},
            {"pgm", "P5\n0 0\n255\n"},
            {"pgm", "P5\n-5 7\n255\n" + junk},
            {"pgm", "P5\n99999999999999 2\n255\n" + junk},
            {"pfm", "PF\n" + n + " " + n + "\n-1.0\n" + junk},
            {"hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + n + " +X " + n + "\n" + junk},
            {"hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n"},
            {"bmp", bmp(most, most, 24)},
            {"bmp", bmp(most, 0x80000000, 32)},
            {"bmp", bmp(0, 0, 24)},
            {"tga", number(0, 2) + "\x0a" + number(0, 9) + number(65535, 2) + number(65535, 2) + "\x20\x08" + junk},
            {"tif", tiff(most, most, most, 1)},
            {"tif", tiff(most, most, 1, 1)},
            {"tif", tiff(0xffffffff, 0xffffffff, 16, 8)},
            {"tif", tiff(100000, most, most, 8)},
            {"tif", tiff(100000, most, most, 5)},
            {"tif", tiff(most, most, most, 4)},
            {"tif", tiff(0, 0, 1, 1)},
            {"tif", tiled_tiff(40, 30, 0, 0, 1)},
            {"tif", tiled_tiff(40, 30, 0, 16, 8)},
            {"tif", tiled_tiff(40, 30, 16, 0, 5)},
            {"tif", tiled_tiff(40, 30, 7, 5, 1)},
            {"tif", tiled_tiff(40, 30, 16, 16, 1)},     // six tiles, of which one is listed
            {"tif", tiled_tiff(40, 30, 16, 16, 8, 6)},  // whose places lie in the middle of pixels
            {"tif", tiled_tiff(40, 30, most, 16, 8)},   // a tile far larger than the picture
            {"tif", tiled_tiff(40, 30, 16, most, 5)},
            {"tif", tiled_tiff(40, 30, most, most, 8)},
            {"tif", tiled_tiff(40, 30, 0xfffffff0, 0xfffffff0, 8)},
            {"tif", tiled_tiff(40, 30, 65536, 32752, 8)},  // just below 2 GiB
            {"tif", tiled_tiff(40, 30, 65536, 65536, 4)},  // of a compression without a bound
            {"tif", tiled_tiff(most, most, 256, 256, 8)},
            {"tif", tiled_tiff(most, most, 16, 1 << 20, 8)},
            {"tif", tiled_tiff(most, most, 16, 16, 7, most)},
            {"tif", tiled_tiff(most, 16, 16, 16, 8, 0xffffffff)},
            {"tif", tiled_tiff(0, 0, 16, 16, 1)},
            {"exr", exr(0, 0, most - 1, most - 1, 0, 0)},
            {"exr", exr(0, 0, 15, (1 << 30) - 2, 0, 0)},
            {"exr", exr(-(1 << 30) + 2, 0, (1 << 29), 15, 3, 0)},
            {"exr", exr(0, 0, 1000000, 1000000, 0, 1)},
            {"exr", exr(0, 0, 1 << 29, 1 << 29, 3, 1 << 29)},
            {"exr", exr(5, 5, 1, 1, 0, 0)},
            {"jpg", jpeg('\xc0')},
            {"jpg", jpeg('\xc2')},
            {"webp", "RIFF" + number(lossless.size() + 4, 4) + "WEBP" + lossless}};
}

TEST(Hostile, PromisesThatCannotBeKeptAreRefusedQuicklyAndWithLittleMemory) {
    const Folder folder;
    rusage before{}, after{};
    ::getrusage(RUSAGE_SELF, &before);
    for (const Promise& promise : promises()) {
        SCOPED_TRACE(promise.name + " " + std::to_string(promise.bytes.size()));
        const std::string path = folder / ("a." + promise.name);
        write_bytes(path, promise.bytes);
        const auto start = std::chrono::steady_clock::now();
        EXPECT_TRUE(fails_for(path, [&] { read_all(path); }));
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    }
    ::getrusage(RUSAGE_SELF, &after);
    // One block of a 1000000 x 1000000 PNG is 28 MB; nothing needs much more.
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 * 1024);
}

TEST(Hostile, AnAttributeLongerThanTheFileIsRefusedBeforeItIsRead) {
    const Folder folder;
    const std::string path = folder / "long.exr";
    std::string text = exr(0, 0, 3, 3, 0, 0);
    const std::string long_attribute = std::string("note\0string\0", 12) + number(0x69735301, 4);
    write_bytes(path, text.insert(8, long_attribute));
    EXPECT_TRUE(fails_for(
        path, [&] { ImageReader reader(path); }, "an attribute of 1769165569 bytes"));
}

TEST(Hostile, AChunkOfPngLongerThanTheFileIsRefusedBeforeItIsRead) {
    const Folder folder;
    const std::string path = folder / "long.png";
    rusage before{}, after{};
    ::getrusage(RUSAGE_SELF, &before);
    for (const std::string name : {"tEXt", "zTXt", "iTXt", "iCCP", "eXIf", "PLTE", "tRNS", "vpAg"}) {
        write_bytes(path, png(20, 20, 0, number(0x7fffffff, 4, true) + name + "Comment" + std::string(100, '\0')));
        EXPECT_TRUE(fails_for(
            path, [&] { ImageReader reader(path); }, "a chunk of 2147483647 bytes"));
    }
    ::getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 * 1024) << "kB";
}

TEST(Hostile, AnInterlacedPictureIsRefusedForTheMemoryItNeeds) {
    // Long enough to hold what it claims, as far as anybody can tell: 4 TB of pixels.
    const Folder folder;
    const std::string path = folder / "a.png";
    write_bytes(path, png(1000000, 1000000, 1));
    std::filesystem::resize_file(path, 130 << 20);
    EXPECT_TRUE(fails_for(
        path, [&] { ImageReader reader(path); }, "memory"));
}

TEST(Hostile, WhatIsNoImageIsNamed) {
    const Folder folder;
    const std::string missing = folder / "none.png", empty = folder / "empty.png", text = folder / "text.png";
    const std::string pipe = folder / "pipe.png", mute = folder / "mute.png";
    write_bytes(empty, "");
    write_bytes(text, "This is no picture at all, though its name says so.\n");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_TRUE(fails_for(
        missing, [&] { ImageReader reader(missing); }, "does not exist"));
    EXPECT_TRUE(fails_for(
        folder / "", [&] { ImageReader reader(folder / ""); }, "is a directory"));
    EXPECT_TRUE(fails_for(
        empty, [&] { ImageReader reader(empty); }, "is empty"));
    EXPECT_TRUE(fails_for(
        text, [&] { ImageReader reader(text); }, "is no image"));
    EXPECT_TRUE(fails_for(
        pipe, [&] { ImageReader reader(pipe); }, "a pipe"));
    EXPECT_TRUE(fails_for(
        "/dev/zero", [&] { ImageReader reader("/dev/zero"); }, "a device"));
    EXPECT_TRUE(fails_for(
        "", [&] { ImageReader reader(""); }, "does not exist"));
    EXPECT_TRUE(fails_for(text + "/x", [&] { ImageReader reader(text + "/x"); }));
}

TEST(Hostile, TheFirstBytesDecideNotTheName) {
    const Folder folder;
    AnyImage image = noise(Depth::u8, 5, 4, 3);
    write_image(folder / "a.png", target_of(Depth::u8, 5, 4, 3), pixels(image));
    std::filesystem::rename(folder / "a.png", folder / "a.jpg");
    EXPECT_EQ(ImageReader(folder / "a.jpg", 1).info().format, "png");
}

TEST(Hostile, DeepImagesAreRefused) {
    const Folder folder;
    OIIO::ImageSpec spec(4, 4, 2, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"Z", "A"};
    spec.deep = true;
    const auto out = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(out->open(folder / "deep.exr", spec));
    OIIO::DeepData data(spec);
    ASSERT_TRUE(out->write_deep_scanlines(0, 4, 0, data));
    out->close();
    EXPECT_TRUE(fails_for(
        folder / "deep.exr", [&] { ImageReader reader(folder / "deep.exr"); }, "deep"));
}

TEST(Memory, MoreThanThereIsIsRefused) {
    EXPECT_NO_THROW(require_memory(0, "x"));
    EXPECT_NO_THROW(require_memory(2 << 20, "x"));
    EXPECT_TRUE(fails_for(
        "x", [] { require_memory(std::uint64_t{1} << 60, "x"); }, "memory"));
}

}  // namespace
}  // namespace bandlimit
