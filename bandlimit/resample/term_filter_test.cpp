#include "bandlimit/resample/term_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/fetch_banks.h"
#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

double bilinear(const Image<float>& image, double u, double v, Edge edge) {
    // u, v in texels, centres at halves
    double sum = 0;
    const double x = u - 0.5, y = v - 0.5;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int s = static_cast<int>(std::floor(x)) + i, t = static_cast<int>(std::floor(y)) + j;
            const int at_x = resolve(s, image.width(), edge), at_y = resolve(t, image.height(), edge);
            const double weight = (1 - std::abs(x - s)) * (1 - std::abs(y - t));
            if (at_x >= 0 && at_y >= 0) sum += weight * static_cast<double>(image.view()(at_x, at_y));
        }
    return sum;
}

/// The fetches as a shader runs them: one read after the other.
double shaded(const Fetches& fetches, const Image<float>& image, int x, int y, int width, int height, Edge edge) {
    const double ratio_x = double(image.width()) / width, ratio_y = double(image.height()) / height;
    double sum = 0;
    for (const Fetch& f : fetches)
        sum += f.weight *
               bilinear(image, (x + 0.5) * ratio_x + f.x * ratio_x / 2, (y + 0.5) * ratio_y + f.y * ratio_y / 2, edge);
    return sum;
}

Image<float> filtered(const Fetches& fetches, const Image<float>& image, int width, int height, Edge edge) {
    const Grid src{{image.width()}, {image.height()}}, dst{{width}, {height}};
    Image<float> out(width, height, 1, Layout::interleaved);
    term_filter(bank_terms(fetches, src, dst, edge, edge), false)
        .run({image.view(), 0, {}}, {out.view(), 0, {}, {}}, {});
    return out;
}

TEST(Downsample8, IsEightReadsOfSumOne) {
    const Fetches fetches = downsample8();
    ASSERT_EQ(fetches.size(), 8u);
    double sum = 0, x = 0, y = 0;
    for (const Fetch& f : fetches) {
        sum += f.weight;
        x += f.x * f.weight;
        y += f.y * f.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    EXPECT_NEAR(x, 0, 1e-15);
    EXPECT_NEAR(y, 0, 1e-15);
}

TEST(Separate, GivesTheFewestTerms) {
    EXPECT_EQ(separate(downsample8()).size(), 3u);
    EXPECT_EQ(separate({{0.5, 0.5, 1}}).size(), 1u);
    EXPECT_EQ(separate({{-1, -1, 2}, {1, -1, 4}, {-1, 1, 3}, {1, 1, 6}}).size(), 1u);  // rank one
    EXPECT_EQ(separate({{-1, -1, 2}, {1, -1, 4}, {-1, 1, 3}, {1, 1, 5}}).size(), 2u);  // not
    EXPECT_EQ(separate({{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}).size(), 3u);
}

// Any list, any size: the sum of products of banks is what reading one after the other gives.
TEST(TermFilter, ReadsAsShadersDo) {
    Random random(3);
    Fetches any = downsample8();
    any.push_back({1.3, -2.1, 0.25});
    any.push_back({-0.2, 0.9, -0.125});
    const Fetches uneven{{0.3, -0.4, 0.6}, {-1.2, 3.7, 0.3}, {0.4, 2.2, 0.1}};  // the first term reads the fewest rows
    for (const Fetches& fetches : {downsample8(), any, uneven})
        for (const auto& [w, h] : {std::pair{16, 16}, {17, 9}, {2, 2}, {3, 1}, {1, 5}, {33, 40}}) {
            const auto image = picture<float>(w, h, 1, [&](int, int, int) { return random.uniform(); });
            const int width = std::max(1, w / 2), height = std::max(1, h / 2);
            for (const Edge edge : {Edge::clamp, Edge::reflect, Edge::wrap, Edge::zero}) {
                const Image<float> found = filtered(fetches, image, width, height, edge);
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)  // weights rounded to floats, sums of up to 64
                        ASSERT_NEAR(found.view()(x, y), shaded(fetches, image, x, y, width, height, edge), 2e-6)
                            << w << " x " << h << ' ' << name_of(edge);
            }
            // Renormalized: what is read of the picture, over what is read of a picture of ones.
            const auto ones = picture<float>(w, h, 1, [](int, int, int) { return 1; });
            const Image<float> found = filtered(fetches, image, width, height, Edge::renormalize);
            double whole = 0;
            for (const Fetch& f : fetches) whole += f.weight;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    ASSERT_NEAR(found.view()(x, y),
                                whole * shaded(fetches, image, x, y, width, height, Edge::zero) /
                                    shaded(fetches, ones, x, y, width, height, Edge::zero),
                                5e-6)
                        << w << " x " << h;
        }
}

TEST(TermFilter, DividesByAlphaWhatComesMultiplied) {
    // Colour 1/2 at alpha 1/4, for a target that holds colour as it is.
    const auto image = picture<float>(8, 8, 4, [](int, int, int c) { return c < 3 ? 0.125 : 0.25; });
    Image<float> out(4, 4, 4, Layout::interleaved);
    for (const bool premultiply : {true, false}) {
        term_filter(bank_terms(downsample8(), {{8}, {8}}, {{4}, {4}}, Edge::clamp, Edge::clamp), premultiply)
            .run({image.view(), 0, {Transfer::linear, 3, true}}, {out.view(), 0, {Transfer::linear, 3, false}, {}}, {});
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(out.view()(1, 2, c), c < 3 ? 0.5 : 0.25, 1e-6) << premultiply;
    }
}

TEST(TermFilter, RefusesWhatHasNoSum) {
    const Image<float> image(8, 8, 1, Layout::interleaved);
    EXPECT_THROW(filtered({{-1, 0, -1}, {1, 0, 1}}, image, 4, 4, Edge::renormalize), Error);
    EXPECT_THROW(filtered({{40, 0, 1}}, image, 4, 4, Edge::renormalize), Error);
    EXPECT_THROW(filtered({{NAN, 0, 1}}, image, 4, 4, Edge::clamp), Error);
    EXPECT_NO_THROW(filtered({{-1, 0, -1}, {1, 0, 1}}, image, 4, 4, Edge::reflect));
}

}  // namespace
}  // namespace bandlimit
