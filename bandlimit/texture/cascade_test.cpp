#include "bandlimit/texture/cascade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/texture/texture.h"

namespace bandlimit {
namespace {

Image<std::uint8_t> codes(int width, int height, int channels) {
    Image<std::uint8_t> image(width, height, channels, Layout::interleaved);
    Random random(static_cast<std::uint64_t>(width + 1000 * height));
    const auto v = image.view();
    std::generate_n(v.data, width * height * channels,
                    [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); });
    return image;
}

using Levels = std::vector<Image<float>>;

Levels empty_levels(int width, int height, int channels, int count) {
    Levels levels;
    for (int l = 1; l < count; ++l)
        levels.emplace_back(mip_length(width, l), mip_length(height, l), channels, Layout::interleaved);
    return levels;
}

/// The definition: whole levels, one after another.
Levels by_levels(const Image<std::uint8_t>& base, const Encoding& stored, int count, const ResizeOptions& options) {
    Levels levels = empty_levels(base.width(), base.height(), base.channels(), count);
    AnyConstView above = base.view();
    Encoding encoding = stored;
    for (int l = 1; l < count; ++l) {
        const View<float> v = levels[static_cast<std::size_t>(l - 1)].view();
        const Grid from{{mip_length(base.width(), l - 1)}, {mip_length(base.height(), l - 1)}};
        const Encoding linear{Transfer::linear, stored.alpha, true};
        Resizer(from, {{v.width}, {v.height}}, v.channels, options).run({above, 0, encoding}, {v, 0, linear, {}}, {1});
        above = View<const float>(v), encoding = linear;
    }
    return levels;
}

Levels by_cascade(const Image<std::uint8_t>& base, const Encoding& stored, int count, const ResizeOptions& options,
                  Parallel parallel) {
    Levels levels = empty_levels(base.width(), base.height(), base.channels(), count);
    std::vector<int> expected(levels.size(), 0);
    MipCascade cascade(base.width(), base.height(), base.channels(), stored, count, options, parallel);
    int begin = 0;
    for (int step = 0; step < cascade.steps(); ++step) {
        const IndexRange needed = cascade.rows_needed(step);
        EXPECT_GE(needed.begin, begin);
        begin = needed.begin;
        const auto rows = cropped(base.view(), 0, needed.begin, base.width(), needed.end - needed.begin);
        cascade.advance(rows, needed.begin, [&](int level, int first, View<const float> made) {
            const auto l = static_cast<std::size_t>(level - 1);
            EXPECT_EQ(first, expected[l]);  // top to bottom, nothing twice
            expected[l] += made.height;
            std::copy_n(made.data, made.height * made.dy, &levels[l].view()(0, first));
        });
    }
    for (std::size_t l = 0; l < levels.size(); ++l) EXPECT_EQ(expected[l], levels[l].height()) << "level " << l + 1;
    return levels;
}

bool same_bits(const Image<float>& a, const Image<float>& b) {
    const auto v = a.view();
    return std::memcmp(v.data, b.view().data, sizeof(float) * static_cast<std::size_t>(v.height * v.dy)) == 0;
}

TEST(MipCascade, HasTheBitsOfWholeLevelsOneAfterAnother) {
    const Encoding stored{Transfer::srgb, 3, false};
    struct Size {
        int width, height;
    };
    for (const Size size : {Size{64, 1000}, {33, 777}, {4, 4096}, {3, 5000}, {1, 300}, {300, 1}, {5, 3}, {1, 1}})
        for (const Edge edge : {Edge::renormalize, Edge::wrap})
            for (const int threads : {1, 3}) {
                const Image<std::uint8_t> base = codes(size.width, size.height, 4);
                const int count = mip_count(size.width, size.height);
                ResizeOptions options;
                options.edge = edge;
                const Levels whole = by_levels(base, stored, count, options);
                const Levels pieces = by_cascade(base, stored, count, options, {threads});
                for (std::size_t l = 0; l < whole.size(); ++l)
                    EXPECT_TRUE(same_bits(whole[l], pieces[l]))
                        << size.width << " x " << size.height << ", edge " << name_of(edge) << ", level " << l + 1;
            }
}

TEST(MipCascade, KeepsNoRowsWhereTheKernelSkipsThem) {
    // Of two rows nearest reads one: the next that a level needs may lie below all that are made.
    ResizeOptions options;
    options.reconstruction = nearest();
    for (const int height : {777, 5000})
        for (const int threads : {1, 3}) {
            const Image<std::uint8_t> base = codes(3, height, 1);
            const int count = mip_count(3, height);
            const Levels whole = by_levels(base, {}, count, options);
            const Levels pieces = by_cascade(base, {}, count, options, {threads});
            for (std::size_t l = 0; l < whole.size(); ++l)
                EXPECT_TRUE(same_bits(whole[l], pieces[l])) << height << " rows, level " << l + 1;
        }
}

TEST(MipCascade, KeepsAlphaMultipliedWhereItComesSo) {
    const Image<std::uint8_t> base = codes(5, 300, 4);
    const Encoding stored{Transfer::linear, 3, true};
    for (const bool premultiply : {true, false}) {
        ResizeOptions options;
        options.premultiply = premultiply;
        const Levels whole = by_levels(base, stored, 5, options);
        const Levels pieces = by_cascade(base, stored, 5, options, {1});
        for (std::size_t l = 0; l < whole.size(); ++l) EXPECT_TRUE(same_bits(whole[l], pieces[l])) << "level " << l + 1;
    }
}

TEST(MipCascade, StopsAtTheLevelsAskedFor) {
    const Image<std::uint8_t> base = codes(16, 16, 1);
    EXPECT_EQ(by_cascade(base, {}, 3, {}, {}).size(), 2u);
    EXPECT_EQ(MipCascade(16, 16, 1, {}, 1, {}).steps(), 0);
    EXPECT_THROW(MipCascade(16, 16, 1, {}, 6, {}), Error);
    EXPECT_THROW(MipCascade(16, 0, 1, {}, 1, {}), Error);
}

TEST(MipCascade, RefusesRowsThatDoNotHoldWhatIsNeeded) {
    const Image<std::uint8_t> base = codes(16, 16, 1);
    MipCascade cascade(16, 16, 1, {}, 5, {});
    const auto ignore = [](int, int, View<const float>) {};
    EXPECT_THROW(cascade.advance(cropped(base.view(), 0, 0, 16, 15), 0, ignore), Error);
    cascade.advance(base.view(), 0, ignore);
    EXPECT_THROW(cascade.advance(base.view(), 0, ignore), Error);
}

}  // namespace
}  // namespace bandlimit
