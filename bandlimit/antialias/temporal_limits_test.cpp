// What accumulation over time must hold on whole scenes: near the truth, without flicker, and quick to forget.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "bandlimit/antialias/supersample.h"
#include "bandlimit/antialias/temporal.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/sampling/sequence.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit {
namespace {

/// A scene for an output of width x height, as frames of an input that is `scale` times smaller.
class Sequence {
public:
    Sequence(std::string_view name, int width, int height, double scale, const SceneOptions& options = {})
        : truth(make_scene(name, width, height, options)),
          width(width),
          height(height),
          jitter(jitter_sequence(JitterKind::halton, jitter_length(scale))),
          seen_(with_larger_pixels(truth, scale, scale)),
          in_width_(static_cast<int>(std::lround(width / scale))),
          in_height_(static_cast<int>(std::lround(height / scale))) {}

    int period() const { return static_cast<int>(jitter.size()); }
    Point jitter_of(int frame) const { return jitter[static_cast<std::size_t>(frame) % jitter.size()]; }
    Image<float> frame(int i) const {
        return render_scene(seen_, in_width_, in_height_, i, {.jitter = jitter_of(i)}, {2});
    }
    /// What the history shows after one more frame.
    Image<float> step(TemporalHistory& history, int i, const Image<float>& frame,
                      const TemporalOptions& options) const {
        Image<float> out(width, height, 3, Layout::interleaved);
        accumulate(history,
                   {.color = channels_of(frame.view(), scene_channel::color, 3),
                    .depth = channels_of(frame.view(), scene_channel::depth, 1),
                    .motion = channels_of(frame.view(), scene_channel::motion, 2),
                    .jitter = jitter_of(i)},
                   options, out.view(), {2});
        return out;
    }

    Scene truth;
    int width, height;
    std::vector<Point> jitter;

private:
    Scene seen_;
    int in_width_, in_height_;
};

// h' = (1 - alpha K) h + alpha r, against the plain mean over one period of the jitter. Some twenty samples count, each
// a little more than the one before it, so that their mean depends on which comes last: by some .02 on an edge, and most
// in the middle of a period. At its end the samples are those of the mean.
TEST(TemporalLimits, ExponentialMeansStayNearTheMeanOfAPeriodOnAnEdge) {
    constexpr double alpha = 0.1;
    for (const double scale : {1.0, 1.5, 2.0, 3.0}) {
        const Sequence sequence("edge", 48, 48, scale);
        const int period = sequence.period();
        TemporalOptions options = temporal_preset("reference");
        options.kernel = temporal_preset("balanced").kernel;
        TemporalHistory all(48, 48), history(48, 48);
        Image<float> mean, found;
        for (int i = 0; i < period; ++i) mean = sequence.step(all, i, sequence.frame(i), options);
        // W' = W + K is to be 1 / alpha, and the mean of K is 1 / scale^2.
        options.still_frames = scale * scale / alpha - 1;
        for (int i = 0; i < 4 * period; ++i) found = sequence.step(history, i, sequence.frame(i), options);
        double worst = 0;
        for (int y = 4; y < 44; ++y)
            for (int x = 4; x < 44; ++x)
                worst = std::max(worst, std::abs(double(found.view()(x, y)) - double(mean.view()(x, y))));
        EXPECT_LT(worst, 0.05) << "at " << scale;
        EXPECT_GT(worst, 0.005) << "at " << scale;  // it is another mean
    }
}

/// The standard deviation of the sRGB code of each pixel over one period of the jitter, in codes of 255, as a mean over
/// pixels and channels; after two periods.
double flicker(const Sequence& sequence, const std::vector<Image<float>>& frames, const TemporalOptions& options) {
    const int period = sequence.period();
    TemporalHistory history(sequence.width, sequence.height);
    const auto count = static_cast<std::size_t>(sequence.width * sequence.height * 3);
    std::vector<double> sum(count), square(count);
    for (int i = 0; i < 3 * period; ++i) {
        const Image<float> out = sequence.step(history, i, frames[static_cast<std::size_t>(i % period)], options);
        if (i < 2 * period) continue;
        for (std::size_t k = 0; k < count; ++k) {
            const double code = 255 * linear_to_srgb(std::clamp(double(out.view().data[k]), 0.0, 1.0));
            sum[k] += code, square[k] += code * code;
        }
    }
    double deviations = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double mean = sum[k] / period;
        deviations += std::sqrt(std::max(0.0, square[k] / period - mean * mean));
    }
    return deviations / double(count);
}

// The presets read whole samples where nothing moves, so that "fast" shows there what "balanced" does.
TEST(TemporalLimits, WhatIsStillDoesNotFlicker) {
    struct Case {
        const char* scene;
        double scale;
        int width, height;
    };
    // Lines keep their widths, and lie as far apart as the image is small: here they fill a fifth of it.
    const Case cases[] = {{"line", 1, 128, 128}, {"fence", 1, 64, 48},  {"glyphs", 1, 64, 48}, {"foliage", 1, 64, 48},
                          {"fence", 2, 64, 48},  {"glyphs", 2, 64, 48}, {"foliage", 2, 64, 48}};
    for (const Case& c : cases) {
        const Sequence sequence(c.scene, c.width, c.height, c.scale, {.speed = 0});
        std::vector<Image<float>> frames;
        for (int i = 0; i < sequence.period(); ++i) frames.push_back(sequence.frame(i));
        for (const std::string_view preset : {"balanced", "sharp"})
            EXPECT_LE(flicker(sequence, frames, temporal_preset(preset)), 1)
                << c.scene << ", " << preset << " at " << c.scale;
    }
    const Sequence sequence("foliage", 48, 32, 1, {.speed = 0});
    TemporalHistory balanced(48, 32), fast(48, 32);
    for (int i = 0; i < 12; ++i) {
        const Image<float> frame = sequence.frame(i);
        const Image<float> a = sequence.step(balanced, i, frame, temporal_preset("balanced"));
        const Image<float> b = sequence.step(fast, i, frame, temporal_preset("fast"));
        for (int k = 0; k < 48 * 32 * 3; ++k) ASSERT_EQ(a.view().data[k], b.view().data[k]) << i;
    }
}

// A thin thing that does not move hides what is behind it in some frames, as the jitter goes, and not in others.
TEST(TemporalLimits, JitterDisoccludesNothing) {
    const Sequence sequence("fence", 64, 48, 2, {.speed = 0});
    TemporalHistory history(64, 48);
    Image<float> out(64, 48, 3), rejected(64, 48);
    double sum = 0;
    for (int i = 0; i < 32; ++i) {
        const Image<float> frame = sequence.frame(i);
        TemporalDebug debug;
        debug.disocclusion = rejected.view();
        accumulate(history,
                   {.color = channels_of(frame.view(), scene_channel::color, 3),
                    .depth = channels_of(frame.view(), scene_channel::depth, 1),
                    .motion = channels_of(frame.view(), scene_channel::motion, 2),
                    .jitter = sequence.jitter_of(i)},
                   temporal_preset("balanced"), out.view(), {}, debug);
        for (int y = 0; i > 0 && y < 48; ++y)
            for (int x = 0; x < 64; ++x) sum += double(rejected.view()(x, y)) / (31 * 64 * 48);
    }
    EXPECT_LT(sum, 0.02);
}

/// Which pixels of frame `i` show what something hid in the frame before.
std::vector<bool> disoccluded(const Sequence& sequence, int i) {
    std::vector<bool> found;
    for (int y = 0; y < sequence.height; ++y)
        for (int x = 0; x < sequence.width; ++x) {
            const SceneSample now = sequence.truth.at(x + 0.5, y + 0.5, i);
            const SceneSample before = sequence.truth.at(x + 0.5 + now.motion.x, y + 0.5 + now.motion.y, i - 1);
            found.push_back(before.depth < now.previous_depth * (1 - 1e-6) && now.motion.x == 0 && now.motion.y == 0);
        }
    return found;
}

/// Of each preset, the error where something has appeared two frames before, divided by that of a frame's own samples.
std::vector<double> errors_of_what_appears(double scale, const std::vector<std::string_view>& presets) {
    constexpr int frames = 26, measured = 18;  // objects have a long history by then
    const Sequence sequence("mover", 64, 36, scale);
    std::vector<TemporalHistory> histories;
    for (std::size_t p = 0; p < presets.size(); ++p) histories.emplace_back(sequence.width, sequence.height);
    std::vector<std::vector<bool>> is_new(frames);
    std::vector<double> errors(presets.size());
    double of_a_frame = 0;
    int count = 0;
    for (int i = 0; i < frames; ++i) {
        const Image<float> frame = sequence.frame(i);
        std::vector<Image<float>> shown;
        for (std::size_t p = 0; p < presets.size(); ++p)
            shown.push_back(sequence.step(histories[p], i, frame, temporal_preset(presets[p])));
        if (i < measured - 2) continue;
        is_new[static_cast<std::size_t>(i)] = disoccluded(sequence, i);
        if (i < measured) continue;
        const Image<float> truth = supersample(sequence.truth, sequence.width, sequence.height, i,
                                               {.pattern = regular_pattern(16), .kernel = box()}, {2});
        for (int y = 0; y < sequence.height; ++y)
            for (int x = 0; x < sequence.width; ++x) {
                const auto at = static_cast<std::size_t>(y * sequence.width + x), now = static_cast<std::size_t>(i);
                if (!is_new[now - 2][at] || is_new[now][at]) continue;
                ++count;
                const int in_x = static_cast<int>((x + 0.5) / scale), in_y = static_cast<int>((y + 0.5) / scale);
                for (int c = 0; c < 3; ++c) {
                    const double wanted = double(truth.view()(x, y, c));
                    of_a_frame += std::pow(double(frame.view()(in_x, in_y, c)) - wanted, 2);
                    for (std::size_t p = 0; p < presets.size(); ++p)
                        errors[p] += std::pow(double(shown[p].view()(x, y, c)) - wanted, 2);
                }
            }
    }
    EXPECT_GT(count, 30);
    for (double& error : errors) error = std::sqrt(error / of_a_frame);
    return errors;
}

TEST(TemporalLimits, WhatAppearsIsAsGoodAsAFrameTwoFramesLater) {
    for (const double scale : {1.0, 2.0}) {
        const std::vector<double> errors = errors_of_what_appears(scale, {"reference", "balanced", "fast", "sharp"});
        for (std::size_t p = 1; p < errors.size(); ++p) {
            EXPECT_LE(errors[p], 0.9) << p << " at " << scale;
            EXPECT_LE(errors[p], 0.95 * errors[0]) << p << " at " << scale;  // which believes all history
        }
    }
}

TEST(TemporalLimits, HighlightsStayFinite) {
    for (const double scale : {1.0, 1.5, 3.0})
        for (const std::string_view preset : temporal_presets()) {
            const Sequence sequence("highlight", 96, 54, scale);
            TemporalHistory history(sequence.width, sequence.height);
            float brightest = 0;
            for (int i = 0; i < 12; ++i) {
                const Image<float> frame = sequence.frame(i);
                const View<const float> color = channels_of(frame.view(), scene_channel::color, 3);
                for (int y = 0; y < color.height; ++y)
                    for (int x = 0; x < color.width; ++x) brightest = std::max(brightest, color(x, y));
                const Image<float> out = sequence.step(history, i, frame, temporal_preset(preset));
                const int count = sequence.width * sequence.height * 3;
                for (int k = 0; k < count; ++k) {
                    const float v = out.view().data[k];
                    ASSERT_TRUE(std::isfinite(v)) << preset << " at " << scale << ", frame " << i;
                    if (preset == "balanced" || preset == "fast") {  // of weights that are all positive
                        ASSERT_GE(v, 0) << preset;
                        ASSERT_LE(v, 1.0001f * brightest) << preset;
                    }
                }
            }
            EXPECT_GT(brightest, 20);
        }
}

}  // namespace
}  // namespace bandlimit
