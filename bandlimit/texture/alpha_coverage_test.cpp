#include "bandlimit/texture/alpha_coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

double share_of(const AnyImage& image, double threshold) {
    const AnyConstView view = std::visit([](const auto& i) { return AnyConstView(i.view()); }, image);
    return double(count_passing(view, 3, threshold)) / (width_of(image) * height_of(image));
}

/// RGBA codes with this alpha, and colour that tells left from right.
template <class Alpha>
Image<std::uint8_t> with_alpha(int width, int height, Alpha alpha) {
    return picture<std::uint8_t>(width, height, 4, [&](int x, int y, int c) {
        return c == 3 ? int(std::lround(std::clamp<double>(alpha(x, y), 0, 1) * 255)) : c == 0 ? 255 * x / width : 90;
    });
}

/// Blades of grass: soft-edged, thin at the tip.
double blades(int x, int y) {
    const double u = x / 96.0 * 9, height = 1 - y / 64.0;
    return (0.5 - std::abs(u - std::floor(u) - 0.5 + 0.1 * std::sin(7 * height))) * 12 - 5 * height;
}

TEST(CountPassing, ComparesAsShadersDo) {
    Image<std::uint8_t> ramp(256, 1, 1);
    for (int x = 0; x < 256; ++x) ramp.view()(x, 0) = std::uint8_t(x);
    EXPECT_EQ(count_passing(ramp.view(), 0, 0.5), 128u);
    EXPECT_EQ(count_passing(ramp.view(), 0, 100 / 255.0), 156u);
    EXPECT_EQ(count_passing(ramp.view(), 0, 1), 1u);
    EXPECT_EQ(count_passing(ramp.view(), 0, 0.001), 255u);
}

// What the share misses by is at most half a texel or 0.5 %, unless texels of equal alpha can only pass together.
TEST(AlphaTestedMips, KeepTheCoverage) {
    Random random(2);
    struct Case {
        const char* name;
        Image<std::uint8_t> base;
    };
    Case cases[] = {{"noise", with_alpha(90, 61, [&](int, int) { return random.uniform(); })},
                    {"sparse", with_alpha(64, 64, [&](int, int) { return random.uniform() < 0.03 ? 1.0 : 0.0; })},
                    {"gradient", with_alpha(64, 48, [](int x, int y) { return (x * 0.7 + y * 0.3) / 64; })},
                    {"blades", with_alpha(96, 64, blades)},
                    {"opaque", with_alpha(33, 20, [](int, int) { return 1.0; })},
                    {"transparent", with_alpha(33, 20, [](int, int) { return 0.0; })}};
    for (const Case& c : cases)
        for (const double threshold : {0.1, 0.5, 0.9, 1.0})
            for (const Depth depth : {Depth::u8, Depth::f16, Depth::f32})
                for (const MipFilter& filter : {MipFilter(Auto{}), MipFilter(box())}) {
                    const TexelFormat target{4, depth, depth == Depth::u8, false};
                    const MipChain chain =
                        make_mips(c.base.view(), srgb_alpha, target,
                                  {.role = Role::alpha_tested, .filter = filter, .alpha_threshold = threshold});
                    const double share = share_of(chain.images[0], threshold);
                    // The same without scaling: what values there are to choose from.
                    const MipChain plain_chain =
                        make_mips(c.base.view(), srgb_alpha, {4, Depth::f32, false, false}, {.filter = filter});
                    for (std::size_t level = 1; level < chain.images.size(); ++level) {
                        const AnyImage &image = chain.images[level], &unscaled = plain_chain.images[level];
                        const int texels = width_of(image) * height_of(image);
                        const double found = share_of(image, threshold);
                        const double allowed = std::max(0.005, 0.5 / texels) + 1e-9;
                        if (std::abs(found - share) <= allowed) continue;
                        // Then no count that equal alphas permit is nearer.
                        std::multiset<double, std::greater<>> alphas;
                        for (int y = 0; y < height_of(image); ++y)
                            for (int x = 0; x < width_of(image); ++x) alphas.insert(sample(unscaled, x, y, 3));
                        double nearest = share;  // none pass
                        std::size_t passing = 0;
                        for (auto i = alphas.begin(); i != alphas.end() && *i > 1e-7; i = alphas.upper_bound(*i)) {
                            passing += alphas.count(*i);
                            nearest = std::min(nearest, std::abs(double(passing) / texels - share));
                        }
                        EXPECT_LE(std::abs(found - share), nearest + 1e-9)
                            << c.name << ' ' << threshold << ' ' << name_of(depth) << " level " << level;
                    }
                }
}

TEST(AlphaTestedMips, KeepTheColour) {
    const Image<std::uint8_t> base = with_alpha(96, 64, blades);
    const MipChain tested = make_mips(base.view(), srgb_alpha, rgba8_srgb, {.role = Role::alpha_tested}),
                   color = make_mips(base.view(), srgb_alpha, rgba8_srgb, {.role = Role::color});
    bool changed = false;
    for (std::size_t level = 0; level < color.images.size(); ++level)
        for (int y = 0; y < height_of(color.images[level]); ++y)
            for (int x = 0; x < width_of(color.images[level]); ++x) {
                const double a = sample(color.images[level], x, y, 3), b = sample(tested.images[level], x, y, 3);
                changed |= a != b;
                if (a == 0 || b == 0) continue;
                for (int c = 0; c < 3; ++c)  // a quotient of products rounds once more
                    ASSERT_NEAR(sample(color.images[level], x, y, c), sample(tested.images[level], x, y, c), 1);
            }
    EXPECT_TRUE(changed);
    for (const double alpha : {0.0, 1.0}) {  // nothing to scale
        const Image<std::uint8_t> flat = with_alpha(30, 20, [&](int, int) { return alpha; });
        const MipChain a = make_mips(flat.view(), srgb_alpha, rgba8_srgb, {.role = Role::alpha_tested}),
                       b = make_mips(flat.view(), srgb_alpha, rgba8_srgb, {});
        for (std::size_t level = 0; level < a.images.size(); ++level)
            EXPECT_EQ(difference(a.images[level], b.images[level]), 0);
    }
}

TEST(CoverageFactor, FollowsTheOrder) {
    const std::vector<float> alphas{0.1f, 0.4f, 0.2f, 0.3f};
    for (int count = 0; count <= 4; ++count)
        for (const Depth depth : all_depths()) {
            const double factor = coverage_factor(alphas, count / 4.0, depth, 0.5);
            int passing = 0;
            for (const float alpha : alphas) {
                const double scaled = static_cast<double>(alpha) * factor;
                if (depth == Depth::u8) passing += to_code<std::uint8_t>(scaled) >= 128;
                else if (depth == Depth::u16) passing += to_code<std::uint16_t>(scaled) >= 32768;
                else passing += scaled >= 0.5;
            }
            EXPECT_EQ(passing, count) << name_of(depth);
        }
    EXPECT_EQ(coverage_factor({0.2f, 0.6f}, 0.5, Depth::u8, 0.5), 1);
    EXPECT_EQ(coverage_factor({NAN, 0.6f}, 0.5, Depth::f32, 0.5), 1);
    EXPECT_EQ(coverage_factor({}, 0.5, Depth::f32, 0.5), 1);
    // Zeros never pass: what is above them does.
    const double factor_of_zeros = coverage_factor({0, 0, 0.3f, 0.2f}, 1, Depth::f32, 0.5);
    EXPECT_TRUE(std::isfinite(factor_of_zeros));
    EXPECT_GE(0.2f * factor_of_zeros, 0.5);
    // Half way between two halves: ties go to the even one, which is the one below here, or the one above.
    for (const std::uint16_t bits : {std::uint16_t(0x3801), std::uint16_t(0x3802)}) {
        const float passes = to_float(Half{bits}), below = to_float(Half{static_cast<std::uint16_t>(bits - 1)});
        const double middle = (static_cast<double>(passes) + static_cast<double>(below)) / 2;
        const double factor =
            coverage_factor({static_cast<float>(middle), 0.1f}, 0.5, Depth::f16, static_cast<double>(passes));
        EXPECT_GE(to_float(to_half(static_cast<float>(middle * factor))), passes) << bits;
    }
    // Three equal ones of four, half to pass: none or three; one is as far as three, and more is chosen.
    EXPECT_LT(coverage_factor({0.9f, 0.9f, 0.9f, 0.1f}, 0.25, Depth::u8, 0.5), 0.5 / 0.9);
    EXPECT_EQ(coverage_factor({0.9f, 0.9f, 0.9f, 0.1f}, 0.5, Depth::u8, 0.5), 1);
}

}  // namespace
}  // namespace bandlimit
