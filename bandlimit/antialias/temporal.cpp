#include "bandlimit/antialias/temporal.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "bandlimit/antialias/frame_gather.h"
#include "bandlimit/antialias/history_weights.h"
#include "bandlimit/antialias/temporal_rows.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int band_rows = 16;  // what they are made of stays in the second cache

constexpr std::array<std::string_view, 6> preset_names{"fast",      "balanced",  "sharp",
                                                       "reference", "per-frame", "input-sized"};

bool is_share(double v) { return v >= 0 && v <= 1; }

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

void check_options(const TemporalOptions& o) {
    if (!(o.alpha > 0 && o.alpha <= 1)) fail("accumulate: alpha = ", o.alpha, "; pass more than 0, up to 1");
    if (!(o.still_frames >= 1)) fail("accumulate: still_frames = ", o.still_frames, "; pass 1 or more");
    if (!(o.forget_by_motion >= 0)) fail("accumulate: forget_by_motion = ", o.forget_by_motion, "; pass 0 or more");
    if (!(o.depth_tolerance > 0)) fail("accumulate: depth_tolerance = ", o.depth_tolerance, "; pass more than 0");
    if (!is_share(o.disocclusion_keep) || !is_share(o.rectify_share) || !is_share(o.sharpening))
        fail("accumulate: disocclusion_keep, rectify_share and sharpening are shares; pass 0 to 1");
    if (!(o.anti_flicker >= 0 && o.deringing_frames >= 0 && std::isfinite(o.deringing_frames)))
        fail("accumulate: anti_flicker and deringing_frames may not be below 0; pass e.g. 1 and 4, or 0 for none");
    if (!(o.lock_frames == 0 || (o.lock_frames >= 1 && std::isfinite(o.lock_frames))))
        fail("accumulate: lock_frames = ", o.lock_frames, "; pass 1 or more, e.g. 4, or 0 for none");
    if (!(o.box_size >= 0 && o.doubt >= 0))
        fail("accumulate: box_size and doubt may not be below 0; pass e.g. 1.25 and 0.02");
}

std::string_view name_of(HistoryKernel kernel) {
    constexpr std::array<std::string_view, 5> names{"bilinear", "catmull-rom", "catmull-rom5", "lanczos2", "bspline"};
    return names[static_cast<std::size_t>(kernel)];
}

std::string_view name_of(Accumulation rule) {
    constexpr std::array<std::string_view, 3> names{"weighted", "per-frame", "input-sized"};
    return names[static_cast<std::size_t>(rule)];
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
    now_.sums = Image<float>(width, height, 4, Layout::interleaved);
}

TemporalHistory TemporalHistory::clone() const {
    TemporalHistory copy(width(), height());
    copy.now_ = {now_.sums.clone(), now_.transparency.clone(), now_.locks.clone(), now_.surface.clone()};
    copy.jitter_ = jitter_, copy.exposure_ = exposure_, copy.frames_ = frames_;
    return copy;
}

/// What a thread needs of the frame for some rows of the output.
struct TemporalBand {
    Image<float> finite, gathered, guide, box;
};

/// One frame on its way into the history.
class TemporalStep {
public:
    TemporalStep(TemporalHistory& history, const TemporalFrame& frame, const TemporalOptions& options, View<float> out,
                 const Parallel& parallel, const TemporalDebug& debug)
        : history_(history),
          frame_(frame),
          parallel_(parallel),
          in_width_(frame.color.width),
          in_height_(frame.color.height),
          has_history_(history.frames_ > 0 && !frame.is_cut),
          gather_(frame_gather(options.kernel, options.rule == Accumulation::input_sized, in_width_, in_height_,
                               history.width(), history.height(), frame.jitter)),
          pass_{.frame = frame,
                .options = options,
                .gather = gather_,
                .history_weights = history_weights(options.history_kernel),
                .surface_jitter = history.jitter_,
                .surface_exposure = history.exposure_,
                .out = out,
                .debug = debug} {
        const WeightLimits limits = weight_limits(options.kernel);
        pass_.least_weight = limits.least, pass_.enough_weight = limits.enough;
    }

    void run() {
        make_room();
        const int height = history_.height(), bands = (height + band_rows - 1) / band_rows;
        // Ranges of several bands share their memory.
        parallel_for(bands, std::max(1, bands / (2 * parallel_.count())), parallel_,
                     [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         TemporalBand band;
                         for (std::ptrdiff_t i = begin; i < end; ++i)
                             run_band(band, static_cast<int>(i) * band_rows,
                                      std::min(static_cast<int>(i + 1) * band_rows, height));
                     });
        keep();
    }

private:
    /// The next history, and the views of both.
    void make_room() {
        const int width = history_.width(), height = history_.height();
        auto& [sums, transparency, locks, surface] = history_.next_;
        if (sums.width() != width) sums = Image<float>(width, height, 4, Layout::interleaved);
        if (is_transparent()) transparency = Image<float>(width, height);
        else transparency = {};
        if (pass_.options.lock_frames == 0) locks = {};
        else if (locks.width() != width) locks = Image<float>(width, height);
        if (frame_.depth.width == 0) surface = {};
        else if (surface.width() != in_width_ || surface.height() != in_height_)
            surface = Image<float>(in_width_, in_height_, 4, Layout::interleaved);
        pass_.next_sums = sums.view();
        pass_.next_transparency = transparency.view();
        pass_.next_locks = locks.view();
        pass_.next_surface = surface.view();
        if (!has_history_) return;
        pass_.sums = std::as_const(history_.now_.sums).view();
        pass_.transparency = std::as_const(history_.now_.transparency).view();
        pass_.locks = std::as_const(history_.now_.locks).view();
        pass_.surface = std::as_const(history_.now_.surface).view();
    }

    /// Whether anything is, or was.
    bool is_transparent() const {
        const View<const float>& color = frame_.color;
        if (color.channels == 3) return false;
        if (has_history_ && history_.now_.transparency.width() > 0) return true;
        std::atomic<bool> found = false;
        parallel_for(color.height, band_rows, parallel_, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (int y = static_cast<int>(begin); y < end && !found; ++y)
                for (int x = 0; x < color.width; ++x)
                    if (color(x, y, 3) != 1) found = true;
        });
        return found;
    }

    /// Output rows [first, last).
    void run_band(TemporalBand& band, int first, int last) {
        const FiniteRows rows = finite_rows(band, first, last);
        const int width = history_.width();
        if (band.gathered.width() != width) band.gathered = Image<float>(width, band_rows, 4, Layout::interleaved);
        const View<float> gathered = cropped(band.gathered.view(), 0, 0, width, last - first);
        gather_.rows.run({interleaved(rows.samples, in_width_, rows.count, 4), rows.first, {}},
                         {gathered, first, {}, {}}, {1});
        const bool rectifies = pass_.options.rectification != Rectification::none;
        if (band.guide.width() != in_width_) {
            band.guide = Image<float>(in_width_, 1, 4, Layout::interleaved);
            if (rectifies) band.box = Image<float>(in_width_, 1, 8, Layout::interleaved);
        }
        for (int y = first, known = -1; y < last; ++y) {
            if (const int near = gather_.near_y[static_cast<std::size_t>(y)]; near != known) {
                guide_row(pass_, known = near, band.guide.view().data);
                if (rectifies) box_row(pass_, rows, near, band.box.view().data);
            }
            step_row(pass_, {.y = y,
                             .gathered = &gathered(0, y - first),
                             .near_y = known,
                             .guide = band.guide.view().data,
                             .box = rectifies ? band.box.view().data : nullptr,
                             .rows = rows});
        }
        if (pass_.next_surface.width == 0) return;
        const auto owned = [&](int y) { return static_cast<int>(std::int64_t(y) * in_height_ / history_.height()); };
        for (int y = owned(first); y < owned(last); ++y) keep_surface_row(pass_, y);
    }

    /// The rows of the frame that output rows [first, last) are made of, and those beside the nearest ones.
    FiniteRows finite_rows(TemporalBand& band, int first, int last) const {
        const IndexRange read = gather_.rows.rows_needed(first, last);
        const int begin = std::max(0, std::min(read.count() > 0 ? read.begin : in_height_,
                                               gather_.near_y[static_cast<std::size_t>(first)] - 1));
        const int end = std::min(in_height_, std::max(read.count() > 0 ? read.end : 0,
                                                      gather_.near_y[static_cast<std::size_t>(last) - 1] + 2));
        if (band.finite.width() != in_width_ || band.finite.height() < end - begin)
            band.finite = Image<float>(in_width_, end - begin, 4, Layout::interleaved);
        for (int y = begin; y < end; ++y) finite_row(pass_, y, &band.finite.view()(0, y - begin));
        return {band.finite.view().data, in_width_, begin, end - begin};
    }

    /// The frame becomes the past of the next one.
    void keep() {
        std::swap(history_.now_, history_.next_);
        history_.jitter_ = frame_.jitter;
        history_.exposure_ = frame_.exposure;
        history_.frames_ = has_history_ ? history_.frames_ + 1 : 1;
    }

    TemporalHistory& history_;
    const TemporalFrame& frame_;
    const Parallel& parallel_;
    int in_width_, in_height_;
    bool has_history_;
    FrameGather gather_;
    TemporalPass pass_;
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
