// Shapes of textures, and what check_texture() refuses.
#include "bandlimit/texture/texture.h"

#include "bandlimit/core/error.h"
#include "bandlimit/texture/textures_test.h"

namespace bandlimit {
namespace {

TEST(Texture, LevelsHalveRoundedDownUntilOne) {
    EXPECT_EQ(mip_length(903, 0), 903);
    EXPECT_EQ(mip_length(903, 1), 451);
    EXPECT_EQ(mip_length(903, 9), 1);
    EXPECT_EQ(mip_length(903, 10), 1);
    EXPECT_EQ(mip_length(0x7fffffff, 30), 1);
    EXPECT_EQ(mip_length(1, 100), 1);
    EXPECT_EQ(mip_count(1, 1), 1);
    EXPECT_EQ(mip_count(903, 451), 10);
    EXPECT_EQ(mip_count(1, 1024), 11);
    EXPECT_EQ(mip_count(1023, 1), 10);
    EXPECT_EQ(mip_count(0x7fffffff, 1), 31);
    for (int width = 2; width < 70; ++width) {
        EXPECT_EQ(mip_length(width, mip_count(width, 1) - 1), 1);
        EXPECT_GT(mip_length(width, mip_count(width, 1) - 2), 1);
    }
}

TEST(Texture, EncodingSaysWhatTexelsMean) {
    const Encoding color = encoding_of({.channels = 4, .srgb = true, .premultiplied = true}, false);
    EXPECT_EQ(color.transfer, Transfer::srgb);
    EXPECT_EQ(color.alpha, 3);
    EXPECT_TRUE(color.associated);
    EXPECT_EQ(encoding_of({.channels = 4}, true).alpha, -1);
    EXPECT_EQ(encoding_of({.channels = 2}, false).alpha, -1);
    EXPECT_EQ(encoding_of({.channels = 1}, false).transfer, Transfer::linear);
}

TEST(Texture, EveryShapePassesTheCheck) {
    for (const TexelFormat& format : all_texel_formats())
        EXPECT_NO_THROW(check_texture(noise_texture(format, {5, 3, 2})));
    const Texture cubes = noise_texture({}, {4, 4, 3, true, 2});
    EXPECT_NO_THROW(check_texture(cubes));
    EXPECT_EQ(cubes.width(), 4);
    EXPECT_EQ(cubes.height(), 4);
    EXPECT_EQ(&cubes.image(2, 1, 3), &cubes.levels[2][9]);
    EXPECT_THROW((void)cubes.image(3), std::out_of_range);
}

/// Whether check_texture() throws an Error with `word` in it, once `change` was made to a cube array.
template <class Change>
::testing::AssertionResult is_wrong_after(Change change, const std::string& word) {
    Texture texture = noise_texture({}, {4, 4, 3, true, 2});
    change(texture);
    try {
        check_texture(texture);
    } catch (const Error& e) {
        const std::string what = e.what();
        return (what.find(word) != what.npos ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << what;
    }
    return ::testing::AssertionFailure() << "no error";
}

TEST(Texture, WhatContradictsItselfIsRefused) {
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.format.channels = 3; }, "3 channels"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.format.channels = 2; }, "number of channels"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.format.depth = Depth::u16; }, "depth"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.format.depth = Depth::f32, t.format.srgb = true; }, "sRGB"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.format.channels = 1, t.format.premultiplied = true; }, "alpha"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.layers = 0; }, "0 layers"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.layers = most_layers + 1; }, "layers"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.is_array = false; }, "2 layers"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.layers = 3; }, "12 images"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.is_cube = false; }, "12 images"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels.clear(); }, "no image"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[0].clear(); }, "no image"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[1].pop_back(); }, "11 images"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels.erase(t.levels.begin() + 1); }, "due"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels.emplace_back(); }, "4 levels"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[0][0] = make_image(Depth::u8, 4, 2, 4); }, "squares"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[0][0] = make_image(Depth::u8, 0, 0, 4); }, "0 x 0"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[1][5] = make_image(Depth::u8, 3, 2, 4); }, "3 x 2"));
    EXPECT_TRUE(is_wrong_after([](Texture& t) { t.levels[1][5] = make_image(Depth::u8, 2, 2, 4, Layout::planar); },
                               "interleaved"));
}

}  // namespace
}  // namespace bandlimit
