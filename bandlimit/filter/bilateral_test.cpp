#include "bandlimit/filter/bilateral.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/core/targets_test.h"
#include "bandlimit/filter/bilateral_rows.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

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

template <class F>
void for_each_sample(const Image<float>& image, F f) {
    for (int c = 0; c < image.channels(); ++c)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) f(x, y, c);
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

void expect_same_bits(const Image<float>& a, const Image<float>& b) {
    ASSERT_TRUE(same_shape(a.view(), b.view()));
    int different = 0;
    for_each_sample(a, [&](int x, int y, int c) { different += !same_bits(a.view()(x, y, c), b.view()(x, y, c)); });
    EXPECT_EQ(different, 0);
}

void expect_near(const Image<float>& a, const Image<float>& b, double tolerance) {
    ASSERT_TRUE(same_shape(a.view(), b.view()));
    double worst = 0;
    for_each_sample(a, [&](int x, int y, int c) {
        const double error = std::abs(static_cast<double>(a.view()(x, y, c)) - static_cast<double>(b.view()(x, y, c)));
        worst = std::max(worst, std::isnan(error) ? infinity : error);
    });
    EXPECT_LE(worst, tolerance);
}

double sigma_of(const BilateralOptions& o, int c) {
    return o.sigma_range[o.sigma_range.size() == 1 ? 0 : static_cast<std::size_t>(c)];
}

/// Weight of a difference, with the limits of sigma 0 and infinity.
double weight_of(double d, double sigma) {
    if (d == 0 || std::isinf(sigma)) return 1;
    return sigma == 0 ? 0 : std::exp(-d * d / (2 * sigma * sigma));
}

/// How far a window reaches.
struct Reach {
    int x, y;
};

/// An output from the definition, in double.
double expected(const Image<float>& signal, const Image<float>& guide, const BilateralOptions& o, Reach reach, int x,
                int y, int c) {
    double weights = 0, sum = 0;
    for (int j = -reach.y; j <= reach.y; ++j)
        for (int i = -reach.x; i <= reach.x; ++i) {
            const int u = resolve(x + i, signal.width(), o.edge_x), v = resolve(y + j, signal.height(), o.edge_y);
            const bool is_zero = u < 0 || v < 0;
            if (is_zero && (u < 0 ? o.edge_x : o.edge_y) == Edge::renormalize) continue;
            const double sample = is_zero ? 0 : static_cast<double>(signal.view()(u, v, c));
            double weight = weight_of(i, o.sigma_space) * weight_of(j, o.sigma_space);
            bool is_missing = std::isnan(sample);
            for (int g = 0; g < guide.channels(); ++g) {
                const double own = static_cast<double>(guide.view()(x, y, g));
                const double other = is_zero ? 0 : static_cast<double>(guide.view()(u, v, g));
                if (std::isnan(other)) is_missing = true;
                else if (!std::isnan(own)) weight *= weight_of(other - own, sigma_of(o, g));
            }
            if (is_missing) continue;
            weights += weight;
            sum += weight * sample;
        }
    return sum / weights;
}

Image<float> expected(const Image<float>& signal, const Image<float>& guide, const BilateralOptions& o, Reach reach) {
    return picture(signal.width(), signal.height(), signal.channels(),
                   [&](int x, int y, int c) { return expected(signal, guide, o, reach, x, y, c); });
}
Image<float> expected(const Image<float>& signal, const Image<float>& guide, const BilateralOptions& o) {
    const int radius = bilateral_radius(o);
    if (!o.separable) return expected(signal, guide, o, {radius, radius});
    return expected(expected(signal, guide, o, {radius, 0}), guide, o, {0, radius});
}

TEST(Falloff, IsAPowerOfTwo) {
    double worst = 0;
    for (float x = 0; x <= 126; x += 1.0f / 1024) {
        const double truth = std::exp(-static_cast<double>(x) * std::log(2.0));
        worst = std::max(worst, std::abs(static_cast<double>(falloff(x)) / truth - 1));
    }
    EXPECT_LT(worst, 3e-7);
    EXPECT_EQ(falloff(0), 1);
    for (const float x : {127.0f, 1e10f, std::numeric_limits<float>::infinity()}) EXPECT_EQ(falloff(x), 0);
}

TEST(Bilateral, IsItsDefinition) {
    for (const int guides : {1, 2, 3, 5})
        for (const int signals : {1, 3, 6}) {
            const Image<float> signal = noise(21, 17, signals, 1), guide = noise(21, 17, guides, 2);
            BilateralOptions o{.sigma_space = 1.5, .sigma_range = {0.3}};
            if (guides == 3) o.sigma_range = {0.2, infinity, 0.6};
            for (const Edge edge : all_edges()) {
                o.edge_x = o.edge_y = edge;
                expect_near(joint_bilateral(signal.view(), guide.view(), o), expected(signal, guide, o), 2e-6);
            }
        }
    const Image<float> image = noise(21, 17, 3, 3);
    const BilateralOptions o{.sigma_space = 2, .sigma_range = {0.2}, .radius = 3};
    expect_near(bilateral(image.view(), o), expected(image, image, o), 2e-6);
}

TEST(Bilateral, WindowsMayBeLargerThanThePicture) {
    for (const int width : {1, 5})
        for (const bool separable : {false, true}) {
            const Image<float> signal = noise(width, 4, 2, 1), guide = noise(width, 4, 1, 2);
            BilateralOptions o{.sigma_space = 4, .sigma_range = {0.3}, .radius = 11, .separable = separable};
            for (const Edge edge : all_edges()) {
                o.edge_x = o.edge_y = edge;
                expect_near(joint_bilateral(signal.view(), guide.view(), o), expected(signal, guide, o), 2e-6);
            }
        }
}

TEST(Bilateral, SeparableIsAPassAlongEachAxis) {
    const Image<float> signal = noise(26, 19, 2, 1), guide = noise(26, 19, 3, 2);
    BilateralOptions o{.sigma_space = 1.5, .sigma_range = {0.3, 0.5, 0.7}, .separable = true};
    for (const Edge edge : all_edges()) {
        o.edge_x = o.edge_y = edge;
        expect_near(joint_bilateral(signal.view(), guide.view(), o), expected(signal, guide, o), 3e-6);
    }
}

TEST(Bilateral, VectorsHaveTheBitsOfTheDefinition) {
    Image<float> signal = noise(45, 19, 6, 1);
    signal.view()(7, 5, 2) = nan;
    for (const int guides : {1, 3, 4})
        for (const bool separable : {false, true}) {
            Image<float> guide = noise(45, 19, guides, 2);
            guide.view()(30, 9, 0) = nan;
            const BilateralOptions o{.sigma_space = 1, .sigma_range = {0.3}, .separable = separable};
            Image<float> definition;
            for_each_target([&](Target target) {
                const Image<float> out = joint_bilateral(signal.view(), guide.view(), o);
                if (target == Target::scalar) definition = out.clone();
                else if (has_fused_multiply_add(target)) expect_same_bits(out, definition);
                else
                    expect_near(picture(29, 19, 6, [&](int x, int y, int c) { return out.view()(x, y, c); }),
                                picture(29, 19, 6, [&](int x, int y, int c) { return definition.view()(x, y, c); }),
                                1e-5);
            });
        }
}

TEST(Bilateral, HasTheSameBitsInPartsAndForAnyThreads) {
    const Image<float> signal = noise(1030, 70, 1, 1), guide = noise(1030, 70, 1, 2);
    const BilateralOptions o{.sigma_space = 0.6, .sigma_range = {0.3}};
    const Image<float> whole = joint_bilateral(signal.view(), guide.view(), o, {1});
    expect_same_bits(joint_bilateral(signal.view(), guide.view(), o, {3}), whole);
    const RowFilter filter = bilateral_filter(1030, 70, o, guide.view());
    Image<float> parts(1030, 70, 1);
    for (int y = 0; y < 70; y += 7) {
        const IndexRange rows = filter.rows_needed(y, y + 7);
        const Image<float> needed = picture(1030, 70, 1, [&](int u, int v, int) {
            return v >= rows.begin && v < rows.end ? signal.view()(u, v) : 7.0f;
        });
        filter.run({cropped(needed.view(), 0, rows.begin, 1030, rows.count()), rows.begin, {}},
                   {cropped(parts.view(), 0, y, 1030, 7), y, {}, {}});
    }
    expect_same_bits(parts, whole);
}

TEST(Bilateral, IsTheIdentityAtSigmaZero) {
    const Image<float> image = noise(33, 20, 3, 1);
    expect_same_bits(bilateral(image.view(), {.sigma_space = 3, .sigma_range = {0}}), image);
    expect_same_bits(bilateral(image.view(), {.sigma_space = 0, .sigma_range = {infinity}}), image);
    expect_same_bits(bilateral(image.view(), {.sigma_space = 0, .sigma_range = {infinity}, .radius = 4}), image);
    expect_same_bits(bilateral(image.view(), {.sigma_space = 3, .sigma_range = {1}, .radius = 0}), image);
}

TEST(Bilateral, IsTheGaussianAtInfinityAndForAConstantGuide) {
    const Image<float> image = noise(33, 20, 2, 1),
                       constant = picture(33, 20, 3, [](int, int, int c) { return 1000 + c; });
    BilateralOptions o{.sigma_space = 2, .sigma_range = {infinity}, .radius = 4};
    for (const Edge edge : all_edges()) {
        if (edge == Edge::zero) continue;  // whose zeros differ from a constant guide
        o.edge_x = o.edge_y = edge;
        o.sigma_range = {infinity};
        const Image<float> gaussian = bilateral(image.view(), o);
        expect_near(gaussian, expected(image, image, o), 1e-6);
        for (const double sigma : {0.0, 1e-3, 10.0}) {
            o.sigma_range = {sigma};
            expect_same_bits(joint_bilateral(image.view(), constant.view(), o), gaussian);
        }
    }
    // In the middle of a large picture one light becomes the weights.
    const Image<float> light = picture(31, 31, 1, [](int x, int y, int) { return x == 15 && y == 15; });
    o = {.sigma_space = infinity, .sigma_range = {infinity}, .radius = 2};
    EXPECT_FLOAT_EQ(bilateral(light.view(), o).view()(13, 17), 1 / 25.0f);
}

TEST(Bilateral, ConstantsStay) {
    const Image<float> guide = noise(40, 20, 2, 1), seven = picture(40, 20, 1, [](int, int, int) { return 0.7; });
    for (const bool separable : {false, true})
        expect_same_bits(joint_bilateral(seven.view(), guide.view(), {.sigma_range = {0.2}, .separable = separable}),
                         seven);
}

TEST(Bilateral, KeepsEdgesOfItsGuide) {
    const Image<float> step = picture(40, 9, 1, [](int x, int, int) { return x < 20 ? 1000 : 1001; });
    const Image<float> noisy = picture(40, 9, 1, [](int x, int y, int) { return (x < 20 ? 0 : 10) + (x + y) % 2; });
    const Image<float> out = joint_bilateral(noisy.view(), step.view(), {.sigma_space = 3, .sigma_range = {0.05}});
    for_each_sample(out, [&](int x, int y, int) { EXPECT_NEAR(out.view()(x, y), x < 20 ? 0.5 : 10.5, 0.1); });
}

TEST(Bilateral, SeparableIsExactForConstantGuidesAndAlongAxes) {
    const Image<float> image = noise(40, 30, 1, 1), constant(40, 30, 1);
    BilateralOptions exact{.sigma_space = 2, .sigma_range = {0.2}}, separable = exact;
    separable.separable = true;
    for (const Edge edge : all_edges()) {
        exact.edge_x = exact.edge_y = separable.edge_x = separable.edge_y = edge;
        if (edge == Edge::zero) continue;
        expect_near(joint_bilateral(image.view(), constant.view(), separable),
                    joint_bilateral(image.view(), constant.view(), exact), 1e-6);
        const Image<float> stripes = picture(40, 30, 1, [](int x, int, int) { return (x / 7) % 2; });
        expect_near(joint_bilateral(image.view(), stripes.view(), separable),
                    joint_bilateral(image.view(), stripes.view(), exact), 1e-6);
    }
    // A diagonal line is what neither pass sees.
    const Image<float> diagonal = picture(40, 30, 1, [](int x, int y, int) { return x == y; });
    const Image<float> a = joint_bilateral(image.view(), diagonal.view(), separable);
    EXPECT_NEAR(a.view()(15, 15), image.view()(15, 15), 1e-4);
    EXPECT_GT(std::abs(joint_bilateral(image.view(), diagonal.view(), exact).view()(15, 15) - image.view()(15, 15)),
              0.01);
}

TEST(Bilateral, MissingSamplesAreLeftOutAndFilled) {
    Image<float> signal = noise(25, 20, 2, 1), guide = noise(25, 20, 2, 2);
    signal.view()(5, 6, 0) = nan;
    signal.view()(5, 7, 1) = nan;
    for (int c = 0; c < 2; ++c) signal.view()(12, 9, c) = nan;
    guide.view()(18, 3, 1) = nan;
    const BilateralOptions o{.sigma_space = 1.5, .sigma_range = {0.4}};
    expect_near(joint_bilateral(signal.view(), guide.view(), o), expected(signal, guide, o), 2e-6);
    expect_near(bilateral(signal.view(), o), expected(signal, signal, o), 2e-6);
    // An infinite sample of the signal is missing too, and does not reach others.
    Image<float> hot = noise(25, 20, 1, 1);
    hot.view()(4, 4) = nan;
    const Image<float> without = joint_bilateral(hot.view(), guide.view(), o);
    hot.view()(4, 4) = std::numeric_limits<float>::infinity();
    expect_same_bits(joint_bilateral(hot.view(), guide.view(), o), without);
    // The separable form fills holes too.
    for (const Image<float>& image :
         {joint_bilateral(signal.view(), guide.view(), {.sigma_range = {0.4}, .separable = true})})
        for_each_sample(image, [&](int x, int y, int c) { EXPECT_TRUE(std::isfinite(image.view()(x, y, c))); });
    // Nothing comes of nothing.
    const Image<float> none = picture(9, 9, 1, [](int, int, int) { return nan; });
    for (const bool separable : {false, true}) expect_same_bits(bilateral(none.view(), {.separable = separable}), none);
}

TEST(Bilateral, InfinitelyFarIsLikeItself) {
    const Image<float> depth = picture(20, 10, 1, [](int x, int, int) { return x < 10 ? 1 : infinity; });
    const Image<float> signal = picture(20, 10, 1, [](int x, int, int) { return x < 10 ? 0.25 : 0.75; });
    for (const double sigma : {0.0, 1.0})
        expect_same_bits(joint_bilateral(signal.view(), depth.view(), {.sigma_range = {sigma}}), signal);
}

TEST(Bilateral, RefusesWhatItCannotRun) {
    const Image<float> image(8, 6, 2), other(6, 8, 1);
    const auto refused = [&](const BilateralOptions& o, std::string_view word, const Image<float>* guide = nullptr) {
        try {
            joint_bilateral(image.view(), guide ? guide->view() : View<const float>{}, o);
            ADD_FAILURE() << word;
        } catch (const Error& e) {
            EXPECT_NE(std::string_view(e.what()).find(word), std::string_view::npos) << e.what();
        }
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    refused({.sigma_space = -1}, "sigma-space: -1");
    refused({.sigma_space = not_a_number}, "sigma-space: nan");
    refused({.sigma_range = {-0.5}}, "sigma-range: -0.5");
    refused({.sigma_range = {not_a_number}}, "sigma-range: nan");
    refused({.sigma_range = {}}, "sigma-range");
    refused({.sigma_range = {1, 2, 3}}, "3 values");
    refused({.radius = -1}, "radius: -1");
    refused({.radius = 1001}, "radius: 1001");
    refused({.sigma_space = infinity}, "pass a radius");
    refused({.sigma_space = 1e9}, "pass a radius");
    refused({}, "6 x 8", &other);
    // A window larger than the picture is fine.
    EXPECT_EQ(bilateral(image.view(), {.sigma_space = infinity, .radius = 60}).width(), 8);
}

}  // namespace
}  // namespace bandlimit
