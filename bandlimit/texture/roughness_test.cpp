#include "bandlimit/texture/roughness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bandlimit/texture/pictures_test.h"

namespace bandlimit {
namespace {

using Vec = std::array<double, 3>;

/// A vector at an angle from `axis`, in a random direction around it.
Vec around(const Vec& axis, double cosine, Random& random) {
    const double phi = 2 * std::numbers::pi * random.uniform(), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double s = std::copysign(1.0, axis[2]), a = -1 / (s + axis[2]), b = axis[0] * axis[1] * a;
    const Vec t{1 + s * axis[0] * axis[0] * a, s * b, -s * axis[0]}, u{b, s + axis[1] * axis[1] * a, -axis[1]};
    Vec v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = sine * (std::cos(phi) * t[k] + std::sin(phi) * u[k]) + cosine * axis[k];
    return v;
}
/// The cosine of the angle from the mean of a von Mises-Fisher distribution, by its inverse.
double von_mises_fisher(double kappa, Random& random) {
    const double u = random.uniform();
    return 1 + std::log(u + (1 - u) * std::exp(-2 * kappa)) / kappa;
}
/// The cosine of the angle between a facet and the normal, by Beckmann's distribution of facets.
double beckmann(double alpha, Random& random) {
    return 1 / std::sqrt(1 - alpha * alpha * std::log(1 - random.uniform()));
}

TEST(Roughness, IsItsVarianceAndBack) {
    for (int code = 0; code < 256; ++code) {
        const float r = from_code(std::uint8_t(code));
        EXPECT_NEAR(roughness_of_variance(roughness_variance(r)), r, 1e-6);
    }
    EXPECT_EQ(roughness_of_variance(-1), 0);
    EXPECT_EQ(roughness_of_variance(INFINITY), 1);
}

TEST(LostVariance, GrowsAsMeansShorten) {
    EXPECT_EQ(lost_variance(1), 0);
    EXPECT_EQ(lost_variance(1 + 1e-6f), 0);
    EXPECT_EQ(lost_variance(1 - 0x1p-22f), 0);  // the rounding of floats
    EXPECT_GT(lost_variance(1 - 0x1p-20f), 0);
    EXPECT_EQ(lost_variance(0), INFINITY);
    float last = 0;
    for (float r = 0.999f; r > 0; r -= 0.001f) {
        EXPECT_GT(lost_variance(r), last);
        last = lost_variance(r);
    }
}

// The concentration comes back out of the mean: for large kappa R = coth(kappa) - 1 / kappa, which the formula inverts
// within a few percent everywhere (Banerjee et al. 2005).
TEST(LostVariance, IsThatOfVonMisesFisher) {
    for (const double kappa : {0.5, 2.0, 10.0, 100.0, 1000.0}) {
        const double r = 1 / std::tanh(kappa) - 1 / kappa;
        EXPECT_NEAR(lost_variance(float(r)) * kappa / 2, 1, kappa > 50 ? 0.02 : 0.1) << kappa;
    }
}

// By brute force: facets by Beckmann about normals by von Mises-Fisher. Of Beckmann's facets the median of tan^2 is
// alpha^2 ln 2; that of the mixture gives the width it looks like.
TEST(LostVariance, AddsToTheLobeAsFacetsDo) {
    Random random(5);
    constexpr int count = 200000;
    for (const auto& [alpha, kappa] : {std::pair{0.05, 200.0}, {0.1, 200.0}, {0.2, 100.0}, {0.1, 30.0}, {0.3, 30.0}}) {
        std::vector<double> tangents(count);
        Vec mean{};
        for (double& tangent : tangents) {
            const Vec normal = around({0, 0, 1}, von_mises_fisher(kappa, random), random);
            for (std::size_t k = 0; k < 3; ++k) mean[k] += normal[k] / count;
            const Vec facet = around(normal, beckmann(alpha, random), random);
            tangent = (facet[0] * facet[0] + facet[1] * facet[1]) / (facet[2] * facet[2]);
        }
        std::nth_element(tangents.begin(), tangents.begin() + count / 2, tangents.end());
        const double found = std::sqrt(tangents[count / 2] / std::numbers::ln2);
        const double length = std::hypot(mean[0], mean[1], mean[2]);
        const double expected = std::sqrt(alpha * alpha + static_cast<double>(lost_variance(float(length))));
        // The sum is exact for small slopes, and 2.8 % off for the widest lobe here; noise of the median is 0.3 %.
        EXPECT_NEAR(found / expected, 1, 0.035) << alpha << ' ' << kappa;
    }
}

Image<std::uint8_t> flat_normals(int width, int height) {
    return picture<std::uint8_t>(width, height, 3, [](int, int, int c) { return c < 2 ? 128 : 255; });
}

TEST(RoughnessMips, AverageTheFourthPower) {
    const auto base = picture<float>(2, 1, 1, [](int x, int, int) { return x == 0 ? 0.2 : 0.8; });
    const MipChain chain = make_mips(base.view(), plain, r32f, {.role = Role::roughness, .filter = box()});
    EXPECT_NEAR(sample(chain.images[1], 0, 0), std::pow((std::pow(0.2, 4) + std::pow(0.8, 4)) / 2, 0.25), 1e-6);
}

TEST(RoughnessMips, DoNotChangeByFlatNormals) {
    const Image<std::uint8_t> base = noise_codes(40, 24, 1);
    for (const auto& [w, h] : {std::pair{40, 24}, {64, 64}, {13, 9}, {1, 1}}) {
        const Image<std::uint8_t> normals = flat_normals(w, h);
        const MipChain alone = make_mips(base.view(), plain, r8, {.role = Role::roughness}),
                       with = make_mips(base.view(), plain, r8, {.role = Role::roughness, .normals = normals.view()});
        for (std::size_t level = 0; level < alone.images.size(); ++level)
            EXPECT_EQ(difference(alone.images[level], with.images[level]), 0) << level;
    }
    const auto smooth = picture<std::uint8_t>(16, 16, 1, [](int, int, int) { return 0; });
    const Image<std::uint8_t> normals = flat_normals(21, 17);
    const MipChain chain = make_mips(smooth.view(), plain, r8, {.role = Role::roughness, .normals = normals.view()});
    for (const AnyImage& image : chain.images) EXPECT_EQ(sample(image, 0, 0), 0);
}

// Normals that alternate by +-theta have means of length cos(theta) from level 1 on.
TEST(RoughnessMips, GrowByTheNormalsThatALevelLoses) {
    const double theta = 0.2, r = 0.3;
    for (const int scale : {1, 2}) {  // a map of the same size, or of twice that
        const auto base = picture<float>(16, 16, 1, [&](int, int, int) { return r; });
        const auto normals = picture<float>(16 * scale, 16 * scale, 3, [&](int x, int, int c) {
            return c == 0 ? std::sin(x % 2 ? theta : -theta) : c == 1 ? 0.0 : std::cos(theta);
        });
        const MipChain chain =
            make_mips(base.view(), plain, r32f, {.role = Role::roughness, .normals = normals.view()});
        EXPECT_EQ(sample(chain.images[0], 3, 3), double(float(r)));
        const double expected =
            std::pow(std::pow(r, 4) + static_cast<double>(lost_variance(float(std::cos(theta)))), 0.25);
        for (std::size_t level = 1; level < chain.images.size(); ++level)
            EXPECT_NEAR(sample(chain.images[level], 0, 0), expected, 1e-5) << level;
    }
}

TEST(RoughnessMips, LeaveAlphaAlone) {
    const Image<std::uint8_t> base = noise_codes(16, 16, 4);
    const MipChain rough = make_mips(base.view(), plain, rgba8, {.role = Role::roughness}),
                   data = make_mips(base.view(), plain, rgba8, {.role = Role::data});
    for (std::size_t level = 0; level < rough.images.size(); ++level)
        EXPECT_LE(std::abs(sample(rough.images[level], 0, 0, 3) - sample(data.images[level], 0, 0, 3)), 1);
}

}  // namespace
}  // namespace bandlimit
