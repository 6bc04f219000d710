#include "bandlimit/filter/bilateral_upsample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr UpsampleWindow windows[] = {UpsampleWindow::bilinear, UpsampleWindow::gaussian};

template <class F>
Image<float> picture(int width, int height, int channels, F f) {
    Image<float> image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = static_cast<float>(f(x, y, c));
    return image;
}

Image<float> noise(int width, int height, int channels, std::uint64_t seed) {
    Random random(seed);
    return picture(width, height, channels, [&](int, int, int) { return random.uniform(); });
}

double largest_difference(const Image<float>& a, const Image<float>& b) {
    double worst = 0;
    for (int c = 0; c < a.channels(); ++c)
        for (int y = 0; y < a.height(); ++y)
            for (int x = 0; x < a.width(); ++x) {
                const double d = std::abs(static_cast<double>(a.view()(x, y, c) - b.view()(x, y, c)));
                worst = std::max(worst, std::isnan(d) ? infinity : d);
            }
    return worst;
}

/// Regions of a plane, whatever the number of pixels over it.
int region(double x, double y) { return x + 0.4 * y < 0.55 ? 0 : x < 0.8 ? 1 : 2; }
template <class F>
Image<float> scene(int width, int height, int channels, F value) {
    return picture(width, height, channels,
                   [&](int x, int y, int c) { return value(region((x + 0.5) / width, (y + 0.5) / height), c); });
}

TEST(BilateralUpsample, APiecewiseConstantSceneIsExact) {
    const auto signal = [](int r, int c) { return 0.1 + 0.3 * r + c; };
    const auto guide = [](int r, int) { return 1000 + r; };
    for (const int factor : {2, 3, 4})
        for (const UpsampleWindow window : windows)
            for (const double sigma : {0.0, 0.05}) {
                const int width = 24, height = 18;
                const Image<float> low = scene(width, height, 2, signal), low_guide = scene(width, height, 1, guide);
                const Image<float> full_guide = scene(width * factor, height * factor, 1, guide);
                const BilateralOptions o{.sigma_space = 1, .sigma_range = {sigma}};
                const Image<float> out =
                    bilateral_upsampled(low.view(), low_guide.view(), full_guide.view(), o, window);
                const Image<float> truth = scene(width * factor, height * factor, 2, signal);
                EXPECT_EQ(largest_difference(out, truth), 0) << factor << " " << sigma;
            }
}

TEST(BilateralUpsample, AConstantGuideInterpolates) {
    const Image<float> low = noise(9, 7, 2, 1), constant(9, 7, 1), full(27, 14, 1);
    const Image<float> out = bilateral_upsampled(low.view(), constant.view(), full.view(), {.sigma_range = {0.1}});
    const Image<float> bilinear = resample(low.view(), 27, 14, {.reconstruction = tent()});
    EXPECT_LE(largest_difference(out, bilinear), 1e-6);
}

TEST(BilateralUpsample, IsItsDefinition) {
    const Image<float> low = noise(9, 7, 2, 1), guide = noise(9, 7, 2, 2), full = noise(18, 14, 2, 3);
    const BilateralOptions o{.sigma_space = 0.8, .sigma_range = {0.3, 0.5}, .radius = 2};
    const Image<float> out = bilateral_upsampled(low.view(), guide.view(), full.view(), o, UpsampleWindow::gaussian);
    const Image<float> truth = picture(18, 14, 2, [&](int x, int y, int c) {
        const double at_x = (x + 0.5) / 2 - 0.5, at_y = (y + 0.5) / 2 - 0.5;
        double weights = 0, sum = 0;
        for (int v = 0; v < 7; ++v)
            for (int u = 0; u < 9; ++u) {
                if (std::abs(u - std::round(at_x)) > 2 || std::abs(v - std::round(at_y)) > 2) continue;
                double square = (std::pow(u - at_x, 2) + std::pow(v - at_y, 2)) / (0.8 * 0.8);
                for (int g = 0; g < 2; ++g)
                    square += std::pow(static_cast<double>(guide.view()(u, v, g) - full.view()(x, y, g)) /
                                           o.sigma_range[static_cast<std::size_t>(g)],
                                       2);
                weights += std::exp(-square / 2);
                sum += std::exp(-square / 2) * static_cast<double>(low.view()(u, v, c));
            }
        return sum / weights;
    });
    EXPECT_LE(largest_difference(out, truth), 1e-6);
}

TEST(BilateralUpsample, TakesTheNearestDepthWhereNoneIsNear) {
    const Image<float> low = picture(4, 4, 1, [](int x, int y, int) { return 10 * x + y; });
    const Image<float> guide = picture(4, 4, 1, [](int x, int, int) { return x % 2 == 0 ? 1 : 5; });
    const Image<float> full = picture(8, 8, 1, [](int, int, int) { return 100; });  // nearer to 5
    const Image<float> out = bilateral_upsampled(low.view(), guide.view(), full.view(), {.sigma_range = {0.01}});
    for (int y = 0; y < 8; ++y)
        for (int x = 1; x < 7; ++x) {
            const float value = out.view()(x, y);
            EXPECT_TRUE(value >= 10 && (value <= 13 || (value >= 30 && value <= 33))) << x << " " << y << " " << value;
        }
}

TEST(BilateralUpsample, MissingSamplesAreLeftOut) {
    Image<float> low = picture(6, 6, 2, [](int, int, int c) { return 0.5 + c; }), guide(6, 6, 1), full(12, 12, 1);
    low.view()(2, 3, 0) = nan;
    guide.view()(4, 1) = nan;
    full.view()(7, 7) = nan;
    const Image<float> truth = picture(12, 12, 2, [](int, int, int c) { return 0.5 + c; });
    for (const UpsampleWindow window : windows)
        EXPECT_EQ(largest_difference(
                      bilateral_upsampled(low.view(), guide.view(), full.view(), {.sigma_space = 1}, window), truth),
                  0);
    const Image<float> none = picture(3, 3, 1, [](int, int, int) { return nan; }), flat(3, 3, 1);
    EXPECT_TRUE(std::isnan(bilateral_upsampled(none.view(), flat.view(), full.view(), {}).view()(3, 3)));
}

TEST(BilateralUpsample, TheSignalMayGuideItself) {
    const auto value = [](int r, int) { return 0.2 + 0.3 * r; };
    const Image<float> low = scene(16, 12, 1, value), full = scene(32, 24, 1, value);
    EXPECT_EQ(largest_difference(bilateral_upsampled(low.view(), {}, full.view(), {.sigma_range = {0.01}}), full), 0);
}

TEST(BilateralUpsample, RefusesWhatDoesNotFit) {
    const Image<float> low(4, 4, 1), other(5, 4, 1), two(4, 4, 2), full(8, 8, 1), full_two(8, 8, 2);
    EXPECT_THROW(bilateral_upsampled(low.view(), other.view(), full.view(), {}), Error);
    EXPECT_THROW(bilateral_upsampled(low.view(), two.view(), full.view(), {}), Error);
    EXPECT_THROW(bilateral_upsampled(low.view(), {}, full_two.view(), {}), Error);
    EXPECT_THROW(bilateral_upsampled(low.view(), low.view(), full.view(), {.separable = true}), Error);
    EXPECT_THROW(bilateral_upsampled(low.view(), low.view(), full.view(), {.sigma_range = {1, 2}}), Error);
    EXPECT_THROW(bilateral_upsampled(low.view(), low.view(), full.view(), {.sigma_space = infinity}), Error);
}

}  // namespace
}  // namespace bandlimit
