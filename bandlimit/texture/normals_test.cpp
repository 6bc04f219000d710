#include "bandlimit/texture/normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

struct Normal {
    double x, y, z;
};
Normal random_normal(Random& random, double spread) {
    const double x = random.uniform(-spread, spread), y = random.uniform(-spread, spread), z = 1;
    const double length = std::hypot(x, y, z);
    return {x / length, y / length, z / length};
}
double component(const Normal& n, int c) { return c == 0 ? n.x : c == 1 ? n.y : n.z; }

template <class T>
Image<T> normal_map(int width, int height, int channels, double spread, std::uint64_t seed = 1) {
    Random random(seed);
    Image<T> image(width, height, channels, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Normal n = random_normal(random, spread);
            for (int c = 0; c < channels; ++c) {
                const double v = c < 3 ? component(n, c) : 0.25;
                if constexpr (std::is_integral_v<T>)
                    image.view()(x, y, c) = static_cast<T>(std::lround((v + 1) / 2 * std::numeric_limits<T>::max()));
                else image.view()(x, y, c) = static_cast<T>(v);
            }
        }
    return image;
}

double decoded(const AnyImage& image, int x, int y, int c) {
    const double v = sample(image, x, y, c);
    if (std::holds_alternative<Image<std::uint8_t>>(image)) return 2 * v / 255 - 1;
    if (std::holds_alternative<Image<std::uint16_t>>(image)) return 2 * v / 65535 - 1;
    return v;
}

// In codes of 8 bits 0 lies between 127 and 128: both ways to write a flat map are kept at every level and size.
TEST(NormalMips, KeepFlatMapsFlat) {
    for (const int code : {127, 128})
        for (const auto& [w, h] : {std::pair{16, 16}, {17, 5}, {1, 9}, {31, 64}})
            for (const int channels : {2, 3, 4}) {
                const auto base =
                    picture<std::uint8_t>(w, h, channels, [&](int, int, int c) { return c < 2 ? code : 255; });
                for (const MipFilter& filter : {MipFilter(Auto{}), MipFilter(box()), MipFilter(downsample8())}) {
                    const TexelFormat target = channels == 2 ? rg8 : rgba8;
                    const MipChain chain =
                        make_mips(base.view(), plain, target, {.role = Role::normal, .filter = filter});
                    for (const AnyImage& image : chain.images)
                        for (int c = 0; c < target.channels; ++c)
                            for (int y = 0; y < height_of(image); ++y)
                                ASSERT_EQ(sample(image, width_of(image) / 2, y, c), c < 2 ? code : 255);
                }
            }
}

TEST(NormalMips, AreUnitVectors) {
    for (const Depth depth : all_depths())
        for (const double spread : {1.5, 0.05}) {  // means that are far from unit, and nearly so
            const MipFilter filter = spread > 1 ? MipFilter(Auto{}) : MipFilter(box());
            const auto base = normal_map<float>(33, 20, 3, spread);
            const MipChain chain =
                make_mips(base.view(), plain, {4, depth, false, false}, {.role = Role::normal, .filter = filter});
            // Half a step of each component, or of a half's significand.
            const double step = depth == Depth::u8    ? 2.0 / 255
                                : depth == Depth::u16 ? 2.0 / 65535
                                : depth == Depth::f16 ? 0x1p-11
                                                      : 0x1p-22;
            for (const AnyImage& image : chain.images)
                for (int y = 0; y < height_of(image); ++y)
                    for (int x = 0; x < width_of(image); ++x)
                        ASSERT_NEAR(
                            std::hypot(decoded(image, x, y, 0), decoded(image, x, y, 1), decoded(image, x, y, 2)), 1,
                            std::sqrt(3.0) * step / 2 * 1.001)
                            << name_of(depth);
        }
}

// Two texels that lean to opposite sides make one that stands up, and the mean of two directions halves their angle.
TEST(NormalMips, AverageDirections) {
    const double angle = 0.6;
    const auto base = picture<float>(2, 1, 3, [&](int x, int, int c) {
        const double a = x == 0 ? 0.0 : angle;
        return c == 0 ? std::sin(a) : c == 1 ? 0.0 : std::cos(a);
    });
    const MipChain chain = make_mips(base.view(), plain, rgba32f, {.role = Role::normal, .filter = box()});
    EXPECT_NEAR(sample(chain.images[1], 0, 0, 0), std::sin(angle / 2), 1e-6);
    EXPECT_NEAR(sample(chain.images[1], 0, 0, 2), std::cos(angle / 2), 1e-6);
}

TEST(NormalMips, OfTwoChannelsUseTheirThird) {
    const auto three = normal_map<std::uint16_t>(32, 32, 3, 2.0);
    const auto two = picture<std::uint16_t>(32, 32, 2, [&](int x, int y, int c) { return three.view()(x, y, c); });
    const TexelFormat rg16{2, Depth::u16, false, false}, rgba16{4, Depth::u16, false, false};
    const MipOptions options{.role = Role::normal};
    const MipChain a = make_mips(two.view(), plain, rg16, options), b = make_mips(three.view(), plain, rg16, options),
                   c = make_mips(two.view(), plain, rgba16, options),
                   d = make_mips(three.view(), plain, rgba16, options);
    for (std::size_t level = 0; level < a.images.size(); ++level) {
        // z of a code is off by its rounding times x / z: some codes of 16 bits.
        EXPECT_LE(difference(a.images[level], b.images[level]), 8) << level;
        EXPECT_LE(difference(c.images[level], d.images[level]), 8) << level;
    }
    EXPECT_EQ(sample(c.images[0], 3, 3, 3), 65535);
}

// Whatever the direction, what is constant stays so to the code; and a fourth channel is data.
TEST(NormalMips, KeepConstants) {
    Random random(7);
    for (int trial = 0; trial < 200; ++trial) {
        const Normal n = random_normal(random, 1.5);
        const auto base = picture<std::uint8_t>(
            4, 2, 4, [&](int, int, int c) { return c < 3 ? std::lround((component(n, c) + 1) / 2 * 255) : 40; });
        const MipChain chain = make_mips(base.view(), plain, rgba8, {.role = Role::normal});
        for (const AnyImage& image : chain.images)
            for (int c = 0; c < 4; ++c) ASSERT_EQ(sample(image, 0, 0, c), base.view()(0, 0, c)) << trial;
    }
}

TEST(NormalMips, OfTwoChannelsThatAreTooLongLieInThePlane) {
    const auto base = picture<std::uint8_t>(2, 2, 2, [](int, int, int) { return 255; });
    const MipChain chain = make_mips(base.view(), plain, rg8, {.role = Role::normal});
    EXPECT_EQ(sample(chain.images[1], 0, 0, 0), std::round((std::sqrt(0.5) + 1) / 2 * 255));
    EXPECT_FALSE(chain.lost_non_finite);
}

TEST(NormalMips, KeepTheDirectionOfShortMeans) {
    // (0.1, 1, 0) and (0.1, -1, 0): a tenth of a vector is left, along x.
    const auto base = picture<float>(2, 1, 3, [](int x, int, int c) { return c == 0 ? 0.1 : c == 1 ? 1 - 2 * x : 0; });
    const MipChain chain = make_mips(base.view(), plain, rgba32f, {.role = Role::normal, .filter = box()});
    EXPECT_NEAR(sample(chain.images[1], 0, 0, 0), 1, 1e-6);
}

TEST(NormalMips, OfOppositeVectorsPointUp) {
    const auto base = picture<std::uint8_t>(4, 4, 3, [](int x, int y, int c) {
        return c == 2 ? 128 : (x + y) % 2 ? 255 : 0;
    });
    const auto opposite = picture<float>(4, 4, 3, [](int x, int y, int c) {
        return c ? 0.0 : (x + y) % 2 ? 1.0 : -1.0;
    });
    const MipChain chain = make_mips(opposite.view(), plain, rgba8, {.role = Role::normal, .filter = box()});
    EXPECT_EQ(sample(chain.images[1], 0, 0, 0), 128);
    EXPECT_EQ(sample(chain.images[1], 0, 0, 2), 255);
    EXPECT_EQ(sample(make_mips(base.view(), plain, rgba8, {.role = Role::normal, .filter = box()}).images[1], 0, 0, 2),
              255);
}

// A border of zero vectors turns nothing.
TEST(NormalMips, TreatZeroAsNothing) {
    const auto base = normal_map<float>(16, 16, 3, 1);
    const auto chain = [&](Edge edge) {
        return make_mips(base.view(), plain, rgba32f, {.role = Role::normal, .edge_x = edge, .edge_y = edge});
    };
    const MipChain zero = chain(Edge::zero), renormalize = chain(Edge::renormalize);
    for (std::size_t level = 0; level < zero.images.size(); ++level)
        EXPECT_EQ(difference(zero.images[level], renormalize.images[level]), 0);
}

TEST(NormalMoments, AreMeansOverExactCells) {
    const auto map = normal_map<float>(12, 9, 3, 1);
    NormalMoments moments(map.view(), {});
    for (const auto& [w, h] : {std::pair{5, 4}, {4, 3}, {2, 2}, {2, 1}, {1, 1}}) {
        const View<const float> means = moments.means(w, h, {});
        ASSERT_EQ(means.width, w);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                double sum = 0;
                for (int j = 0; j < 9; ++j)
                    for (int i = 0; i < 12; ++i) {
                        const auto overlap = [](double a0, double a1, double b0, double b1) {
                            return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
                        };
                        sum += overlap(i, i + 1, x * 12.0 / w, (x + 1) * 12.0 / w) *
                               overlap(j, j + 1, y * 9.0 / h, (y + 1) * 9.0 / h) * double(map.view()(i, j));
                    }
                EXPECT_NEAR(means(x, y), sum / (12.0 / w * 9.0 / h), 1e-6);
            }
    }
}

}  // namespace
}  // namespace bandlimit
