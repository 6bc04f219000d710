#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/texture/container.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {
namespace {

constexpr TexelFormat srgb8{.channels = 4, .depth = Depth::u8, .srgb = true};
constexpr TexelFormat unorm8{.channels = 4, .depth = Depth::u8};

Image<std::uint8_t> codes(int width, int height, int channels) {
    Image<std::uint8_t> image(width, height, channels, Layout::interleaved);
    Random random(3);
    std::generate_n(image.view().data, width * height * channels,
                    [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); });
    return image;
}

/// Levels from windows that hold no row more than is needed.
std::vector<AnyImage> streamed(const Image<std::uint8_t>& base, const Encoding& stored, const TexelFormat& target,
                               const MipOptions& options) {
    MipStream stream(base.width(), base.height(), base.channels(), Depth::u8, stored, target, options, {2});
    std::vector<AnyImage> images;
    for (int level = 0; level < stream.levels(); ++level)
        images.push_back(make_image(target.depth, mip_length(base.width(), level), mip_length(base.height(), level),
                                    target.channels));
    std::vector<int> finished(images.size(), 0);
    const MipStream::Sink sink{[&](int level, int first, int count) {
                                   return rows_of(view_of(images[static_cast<std::size_t>(level)]), first, count);
                               },
                               [&](int level, int first, const AnyView& rows) {
                                   EXPECT_EQ(first, finished[static_cast<std::size_t>(level)]);
                                   finished[static_cast<std::size_t>(level)] +=
                                       std::visit([](const auto& v) { return v.height; }, rows);
                               }};
    for (int step = 0; step < stream.steps(); ++step) {
        const IndexRange needed = stream.rows_needed(step);
        const int count = needed.end - needed.begin;
        // A copy, so that a read outside of the window is one outside of memory.
        Image<std::uint8_t> window(base.width(), count, base.channels(), Layout::interleaved);
        std::copy_n(&base.view()(0, needed.begin), count * base.view().dy, window.view().data);
        stream.advance(window.view(), needed.begin, sink);
    }
    for (int level = 0; level < stream.levels(); ++level)
        EXPECT_EQ(finished[static_cast<std::size_t>(level)], mip_length(base.height(), level));
    return images;
}

bool same_bytes(const std::vector<AnyImage>& a, const std::vector<AnyImage>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const AnyImage& left, const AnyImage& right) {
        const auto x = bytes_of(left), y = bytes_of(right);
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size()) == 0;
    });
}

TEST(MipStream, HasTheBitsOfTheChainInMemory) {
    const Encoding color{Transfer::srgb, 3, false};
    struct Case {
        Role role;
        int channels;
        Encoding stored;
        TexelFormat target;
    };
    for (const Case& c : {Case{Role::color, 4, color, srgb8},
                          {Role::color, 3, {Transfer::srgb}, srgb8},
                          {Role::data, 4, {}, unorm8},
                          {Role::normal, 3, {}, unorm8},
                          {Role::mask, 1, {}, unorm8}})
        for (const Edge edge : {Edge::renormalize, Edge::wrap})
            for (const int height : {1, 5, 1100}) {
                const Image<std::uint8_t> base = codes(9, height, c.channels);
                MipOptions options;
                options.role = c.role, options.edge_x = options.edge_y = edge;
                EXPECT_TRUE(same_bytes(streamed(base, c.stored, c.target, options),
                                       make_mips(base.view(), c.stored, c.target, options).images))
                    << name_of(c.role) << ", " << c.channels << " channels, edge " << name_of(edge) << ", " << height
                    << " rows";
            }
}

TEST(MipStream, StoresAllOfLevelZeroWhereTheKernelSkipsRows) {
    const Image<std::uint8_t> base = codes(4, 1001, 4);
    MipOptions options;
    options.role = Role::data, options.filter = nearest(), options.levels = 2;
    EXPECT_TRUE(same_bytes(streamed(base, {}, unorm8, options), make_mips(base.view(), {}, unorm8, options).images));
    options.levels = 1;
    const std::vector<AnyImage> only_base = streamed(base, {}, unorm8, options);
    ASSERT_EQ(only_base.size(), 1u);
    EXPECT_EQ(std::memcmp(bytes_of(only_base[0]).data(), base.view().data, bytes_of(only_base[0]).size()), 0);
}

TEST(MipStream, TellsWhichLevelsLoseWhatIsNotFinite) {
    // NaN in level 0; and a step between the largest floats, over which the sums of level 1 alone shoot.
    MipOptions options;
    options.role = Role::data, options.filter = lanczos(3);
    const auto loses = [&](const Image<float>& base, int levels) {
        options.levels = levels;
        return make_mips(base.view(), {}, {.channels = 1, .depth = Depth::u8}, options).lost_non_finite;
    };
    Image<float> step(32, 1), nan(32, 1);
    for (int x = 0; x < 32; ++x)
        step.view()(x, 0) = std::numeric_limits<float>::max() * (x < 16 ? -1.0f : 1.0f), nan.view()(x, 0) = 0.5f;
    nan.view()(31, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(loses(nan, 1));
    EXPECT_FALSE(loses(step, 1));
    EXPECT_TRUE(loses(step, 2));
}

TEST(MipStream, RefusesRowsThatDoNotHoldWhatIsNeeded) {
    const Image<std::uint8_t> base = codes(4, 1000, 4);
    MipStream stream(4, 1000, 4, Depth::u8, {}, unorm8, {.role = Role::data}, {1});
    AnyImage block;
    const MipStream::Sink nowhere{[&](int level, int, int count) {
                                      block = make_image(Depth::u8, mip_length(4, level), count, 4);
                                      return view_of(block);
                                  },
                                  [](int, int, const AnyView&) {}};
    const auto rows = [&](int begin, int end) { return cropped(base.view(), 0, begin, 4, end - begin); };
    for (int step = 0; step < stream.steps(); ++step) {
        const IndexRange needed = stream.rows_needed(step);
        EXPECT_THROW(stream.advance(rows(needed.begin + 1, needed.end), needed.begin + 1, nowhere), Error);
        EXPECT_THROW(stream.advance(rows(needed.begin, needed.end - 1), needed.begin, nowhere), Error);
        stream.advance(rows(needed.begin, needed.end), needed.begin, nowhere);
    }
    EXPECT_GT(stream.steps(), 2);
    EXPECT_THROW(stream.advance(base.view(), 0, nowhere), Error);
    MipStream only_base(4, 1000, 4, Depth::u8, {}, unorm8, {.role = Role::data, .levels = 1}, {1});
    EXPECT_EQ(MipStream(4, 512, 4, Depth::u8, {}, unorm8, {.role = Role::data, .levels = 1}).steps(), 2);
    for (int step = 0; step < only_base.steps(); ++step) only_base.advance(base.view(), 0, nowhere);
    EXPECT_THROW(only_base.advance(base.view(), 0, nowhere), Error);
}

TEST(MipStream, RefusesWhatNeedsWholeLevels) {
    MipOptions options;
    for (const Role role : {Role::roughness, Role::alpha_tested}) {
        options.role = role;
        EXPECT_FALSE(MipStream::is_possible(options, 4));
        EXPECT_THROW(MipStream(8, 8, 4, Depth::u8, {}, unorm8, options), Error);
    }
    options.role = Role::data, options.from = MipSource::base;
    EXPECT_FALSE(MipStream::is_possible(options, 4));
    options.from = MipSource::previous, options.filter = downsample8();
    EXPECT_FALSE(MipStream::is_possible(options, 4));
}

}  // namespace
}  // namespace bandlimit
