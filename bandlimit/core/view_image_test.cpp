#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/core/view.h"

namespace bandlimit {
namespace {

/// Samples whose value tells where they are.
struct Labelled {
    std::vector<int> samples;
    View<int> view;
};
int label(int x, int y, int c) { return 10000 * c + 100 * y + x; }

Labelled labelled(int width, int height, int channels) {
    Labelled l{std::vector<int>(static_cast<std::size_t>(width * height * channels)), {}};
    l.view = {l.samples.data(), width, height, channels, channels, std::ptrdiff_t{width} * channels, 1};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) l.view(x, y, c) = label(x, y, c);
    return l;
}

template <class At>
void expect_everywhere(View<const int> v, int width, int height, int channels, At at) {
    ASSERT_EQ(v.width, width);
    ASSERT_EQ(v.height, height);
    ASSERT_EQ(v.channels, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) ASSERT_EQ(v(x, y, c), at(x, y, c)) << x << ' ' << y << ' ' << c;
}

TEST(View, TransposeFlipCropAndChannelsMoveNoSample) {
    const Labelled l = labelled(7, 5, 3);
    const View<int> v = l.view;
    expect_everywhere(transposed(v), 5, 7, 3, [](int x, int y, int c) { return label(y, x, c); });
    expect_everywhere(flipped_x(v), 7, 5, 3, [](int x, int y, int c) { return label(6 - x, y, c); });
    expect_everywhere(flipped_y(v), 7, 5, 3, [](int x, int y, int c) { return label(x, 4 - y, c); });
    expect_everywhere(cropped(v, 2, 1, 4, 3), 4, 3, 3, [](int x, int y, int c) { return label(x + 2, y + 1, c); });
    expect_everywhere(channels_of(v, 1, 2), 7, 5, 2, [](int x, int y, int c) { return label(x, y, c + 1); });
}

TEST(View, OperationsCompose) {
    const Labelled l = labelled(6, 4, 2);
    const View<int> v = l.view;
    const auto same = [](int x, int y, int c) { return label(x, y, c); };
    expect_everywhere(flipped_x(flipped_x(v)), 6, 4, 2, same);
    expect_everywhere(flipped_y(flipped_y(v)), 6, 4, 2, same);
    expect_everywhere(transposed(transposed(v)), 6, 4, 2, same);
    expect_everywhere(transposed(flipped_y(transposed(v))), 6, 4, 2,
                      [](int x, int y, int c) { return label(5 - x, y, c); });
    expect_everywhere(cropped(flipped_x(v), 1, 0, 3, 4), 3, 4, 2,
                      [](int x, int y, int c) { return label(4 - x, y, c); });
}

TEST(View, SameShapeComparesAllThree) {
    const View<int> v{nullptr, 3, 4, 2};
    EXPECT_TRUE(same_shape(v, View<const float>{nullptr, 3, 4, 2}));
    EXPECT_FALSE(same_shape(v, View<int>{nullptr, 4, 3, 2}));
    EXPECT_FALSE(same_shape(v, View<int>{nullptr, 3, 5, 2}));
    EXPECT_FALSE(same_shape(v, View<int>{nullptr, 3, 4, 1}));
}

TEST(Image, HasOneZeroedPlaceForEachSample) {
    for (const Layout layout : {Layout::planar, Layout::interleaved})
        for (const auto& [w, h, c] : {std::tuple{1, 1, 1}, {7, 5, 3}, {40, 1, 4}, {1, 33, 2}}) {
            Image<int> image(w, h, c, layout);
            std::set<const int*> places;
            const View<int> v = image.view();
            for (int y = 0; y < h; ++y)
                for (int x = 0; x < w; ++x)
                    for (int k = 0; k < c; ++k) {
                        ASSERT_EQ(v(x, y, k), 0);
                        places.insert(&v(x, y, k));
                    }
            const auto count = static_cast<std::size_t>(w * h * c);
            ASSERT_EQ(places.size(), count);
            ASSERT_EQ(static_cast<std::size_t>(*places.rbegin() - *places.begin()) + 1, count) << "no gaps";
            ASSERT_EQ(v.dc, layout == Layout::interleaved ? 1 : w * h);
        }
}

TEST(Image, CloneIsEqualAndIndependent) {
    for (const Layout layout : {Layout::planar, Layout::interleaved}) {
        Image<float> image(3, 2, 2, layout);
        image.view()(2, 1, 1) = 5;
        Image<float> copy = image.clone();
        EXPECT_TRUE(same_shape(copy.view(), image.view()));
        EXPECT_EQ(copy.view().dx, image.view().dx);
        EXPECT_EQ(copy.view()(2, 1, 1), 5);
        copy.view()(2, 1, 1) = 6;
        EXPECT_EQ(image.view()(2, 1, 1), 5);
    }
}

TEST(Image, MovesItsSamples) {
    Image<float> image(3, 2);
    const float* data = image.view().data;
    const Image<float> moved = std::move(image);
    EXPECT_EQ(moved.view().data, data);
    EXPECT_EQ(moved.width(), 3);
    EXPECT_EQ(moved.height(), 2);
    EXPECT_EQ(moved.channels(), 1);
}

TEST(Image, RefusesNegativeSizes) {
    EXPECT_THROW(Image<float>(-1, 2), Error);
    EXPECT_THROW(Image<float>(1, -2), Error);
    EXPECT_THROW(Image<float>(1, 2, 0), Error);
    EXPECT_NO_THROW(Image<float>(0, 2));
}

TEST(View, OfMemoryAsItLies) {
    std::vector<int> memory(60);
    std::iota(memory.begin(), memory.end(), 0);
    const View<int> rgb = interleaved(memory.data(), 3, 2, 3);
    EXPECT_EQ(rgb(2, 1, 1), 2 * 3 + 1 * 9 + 1);
    EXPECT_EQ(interleaved(memory.data(), 3, 2, 3, 20)(2, 1, 1), 2 * 3 + 1 * 20 + 1) << "padded rows";
    EXPECT_EQ(interleaved(memory.data() + 40, 3, 3, 3, -20)(2, 2, 1), 40 - 2 * 20 + 2 * 3 + 1) << "from the bottom up";
    EXPECT_EQ(planar(memory.data(), 5, 3)(4, 2), 4 + 2 * 5);
    EXPECT_EQ(planar(memory.data(), 5, 3, 2)(4, 2, 1), 4 + 2 * 5 + 15);
    EXPECT_EQ(planar(memory.data(), 5, 3, 2, 8)(4, 2, 1), 4 + 2 * 8 + 24);
    EXPECT_EQ(planar(memory.data(), 5, 3, 2, 8, 30)(4, 2, 1), 4 + 2 * 8 + 30);
}

}  // namespace
}  // namespace bandlimit
