#include "bandlimit/antialias/temporal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "bandlimit/antialias/frame_gather.h"
#include "bandlimit/antialias/history_weights.h"
#include "bandlimit/antialias/temporal_rows.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/targets.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Picture = std::function<double(double x, double y)>;  // of input pixels

/// The radical inverse of i in a base, less 1/2: jitter of Halton's sequence.
double halton(int i, int base) {
    double sum = 0, place = 1.0 / base;
    for (; i > 0; i /= base, place /= base) sum += i % base * place;
    return sum - 0.5;
}
Point jitter_of(int frame) { return {halton(frame + 1, 2), halton(frame + 1, 3)}; }

Image<float> rendered(const Picture& picture, int width, int height, Point jitter, int channels = 3) {
    Image<float> image(width, height, channels, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.view()(x, y, c) = static_cast<float>(picture(x + 0.5 + jitter.x, y + 0.5 + jitter.y));
    return image;
}

/// Rings whose frequency reaches that of the output's pixels.
Picture zone_plate(double size, double scale) {
    return [=](double x, double y) {
        const double r2 = (x - size / 2) * (x - size / 2) + (y - size / 2) * (y - size / 2);
        return 0.5 + 0.5 * std::cos(M_PI * scale * r2 / size);
    };
}

Image<float> accumulated(const Picture& picture, int in, int out, int frames, const TemporalOptions& options) {
    TemporalHistory history(out, out);
    Image<float> result(out, out, 3, Layout::interleaved);
    for (int f = 0; f < frames; ++f) {
        const Image<float> color = rendered(picture, in, in, jitter_of(f));
        accumulate(history, {.color = color.view(), .jitter = jitter_of(f)}, options, result.view(), {2});
    }
    return result;
}

/// sum w s / sum w over the samples of all frames, from the definition.
double supersampled(const Picture& picture, const Kernel& kernel, int in, int out, int frames, int x, int y) {
    const double scale = double(out) / in;
    double sum = 0, weights = 0;
    for (int f = 0; f < frames; ++f) {
        const Point jitter = jitter_of(f);
        for (int j = 0; j < in; ++j)
            for (int i = 0; i < in; ++i) {
                const double w = kernel.value((i + 0.5 + jitter.x) * scale - (x + 0.5)) *
                                 kernel.value((j + 0.5 + jitter.y) * scale - (y + 0.5));
                if (w == 0) continue;
                sum += w * static_cast<double>(static_cast<float>(picture(i + 0.5 + jitter.x, j + 0.5 + jitter.y)));
                weights += w;
            }
    }
    return sum / weights;
}

/// Options under which a pixel is K = 1 times its own sample, and history counts as it is.
TemporalOptions plain() {
    TemporalOptions options = temporal_preset("reference");
    options.kernel = tent();
    return options;
}

Image<float> filled(int width, int height, const std::vector<float>& values) {
    Image<float> image(width, height, static_cast<int>(values.size()), Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) std::copy(values.begin(), values.end(), &image.view()(x, y));
    return image;
}

/// The weights of the four samples at t.
std::array<double, 4> weights_at(HistoryKernel kernel, double t) {
    const auto parts = history_weights(kernel);
    const auto i = std::min(static_cast<std::size_t>(t * double(parts.size())), parts.size() - 1);
    const double rest = t * double(parts.size()) - double(i);
    std::array<double, 4> w{};
    for (std::size_t power = 4; power-- > 0;)
        for (std::size_t k = 0; k < 4; ++k) w[k] = w[k] * rest + double(parts[i][power][k]);
    return w;
}

constexpr HistoryKernel history_kernels[] = {HistoryKernel::bilinear, HistoryKernel::catmull_rom,
                                             HistoryKernel::catmull_rom5, HistoryKernel::lanczos2,
                                             HistoryKernel::bspline};

TEST(Temporal, IsSupersamplingAfterOnePeriod) {
    for (const auto& [in, out] : {std::pair{24, 24}, {16, 24}, {12, 24}, {8, 24}})
        for (const Kernel& kernel : {lanczos(2), gaussian(0.4385), bspline()}) {
            const double scale = double(out) / in;
            const int frames = static_cast<int>(std::lround(8 * scale * scale));
            TemporalOptions options = temporal_preset("reference");
            options.kernel = kernel;
            const Picture picture = zone_plate(in, scale);
            const Image<float> found = accumulated(picture, in, out, frames, options);
            for (int y = 0; y < out; y += 3)
                for (int x = 0; x < out; x += 2)  // roundings of sums of at most 72 frames
                    ASSERT_NEAR(found.view()(x, y), supersampled(picture, kernel, in, out, frames, x, y), 1e-6)
                        << kernel.name << " at " << scale << ": " << x << ", " << y;
        }
}

// The rules that people use have another limit.
TEST(Temporal, PlainRulesAreFarFromTheTruthWhenTheyUpscale) {
    const int in = 32, out = 64, frames = 32;
    const Picture picture = zone_plate(in, 2);
    const auto error = [&](std::string_view preset) {
        const Image<float> found = accumulated(picture, in, out, frames, temporal_preset(preset));
        double sum = 0;
        int count = 0;
        for (int y = 8; y < out - 8; y += 4)
            for (int x = 8; x < out - 8; x += 4, ++count) {
                const double truth = supersampled(picture, lanczos(2), in, out, frames, x, y);
                sum += (double(found.view()(x, y)) - truth) * (double(found.view()(x, y)) - truth);
            }
        return std::sqrt(sum / count);
    };
    EXPECT_LT(error("reference"), 1e-3);
    EXPECT_GT(error("per-frame"), 0.3);
    EXPECT_GT(error("input-sized"), 0.1);
}

// Each frame then counts as much as it has samples: h' = h + (r - K h) / (W + K), W = frames times the mean of K.
TEST(Temporal, RemembersExponentiallyOnceMemoryIsFull) {
    TemporalOptions options = temporal_preset("reference");
    options.kernel = tent();  // of integral 1: at scale 1 the mean of K is 1
    options.still_frames = 5;
    TemporalHistory history(1, 1);
    double h = 0, w = 0;
    Image<float> out(1, 1, 3);
    for (int f = 0; f < 40; ++f) {
        const Point jitter = jitter_of(f);
        const double value = f % 3, weight = (1 - std::abs(jitter.x)) * (1 - std::abs(jitter.y));
        const Image<float> color = rendered([&](double, double) { return value; }, 1, 1, jitter);
        accumulate(history, {.color = color.view(), .jitter = jitter}, options, out.view());
        w = std::min(w, 5.0);
        h = (h * w + value * weight) / (w + weight);
        w += weight;
        ASSERT_NEAR(out.view()(0, 0), h, 1e-5) << f;
    }
}

TEST(Temporal, ConstantsStayConstantWhateverMoves) {
    for (const std::string_view preset : temporal_presets())
        for (const int out : {16, 27, 40}) {
            if (preset == "per-frame") continue;  // it divides by sums of weights near 0, and has few digits left
            TemporalHistory history(out, out);
            Image<float> motion(16, 16, 2), depth(16, 16), result(out, out, 4, Layout::interleaved);
            Random random(5);
            for (int f = 0; f < 12; ++f) {
                Image<float> color(16, 16, 4, Layout::interleaved);
                for (int y = 0; y < 16; ++y)
                    for (int x = 0; x < 16; ++x) {
                        for (int c = 0; c < 3; ++c) color.view()(x, y, c) = 0.25f * float(c + 1);
                        color.view()(x, y, 3) = 1;
                        motion.view()(x, y, 0) = float(4 * random.uniform() - 2);
                        motion.view()(x, y, 1) = float(4 * random.uniform() - 2);
                        depth.view()(x, y) = float(1 + random.uniform());
                    }
                accumulate(
                    history,
                    {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter_of(f)},
                    temporal_preset(preset), result.view());
            }
            for (int y = 0; y < out; ++y)
                for (int x = 0; x < out; ++x)
                    for (int c = 0; c < 4; ++c)
                        ASSERT_NEAR(result.view()(x, y, c), c == 3 ? 1 : 0.25 * (c + 1), 2e-5) << preset << ' ' << out;
        }
}

TEST(Temporal, WhatIsNotFiniteAndWhatIsBrightStaysWhereItIs) {
    for (const std::string_view preset : temporal_presets()) {
        TemporalHistory history(24, 24);
        Image<float> result(24, 24, 3), depth(12, 12), motion(12, 12, 2);
        for (int f = 0; f < 8; ++f) {
            Image<float> color = rendered([](double, double) { return 0.5; }, 12, 12, {});
            const float bad[] = {NAN, INFINITY, -INFINITY, 1e9f};
            for (int c = 0; c < 3; ++c) color.view()(2 + f, 6, c) = bad[f % 4];
            depth.view()(f, f) = NAN;
            motion.view()(f, 3, 1) = NAN;
            accumulate(history,
                       {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter_of(f)},
                       temporal_preset(preset), result.view());
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 24; ++x) {
                    ASSERT_TRUE(std::isfinite(result.view()(x, y))) << preset << ' ' << f;
                    if (y < 5 || y > 19) {
                        ASSERT_NEAR(result.view()(x, y), 0.5, 1e-5) << preset << ' ' << f;
                    }
                }
        }
    }
}

TEST(Temporal, ThreadsGiveTheSameBits) {
    const int in = 40, out = 75;
    const Picture picture = zone_plate(in, 2);
    Image<float> motion(in, in, 2), depth(in, in);
    for (int y = 0; y < in; ++y)
        for (int x = 0; x < in; ++x) {
            motion.view()(x, y, 0) = float(x % 5) / 3, motion.view()(x, y, 1) = float(y % 7) / 5 - 0.5f;
            depth.view()(x, y) = float(1 + x % 3);
        }
    std::vector<Image<float>> results;
    for (const int threads : {1, 2, 7}) {
        TemporalHistory history(out, out);
        Image<float> result(out, out, 4, Layout::interleaved);
        for (int f = 0; f < 5; ++f) {
            const Image<float> color = rendered(picture, in, in, jitter_of(f), 4);
            accumulate(history,
                       {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter_of(f)},
                       temporal_preset("sharp"), result.view(), {threads});
        }
        results.push_back(std::move(result));
    }
    for (std::size_t i = 1; i < results.size(); ++i)
        for (int k = 0; k < out * out * 4; ++k)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(results[0].view().data[k]),
                      std::bit_cast<std::uint32_t>(results[i].view().data[k]));
}

/// Frames in which everything that a step may do is done somewhere.
Image<float> eventful(const TemporalOptions& options, int channels) {
    const int in = 37, out_width = 61, out_height = 50;
    TemporalHistory history(out_width, out_height);
    Image<float> result(out_width, out_height, 4, Layout::interleaved);
    Random random(11);
    for (int f = 0; f < 4; ++f) {
        Image<float> color(in, in, channels, f % 2 == 0 ? Layout::interleaved : Layout::planar), depth(in, in),
            motion(in, in, 2), reactive(in, in);
        for (int y = 0; y < in; ++y)
            for (int x = 0; x < in; ++x) {
                for (int c = 0; c < channels; ++c)
                    color.view()(x, y, c) = float(random.uniform() * (c == 1 && x % 9 == 0 ? 30 : 1));
                depth.view()(x, y) = float(1 + x % 3 + (y > 20 ? random.uniform() : 0));
                motion.view()(x, y, 0) = x < 12 ? 0 : x < 20 ? 2 : float(4 * random.uniform() - 2);
                motion.view()(x, y, 1) = y < 12 ? 0 : float(2 * random.uniform() - 1);
                reactive.view()(x, y) = x > 30 ? float(random.uniform()) : 0;
            }
        color.view()(5, 5, 0) = NAN, motion.view()(7, 7, 0) = INFINITY, reactive.view()(34, 3) = NAN;
        accumulate(history,
                   {.color = color.view(),
                    .depth = depth.view(),
                    .motion = motion.view(),
                    .reactive = reactive.view(),
                    .jitter = jitter_of(f),
                    .exposure = f == 2 ? 1.5 : 1},
                   options, result.view());
    }
    return result;
}

// The definition is compiled as the scalar target; all others do the same sums in the same order.
TEST(Temporal, TargetsGiveTheSameBits) {
    const auto compare_with_definition = [](const TemporalOptions& options, int channels) {
        const Image<float> defined = [&] {
            const TargetScope scope(Target::scalar);
            return eventful(options, channels);
        }();
        for (const Target target : supported_targets()) {
            const TargetScope scope(target);
            const Image<float> found = eventful(options, channels);
            for (int i = 0; i < defined.width() * defined.height() * 4; ++i) {
                const float a = defined.view().data[i], b = found.view().data[i];
                if (has_fused_multiply_add(target))
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b))
                        << name_of(target) << ' ' << i << ": " << a << ' ' << b;
                else ASSERT_TRUE(std::isfinite(b));
            }
        }
    };
    for (const std::string_view preset : temporal_presets()) compare_with_definition(temporal_preset(preset), 3);
    TemporalOptions steady = temporal_preset("sharp");
    steady.anti_flicker = 1, steady.deringing_frames = 6, steady.lock_frames = 4;
    compare_with_definition(steady, 4);
    for (const HistoryKernel kernel : history_kernels)
        for (const Rectification kind : {Rectification::clamp, Rectification::clip, Rectification::variance}) {
            TemporalOptions options;
            options.history_kernel = kernel, options.rectification = kind;
            options.rectifies_ycocg = kernel == HistoryKernel::bspline;
            compare_with_definition(options, 4);
        }
}

// Where all is opaque, alpha is 1, however many weights it is a mean of.
TEST(Temporal, WhatIsOpaqueStaysSoExactly) {
    TemporalHistory history(30, 30);
    Image<float> out(30, 30, 4);
    for (int f = 0; f < 6; ++f) {
        const Image<float> color = filled(20, 20, {0.25f, 0.5f, 1, 1}), motion = filled(20, 20, {0.3f, 0.7f});
        accumulate(history, {.color = color.view(), .motion = motion.view(), .jitter = jitter_of(f)}, {}, out.view());
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x) ASSERT_EQ(out.view()(x, y, 3), 1);
    }
}

TEST(Temporal, ACutIsANewBeginning) {
    const Picture before = zone_plate(16, 1);
    const Picture after = [](double x, double y) { return x > y ? 1.0 : 0.25; };
    TemporalHistory history(32, 32), fresh(32, 32);
    Image<float> a(32, 32, 3), b(32, 32, 3);
    for (int f = 0; f < 6; ++f) {
        const Image<float> color = rendered(before, 16, 16, jitter_of(f));
        accumulate(history, {.color = color.view(), .jitter = jitter_of(f)}, {}, a.view());
    }
    for (int f = 0; f < 4; ++f) {
        const Image<float> color = rendered(after, 16, 16, jitter_of(f));
        TemporalFrame frame{.color = color.view(), .jitter = jitter_of(f)};
        accumulate(fresh, frame, {}, b.view());
        frame.is_cut = f == 0;
        accumulate(history, frame, {}, a.view());
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) ASSERT_EQ(a.view()(x, y), b.view()(x, y)) << f;
    }
    EXPECT_EQ(history.frames(), 4);
}

TEST(Temporal, AClonedHistoryGoesItsOwnWay) {
    const Image<float> grey = filled(16, 16, {0.5f, 0.5f, 0.5f, 0.5f}), white = filled(16, 16, {1, 1, 1, 1}),
                       depth = filled(16, 16, {2});
    TemporalHistory history(20, 20);
    Image<float> a(20, 20, 4), b(20, 20, 4);
    for (int f = 0; f < 3; ++f)
        accumulate(history, {.color = grey.view(), .depth = depth.view(), .jitter = jitter_of(f)}, {}, a.view());
    TemporalHistory branch = history.clone();
    EXPECT_EQ(branch.frames(), 3);
    accumulate(branch, {.color = white.view(), .depth = depth.view(), .jitter = jitter_of(3)}, {}, b.view());
    EXPECT_EQ(history.frames(), 3);
    TemporalHistory other = history.clone();
    accumulate(history, {.color = grey.view(), .depth = depth.view(), .jitter = jitter_of(3)}, {}, a.view());
    EXPECT_LT(a.view()(9, 9), b.view()(9, 9) - 0.05f);
    accumulate(other, {.color = grey.view(), .depth = depth.view(), .jitter = jitter_of(3)}, {}, b.view());
    for (int c = 0; c < 4; ++c) EXPECT_EQ(a.view()(9, 9, c), b.view()(9, 9, c));
}

// What moves by whole pixels is read where it was, exactly; a picture that moves so is as sharp as one that is still.
TEST(Temporal, FollowsMotion) {
    const int size = 48;
    Random random(9);
    Image<float> texture(4 * size, 4 * size);
    for (int i = 0; i < 16 * size * size; ++i) texture.view().data[i] = float(random.uniform());
    const auto texel = [&](double x, double y) { return double(texture.view()(int(x) + size, int(y) + size)); };
    TemporalOptions options = temporal_preset("reference");
    options.kernel = tent();
    TemporalHistory history(size, size);
    Image<float> motion(size, size, 2), result(size, size, 3);
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) motion.view()(i, j, 0) = -3, motion.view()(i, j, 1) = 2;
    for (int f = 0; f < 5; ++f) {
        const Image<float> color =
            rendered([&](double x, double y) { return texel(x - 3 * f, y + 2 * f); }, size, size, {});
        accumulate(history, {.color = color.view(), .motion = motion.view()}, options, result.view());
        for (int y = 0; y < size - 10; ++y)
            for (int x = 12; x < size; ++x) ASSERT_NEAR(result.view()(x, y), color.view()(x, y), 1e-6) << f;
    }
}

TEST(Temporal, WhatReactsForgets) {
    TemporalHistory history(8, 8);
    Image<float> reactive(8, 8), result(8, 8, 3);
    for (int y = 0; y < 8; ++y)
        for (int x = 4; x < 8; ++x) reactive.view()(x, y) = 1;
    for (int f = 0; f < 5; ++f) {
        const Image<float> color = rendered([&](double, double) { return f == 4 ? 1 : 0; }, 8, 8, {});
        accumulate(history, {.color = color.view(), .reactive = reactive.view()}, temporal_preset("reference"),
                   result.view());
    }
    EXPECT_EQ(result.view()(6, 3), 1);
    EXPECT_NEAR(result.view()(1, 3), 0.2, 1e-6);
}

TEST(Temporal, FollowsExposure) {
    TemporalHistory history(8, 8);
    Image<float> result(8, 8, 3);
    for (int f = 0; f < 6; ++f) {
        const double exposure = f < 3 ? 1 : 4;
        const Image<float> color = rendered([&](double, double) { return 0.2 * exposure; }, 8, 8, {});
        accumulate(history, {.color = color.view(), .exposure = exposure}, {}, result.view());
        for (int x = 0; x < 8; ++x) ASSERT_NEAR(result.view()(x, 3), 0.2 * exposure, 1e-6) << f;
    }
}

TEST(Temporal, RefusesWhatDoesNotFit) {
    TemporalHistory history(16, 16);
    Image<float> out(16, 16, 3), small(8, 8, 3), grey(8, 8), large(17, 8, 3);
    const auto run = [&](const TemporalFrame& frame, const TemporalOptions& options = {}) {
        accumulate(history, frame, options, out.view());
    };
    EXPECT_NO_THROW(run({.color = small.view()}));
    EXPECT_THROW(run({}), Error);
    EXPECT_THROW(run({.color = grey.view()}), Error);
    EXPECT_THROW(run({.color = large.view()}), Error);
    EXPECT_THROW(run({.color = small.view(), .depth = out.view()}), Error);
    EXPECT_THROW(run({.color = small.view(), .motion = grey.view()}), Error);
    EXPECT_THROW(run({.color = small.view(), .jitter = {NAN, 0}}), Error);
    EXPECT_THROW(run({.color = small.view(), .jitter = {0, 1.5}}), Error);
    EXPECT_THROW(run({.color = small.view(), .exposure = 0}), Error);
    EXPECT_THROW(run({.color = small.view()}, {.kernel = jinc_lanczos(2)}), Error);
    EXPECT_THROW(run({.color = small.view()}, {.rectify_share = 2}), Error);
    EXPECT_THROW(TemporalHistory(0, 4), Error);
    EXPECT_THROW(temporal_preset("ultra"), Error);
}

TEST(HistoryWeights, SumToOneAndMirror) {
    for (const HistoryKernel kernel : history_kernels)
        for (int i = 0; i <= 320; ++i) {
            const auto w = weights_at(kernel, i / 320.0), mirrored = weights_at(kernel, 1 - i / 320.0);
            EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 4e-7) << name_of(kernel);
            for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(w[k], mirrored[3 - k], 4e-7) << name_of(kernel);
        }
}

TEST(HistoryWeights, AreThoseOfTheirKernels) {
    for (int i = 0; i < 1000; ++i) {
        const double t = i / 1000.0;
        const auto check = [&](HistoryKernel kernel, const Kernel& truth) {
            double sum = 0;
            for (int k = -1; k <= 2; ++k) sum += truth.value(t - k);
            for (int k = -1; k <= 2; ++k)
                EXPECT_NEAR(weights_at(kernel, t)[std::size_t(k + 1)], truth.value(t - k) / sum, 1e-6) << t;
        };
        check(HistoryKernel::bilinear, tent());
        check(HistoryKernel::catmull_rom, catmull_rom());
        check(HistoryKernel::lanczos2, lanczos(2));
        check(HistoryKernel::bspline, bspline());
    }
}

/// What a history of one frame shows when it is moved.
Image<float> moved_history(HistoryKernel kernel, const Image<float>& color, float dx, float dy) {
    TemporalOptions options = plain();
    options.history_kernel = kernel;
    const int width = color.width(), height = color.height();
    TemporalHistory history(width, height);
    Image<float> out(width, height, 3), motion(width, height, 2), black(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) motion.view()(x, y, 0) = dx, motion.view()(x, y, 1) = dy;
    accumulate(history, {.color = color.view()}, options, out.view());
    options.kernel = gaussian(0.1);  // no sample is near enough to count
    accumulate(history, {.color = black.view(), .motion = motion.view(), .jitter = {0.5, 0.5}}, options, out.view());
    return out;
}

TEST(Temporal, ReadsHistoryAtSamplesExactlyAndWithinTheNeighboursElsewhere) {
    Image<float> color(12, 10, 3);
    Random random(3);
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 12; ++x)
            for (int c = 0; c < 3; ++c) color.view()(x, y, c) = float(random.uniform());
    for (const HistoryKernel kernel : history_kernels) {
        const Image<float> still = moved_history(kernel, color, 0, 0);
        const Image<float> whole = moved_history(kernel, color, -2, 3);
        for (int y = 0; y < 6 && kernel != HistoryKernel::bspline; ++y)
            for (int x = 3; x < 12; ++x) ASSERT_EQ(whole.view()(x, y, 1), still.view()(x - 2, y + 3, 1)) << x << y;
        for (int i = 0; i < 8; ++i) {
            const float dx = float(2 * random.uniform() - 1), dy = float(2 * random.uniform() - 1);
            const Image<float> between = moved_history(kernel, color, dx, dy);
            for (int y = 1; y < 8; ++y)
                for (int x = 1; x < 10; ++x) {
                    const int left = x + int(std::floor(dx)), top = y + int(std::floor(dy));
                    const auto at = [&](int k) { return color.view()(left + k % 2, top + k / 2, 1); };
                    const auto [low, high] = std::minmax({at(0), at(1), at(2), at(3)});
                    ASSERT_GE(between.view()(x, y, 1), low - 1e-6f) << name_of(kernel);
                    ASSERT_LE(between.view()(x, y, 1), high + 1e-6f) << name_of(kernel);
                }
        }
    }
}

TEST(Temporal, OfFiveFetchesLeavesTheCornersOut) {
    const auto red = [&](HistoryKernel kernel, float corner) {
        Image<float> color = filled(8, 8, {0.25f, 0.5f, 0.75f});
        color.view()(2, 2, 0) = corner;                        // a corner of the 4 x 4 samples about (3.5, 3.25)
        color.view()(3, 3, 0) = 1, color.view()(4, 4, 0) = 0;  // room for a difference
        return moved_history(kernel, color, 0.5f, 0.25f).view()(3, 3, 0);
    };
    const auto influence = [&](HistoryKernel kernel) { return std::abs(red(kernel, 1) - red(kernel, 0)); };
    EXPECT_GT(influence(HistoryKernel::catmull_rom), 5 * influence(HistoryKernel::catmull_rom5));
}

TEST(Highlights, ComeBackFromCompression) {
    for (const float v : {-1.0f, 0.0f, 0.5f, 1.0f, 1.001f, 3.0f, 250.0f, 1e6f}) {
        float rgb[3] = {v, v / 2, -v / 7};
        const float was[3] = {rgb[0], rgb[1], rgb[2]};
        compress_highlight(rgb);
        EXPECT_LE(rgb[0], v > 1 ? 1 + std::log(v) + 1e-4f : was[0]);
        restore_highlight(rgb);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], was[c], 2e-6 * std::abs(double(v)) * 16);
    }
}

// ---- What is read where, and what is rejected

TEST(Temporal, FollowsMotionWhenItUpscales) {
    const int in = 24, out = 48;
    TemporalHistory history(out, out);
    const Image<float> motion = filled(in, in, {-1, 0});
    Image<float> first(out, out, 3), result(out, out, 3);
    for (int f = 0; f < 4; ++f) {
        const Image<float> color = rendered(
            [&](double x, double y) { return std::sin(0.9 * (x - f)) * std::cos(0.7 * y) / 2 + 0.5; }, in, in, {});
        accumulate(history, {.color = color.view(), .motion = motion.view()}, plain(),
                   f <= 1 ? first.view() : result.view());
        for (int y = 0; y < out && f > 1; ++y)  // the first frame alone has little weight: it shows samples too
            for (int x = 8; x < out; ++x) ASSERT_NEAR(result.view()(x, y), first.view()(x - 2 * (f - 1), y), 1e-6) << f;
    }
}

TEST(Temporal, WhatComesFromOutsideHasNoHistory) {
    for (const auto& [x, y] : {std::pair{9.0f, 0.0f}, {-9.0f, 0.0f}, {0.0f, 9.0f}, {0.0f, -9.0f}}) {
        TemporalHistory history(8, 8);
        Image<float> result(8, 8, 3), lost(8, 8);
        const Image<float> before = filled(8, 8, {1, 1, 1}), now = filled(8, 8, {0.25f, 0.5f, 0}),
                           motion = filled(8, 8, {x, y});
        accumulate(history, {.color = before.view()}, plain(), result.view());
        accumulate(history, {.color = now.view(), .motion = motion.view()}, plain(), result.view(), {},
                   {.disocclusion = lost.view()});
        EXPECT_EQ(result.view()(4, 4, 0), 0.25f);
        EXPECT_EQ(result.view()(4, 4, 2), 0);
        EXPECT_EQ(lost.view()(4, 4), 1);
    }
}

TEST(Temporal, AnotherDepthKeepsAShareOfItsMemory) {
    const Image<float> color = filled(8, 8, {0.5f, 0.5f, 0.5f}), near = filled(8, 8, {2}), far = filled(8, 8, {3}),
                       almost = filled(8, 8, {2.1f});
    for (const double keep : {0.0, 0.5, 1.0}) {
        TemporalOptions options = plain();
        options.depth_tolerance = 0.1, options.disocclusion_keep = keep;
        TemporalHistory history(8, 8);
        Image<float> result(8, 8, 3), memory(8, 8);
        const auto memory_after = [&](const Image<float>& depth) {
            accumulate(history, {.color = color.view(), .depth = depth.view()}, options, result.view(), {},
                       {.memory = memory.view()});
            return memory.view()(3, 5);
        };
        EXPECT_EQ(memory_after(near), 1);
        EXPECT_EQ(memory_after(near), 2);
        EXPECT_EQ(memory_after(almost), 3) << "5 % is within the tolerance";
        EXPECT_NEAR(memory_after(far), 1 + 3 * keep, 1e-6);
    }
}

// The last frame's samples lie where its jitter put them.
TEST(Temporal, ComparesDepthWhereItWas) {
    TemporalOptions options = plain();
    options.depth_tolerance = 0.1;
    TemporalHistory history(16, 4);
    const Image<float> color = filled(16, 4, {0.5f, 0.5f, 0.5f});
    Image<float> before(16, 4), now(16, 4), result(16, 4, 3), lost(16, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 16; ++x) {
            before.view()(x, y) = static_cast<float>(1 << x);  // the sample at x + 0.9
            now.view()(x, y) = static_cast<float>(1 << std::max(0, x - 1));
        }
    accumulate(history, {.color = color.view(), .depth = before.view(), .jitter = {0.4, 0}}, options, result.view());
    accumulate(history, {.color = color.view(), .depth = now.view()}, options, result.view(), {},
               {.disocclusion = lost.view()});
    for (int x = 1; x < 16; ++x) EXPECT_EQ(lost.view()(x, 2), 0) << x;
}

TEST(Temporal, TakesTheMotionOfWhatIsInFront) {
    const Image<float> color = filled(8, 8, {0.5f, 0.5f, 0.5f});
    Image<float> depth = filled(8, 8, {9}), motion = filled(8, 8, {0, 0}), result(8, 8, 3), used(8, 8, 2);
    depth.view()(4, 4) = 1, motion.view()(4, 4, 0) = -2;
    for (const bool dilates : {true, false}) {
        TemporalHistory history(8, 8);
        TemporalOptions options = plain();
        options.dilates_motion = dilates;
        accumulate(history, {.color = color.view(), .depth = depth.view(), .motion = motion.view()}, options,
                   result.view(), {}, {.motion = used.view()});
        EXPECT_EQ(used.view()(4, 4, 0), -2);
        EXPECT_EQ(used.view()(3, 5, 0), dilates ? -2 : 0);
        EXPECT_EQ(used.view()(2, 4, 0), 0);
    }
}

TEST(Temporal, WhatMovesRemembersLess) {
    for (const float speed : {0.0f, 1.0f, 3.0f}) {
        TemporalOptions options = plain();
        options.kernel = gaussian(0.4385);
        options.still_frames = 12, options.forget_by_motion = 5;
        TemporalHistory history(40, 40);
        const Image<float> color = filled(20, 20, {0.5f, 0.5f, 0.5f}), motion = filled(20, 20, {0, speed / 2});
        Image<float> result(40, 40, 3), memory(40, 40), weight(40, 40);
        for (int f = 0; f < 70; ++f)
            accumulate(history, {.color = color.view(), .motion = motion.view(), .jitter = jitter_of(f)}, options,
                       result.view(), {}, {.frame_weight = weight.view(), .memory = memory.view()});
        // The mean of K over all phases is the kernel's integral over the plane in input pixels: 2 pi sigma^2 / 4.
        const double most = 12 / (1 + 5 * double(speed)) * 2 * M_PI * 0.4385 * 0.4385 / 4;
        EXPECT_NEAR(memory.view()(20, 20), most + double(weight.view()(20, 20)), 2e-3 * most) << speed;
    }
}

// Where no sample is near, the picture is interpolated between those that there are.
TEST(Temporal, InterpolatesWhatItHasNotSeen) {
    TemporalOptions options = plain();
    options.kernel = gaussian(0.1);
    for (const Point jitter : {Point{0.3, -0.2}, Point{-0.45, 0.1}}) {
        TemporalHistory history(32, 32);
        const Image<float> color = rendered([](double x, double y) { return 0.05 * x + 0.02 * y; }, 8, 8, jitter);
        Image<float> result(32, 32, 3);
        accumulate(history, {.color = color.view(), .jitter = jitter}, options, result.view());
        for (int y = 6; y < 26; ++y)
            for (int x = 6; x < 26; ++x)
                if (std::abs(result.view()(x, y) - (0.05 * (x + 0.5) + 0.02 * (y + 0.5)) / 4) > 4e-3)
                    FAIL() << x << ", " << y << ": "
                           << result.view()(x, y);  // a sample alone is at most 0.1 pixels off
    }
}

TEST(Temporal, SharpensWithinTheNeighboursAndLeavesAlpha) {
    Image<float> color = filled(16, 16, {0.25f, 0.25f, 0.25f, 0.5f});
    for (int y = 0; y < 16; ++y)
        for (int x = 8; x < 16; ++x)
            for (int c = 0; c < 4; ++c) color.view()(x, y, c) = x == 8 ? 0.6f : 1;
    TemporalOptions options = plain();
    Image<float> soft(16, 16, 4), sharp(16, 16, 4);
    TemporalHistory a(16, 16), b(16, 16);
    accumulate(a, {.color = color.view()}, options, soft.view());
    options.sharpening = 1;
    accumulate(b, {.color = color.view()}, options, sharp.view());
    for (int y = 1; y < 15; ++y)
        for (int x = 1; x < 15; ++x)
            for (int c = 0; c < 4; ++c) {
                const auto at = [&](int i, int j) { return soft.view()(i, j, c); };
                const float v = at(x, y), mean = (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1)) / 4;
                const auto [low, high] = std::minmax({v, at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)});
                EXPECT_NEAR(sharp.view()(x, y, c), c == 3 ? v : std::clamp(2 * v - mean, low, high), 1e-6)
                    << x << ' ' << c;
            }
}

// Lanczos rings beside an edge, most while a pixel has few samples; then it does what its limit does.
TEST(Temporal, DeringingHoldsBackWhatRingsUntilThereIsMore) {
    const Picture edge = [](double x, double y) { return x + 0.3 * y > 15 ? 1 : 0; };
    TemporalOptions plain_options = temporal_preset("sharp");
    plain_options.sharpening = 0;
    TemporalOptions deringed = plain_options;
    deringed.deringing_frames = 16;
    double plain_ringing = 0, ringing = 0;
    TemporalHistory a(48, 48), b(48, 48);
    Image<float> with(48, 48, 3), without(48, 48, 3);
    for (int f = 0; f < 40; ++f) {
        const Image<float> color = rendered(edge, 24, 24, jitter_of(f));
        accumulate(a, {.color = color.view(), .jitter = jitter_of(f)}, plain_options, without.view());
        accumulate(b, {.color = color.view(), .jitter = jitter_of(f)}, deringed, with.view());
        const auto beyond = [](float v) { return std::max({0.0, double(v) - 1, -double(v)}); };
        for (int y = 0; y < 48 && f < 4; ++y)
            for (int x = 0; x < 48; ++x)
                plain_ringing += beyond(without.view()(x, y)), ringing += beyond(with.view()(x, y));
    }
    EXPECT_LT(ringing, plain_ringing / 4);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) ASSERT_EQ(with.view()(x, y), without.view()(x, y)) << "the limit";
}

// A line of a third of a pixel that moves along: most samples miss it, and those beside it would have it forgotten.
TEST(Temporal, LocksKeepThinThingsThatMove) {
    const auto brightness = [](double lock_frames) {
        const int size = 40, frames = 24;
        TemporalOptions options;
        options.lock_frames = lock_frames;
        TemporalHistory history(size, size);
        Image<float> out(size, size, 3);
        const Image<float> motion = filled(size, size, {-0.6f, 0}), depth = filled(size, size, {5});
        double sum = 0;
        for (int f = 0; f < frames; ++f) {
            const double middle = 8 + 0.6 * f;
            const Image<float> color = rendered(
                [&](double x, double) { return std::abs(x - middle) < 1.0 / 6 ? 1 : 0.1; }, size, size, jitter_of(f));
            accumulate(history,
                       {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter_of(f)},
                       options, out.view());
            for (int y = 10; y < 30 && f >= 12; ++y)
                for (int x = 0; x < size; ++x) sum += (double(out.view()(x, y)) - 0.1) / (20 * 12);
        }
        return sum;  // of a third of a pixel, 0.9 brighter: 0.3 per row
    };
    const double without = brightness(0), with = brightness(8);
    EXPECT_GT(with, 1.2 * without);
    EXPECT_LT(with, 0.31);
}

// One sample in eight hits something bright.
TEST(Temporal, AntiFlickerSteadiesAndLeavesConstantsAlone) {
    const auto deviation = [](double strength) {
        TemporalOptions options = plain();
        options.still_frames = 8, options.anti_flicker = strength;
        TemporalHistory history(4, 4);
        Image<float> out(4, 4, 3);
        double sum = 0, squares = 0;
        for (int f = 0; f < 96; ++f) {
            const float v = f % 8 == 3 ? 1 : 0.1f;
            accumulate(history, {.color = filled(4, 4, {v, v, v}).view()}, options, out.view());
            if (f < 32) continue;
            const double shown = double(out.view()(2, 1));
            sum += shown / 64, squares += shown * shown / 64;
        }
        return std::sqrt(squares - sum * sum);
    };
    EXPECT_LT(deviation(2), deviation(0) / 2);
    TemporalOptions options;
    options.anti_flicker = 3;
    TemporalHistory history(9, 9);
    Image<float> out(9, 9, 3);
    for (int f = 0; f < 9; ++f)
        accumulate(history, {.color = filled(6, 6, {0.25f, 0.5f, 0.125f}).view(), .jitter = jitter_of(f)}, options,
                   out.view());
    EXPECT_NEAR(out.view()(4, 4, 1), 0.5, 1e-6);
}

/// What becomes of `color` beside samples of that range, or that mean and spread, by the definition.
std::array<double, 3> rectified(std::array<double, 3> color, const std::array<double, 3>& centre,
                                const std::array<double, 3>& half, bool clips) {
    double share = 1;
    for (std::size_t c = 0; c < 3; ++c)
        if (std::abs(color[c] - centre[c]) > half[c]) share = std::min(share, half[c] / std::abs(color[c] - centre[c]));
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = clips ? centre[c] + share * (color[c] - centre[c])
                         : std::clamp(color[c], centre[c] - half[c], centre[c] + half[c]);
    return color;
}

std::array<double, 3> ycocg_of(const std::array<double, 3>& c) {
    return {(c[0] + 2 * c[1] + c[2]) / 4, (c[0] - c[2]) / 2, (2 * c[1] - c[0] - c[2]) / 4};
}
std::array<double, 3> rgb_of(const std::array<double, 3>& c) {
    return {c[0] - c[2] + c[1], c[0] + c[2], c[0] - c[1] - c[2]};
}

TEST(Temporal, RectifiesByItsDefinition) {
    const std::array<double, 3> was{0.9, 0.5, 0.1}, even{0.2, 0.3, 0.4}, odd{0.4, 0.2, 0.6};
    for (const Rectification kind : {Rectification::clamp, Rectification::clip, Rectification::variance})
        for (const bool ycocg : {false, true})
            for (const float speed : {0.0f, 1.0f}) {
                TemporalOptions options = plain();
                options.rectification = kind, options.rectifies_ycocg = ycocg;
                options.rectify_share = 0.5, options.box_size = 0.75, options.doubt = 0.1;
                TemporalHistory history(12, 12);
                Image<float> result(12, 12, 3), memory(12, 12), outside(12, 12);
                const Image<float> before = filled(12, 12, {0.9f, 0.5f, 0.1f}), motion = filled(12, 12, {speed, 0});
                Image<float> now(12, 12, 3);  // columns in turn: 3 x 3 samples have 6 of one and 3 of the other
                for (int y = 0; y < 12; ++y)
                    for (int x = 0; x < 12; ++x)
                        for (int c = 0; c < 3; ++c)
                            now.view()(x, y, c) = static_cast<float>((x % 2 ? odd : even)[std::size_t(c)]);
                accumulate(history, {.color = before.view()}, options, result.view());
                accumulate(history, {.color = now.view(), .motion = motion.view()}, options, result.view(), {},
                           {.memory = memory.view(), .rejection = outside.view()});
                const auto a = ycocg ? ycocg_of(odd) : odd, b = ycocg ? ycocg_of(even) : even,
                           h = ycocg ? ycocg_of(was) : was;
                std::array<double, 3> centre{}, extent{}, half{};
                for (std::size_t c = 0; c < 3; ++c) {  // at the even column 6: six odd samples, three even ones
                    const bool is_variance = kind == Rectification::variance;
                    centre[c] = is_variance ? (6 * a[c] + 3 * b[c]) / 9 : (a[c] + b[c]) / 2;
                    extent[c] = is_variance ? std::abs(a[c] - b[c]) * std::sqrt(2.0) / 3 : std::abs(a[c] - b[c]) / 2;
                    half[c] = extent[c] * (is_variance ? 0.75 : 1);
                }
                double far = 0;
                const auto clamped = rectified(h, centre, half, false);
                for (std::size_t c = 0; c < 3; ++c)
                    far = std::max(far, std::abs(h[c] - clamped[c]) / (extent[c] + 0.02));
                auto inside = rectified(h, centre, half, kind == Rectification::clip);
                if (ycocg) inside = rgb_of(inside);
                const double left = speed == 0 ? 1 : 1 / (1 + 0.1 * far);
                // Sums of squares lose digits: an extent of 0 may come out as 3e-4 of the value.
                EXPECT_NEAR(outside.view()(6, 5), speed == 0 ? 0 : far, 2e-3 * far) << name_of(kind) << ycocg;
                EXPECT_NEAR(memory.view()(6, 5), 1 + left, 1e-3);
                for (int c = 0; c < 3; ++c) {
                    const double old = was[std::size_t(c)],
                                 moved = speed == 0 ? old : (old + inside[std::size_t(c)]) / 2;
                    EXPECT_NEAR(result.view()(6, 5, c), (left * moved + even[std::size_t(c)]) / (left + 1), 2e-4)
                        << name_of(kind) << ycocg << speed;
                }
            }
}

// A pixel that something has left is soon as good as if nothing had been there.
TEST(Temporal, ForgetsWhatCoveredAPixel) {
    const int size = 32;
    TemporalHistory history(size, size);
    Image<float> result(size, size, 3);
    const auto background = [](double x, double y) { return 0.5 + 0.3 * std::sin(x) * std::sin(0.7 * y); };
    double found = 0, raw = 0;
    for (int f = 0; f < 8; ++f) {
        Image<float> color = rendered(background, size, size, jitter_of(f)), depth = filled(size, size, {9}),
                     motion = filled(size, size, {0, 0});
        for (int y = 8; y < 24; ++y)
            for (int x = 4 + 3 * f - 3; x < 4 + 3 * f + 3; ++x)
                if (x >= 0 && x < size && f < 6) {
                    for (int c = 0; c < 3; ++c) color.view()(x, y, c) = 1;
                    depth.view()(x, y) = 1, motion.view()(x, y, 0) = -3;
                }
        accumulate(history,
                   {.color = color.view(), .depth = depth.view(), .motion = motion.view(), .jitter = jitter_of(f)}, {},
                   result.view());
        if (f == 7)  // two frames after it went from about x = 16 to 22
            for (int y = 10; y < 22; ++y)
                for (int x = 8; x < 22; ++x) {
                    const double truth = background(x + 0.5, y + 0.5);
                    found += std::abs(double(result.view()(x, y)) - truth);
                    raw += std::abs(double(color.view()(x, y)) - truth);
                }
    }
    EXPECT_LT(found, raw);
}

// What flickers while nothing moves is below a code of sRGB.
TEST(Temporal, IsSteadyWhenNothingMoves) {
    for (const std::string_view preset : {"balanced", "fast", "sharp"}) {
        const int in = 24, out = 48, period = 32;
        const Picture picture = zone_plate(in, 1);
        TemporalHistory history(out, out);
        Image<float> result(out, out, 3);
        std::vector<double> sums(std::size_t(out * out)), squares = sums;
        for (int f = 0; f < 3 * period; ++f) {
            const Point jitter = jitter_of(f % period);
            const Image<float> color = rendered(picture, in, in, jitter);
            accumulate(history, {.color = color.view(), .jitter = jitter}, temporal_preset(preset), result.view());
            for (int i = 0; i < out * out && f >= 2 * period; ++i) {
                const double linear = std::max(0.0f, result.view()(i % out, i / out));
                const double code = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
                sums[std::size_t(i)] += code / period, squares[std::size_t(i)] += code * code / period;
            }
        }
        double deviation = 0;
        for (std::size_t i = 0; i < sums.size(); ++i)
            deviation += std::sqrt(std::max(0.0, squares[i] - sums[i] * sums[i])) / double(sums.size());
        EXPECT_LT(deviation, 1.0 / 255) << preset;
    }
}

TEST(Temporal, FillsWhatIsNotFiniteWithItsNeighbours) {
    Image<float> color(5, 5, 3), out(5, 5, 3);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x)
            for (int c = 0; c < 3; ++c) color.view()(x, y, c) = static_cast<float>(x + 2 * y) / 16;
    color.view()(2, 2, 1) = NAN, color.view()(0, 0, 0) = INFINITY;
    TemporalHistory history(5, 5);
    accumulate(history, {.color = color.view()}, plain(), out.view());
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(out.view()(2, 2, c), 6.0 / 16, 1e-7);  // the mean of a ramp is its middle
        EXPECT_NEAR(out.view()(0, 0, c), (1 + 2 + 3) / 3.0 / 16, 1e-7);
    }
}

TEST(FrameGather, KnowsTheNearestSample) {
    for (const double jitter : {-0.45, 0.0, 0.3, 0.45})
        for (const int out : {16, 23, 40}) {
            const FrameGather gather = frame_gather(tent(), false, 16, 16, out, out, {jitter, 0});
            for (int x = 0; x < out; ++x) {
                const double at = (x + 0.5) * 16 / out;
                const auto distance = [&](int i) { return std::abs(i + 0.5 + jitter - at); };
                const int i = gather.near_x[std::size_t(x)];
                EXPECT_LE(distance(i), distance(std::max(0, i - 1)) + 1e-12);
                EXPECT_LE(distance(i), distance(std::min(15, i + 1)) + 1e-12);
            }
        }
}

}  // namespace
}  // namespace bandlimit
