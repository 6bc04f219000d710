#include "bandlimit/io/orientation.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

/// Where the stored sample (x, y) of w x h belongs in the upright picture, from the text of the standard: the first row
/// is the visual top, top, bottom, bottom, left, right, right, left; the first column the left, right, right, left,
/// top, top, bottom, bottom.
std::pair<int, int> place(int orientation, int x, int y, int w, int h) {
    const int right = w - 1 - x, down = h - 1 - y;
    switch (orientation) {
        case 1: return {x, y};
        case 2: return {right, y};
        case 3: return {right, down};
        case 4: return {x, down};
        case 5: return {y, x};
        case 6: return {down, x};
        case 7: return {down, right};
        default: return {y, right};
    }
}

TEST(Orientation, UprightFollowsTheStandard) {
    const int w = 5, h = 3;
    Image<float> stored(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) stored.view()(x, y) = static_cast<float>(10 * y + x);
    for (int orientation = 1; orientation <= 8; ++orientation) {
        const View<float> picture = upright(stored.view(), orientation);
        EXPECT_EQ(picture.width, is_sideways(orientation) ? h : w);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const auto [u, v] = place(orientation, x, y, w, h);
                EXPECT_EQ(picture(u, v), stored.view()(x, y)) << "orientation " << orientation;
            }
    }
}

TEST(Orientation, FilesWithATagAreReadUprightAndWrittenWithout) {
    const Folder folder;
    const int w = 19, h = 11;
    for (const bool is_tiled : {false, true})
        for (int orientation = 1; orientation <= 8; ++orientation) {
            SCOPED_TRACE(orientation);
            AnyImage stored = noise(Depth::u16, w, h, 3);
            OIIO::ImageSpec spec(w, h, 3, OIIO::TypeDesc::UINT16);
            spec.attribute("Orientation", orientation);
            if (is_tiled) spec.tile_width = spec.tile_height = 16;
            const auto out = OIIO::ImageOutput::create("tiff");
            ASSERT_TRUE(out->open(folder / "a.tif", spec));
            ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT16, std::get<View<std::uint16_t>>(view_of(stored)).data));
            out->close();

            ImageReader reader(folder / "a.tif", 1);
            EXPECT_EQ(reader.info().orientation, orientation);
            const auto expected = upright(std::get<View<std::uint16_t>>(view_of(stored)), orientation);
            ASSERT_EQ(reader.info().width, expected.width);
            AnyImage again = make_image(Depth::u16, expected.width, expected.height, 3);
            const auto v = std::get<View<std::uint16_t>>(view_of(again));
            for (int y = 0; y < v.height; y += 4)
                reader.read_rows(y, cropped(v, 0, y, v.width, std::min(4, v.height - y)));
            EXPECT_TRUE(equal(const_view(AnyView(expected)), pixels(again)));

            ImageTarget target = target_of(Depth::u16, v.width, v.height, 3);
            target.metadata = &reader.metadata();
            write_image(folder / "b.tif", target, pixels(again));
            EXPECT_EQ(ImageReader(folder / "b.tif", 1).info().orientation, 1);
        }
}

}  // namespace
}  // namespace bandlimit
