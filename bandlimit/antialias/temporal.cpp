#include "bandlimit/antialias/temporal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bandlimit/antialias/frame_gather.h"
#include "bandlimit/antialias/history_sampler.h"
#include "bandlimit/antialias/temporal_input.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int band_rows = 32;
constexpr float velocity_tolerance = 0.5f;  // input pixels per frame
constexpr float still_motion = 0.01f;       // the same; less is no motion
constexpr float full_doubt_speed = 0.1f;    // output pixels per frame; what is slower is doubted less

constexpr std::array<std::string_view, 6> preset_names{"fast",      "balanced",  "sharp",
                                                       "reference", "per-frame", "input-sized"};

bool is_share(double v) { return v >= 0 && v <= 1; }

void check_options(const TemporalOptions& o) {
    if (!(o.alpha > 0 && o.alpha <= 1)) fail("accumulate: alpha = ", o.alpha, "; pass more than 0, up to 1");
    if (!(o.still_frames >= 1)) fail("accumulate: still_frames = ", o.still_frames, "; pass 1 or more");
    if (!(o.forget_by_motion >= 0)) fail("accumulate: forget_by_motion = ", o.forget_by_motion, "; pass 0 or more");
    if (!(o.depth_tolerance > 0)) fail("accumulate: depth_tolerance = ", o.depth_tolerance, "; pass more than 0");
    if (!is_share(o.disocclusion_keep) || !is_share(o.rectify_share) || !is_share(o.sharpening))
        fail("accumulate: disocclusion_keep, rectify_share and sharpening are shares; pass 0 to 1");
    if (!(o.box_size >= 0 && o.doubt >= 0))
        fail("accumulate: box_size and doubt may not be below 0; pass e.g. 1.25 and 0.02");
}

template <class T>
void check_buffer(const char* name, const View<T>& view, int width, int height, int channels) {
    if (view.width == 0) return;
    if (view.width != width || view.height != height || view.channels != channels)
        fail("accumulate: ", name, " of ", view.width, " x ", view.height, " with ", view.channels, " channels; need ",
             width, " x ", height, " with ", channels);
}

void check_frame(const TemporalFrame& frame, int width, int height) {
    const View<const float>& color = frame.color;
    if (color.width < 1 || color.height < 1 || color.width > width || color.height > height)
        fail("accumulate: a frame of ", color.width, " x ", color.height, " for an output of ", width, " x ", height,
             "; pass 1 x 1 up to the size of the output");
    if (color.channels != 3 && color.channels != 4)
        fail("accumulate: color of ", color.channels, " channels; pass RGB or RGBA");
    check_buffer("depth", frame.depth, color.width, color.height, 1);
    check_buffer("motion", frame.motion, color.width, color.height, 2);
    check_buffer("reactive", frame.reactive, color.width, color.height, 1);
    if (!(frame.exposure > 0 && std::isfinite(frame.exposure)))
        fail("accumulate: exposure = ", frame.exposure, "; pass a number above 0");
}

}  // namespace

std::string_view name_of(HistoryKernel kernel) {
    constexpr std::array<std::string_view, 5> names{"bilinear", "catmull-rom", "catmull-rom5", "lanczos2", "bspline"};
    return names[static_cast<std::size_t>(kernel)];
}

std::string_view name_of(Rectification rectification) {
    constexpr std::array<std::string_view, 4> names{"none", "clamp", "clip", "variance"};
    return names[static_cast<std::size_t>(rectification)];
}

std::span<const std::string_view> temporal_presets() { return preset_names; }

TemporalOptions temporal_preset(std::string_view name) {
    TemporalOptions o;
    if (name == "balanced") return o;
    if (name == "fast") {
        o.history_kernel = HistoryKernel::bilinear;
        return o;
    }
    if (name == "sharp") {
        o.kernel = lanczos(2);
        o.history_kernel = HistoryKernel::lanczos2;
        o.sharpening = 0.15;
        return o;
    }
    // All others take samples as they are, and believe all history.
    o.kernel = lanczos(2);
    o.rectification = Rectification::none;
    o.depth_tolerance = INFINITY;
    o.doubt = 0;
    o.dilates_motion = false;
    o.compresses_highlights = false;
    o.still_frames = INFINITY;
    o.forget_by_motion = 0;
    if (name == "reference") return o;
    if (name == "per-frame") {
        o.rule = Accumulation::per_frame;
        return o;
    }
    if (name == "input-sized") {
        o.rule = Accumulation::input_sized;
        return o;
    }
    std::string list;
    for (const std::string_view preset : preset_names) list += (list.empty() ? "" : ", ") + std::string(preset);
    fail("preset \"", name, "\" is unknown; choose one of: ", list);
}

TemporalHistory::TemporalHistory(int width, int height) {
    if (width < 1 || height < 1) fail("TemporalHistory: ", width, " x ", height, " pixels; pass at least 1 x 1");
    sums_ = Image<float>(width, height, 4, Layout::interleaved);
}

/// One frame on its way into the history.
class TemporalStep {
public:
    TemporalStep(TemporalHistory& history, const TemporalFrame& frame, const TemporalOptions& options, View<float> out,
                 const Parallel& parallel, const TemporalDebug& debug)
        : history_(history),
          frame_(frame),
          options_(options),
          out_(out),
          parallel_(parallel),
          debug_(debug),
          width_(history.width()),
          height_(history.height()),
          scale_x_(static_cast<float>(width_) / static_cast<float>(frame.color.width)),
          scale_y_(static_cast<float>(height_) / static_cast<float>(frame.color.height)),
          has_history_(history.frames_ > 0 && !frame.is_cut),
          input_(temporal_input(frame, options, parallel)),
          gather_(frame_gather(options.kernel, options.rule == Accumulation::input_sized, frame.color.width,
                               frame.color.height, width_, height_, frame.jitter)) {
        // A kernel with negative weights may gather samples that nearly cancel: nothing is divided by that.
        const bool may_cancel = *std::min_element(gather_.x.begin(), gather_.x.end()) < 0 ||
                                options.kernel.value(options.kernel.radius * 0.75) < 0;
        least_weight_ = may_cancel ? 0.25f : 0.02f;
        enough_weight_ = may_cancel ? 0.5f : 0.3f;
    }

    void run() {
        if (history_.next_.width() != width_) history_.next_ = Image<float>(width_, height_, 4, Layout::interleaved);
        if (has_alpha() && history_.next_alpha_.width() != width_) {
            history_.alpha_ = Image<float>(width_, height_);
            history_.next_alpha_ = Image<float>(width_, height_);
        }
        parallel_for((height_ + band_rows - 1) / band_rows, 1, parallel_,
                     [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (std::ptrdiff_t band = begin; band < end; ++band)
                             run_band(static_cast<int>(band) * band_rows);
                     });
        keep();
    }

private:
    bool has_alpha() const { return frame_.color.channels == 4; }

    void run_band(int first) {
        const int rows = std::min(band_rows, height_ - first);
        Image<float> gathered(width_, rows, frame_.color.channels, Layout::interleaved);
        gather_.rows.run({input_.color.view(), 0, {}}, {gathered.view(), first, {}, {}}, {1});
        for (int y = first; y < first + rows; ++y)
            for (int x = 0; x < width_; ++x) step(x, y, &gathered.view()(x, y - first));
    }

    /// What the history holds of what is at an output pixel now.
    struct Past {
        HistorySample sample;
        float alpha = 0;                   ///< times the weight of the sample
        float motion_x = 0, motion_y = 0;  ///< in output pixels
        float speed = 0;
        float mismatch = 1;  ///< 1 where it is of something else
    };

    Past past_of(int x, int y, int near_x, int near_y) const {
        Past past;
        const float* const guide = &input_.guide.view()(near_x, near_y);
        past.motion_x = guide[0] * scale_x_, past.motion_y = guide[1] * scale_y_;
        past.speed = std::hypot(past.motion_x, past.motion_y);
        const float at_x = static_cast<float>(x) + past.motion_x, at_y = static_cast<float>(y) + past.motion_y;
        if (!has_history_ || !(at_x >= -0.5f && at_y >= -0.5f && at_x <= static_cast<float>(width_) - 0.5f &&
                               at_y <= static_cast<float>(height_) - 0.5f))
            return past;
        past.sample = sample_history(history_.sums_.view(), options_.history_kernel, x, y, past.motion_x, past.motion_y,
                                     least_weight_);
        if (has_alpha()) past.alpha = alpha_at(x, y, past.motion_x, past.motion_y);
        past.mismatch = mismatch_of_surface(guide, (at_x + 0.5f) / scale_x_, (at_y + 0.5f) / scale_y_);
        return past;
    }

    /// Alpha times weight, between the four samples about sample (x, y) moved by (dx, dy).
    float alpha_at(int x, int y, float dx, float dy) const {
        const float fx = std::floor(dx), fy = std::floor(dy), tx = dx - fx, ty = dy - fy;
        float sum = 0;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                sum += history_.alpha_.view()(std::clamp(x + static_cast<int>(fx) + i, 0, width_ - 1),
                                              std::clamp(y + static_cast<int>(fy) + j, 0, height_ - 1)) *
                       (i == 0 ? 1 - tx : tx) * (j == 0 ? 1 - ty : ty);
        return sum;
    }

    /// How much what the last frame saw about a place, in input pixels, is something else than what is there now: by how
    /// little the depth of any of the four samples about it is like that of `guide`, or by the depth of the nearest
    /// sample, where that moved otherwise. (Of a thin line that does not move, the nearest sample often misses it.) What
    /// does not move now has not come in front of what was farther: the samples of that frame missed it.
    float mismatch_of_surface(const float* guide, float x, float y) const {
        const View<const float> before = std::as_const(history_.surface_).view();
        if (before.width == 0 || !std::isfinite(options_.depth_tolerance)) return 0;
        x *= static_cast<float>(before.width) / static_cast<float>(frame_.color.width);
        y *= static_cast<float>(before.height) / static_cast<float>(frame_.color.height);
        x -= 0.5f + static_cast<float>(history_.jitter_.x), y -= 0.5f + static_cast<float>(history_.jitter_.y);
        const float left = std::floor(x), top = std::floor(y);
        const bool is_still = std::abs(guide[0]) < still_motion && std::abs(guide[1]) < still_motion;
        const auto mismatch_of = [&](const float* sample) {
            return is_still && sample[0] > guide[2] ? 0 : mismatch_of_depth(sample[0], guide[2]);
        };
        float least = 3e38f;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                least = std::min(least,
                                 mismatch_of(sample_before(left + static_cast<float>(i), top + static_cast<float>(j))));
        const float* const nearest = sample_before(std::floor(x + 0.5f), std::floor(y + 0.5f));
        const float otherwise = std::hypot(nearest[1] - guide[0], nearest[2] - guide[1]) - velocity_tolerance;
        return std::max(least, std::min(mismatch_of(nearest), std::clamp(otherwise, 0.0f, 1.0f)));
    }

    /// Depth and motion of a sample of the last frame, or of the one at the border that is nearest.
    const float* sample_before(float x, float y) const {
        const View<const float> before = std::as_const(history_.surface_).view();
        return &before(std::clamp(static_cast<int>(x), 0, before.width - 1),
                       std::clamp(static_cast<int>(y), 0, before.height - 1));
    }

    float mismatch_of_depth(float before, float now) const {
        const float difference = std::abs(before - now) / std::max(std::min(before, now), 1e-6f);
        return std::clamp(difference / static_cast<float>(options_.depth_tolerance) - 1, 0.0f, 1.0f);
    }

    /// Moves history towards what is about the pixel now; returns how far it was outside of that, in half extents.
    float rectify(Past& past, int near_x, int near_y) const {
        const float* const box = &input_.box.view()(near_x, near_y);
        float* const color = past.sample.color;
        const float was[3] = {color[0], color[1], color[2]};
        if (options_.rectifies_ycocg) to_ycocg(color);
        const bool is_variance = options_.rectification == Rectification::variance;
        const float size = is_variance ? static_cast<float>(options_.box_size) : 1;
        float outside = 0, shrink = 1;
        float inside[3];
        for (int c = 0; c < 3; ++c) {
            const float half = size * box[3 + c], difference = color[c] - box[c];
            inside[c] = box[c] + std::clamp(difference, -half, half);
            outside = std::max(outside, std::abs(color[c] - inside[c]) / (box[3 + c] + 0.02f));
            if (std::abs(difference) > half) shrink = std::min(shrink, half / std::abs(difference));
        }
        if (outside == 0) {
            std::copy_n(was, 3, color);
            return 0;
        }
        if (options_.rectification == Rectification::clip)
            for (int c = 0; c < 3; ++c) inside[c] = box[c] + shrink * (color[c] - box[c]);
        if (options_.rectifies_ycocg) to_rgb(inside);
        const float moving = std::min(1.0f, past.speed / full_doubt_speed);
        const float least = static_cast<float>(options_.rectify_share) * moving;
        const float share = least + (1 - least) * past.mismatch;
        for (int c = 0; c < 3; ++c) color[c] = was[c] + share * (inside[c] - was[c]);
        if (share > 0) past.sample.is_exact = false;
        return outside * std::max(moving, past.mismatch);
    }

    void follow_exposure(HistorySample& sample) const {
        if (frame_.exposure == history_.exposure_) return;
        if (options_.compresses_highlights) restore_highlight(sample.color);
        for (float& v : sample.color) v *= static_cast<float>(frame_.exposure / history_.exposure_);
        if (options_.compresses_highlights) compress_highlight(sample.color);
        sample.is_exact = false;
    }

    /// How much weight a pixel of this speed may bring along.
    float most_weight(float speed) const {
        const double frames = options_.still_frames / (1 + options_.forget_by_motion * static_cast<double>(speed));
        return static_cast<float>(frames * gather_.mean_weight);
    }

    void step(int x, int y, const float* gathered) {
        const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
        const int near_x = gather_.near_x[column], near_y = gather_.near_y[row];
        const float weight = gather_.x[column] * gather_.y[row];
        Past past = past_of(x, y, near_x, near_y);
        HistorySample& sample = past.sample;
        const float remembered = sample.weight;
        float outside = 0;
        if (remembered > least_weight_) {
            follow_exposure(sample);
            if (options_.rectification != Rectification::none) outside = rectify(past, near_x, near_y);
        }
        float memory = remembered;
        if (memory > 0) {
            memory *= 1 - past.mismatch * static_cast<float>(1 - options_.disocclusion_keep);
            if (outside > 0) memory *= std::exp(-static_cast<float>(options_.doubt) * outside);
            if (frame_.reactive.width > 0) memory *= 1 - std::clamp(frame_.reactive(near_x, near_y), 0.0f, 1.0f);
            memory = std::min(memory, most_weight(past.speed));
        }
        float* const next = &history_.next_.view()(x, y);
        float next_alpha = 0;
        if (options_.rule == Accumulation::weighted) {
            const bool is_copy = sample.is_exact && memory == remembered;
            const float share = remembered != 0 ? memory / remembered : 0;
            for (int c = 0; c < 3; ++c)
                next[c] = gathered[c] + (is_copy           ? sample.sums[c]
                                         : sample.is_exact ? share * sample.sums[c]
                                                           : memory * sample.color[c]);
            next[3] = memory + weight;
            if (has_alpha()) next_alpha = (is_copy ? 1 : share) * past.alpha + gathered[3];
        } else {
            const float peak = gather_.peak_x[column] * gather_.peak_y[row];
            const float share = options_.rule == Accumulation::per_frame ? 1 : peak;
            const float alpha = remembered > 0 ? static_cast<float>(options_.alpha) * share : 1;
            const bool is_usable = std::abs(weight) > 1e-4f;
            for (int c = 0; c < 3; ++c)
                next[c] =
                    is_usable ? sample.color[c] + alpha * (gathered[c] / weight - sample.color[c]) : sample.color[c];
            next[3] = is_usable || remembered > 0 ? 1.0f : 0.0f;
            if (has_alpha())
                next_alpha = is_usable ? past.alpha + alpha * (gathered[3] / weight - past.alpha) : past.alpha;
        }
        if (has_alpha()) history_.next_alpha_.view()(x, y) = next_alpha;
        show(x, y, next, next_alpha);
        note(x, y, weight, past, outside, next[3]);
    }

    /// The output pixel: what is remembered, or, as far as that is too little, samples about it.
    void show(int x, int y, const float* next, float next_alpha) const {
        float color[4] = {};
        const float trust = std::clamp((next[3] - least_weight_) / (enough_weight_ - least_weight_), 0.0f, 1.0f);
        if (trust < 1) interpolate_input(x, y, color);
        if (trust > 0) {
            const float scale = trust / next[3];
            for (int c = 0; c < 3; ++c) color[c] = (1 - trust) * color[c] + next[c] * scale;
            color[3] = has_alpha() ? (1 - trust) * color[3] + next_alpha * scale : 1;
        }
        if (options_.compresses_highlights) restore_highlight(color);
        for (int c = 0; c < out_.channels; ++c) out_(x, y, c) = color[c];
    }

    void interpolate_input(int x, int y, float* color) const {
        const View<const float> in = input_.color.view();
        const float at_x = (static_cast<float>(x) + 0.5f) / scale_x_ - 0.5f - static_cast<float>(frame_.jitter.x);
        const float at_y = (static_cast<float>(y) + 0.5f) / scale_y_ - 0.5f - static_cast<float>(frame_.jitter.y);
        const float fx = std::floor(at_x), fy = std::floor(at_y), tx = at_x - fx, ty = at_y - fy;
        std::fill_n(color, 4, 0.0f);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const float w = (i == 0 ? 1 - tx : tx) * (j == 0 ? 1 - ty : ty);
                const float* const p = &in(std::clamp(static_cast<int>(fx) + i, 0, in.width - 1),
                                           std::clamp(static_cast<int>(fy) + j, 0, in.height - 1));
                for (int c = 0; c < in.channels; ++c) color[c] += w * p[c];
            }
        if (in.channels == 3) color[3] = 1;
    }

    void note(int x, int y, float weight, const Past& past, float outside, float memory) const {
        if (debug_.frame_weight.width > 0) debug_.frame_weight(x, y) = weight;
        if (debug_.memory.width > 0) debug_.memory(x, y) = memory;
        if (debug_.rejection.width > 0) debug_.rejection(x, y) = outside;
        if (debug_.disocclusion.width > 0) debug_.disocclusion(x, y) = past.mismatch;
        if (debug_.motion.width > 0) debug_.motion(x, y, 0) = past.motion_x, debug_.motion(x, y, 1) = past.motion_y;
    }

    /// The frame becomes the past of the next one.
    void keep() {
        std::swap(history_.sums_, history_.next_);
        std::swap(history_.alpha_, history_.next_alpha_);
        if (frame_.depth.width > 0) keep_surface();
        else history_.surface_ = {};
        history_.jitter_ = frame_.jitter;
        history_.exposure_ = frame_.exposure;
        history_.frames_ = has_history_ ? history_.frames_ + 1 : 1;
    }

    void keep_surface() {
        const View<const float>&color = frame_.color, &motion = frame_.motion;
        if (history_.surface_.width() != color.width || history_.surface_.height() != color.height)
            history_.surface_ = Image<float>(color.width, color.height, 3, Layout::interleaved);
        for (int y = 0; y < color.height; ++y)
            for (int x = 0; x < color.width; ++x) {
                float* const to = &history_.surface_.view()(x, y);
                to[0] = input_.guide.view()(x, y, 3);
                for (int c = 0; c < 2; ++c) {
                    const float v = motion.width > 0 ? motion(x, y, c) : 0;
                    to[1 + c] = std::isfinite(v) ? v : 0;
                }
            }
    }

    TemporalHistory& history_;
    const TemporalFrame& frame_;
    const TemporalOptions& options_;
    View<float> out_;
    const Parallel& parallel_;
    const TemporalDebug& debug_;
    int width_, height_;
    float scale_x_, scale_y_;
    bool has_history_;
    TemporalInput input_;
    FrameGather gather_;
    float least_weight_ = 0.02f, enough_weight_ = 0.3f;  ///< what may be divided by; what is shown alone
};

namespace {

/// Contrast-adaptive sharpening: each pixel moves away from the mean of its four neighbours, but no further than the
/// range of the five leaves room, so that nothing rings.
void sharpen(View<const float> from, View<float> to, double amount, const Parallel& parallel) {
    const auto most = static_cast<float>(amount);
    parallel_for(from.height, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < from.width; ++x) {
                const int left = std::max(0, x - 1), right = std::min(from.width - 1, x + 1);
                const int up = std::max(0, y - 1), down = std::min(from.height - 1, y + 1);
                for (int c = 0; c < from.channels; ++c) {
                    const float v = from(x, y, c), l = from(left, y, c), r = from(right, y, c), u = from(x, up, c),
                                d = from(x, down, c);
                    const float low = std::min({v, l, r, u, d}), high = std::max({v, l, r, u, d});
                    const float wanted = v + most * (v - (l + r + u + d) / 4);
                    to(x, y, c) = c == 3 ? v : std::clamp(wanted, low, high);
                }
            }
    });
}

}  // namespace

void accumulate(TemporalHistory& history, const TemporalFrame& frame, const TemporalOptions& options, View<float> out,
                const Parallel& parallel, const TemporalDebug& debug) {
    const int width = history.width(), height = history.height();
    check_options(options);
    check_frame(frame, width, height);
    if (out.width != width || out.height != height || (out.channels != 3 && out.channels != 4))
        fail("accumulate: an output of ", out.width, " x ", out.height, " with ", out.channels, " channels; need ",
             width, " x ", height, " with 3 or 4");
    for (const auto& [name, view, channels] : {std::tuple{"frame_weight", debug.frame_weight, 1},
                                               {"memory", debug.memory, 1},
                                               {"rejection", debug.rejection, 1},
                                               {"motion", debug.motion, 2},
                                               {"disocclusion", debug.disocclusion, 1}})
        check_buffer(name, view, width, height, channels);
    if (options.sharpening == 0) return TemporalStep(history, frame, options, out, parallel, debug).run();
    Image<float> soft(width, height, out.channels, Layout::interleaved);
    TemporalStep(history, frame, options, soft.view(), parallel, debug).run();
    sharpen(soft.view(), out, options.sharpening, parallel);
}

}  // namespace bandlimit
