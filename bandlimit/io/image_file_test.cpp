// What is written is read again.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <atomic>
#include <thread>

#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

constexpr int width = 37, height = 29;

/// A format that loses nothing, with all it holds.
struct Exact {
    std::string extension;
    std::vector<int> channels;
};
const std::vector<Exact> exact{{"png", {1, 2, 3, 4}},
                               {"tif", {1, 2, 3, 4, 5, 7}},
                               {"exr", {1, 2, 3, 4, 5, 7}},
                               {"pgm", {1}},
                               {"ppm", {3}},
                               {"pnm", {1, 3}},
                               {"pfm", {1, 3}},
                               {"tga", {1, 3, 4}},
                               {"bmp", {1, 3}}};

template <class Visit>
void for_every_exact_file(Visit visit) {
    for (const Exact& format : exact)
        for (const Depth depth : abilities_of("x." + format.extension).depths)
            for (const int channels : format.channels) {
                SCOPED_TRACE(format.extension + " " + std::string(name_of(depth)) + " x " + std::to_string(channels));
                visit(format.extension, depth, channels);
            }
}

TEST(ImageFile, EveryFormatDepthAndNumberOfChannelsComesBack) {
    const Folder folder;
    for_every_exact_file([&](const std::string& extension, Depth depth, int channels) {
        const std::string path = folder / ("a." + extension);
        AnyImage image = noise(depth, width, height, channels);
        const ImageTarget target = target_of(depth, width, height, channels);
        write_image(path, target, pixels(image));

        ImageReader reader(path, 1);
        const ImageInfo& info = reader.info();
        ASSERT_EQ(info.depth, depth);
        ASSERT_EQ(info.channels(), channels);
        EXPECT_EQ(info.format, abilities_of(path).name);
        EXPECT_EQ(info.alpha, target.alpha);
        EXPECT_EQ(info.associated, extension == "exr" && target.alpha >= 0);
        EXPECT_EQ(info.transfer, is_integer(depth) || extension == "tif" ? Transfer::srgb : Transfer::linear);
        AnyImage again = read_image(reader);
        EXPECT_TRUE(equal(pixels(image), pixels(again)));
    });
    EXPECT_EQ(folder.count(), static_cast<std::ptrdiff_t>(exact.size())) << "something else was left behind";
}

TEST(ImageFile, BlocksOfRowsAndAnyLayoutGiveTheSamePixels) {
    const Folder folder;
    for_every_exact_file([&](const std::string& extension, Depth depth, int channels) {
        const std::string whole = folder / ("whole." + extension), blocks = folder / ("blocks." + extension);
        const ImageTarget target = target_of(depth, width, height, channels);
        AnyImage image = noise(depth, width, height, channels);
        AnyImage planar = noise(depth, width, height, channels, Layout::planar);
        write_image(whole, target, pixels(image));
        {
            ImageWriter writer(blocks, target, 1);
            const auto write_block = [&](int y, int rows) {
                writer.write_rows(const_view(rows_of(view_of(planar), y, rows)));
            };
            write_block(0, 1), write_block(1, 12), write_block(13, 0), write_block(13, 16);
            writer.finish();
        }
        EXPECT_TRUE(bytes_of(whole) == bytes_of(blocks));

        AnyImage again = make_image(depth, width, height, channels, Layout::planar);
        ImageReader reader(blocks, 1);
        const auto read_block = [&](int y, int rows) { reader.read_rows(y, rows_of(view_of(again), y, rows)); };
        read_block(0, 5), read_block(5, 1), read_block(6, 17), read_block(23, 6);
        EXPECT_TRUE(equal(pixels(image), pixels(again)));
        // Going back, and into an upside-down view.
        std::visit([&](const auto& v) { reader.read_rows(0, flipped_y(cropped(v, 0, 0, width, 3))); }, view_of(again));
        std::visit([&](const auto& v) { reader.read_rows(0, flipped_y(cropped(v, 0, 0, width, 3))); }, view_of(again));
        EXPECT_FALSE(equal(pixels(image), pixels(again)));
        read_block(0, 3);
        EXPECT_TRUE(equal(pixels(image), pixels(again)));
    });
}

TEST(ImageFile, LossyFormatsComeBackNearly) {
    const Folder folder;
    for (const std::string extension : {"jpg", "webp"})
        for (const int channels : {1, 3}) {
            if (extension == "webp" && channels == 1) continue;
            SCOPED_TRACE(extension);
            const std::string path = folder / ("a." + extension);
            Image<std::uint8_t> ramp(64, 64, channels, Layout::interleaved);
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x)
                    for (int c = 0; c < channels; ++c) ramp.view()(x, y, c) = static_cast<std::uint8_t>(2 * x + y + 20);
            write_image(path, target_of(Depth::u8, 64, 64, channels), AnyConstView(std::as_const(ramp).view()));
            ImageReader reader(path, 1);
            AnyImage first = read_image(reader), again = read_image(reader);
            EXPECT_TRUE(equal(pixels(first), pixels(again)));
            const auto v = std::get<View<std::uint8_t>>(view_of(again));
            ASSERT_EQ(v.channels, channels);
            // A ramp has hardly anything but DC to lose: rounding of colours (1), of DC (1), of the ramp's slope (2).
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x)
                    for (int c = 0; c < channels; ++c) ASSERT_NEAR(v(x, y, c), ramp.view()(x, y, c), 4);
        }
}

TEST(ImageFile, HdrKeepsEightBitsOfTheLargestChannel) {
    const Folder folder;
    const std::string path = folder / "a.hdr";
    AnyImage image = noise(Depth::f32, width, height, 3);
    write_image(path, target_of(Depth::f32, width, height, 3), pixels(image));
    AnyImage again = read_image(path);
    const auto a = std::get<View<float>>(view_of(image)), b = std::get<View<float>>(view_of(again));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float largest = std::max({a(x, y, 0), a(x, y, 1), a(x, y, 2)});
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(b(x, y, c), a(x, y, c), largest / 128);  // a code, cut not rounded
        }
}

TEST(ImageFile, AlphaIsNeverMultipliedNorDivided) {
    // Colour under zero alpha is the first thing that a multiplication would lose; noise() has codes for both.
    const Folder folder;
    for (const std::string extension : {"png", "tif", "tga"}) {
        const std::string path = folder / ("a." + extension);
        Image<std::uint8_t> image(2, 1, 4, Layout::interleaved);
        const std::array<int, 8> codes{200, 100, 50, 0, 10, 250, 3, 1};
        for (std::size_t i = 0; i < codes.size(); ++i) image.view().data[i] = static_cast<std::uint8_t>(codes[i]);
        write_image(path, target_of(Depth::u8, 2, 1, 4), AnyConstView(std::as_const(image).view()));
        ImageReader reader(path, 1);
        EXPECT_FALSE(reader.info().associated);
        for (int pass = 0; pass < 2; ++pass) {  // the second reading starts over
            AnyImage again = read_image(reader);
            EXPECT_TRUE(equal(pixels(again), AnyConstView(std::as_const(image).view())));
        }
    }
}

/// Writes through OpenImageIO alone: what other programs write.
void write_elsewhere(const std::string& format, const std::string& path, const OIIO::ImageSpec& spec,
                     const void* pixels) {
    const auto out = OIIO::ImageOutput::create(format);
    ASSERT_TRUE(out && out->open(path, spec)) << path;
    if (spec.tile_width > 0) {
        ASSERT_TRUE(
            out->write_tiles(spec.x, spec.x + spec.width, spec.y, spec.y + spec.height, 0, 1, spec.format, pixels));
    } else {
        ASSERT_TRUE(out->write_scanlines(spec.y, spec.y + spec.height, 0, spec.format, pixels));
    }
    ASSERT_TRUE(out->close());
}

TEST(ImageFile, AssociatedTiffIsSaidToBe) {
    const Folder folder;
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
    const std::array<std::uint8_t, 4> pixel{20, 10, 5, 40};
    write_elsewhere("tiff", folder / "a.tif", spec, pixel.data());
    ImageReader reader(folder / "a.tif", 1);
    EXPECT_TRUE(reader.info().associated);
    AnyImage image = read_image(reader);
    EXPECT_EQ(std::get<View<std::uint8_t>>(view_of(image))(0, 0, 0), 20);
}

TEST(ImageFile, WebpAlphaIsDividedAgain) {
    // OpenImageIO multiplies codes by alpha; the quotient is right to half a code over alpha.
    const Folder folder;
    const OIIO::ImageSpec spec(16, 16, 4, OIIO::TypeDesc::UINT8);
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 256; ++i) pixels.insert(pixels.end(), {60, 60, 60, 128});
    write_elsewhere("webp", folder / "a.webp", spec, pixels.data());
    const auto in = OIIO::ImageInput::open(folder / "a.webp");
    ASSERT_TRUE(in);
    in->read_scanlines(0, 0, 0, 16, 0, 0, 4, OIIO::TypeDesc::UINT8, pixels.data());
    ImageReader reader(folder / "a.webp", 1);
    EXPECT_FALSE(reader.info().associated);
    AnyImage image = read_image(reader);
    EXPECT_NEAR(std::get<View<std::uint8_t>>(view_of(image))(3, 3, 0), pixels[0] * 255.0 / 128, 0.5);
}

TEST(ImageFile, TilesLevelsAndDataWindowsAreRead) {
    const Folder folder;
    for (const std::string format : {"tiff", "openexr", "openexr scanlines"}) {
        SCOPED_TRACE(format);
        const bool is_tiled = format != "openexr scanlines";
        OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
        if (is_tiled) spec.tile_width = 16, spec.tile_height = 16;
        if (format != "tiff") spec.x = -5, spec.y = 7;
        AnyImage image = noise(Depth::f32, width, height, 3);
        write_elsewhere(format.substr(0, 7), folder / "tiled", spec, std::get<View<float>>(view_of(image)).data);
        ImageReader reader(folder / "tiled", 1);
        EXPECT_EQ(reader.info().levels, 1);
        AnyImage again = make_image(Depth::f32, width, height, 3);
        for (int y = 0; y < height; y += 5)
            reader.read_rows(y, cropped(std::get<View<float>>(view_of(again)), 0, y, width, std::min(5, height - y)));
        EXPECT_TRUE(equal(pixels(image), pixels(again)));
    }
}

TEST(ImageFile, TilesComeBackForAnyBlocksOfRows) {
    // Sizes that end within a tile, at its end, and before the first one ends; two tiles of 16 are a call, or many are.
    const Folder folder;
    for (const std::string extension : {"tif", "exr"})
        for (const Depth depth : abilities_of("x." + extension).depths)
            for (const int threads : {1, 4})
                for (const auto& [w, h, tile] :
                     {std::array{37, 29, 16}, {64, 32, 32}, {5, 3, 16}, {70, 49, 48}, {1, 40, 16}, {300, 20, 16}}) {
                    SCOPED_TRACE(message(extension, " ", name_of(depth), " ", w, " x ", h, " / ", tile));
                    const std::string path = folder / ("a." + extension);
                    AnyImage image = noise(depth, w, h, 4), again = make_image(depth, w, h, 4);
                    ImageTarget target = target_of(depth, w, h, 4);
                    target.tile = tile;
                    ImageWriter writer(path, target, threads);
                    for (int y = 0, rows = 1; y < h; y += rows, rows = std::min(rows + 6, h - y))
                        writer.write_rows(const_view(rows_of(view_of(image), y, rows)));
                    writer.finish();

                    const auto stored = OIIO::ImageInput::open(path);
                    ASSERT_TRUE(stored);
                    EXPECT_EQ(stored->spec().tile_width, tile);
                    EXPECT_EQ(stored->spec().tile_height, tile);
                    ImageReader reader(path, threads);
                    for (int y = 0, rows = 5; y < h; y += rows, rows = std::min(rows + 9, h - y))
                        reader.read_rows(y, rows_of(view_of(again), y, std::min(rows, h - y)));
                    EXPECT_TRUE(equal(pixels(image), pixels(again)));
                }
    EXPECT_EQ(folder.count(), 2) << "something else was left behind";
}

/// While it lives, memory is handed out full of a byte that depends on `value`, where the allocator can do that.
class FreshMemory {
public:
    explicit FreshMemory([[maybe_unused]] int value) {
#ifdef __GLIBC__
        mallopt(M_PERTURB, value);
#endif
    }
    ~FreshMemory() {
#ifdef __GLIBC__
        mallopt(M_PERTURB, 0);
#endif
    }
    FreshMemory(const FreshMemory&) = delete;
    FreshMemory& operator=(const FreshMemory&) = delete;
};

TEST(ImageFile, BytesDependNeitherOnThreadsNorOnMemoryNorOnTime) {
    // Tiles that end beyond the picture, rows that make several strips.
    const Folder folder;
    for (const std::string extension : {"tif", "exr"})
        for (const Depth depth : abilities_of("x." + extension).depths)
            for (const int tile : {0, 64}) {
                SCOPED_TRACE(message(extension, " ", name_of(depth), " / ", tile));
                AnyImage image = noise(depth, 400, 300, 3);
                ImageTarget target = target_of(depth, 400, 300, 3);
                target.tile = tile;
                std::string first;
                for (const int threads : {1, 2, 12, 24, 12, 24, 1}) {
                    const FreshMemory memory(threads);
                    const std::string path = folder / ("a." + extension);
                    ImageWriter writer(path, target, threads);
                    writer.write_rows(pixels(image));
                    writer.finish();
                    if (first.empty()) first = bytes_of(path);
                    EXPECT_TRUE(bytes_of(path) == first) << threads << " threads";
                }
            }
}

TEST(ImageFile, ManyThreadsReadAndWriteAtOnceEachWithItsOwnCount) {
    const Folder folder;
    AnyImage image = noise(Depth::u8, 40, 30, 3);
    ImageTarget target = target_of(Depth::u8, 40, 30, 3);
    target.tile = 16;
    std::atomic<int> wrong = 0;
    const auto work = [&](int worker) {
        const std::string path = folder / (std::to_string(worker) + ".tif");
        for (int i = 0; i < 25; ++i) {
            const int threads = 1 + (worker + i) % 12;
            ImageWriter writer(path, target, threads);
            writer.write_rows(pixels(image));
            writer.finish();
            ImageReader reader(path, 13 - threads);
            AnyImage again = read_image(reader);
            if (!equal(pixels(image), pixels(again))) ++wrong;
        }
    };
    std::vector<std::thread> workers;
    for (int worker = 0; worker < 24; ++worker) workers.emplace_back(work, worker);
    for (std::thread& worker : workers) worker.join();
    EXPECT_EQ(wrong, 0);
}

TEST(ImageFile, ManyTilesTakeSeveralCalls) {
    // 2048 x 16 tiles of 16 floats: more bytes than go through OpenImageIO at once.
    const Folder folder;
    constexpr int w = 20000, h = 33, tile = 32;
    AnyImage image = noise(Depth::f32, w, h, 8);
    ImageTarget target = target_of(Depth::f32, w, h, 8);
    target.tile = tile;
    write_image(folder / "a.tif", target, pixels(image));
    AnyImage again = read_image(folder / "a.tif");
    EXPECT_TRUE(equal(pixels(image), pixels(again)));
}

TEST(ImageFile, TilesThatNoFileHasAreRefused) {
    const Folder folder;
    ImageTarget target = target_of(Depth::u8, 40, 30, 3);
    for (const int tile : {-16, 1, 8, 17, 24, 4112, 1 << 30}) {
        target.tile = tile;
        EXPECT_THROW(ImageWriter(folder / "a.tif", target, 1), Error) << tile;
    }
    target.tile = 16;
    EXPECT_THROW(ImageWriter(folder / "a.png", target, 1), Error);
    EXPECT_EQ(folder.count(), 0);
}

TEST(ImageFile, LevelsAndSubimagesAreCounted) {
    const Folder folder;
    OIIO::ImageBuf picture(OIIO::ImageSpec(32, 32, 1, OIIO::TypeDesc::FLOAT));
    ASSERT_TRUE(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, picture, folder / "m.exr", {}));
    const ImageReader mips(folder / "m.exr", 1);
    EXPECT_EQ(mips.info().levels, 6);
    EXPECT_EQ(mips.info().width, 32);

    const auto pages = OIIO::ImageOutput::create("tiff");
    const OIIO::ImageSpec page(3, 2, 1, OIIO::TypeDesc::UINT8);
    const std::array<std::uint8_t, 6> codes{1, 2, 3, 4, 5, 6};
    ASSERT_TRUE(pages->open(folder / "p.tif", page) && pages->write_image(OIIO::TypeDesc::UINT8, codes.data()));
    ASSERT_TRUE(pages->open(folder / "p.tif", page, OIIO::ImageOutput::AppendSubimage));
    ASSERT_TRUE(pages->write_image(OIIO::TypeDesc::UINT8, codes.data()));
    pages->close();
    EXPECT_EQ(ImageReader(folder / "p.tif", 1).info().subimages, 2);
}

TEST(ImageFile, OtherTypesBecomeTheNextThatHoldsThem) {
    const Folder folder;
    const std::vector<std::uint64_t> zeros(64);
    const auto depth_read = [&](const std::string& format, OIIO::TypeDesc type) {
        write_elsewhere(format, folder / "a", OIIO::ImageSpec(8, 8, 1, type), zeros.data());
        return ImageReader(folder / "a", 1).info().depth;
    };
    EXPECT_EQ(depth_read("tiff", OIIO::TypeDesc::UINT32), Depth::f32);
    EXPECT_EQ(depth_read("tiff", OIIO::TypeDesc::DOUBLE), Depth::f32);
    EXPECT_EQ(depth_read("openexr", OIIO::TypeDesc::HALF), Depth::f16);
    EXPECT_EQ(depth_read("openexr", OIIO::TypeDesc::UINT32), Depth::f32);

    write_bytes(folder / "b.pbm", "P4\n3 1\n\x40");
    AnyImage bits = read_image(folder / "b.pbm");
    const auto v = std::get<View<std::uint8_t>>(view_of(bits));  // 1 is black in PBM
    EXPECT_EQ(v(0, 0), 255);
    EXPECT_EQ(v(1, 0), 0);
}

TEST(ImageFile, MixedExrChannelsBecomeFloat) {
    const Folder folder;
    OIIO::ImageSpec spec(2, 1, 2, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"Y", "Z"};
    spec.channelformats = {OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT};
    const std::array<float, 4> pixels{0.5f, 1e-9f, 2, 123456.75f};
    write_elsewhere("openexr", folder / "a.exr", spec, pixels.data());
    AnyImage image = read_image(folder / "a.exr");
    ASSERT_TRUE(std::holds_alternative<Image<float>>(image));
    const auto v = std::get<View<float>>(view_of(image));
    EXPECT_EQ(v(0, 0, 0), 0.5f);
    EXPECT_EQ(v(0, 0, 1), 1e-9f);
    EXPECT_EQ(v(1, 0, 1), 123456.75f);
}

TEST(ImageFile, PfmLiesAsOthersReadIt) {
    // Rows from bottom to top, the sign of the scale says which byte comes first.
    const Folder folder;
    Image<float> image(1, 2);
    image.view()(0, 0) = 1, image.view()(0, 1) = 2;
    write_image(folder / "a.pfm", target_of(Depth::f32, 1, 2, 1), AnyConstView(std::as_const(image).view()));
    const std::string one("\0\0\x80\x3f", 4), two("\0\0\0\x40", 4);
    EXPECT_EQ(bytes_of(folder / "a.pfm"), "Pf\n1 2\n-1.0\n" + two + one);
}

TEST(ImageFile, EverySixteenBitCodeOfPnmIsReadAndOtherWhitesAreScaled) {
    const Folder folder;
    Image<std::uint16_t> codes(256, 256);
    for (int i = 0; i < 65536; ++i) codes.view()(i % 256, i / 256) = static_cast<std::uint16_t>(i);
    write_image(folder / "a.pgm", target_of(Depth::u16, 256, 256, 1), AnyConstView(std::as_const(codes).view()));
    AnyImage again = read_image(folder / "a.pgm");
    EXPECT_TRUE(equal(pixels(again), AnyConstView(std::as_const(codes).view())));

    write_bytes(folder / "b.pgm",
                std::string("P5 # white is\n#1000\n 2\t1 1000\n") + std::string("\x01\xf4\x03\xe8", 4));
    AnyImage scaled = read_image(folder / "b.pgm");
    EXPECT_EQ(std::get<View<std::uint16_t>>(view_of(scaled))(0, 0), 32768);
    EXPECT_EQ(std::get<View<std::uint16_t>>(view_of(scaled))(1, 0), 65535);
}

TEST(ImageFile, ViewsAndRowsThatDoNotFitAreRefused) {
    const Folder folder;
    AnyImage image = noise(Depth::u8, 4, 3, 3);
    const ImageTarget target = target_of(Depth::u8, 4, 3, 3);
    write_image(folder / "a.png", target, pixels(image));
    ImageReader reader(folder / "a.png", 1);
    const auto v = std::get<View<std::uint8_t>>(view_of(image));
    EXPECT_THROW(reader.read_rows(1, v), Error);
    EXPECT_THROW(reader.read_rows(-1, cropped(v, 0, 0, 4, 1)), Error);
    EXPECT_THROW(reader.read_rows(0, cropped(v, 0, 0, 3, 1)), Error);
    EXPECT_THROW(reader.read_rows(0, channels_of(v, 0)), Error);
    AnyImage floats = make_image(Depth::f32, 4, 3, 3);
    EXPECT_THROW(reader.read_rows(0, view_of(floats)), Error);
    EXPECT_NO_THROW(reader.read_rows(0, v));

    ImageWriter writer(folder / "b.png", target, 1);
    EXPECT_THROW(writer.write_rows(pixels(floats)), Error);
    EXPECT_THROW(writer.finish(), Error) << "rows are missing";
    writer.write_rows(pixels(image));
    EXPECT_THROW(writer.write_rows(pixels(image)), Error);
    writer.finish();
}

}  // namespace
}  // namespace bandlimit
