#include "bandlimit/antialias/supersample.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "bandlimit/antialias/resolve_table.h"
#include "bandlimit/core/error.h"
#include "bandlimit/signal/render.h"

namespace bandlimit {
namespace {

PointValue of_signal(const Signal& signal) {
    return [value = signal.value](double x, double y, std::span<float> to) { to[0] = static_cast<float>(value(x, y)); };
}

PointValue constant_value(const std::vector<float>& values) {
    return [values](double, double, std::span<float> to) { std::copy(values.begin(), values.end(), to.begin()); };
}

/// 0 left of x = edge, `bright` right of it, in all channels but alpha, which is 1.
PointValue edge_value(double edge, float bright) {
    return [=](double x, double, std::span<float> to) {
        std::fill(to.begin(), to.end(), x < edge ? 0.0f : bright);
        if (to.size() == 4) to[3] = 1;
    };
}

bool same_bits(View<const float> a, View<const float> b) {
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < a.channels; ++c)
                if (a(x, y, c) != b(x, y, c)) return false;
    return same_shape(a, b);
}

double largest_difference(View<const float> a, View<const float> b) {
    double largest = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) largest = std::max<double>(largest, std::abs(a(x, y) - b(x, y)));
    return largest;
}

TEST(Supersample, ConstantsStayForEveryPatternAndKernel) {
    const std::vector<float> color{0.1f, 0.7f, 123.4f, 1.0f};
    for (const PatternInfo& pattern : pattern_list())
        for (const KernelInfo& info : kernel_list()) {
            const Kernel kernel = parse_kernel(info.example);
            if (kernel.form == Kernel::Form::nearest) continue;
            for (const bool per_pixel : {false, true}) {
                SupersampleOptions options{parse_pattern(pattern.example), kernel};
                if (per_pixel) options.pixel_seed = 5;
                if (per_pixel && options.pattern.count() > 4) continue;  // few samples are what is hard, and faster
                const Image<float> image = supersample(constant_value(color), 4, {-1, 2, 3, 2}, options);
                for (int c = 0; c < 4; ++c)
                    for (int y = 0; y < 2; ++y)
                        for (int x = 0; x < 3; ++x)
                            ASSERT_EQ(image.view()(x, y, c), color[static_cast<std::size_t>(c)])
                                << pattern.example << ", " << info.example;
            }
        }
}

TEST(Supersample, RegularGridsWithAnyKernelEqualTheSupersampledSignal) {
    const Signal plate = zone_plate({40, 30}, {.max_frequency = 1.5});
    for (const char* name : {"box", "tent", "mitchell", "lanczos3", "gaussian:0.6", "jinc3"}) {
        const Image<float> wanted = render(plate, 40, 30, Sampling::supersampled(parse_kernel(name), 4));
        const Image<float> image =
            supersample(of_signal(plate), 1, {0, 0, 40, 30}, {regular_pattern(16), parse_kernel(name)});
        // Both add up to 24^2 weights of magnitude below 2 in sum; the other in float.
        EXPECT_LT(largest_difference(image.view(), wanted.view()), 2e-6) << name;
    }
}

TEST(Supersample, ResolvesAreWeightedSumsOfTheTable) {
    const Signal plate = zone_plate({16, 16}, {.max_frequency = 2});
    const SamplePattern pattern = d3d_pattern(8);
    const ResolveTable table = resolve_table(pattern, catmull_rom());
    const Image<float> image = supersample(of_signal(plate), 1, {0, 0, 16, 16}, {pattern, catmull_rom()});
    double sum = 0;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
            for (int s = 0; s < 8; ++s) {
                const Point& p = pattern.points[static_cast<std::size_t>(s)];
                sum += table.weight(dx, dy, s) * plate.value(3 + dx + 0.5 + p.x, 9 + dy + 0.5 + p.y);
            }
    EXPECT_NEAR(image.view()(3, 9), sum, 1e-6);
}

TEST(Supersample, EvaluatesEachSampleOnce) {
    std::atomic<int> calls = 0;
    const PointValue count = [&](double, double, std::span<float> to) { ++calls, to[0] = 0; };
    supersample(count, 1, {0, 0, 50, 170}, {sobol_pattern(8), mitchell()});
    EXPECT_EQ(calls, 8 * (50 + 2 * 2) * (170 + 2 * 2));
    calls = 0;
    supersample(count, 1, {0, 0, 50, 170}, {sobol_pattern(8), box()});
    EXPECT_EQ(calls, 8 * 50 * 170);
}

TEST(Supersample, BitsDependNeitherOnThreadsNorOnThePart) {
    const Signal plate = zone_plate({200, 150}, {.max_frequency = 2});
    for (const bool per_pixel : {false, true}) {
        SupersampleOptions options{sobol_pattern(4), lanczos(2)};
        if (per_pixel) options.pixel_seed = 77;
        const Image<float> one = supersample(of_signal(plate), 1, {0, 0, 200, 150}, options, {.threads = 1});
        const Image<float> three = supersample(of_signal(plate), 1, {0, 0, 200, 150}, options, {.threads = 3});
        EXPECT_TRUE(same_bits(one.view(), three.view()));
        const Image<float> part = supersample(of_signal(plate), 1, {130, 65, 40, 80}, options);
        EXPECT_TRUE(same_bits(part.view(), cropped(one.view(), 130, 65, 40, 80)));
    }
}

TEST(Supersample, PatternsPerPixelDifferAndKeepTheMean) {
    // A frequency that the regular grid takes for a constant: with one pattern all pixels are wrong alike, with many
    // each in its own way.
    const PointValue wave = [](double x, double, std::span<float> to) {
        to[0] = static_cast<float>(0.5 + 0.5 * std::cos(2 * M_PI * 2 * (x - 0.25)));
    };
    const auto moments = [&](const SupersampleOptions& options) {
        const Image<float> image = supersample(wave, 1, {0, 0, 64, 64}, options);
        double sum = 0, squares = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) sum += image.view()(x, y), squares += std::pow(image.view()(x, y), 2);
        const double mean = sum / 4096;
        return std::pair(mean, squares / 4096 - mean * mean);
    };
    const auto [same_mean, same_variance] = moments({regular_pattern(4), box()});
    EXPECT_NEAR(same_mean, 1, 1e-6);
    EXPECT_NEAR(same_variance, 0, 1e-12);
    SupersampleOptions options{regular_pattern(4), box()};
    options.pixel_seed = 3;
    const auto [mean, variance] = moments(options);
    EXPECT_NEAR(mean, 0.5, 5 * std::sqrt(0.125 / 64));  // the mean over the 64 patterns, within five deviations
    EXPECT_NEAR(variance, 0.125, 0.02);                 // all samples of a pixel are alike: that of the wave itself
}

TEST(Supersample, ToneWeightsAreAsBiasedAsStated) {
    // The edge halves pixel 0. The truth is L / 2; the weights make it L / (2 + L).
    for (const float light : {0.5f, 1.0f, 30.0f, 1000.0f})
        for (const ToneWeight tone : {ToneWeight::karis, ToneWeight::lottes}) {
            SupersampleOptions options{regular_pattern(16), box()};
            options.tone = tone;
            const Image<float> image = supersample(edge_value(0.5, light), 3, {0, 0, 2, 1}, options);
            const double biased = light / (2.0 + light);
            EXPECT_NEAR(image.view()(0, 0, 1), biased, 1e-6 * (1 + biased)) << name_of(tone);
            EXPECT_NEAR(image.view()(1, 0, 1), light, 1e-3 * light) << name_of(tone);
        }
    const Image<float> plain = supersample(edge_value(0.5, 30), 3, {0, 0, 1, 1}, {regular_pattern(16), box()});
    EXPECT_EQ(plain.view()(0, 0, 0), 15);
    for (const ToneWeight tone : {ToneWeight::none, ToneWeight::karis, ToneWeight::lottes})
        EXPECT_EQ(parse_tone_weight(name_of(tone)), tone);
    EXPECT_THROW(parse_tone_weight("reinhard"), Error);
}

TEST(Supersample, ToneWeightsOfKernelsWithNegativeLobesStayFinite) {
    for (const ToneWeight tone : {ToneWeight::karis, ToneWeight::lottes}) {
        SupersampleOptions options{sobol_pattern(4), lanczos(3)};
        options.tone = tone;
        const Image<float> image = supersample(edge_value(10, 1e6f), 4, {0, 0, 20, 1}, options);
        for (int x = 0; x < 20; ++x) {
            EXPECT_TRUE(std::isfinite(image.view()(x, 0, 0))) << x;
            EXPECT_LT(std::abs(image.view()(x, 0, 0)), 2e7) << x;
            EXPECT_EQ(image.view()(x, 0, 3), 1) << x;
        }
    }
}

TEST(Supersample, ToneWeightsThatCancelAreHeldAboveZero) {
    // The dark side's weights sum to about -0.07 a pixel beyond the edge, the bright ones' to 1.07 / (1 + light): for
    // some light they cancel. Products of weight and colour are below 1, and magnitudes of Lanczos-3 sum to less than 2.
    SupersampleOptions options{regular_pattern(4), lanczos(3)};
    options.tone = ToneWeight::karis;
    for (int i = 0; i < 400; ++i) {
        const float light = 5 + 0.05f * static_cast<float>(i);
        const Image<float> image = supersample(edge_value(1.5, light), 1, {0, 0, 6, 1}, options);
        for (int x = 0; x < 6; ++x) EXPECT_LT(std::abs(image.view()(x, 0)), 2 * (1 + light)) << light;
    }
}

TEST(Supersample, WeightsThatNearlyCancelDoNotBlowUp) {
    // One random sample per pixel, lobes of which are negative. The sum of the magnitudes is at most 36 times the largest
    // weight, which is 1; that by which it is divided, at least a fifth of the mean.
    const Signal noise = white_noise();
    SupersampleOptions options{random_pattern(1), lanczos(3)};
    options.pixel_seed = 1;
    const Image<float> image = supersample(of_signal(noise), 1, {0, 0, 200, 200}, options);
    double largest = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) largest = std::max<double>(largest, std::abs(image.view()(x, y)));
    EXPECT_LT(largest, 10);
}

TEST(Supersample, WhatLiesOutsideTheKernelDoesNotMatter) {
    const PointValue bad = [](double x, double, std::span<float> to) {
        to[0] = x > 3.5 ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
    };
    const Image<float> image = supersample(bad, 1, {0, 0, 4, 1}, {d3d_pattern(4), tent()});
    for (int x = 0; x < 3; ++x) EXPECT_EQ(image.view()(x, 0), 1);
    EXPECT_TRUE(std::isnan(image.view()(3, 0)));
}

TEST(Supersample, ScenesAreFilteredByCoverage) {
    Scene scene;
    scene.at = [](double x, double, int frame) {
        SceneSample sample;
        sample.color = {0.25 + frame, 0.5, 1};
        sample.alpha = x < 0.5 ? 1 : 0;  // what is transparent has a colour that must not show
        if (sample.alpha == 0) sample.color = {9, 9, 9};
        return sample;
    };
    const Image<float> image = supersample(scene, 2, 1, 3, {regular_pattern(4), box()});
    EXPECT_EQ(image.view()(0, 0, 0), 3.25f);
    EXPECT_EQ(image.view()(0, 0, 2), 1);
    EXPECT_EQ(image.view()(0, 0, 3), 0.5f);
    EXPECT_EQ(image.view()(1, 0, 3), 0);
    scene.color = [](double, double, int) { return std::array{0.5, 0.25, 2.0}; };
    const Image<float> opaque = supersample(scene, 2, 1, 3, {regular_pattern(4), box()});
    EXPECT_EQ(opaque.view()(1, 0, 2), 2);
    EXPECT_EQ(opaque.view()(1, 0, 3), 1);
}

TEST(Supersample, MoreSamplesAreNearerToTheTruth) {
    const Signal plate = zone_plate({64, 64}, {.max_frequency = 1});
    const Image<float> truth = render(plate, 64, 64, Sampling::exact(mitchell()));
    double before = 1;
    for (const int count : {1, 4, 16, 64}) {
        const Image<float> image = supersample(of_signal(plate), 1, {0, 0, 64, 64}, {sobol_pattern(count), mitchell()});
        const double error = largest_difference(image.view(), truth.view());
        EXPECT_LT(error, before / 1.5) << count;
        before = error;
    }
}

TEST(Supersample, WrongArgumentsAreRefused) {
    const PointValue one = constant_value({1});
    EXPECT_THROW(supersample(one, 0, {0, 0, 1, 1}), Error);
    EXPECT_THROW(supersample(one, 5, {0, 0, 1, 1}), Error);
    EXPECT_THROW(supersample(one, 1, {0, 0, 0, 1}), Error);
    EXPECT_THROW(supersample(one, 1, {0, 0, 1, 1}, {d3d_pattern(4), nearest()}), Error);
    EXPECT_THROW(check_supersampling({d3d_pattern(4), nearest()}), Error);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(supersample(one, 1, {0, 0, 1, 1}, {}, {.stop = source.get_token()}), Stopped);
}

}  // namespace
}  // namespace bandlimit
