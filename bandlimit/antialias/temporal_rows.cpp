#include "bandlimit/antialias/temporal_rows.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/antialias/temporal_rows.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/antialias/four-inl.h"
#include "bandlimit/core/dispatch.h"

#ifndef BANDLIMIT_ANTIALIAS_TEMPORAL_ROWS_ONCE
#define BANDLIMIT_ANTIALIAS_TEMPORAL_ROWS_ONCE
namespace bandlimit {

constexpr float far_away = 1e10f;  // the depth of what has none

/// Calls body(u, v) for up to 3 x 3 samples about (x, y) that lie inside.
template <class Body>
void each_neighbour(int x, int y, int width, int height, const Body& body) {
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) body(u, v);
}

inline float depth_at(const TemporalFrame& frame, int x, int y) {
    const float depth = frame.depth.width > 0 ? frame.depth(x, y) : far_away;
    return std::isfinite(depth) ? depth : far_away;
}

inline float motion_at(const TemporalFrame& frame, int x, int y, int c) {
    const float motion = frame.motion.width > 0 ? frame.motion(x, y, c) : 0;
    return std::isfinite(motion) ? motion : 0;
}

inline float reaction_at(const TemporalFrame& frame, int x, int y) {
    const float reaction = frame.reactive(x, y);
    return reaction > 0 ? std::min(reaction, 1.0f) : 0;  // not of NaN
}

}  // namespace bandlimit
#endif

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

// ---- What is known of the samples of a frame

HWY_INLINE Four SampleOf(const View<const float>& color, int x, int y) {
    const float* const p = &color(x, y);
    if (color.channels == 3) return four(p[0], p[color.dc], p[2 * color.dc], 0);
    const Four rgba = color.dc == 1 ? load(p) : four(p[0], p[color.dc], p[2 * color.dc], p[3 * color.dc]);
    return with_last(rgba, 1 - last_of(rgba));
}

/// The mean of the finite samples about one that is not; 0 if there are none.
HWY_NOINLINE Four MeanOfNeighbours(const View<const float>& color, int x, int y) {
    Four sum = all(0);
    float count = 0;
    each_neighbour(x, y, color.width, color.height, [&](int u, int v) HWY_ATTR {
        const Four sample = SampleOf(color, u, v);
        if (is_finite(sample)) sum = sum + sample, ++count;
    });
    return count > 0 ? sum / all(count) : sum;
}

void FiniteRow(const TemporalPass& pass, int y, float* to) {
    const View<const float>& color = pass.frame.color;
    for (int x = 0; x < color.width; ++x, to += 4) {
        Four sample = SampleOf(color, x, y);
        if (!is_finite(sample)) sample = MeanOfNeighbours(color, x, y);
        store(sample, to);
        if (pass.options.compresses_highlights && most_of(with_last(sample, 0)) > 1) compress_highlight(to);
    }
}

/// A sample and how far away it is.
struct Seen {
    float depth;
    int x, y;
};

/// The nearest of a column of up to three; the one in row y if others are only as near.
HWY_INLINE Seen NearestOfColumn(const TemporalFrame& frame, int x, int y) {
    Seen nearest{depth_at(frame, x, y), x, y};
    for (const int v : {y - 1, y + 1}) {
        if (v < 0 || v >= frame.depth.height) continue;
        if (const float depth = depth_at(frame, x, v); depth < nearest.depth) nearest.depth = depth, nearest.y = v;
    }
    return nearest;
}

void GuideRow(const TemporalPass& pass, int y, float* to) {
    const TemporalFrame& frame = pass.frame;
    const int last = frame.color.width - 1;
    const bool dilates = frame.depth.width > 0 && pass.options.dilates_motion;
    Seen left{far_away, 0, y}, middle = dilates ? NearestOfColumn(frame, 0, y) : left, right = middle;
    for (int x = 0; x <= last; ++x, to += 4) {
        Seen nearest{};
        if (dilates) {
            right = x < last ? NearestOfColumn(frame, x + 1, y) : Seen{INFINITY, x, y};
            nearest = middle;
            if (left.depth < nearest.depth) nearest = left;
            if (right.depth < nearest.depth) nearest = right;
            left = middle, middle = right;
        } else {
            nearest = {depth_at(frame, x, y), x, y};
        }
        to[0] = motion_at(frame, nearest.x, nearest.y, 0), to[1] = motion_at(frame, nearest.x, nearest.y, 1);
        to[2] = nearest.depth;
        to[3] = depth_at(frame, x, y);
    }
}

HWY_INLINE Four ToYcocg(Four rgb) {
    const Four r = spread<0>(rgb), g = spread<1>(rgb), b = spread<2>(rgb);
    return fma(r, four(0.25f, 0.5f, -0.25f, 0), fma(g, four(0.5f, 0, 0.5f, 0), b * four(0.25f, -0.5f, -0.25f, 0)));
}
HWY_INLINE Four ToRgb(Four ycocg) {
    const Four y = spread<0>(ycocg), co = spread<1>(ycocg), cg = spread<2>(ycocg);
    return fma(co, four(1, 0, -1, 0), fma(cg, four(-1, 1, -1, 0), y * four(1, 1, 1, 0)));
}

/// Sums or bounds of some colours.
struct Spread {
    Four a, b;  // sum and sum of squares, or least and most

    HWY_INLINE static Spread Of(Four color, bool is_variance) { return {color, is_variance ? color * color : color}; }
    HWY_INLINE Spread With(Spread other, bool is_variance) const {
        return is_variance ? Spread{a + other.a, b + other.b} : Spread{least(a, other.a), most(b, other.b)};
    }
};

template <bool is_variance, bool is_ycocg>
HWY_INLINE Spread ColumnSpread(const FiniteRows& rows, int x, int top, int bottom) {
    const auto at = [&](int y) HWY_ATTR {
        const Four color = load(rows.row(y) + 4 * x);
        return Spread::Of(is_ycocg ? ToYcocg(color) : color, is_variance);
    };
    Spread spread = at(top);
    for (int y = top + 1; y <= bottom; ++y) spread = spread.With(at(y), is_variance);
    return spread;
}

template <bool is_variance, bool is_ycocg>
void BoxRowOf(const FiniteRows& rows, int y, int height, float* to) {
    const int top = std::max(0, y - 1), bottom = std::min(height - 1, y + 1), last = rows.width - 1;
    Spread left{}, middle = ColumnSpread<is_variance, is_ycocg>(rows, 0, top, bottom), right = middle;
    for (int x = 0; x <= last; ++x, to += 8) {
        Spread sum = middle;
        if (x > 0) sum = left.With(sum, is_variance);
        if (x < last) {
            right = ColumnSpread<is_variance, is_ycocg>(rows, x + 1, top, bottom);
            sum = sum.With(right, is_variance);
        }
        left = middle, middle = right;
        if (is_variance) {
            const int columns = 1 + (x > 0) + (x < last);
            const Four count = all(1 / static_cast<float>(columns * (bottom - top + 1)));
            const Four mean = sum.a * count;
            store(mean, to), store(root(most(all(0), sum.b * count - mean * mean)), to + 4);
        } else {
            store((sum.a + sum.b) * all(0.5f), to), store((sum.b - sum.a) * all(0.5f), to + 4);
        }
    }
}

void BoxRow(const TemporalPass& pass, const FiniteRows& rows, int y, float* to) {
    const int height = pass.frame.color.height;
    const bool is_variance = pass.options.rectification == Rectification::variance;
    if (pass.options.rectifies_ycocg) {
        if (is_variance) BoxRowOf<true, true>(rows, y, height, to);
        else BoxRowOf<false, true>(rows, y, height, to);
    } else {
        if (is_variance) BoxRowOf<true, false>(rows, y, height, to);
        else BoxRowOf<false, false>(rows, y, height, to);
    }
}

// ---- What the history holds

/// At a place: the mean colour there, with 1 behind it; how much memory; where it is read at a sample, that one.
struct HistorySample {
    Four color, sums;
    float weight = 0;
    bool is_exact = false;
};

/// The weights of four samples at t.
HWY_INLINE Four WeightsAt(std::span<const CubicPart> parts, float t) {
    std::size_t i = 0;
    if (parts.size() > 1) {
        t *= static_cast<float>(parts.size());
        i = std::min(static_cast<std::size_t>(t), parts.size() - 1);
        t -= static_cast<float>(i);
    }
    const CubicPart& part = parts[i];
    const Four at = all(t);
    return fma(fma(fma(load(part[3].data()), at, load(part[2].data())), at, load(part[1].data())), at,
               load(part[0].data()));
}

/// The 4 x 4 samples about a place: in the image, or a copy clamped to its border.
struct Patch {
    const float* first;
    std::ptrdiff_t row;

    HWY_INLINE Four operator()(int i, int j) const { return load(first + j * row + 4 * i); }
};

HWY_NOINLINE Patch ClampedPatch(View<const float> sums, int x, int y, float (&copy)[64]) {
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            std::copy_n(&sums(std::clamp(x + i - 1, 0, sums.width - 1), std::clamp(y + j - 1, 0, sums.height - 1)), 4,
                        copy + 16 * j + 4 * i);
    return {copy, 16};
}

/// Between the four samples in the middle of a patch.
struct Middle {
    Four low, high;     ///< of their colours
    float weight = 0;   ///< of their memory, interpolated
    Four interpolated;  ///< of their sums
    bool remembers = false;
};

HWY_INLINE Middle MiddleOf(const Patch& patch, float tx, float ty, float least_weight) {
    const Four p[4] = {patch(1, 1), patch(2, 1), patch(1, 2), patch(2, 2)};
    Middle m;
    const Four above = fma(p[1] - p[0], all(tx), p[0]), below = fma(p[3] - p[2], all(tx), p[2]);
    m.interpolated = fma(below - above, all(ty), above);
    m.weight = std::max(0.0f, last_of(m.interpolated));
    const Four weights = lasts_of(p[0], p[1], p[2], p[3]);
    const Four inverse = all(1) / weights;
    const Four colors[4] = {p[0] * spread<0>(inverse), p[1] * spread<1>(inverse), p[2] * spread<2>(inverse),
                            p[3] * spread<3>(inverse)};
    if (least_of(weights) > least_weight) {
        m.low = least(least(colors[0], colors[1]), least(colors[2], colors[3]));
        m.high = most(most(colors[0], colors[1]), most(colors[2], colors[3]));
        m.remembers = true;
        return m;
    }
    m.low = all(3e38f), m.high = all(-3e38f);
    for (int k = 0; k < 4; ++k) {
        if (!(last_of(p[k]) > least_weight)) continue;
        m.low = least(m.low, colors[k]), m.high = most(m.high, colors[k]);
        m.remembers = true;
    }
    return m;
}

/// Where sample (x, y) moved by (dx, dy) samples is; what lies outside is clamped to the border. Between samples the
/// colour is kept within that of the four about it.
HWY_INLINE HistorySample SampleHistory(const TemporalPass& pass, int x, int y, float dx, float dy) {
    const View<const float>& sums = pass.sums;
    const HistoryKernel kernel = pass.options.history_kernel;
    const float whole_x = std::floor(dx), whole_y = std::floor(dy);
    const float tx = dx - whole_x, ty = dy - whole_y;
    x += static_cast<int>(whole_x), y += static_cast<int>(whole_y);
    HistorySample result;
    result.color = result.sums = all(0);
    if (tx == 0 && ty == 0 && kernel != HistoryKernel::bspline) {
        result.sums =
            load(sums.data + std::clamp(y, 0, sums.height - 1) * sums.dy + 4 * std::clamp(x, 0, sums.width - 1));
        result.weight = last_of(result.sums);
        result.is_exact = true;
        if (result.weight > pass.least_weight) result.color = result.sums / all(result.weight);
        return result;
    }
    alignas(16) float copy[64];
    const bool is_inside = x >= 1 && y >= 1 && x + 2 < sums.width && y + 2 < sums.height;
    const Patch patch =
        is_inside ? Patch{sums.data + (y - 1) * sums.dy + 4 * (x - 1), sums.dy} : ClampedPatch(sums, x, y, copy);
    const Middle middle = MiddleOf(patch, tx, ty, pass.least_weight);
    if (!middle.remembers) return result;
    result.weight = middle.weight;
    Four sum = middle.interpolated;
    if (kernel != HistoryKernel::bilinear) {
        const Four wx = WeightsAt(pass.history_weights, tx), wy = WeightsAt(pass.history_weights, ty);
        const Four w0 = spread<0>(wx), w1 = spread<1>(wx), w2 = spread<2>(wx), w3 = spread<3>(wx);
        const bool drops_corners = kernel == HistoryKernel::catmull_rom5;
        const Four end0 = drops_corners ? all(0) : w0, end3 = drops_corners ? all(0) : w3;
        const auto row = [&](int j, Four first, Four last) HWY_ATTR {
            return fma(first, patch(0, j), w1 * patch(1, j)) + fma(last, patch(3, j), w2 * patch(2, j));
        };
        sum = fma(spread<0>(wy), row(0, end0, end3), spread<1>(wy) * row(1, w0, w3)) +
              fma(spread<3>(wy), row(3, end0, end3), spread<2>(wy) * row(2, w0, w3));
    }
    const float weight = last_of(sum);
    result.color = weight > pass.least_weight ? between(middle.low, sum / all(weight), middle.high)
                                              : (middle.low + middle.high) * all(0.5f);
    return result;
}

/// Between four samples of one channel.
HWY_INLINE float Interpolated(View<const float> v, int x, int y, float dx, float dy) {
    const float fx = std::floor(dx), fy = std::floor(dy), tx = dx - fx, ty = dy - fy;
    const int left = x + static_cast<int>(fx), top = y + static_cast<int>(fy);
    const auto at = [&](int i, int j) {
        return v(std::clamp(left + i, 0, v.width - 1), std::clamp(top + j, 0, v.height - 1));
    };
    const float above = at(0, 0) + tx * (at(1, 0) - at(0, 0)), below = at(0, 1) + tx * (at(1, 1) - at(0, 1));
    return above + ty * (below - above);
}

// ---- The step

/// One row of the step; the members are what is the same for all its pixels.
class RowStep {
public:
    RowStep(const TemporalPass& pass, const TemporalLine& line)
        : pass_(pass),
          line_(line),
          options_(pass.options),
          width_(pass.out.width),
          height_(pass.out.height),
          scale_x_(static_cast<float>(width_) / static_cast<float>(pass.frame.color.width)),
          scale_y_(static_cast<float>(height_) / static_cast<float>(pass.frame.color.height)),
          weight_y_(pass.gather.y[static_cast<std::size_t>(line.y)]),
          next_row_(&pass.next_sums(0, line.y)),
          out_row_(&pass.out(0, line.y)),
          has_history_(pass.sums.width > 0),
          has_reactive_(pass.frame.reactive.width > 0),
          has_transparency_(pass.next_transparency.width > 0),
          has_debug_(pass.debug.frame_weight.width + pass.debug.memory.width + pass.debug.rejection.width +
                         pass.debug.motion.width + pass.debug.disocclusion.width >
                     0),
          compares_surfaces_(pass.surface.width > 0 && std::isfinite(pass.options.depth_tolerance)),
          exposure_(static_cast<float>(pass.frame.exposure / pass.surface_exposure)),
          per_tolerance_(static_cast<float>(1 / pass.options.depth_tolerance)),
          box_size_(pass.options.rectification == Rectification::variance ? static_cast<float>(pass.options.box_size)
                                                                          : 1),
          forgets_by_mismatch_(static_cast<float>(1 - pass.options.disocclusion_keep)),
          most_still_(static_cast<float>(pass.options.still_frames * pass.gather.mean_weight)),
          forget_by_motion_(static_cast<float>(pass.options.forget_by_motion)),
          doubt_(static_cast<float>(pass.options.doubt)),
          rectify_share_(static_cast<float>(pass.options.rectify_share)),
          anti_flicker_(static_cast<float>(pass.options.anti_flicker)),
          deringing_weight_(static_cast<float>(pass.options.deringing_frames * pass.gather.mean_weight)),
          per_trust_(1 / (pass.enough_weight - pass.least_weight)) {
        if (!compares_surfaces_) return;
        surface_x_ = static_cast<float>(pass.surface.width) / static_cast<float>(width_);
        surface_y_ = static_cast<float>(pass.surface.height) / static_cast<float>(height_);
        surface_left_ = 0.5f * surface_x_ - 0.5f - static_cast<float>(pass.surface_jitter.x);
        surface_top_ = 0.5f * surface_y_ - 0.5f - static_cast<float>(pass.surface_jitter.y);
    }

    void Run() const {
        for (int x = 0; x < width_; ++x) Step(x);
    }

private:
    /// What the history holds of what is at an output pixel now.
    struct Past {
        HistorySample sample;
        float transparency = 0;            ///< times the weight of the sample
        float motion_x = 0, motion_y = 0;  ///< in output pixels
        float speed = 0;
        float mismatch = 1;  ///< 1 where it is of something else
        float lock = 0;      ///< 1 where it is of something thin
    };

    HWY_INLINE Past PastOf(int x, const float* guide) const {
        Past past;
        past.sample.color = past.sample.sums = all(0);
        past.motion_x = guide[0] * scale_x_, past.motion_y = guide[1] * scale_y_;
        past.speed = std::sqrt(past.motion_x * past.motion_x + past.motion_y * past.motion_y);
        const float at_x = static_cast<float>(x) + past.motion_x, at_y = static_cast<float>(line_.y) + past.motion_y;
        if (!has_history_ || !(at_x >= -0.5f && at_y >= -0.5f && at_x <= static_cast<float>(width_) - 0.5f &&
                               at_y <= static_cast<float>(height_) - 0.5f))
            return past;
        past.sample = SampleHistory(pass_, x, line_.y, past.motion_x, past.motion_y);
        if (pass_.transparency.width > 0)
            past.transparency = Interpolated(pass_.transparency, x, line_.y, past.motion_x, past.motion_y);
        past.mismatch = compares_surfaces_ ? MismatchOfSurface(guide, at_x, at_y) : 0;
        return past;
    }

    /// How much what the last frame saw about a place, in output pixels, is something else than what is there now: by
    /// how far the depth of any of the four samples about it is from those of `guide` and of the sample itself, which may
    /// be of a slope, or by that of the nearest sample, where that moved otherwise. (Of a thin line that does not move,
    /// the nearest sample often misses it.) What does not move now has not come in front of what was farther: the samples
    /// of that frame missed it.
    HWY_INLINE float MismatchOfSurface(const float* guide, float x, float y) const {
        const View<const float>& before = pass_.surface;
        x = x * surface_x_ + surface_left_, y = y * surface_y_ + surface_top_;
        const float fx = std::floor(x), fy = std::floor(y);
        const int left = static_cast<int>(fx), top = static_cast<int>(fy);
        const int x0 = std::clamp(left, 0, before.width - 1), x1 = std::clamp(left + 1, 0, before.width - 1);
        const int y0 = std::clamp(top, 0, before.height - 1), y1 = std::clamp(top + 1, 0, before.height - 1);
        const float *const above = before.data + y0 * before.dy, *const below = before.data + y1 * before.dy;
        const float* const at[4] = {above + 4 * x0, above + 4 * x1, below + 4 * x0, below + 4 * x1};
        const Four then = four(*at[0], *at[1], *at[2], *at[3]), near = all(guide[2]), far = all(guide[3]);
        const bool is_still = std::abs(guide[0]) < still_motion && std::abs(guide[1]) < still_motion;
        const Four beyond = is_still ? all(0) : then - far;
        const Four relative = most(most(beyond, near - then), all(0)) / most(least(then, far), all(1e-6f));
        const float closest = MismatchOfDepth(least_of(relative));
        const int i = (x - fx >= 0.5f ? 1 : 0) + (y - fy >= 0.5f ? 2 : 0);
        const float* const nearest = at[i];
        alignas(16) float lanes[4];
        store(relative, lanes);
        const float farther = MismatchOfDepth(lanes[i]);
        if (!(farther > closest)) return closest;
        const float dx = nearest[1] - guide[0], dy = nearest[2] - guide[1];
        const float otherwise = std::clamp(std::sqrt(dx * dx + dy * dy) - velocity_tolerance, 0.0f, 1.0f);
        return std::max(closest, std::min(farther, otherwise));
    }

    HWY_INLINE float MismatchOfDepth(float relative) const {
        return std::clamp(relative * per_tolerance_ - 1, 0.0f, 1.0f);
    }

    /// Moves history towards what is about the pixel now; returns how far it was outside of that, in half extents.
    HWY_INLINE float Rectify(Past& past, const float* box) const {
        const Four was = past.sample.color, color = options_.rectifies_ycocg ? ToYcocg(was) : with_last(was, 0);
        const Four centre = with_last(load(box), 0), extent = with_last(load(box + 4), 1);
        const Four half = extent * all(box_size_), difference = color - centre, far = magnitude(difference);
        const Four beyond = most(far - half, all(0));
        if (!(most_of(beyond) > 0)) return 0;
        const float outside = most_of(beyond / (extent + all(least_extent)));
        Four inside = color - with_sign(beyond, difference);
        if (options_.rectification == Rectification::clip)
            inside = fma(all(least_of(where_more(far, half, half / far, all(1)))), difference, centre);
        if (options_.rectifies_ycocg) inside = ToRgb(inside);
        const float moving = std::min(1.0f, past.speed * (1 / full_doubt_speed));
        const float least_share = rectify_share_ * moving;
        const float share = (least_share + (1 - least_share) * past.mismatch) * (1 - past.lock);
        past.sample.color = with_last(fma(inside - was, all(share), was), 1);
        if (share > 0) past.sample.is_exact = false;
        return outside * std::max(moving, past.mismatch);
    }

    HWY_NOINLINE void FollowExposure(HistorySample& sample) const {
        alignas(16) float color[4];
        store(sample.color, color);
        if (options_.compresses_highlights) restore_highlight(color);
        for (float& v : color) v *= exposure_;
        if (options_.compresses_highlights) compress_highlight(color);
        sample.color = with_last(load(color), 1);
        sample.is_exact = false;
    }

    /// How much weight a pixel of this speed may bring along.
    HWY_INLINE float MostWeight(float speed) const { return most_still_ / (1 + forget_by_motion_ * speed); }

    /// What is left of the memory of history that is doubted.
    HWY_INLINE float Memory(const Past& past, float outside, int near) const {
        float memory = past.sample.weight * (1 - past.mismatch * forgets_by_mismatch_);
        if (outside > 0) memory /= 1 + doubt_ * outside;
        if (has_reactive_) memory *= 1 - reaction_at(pass_.frame, near, line_.near_y);
        return std::min(memory, MostWeight(past.speed));
    }

    HWY_INLINE void Step(int x) const {
        const int near = pass_.gather.near_x[static_cast<std::size_t>(x)];
        const float* const guide = line_.guide + 4 * near;
        float weight = pass_.gather.x[static_cast<std::size_t>(x)] * weight_y_;
        Four gathered = load(line_.gathered + 4 * x);
        Past past = PastOf(x, guide);
        HistorySample& sample = past.sample;
        const float remembered = sample.weight;
        float outside = 0;
        if (pass_.next_locks.width > 0) UpdateLock(x, near, past);
        if (remembered > pass_.least_weight) {
            if (exposure_ != 1) FollowExposure(sample);
            if (line_.box != nullptr) outside = Rectify(past, line_.box + 8 * near);
            if (anti_flicker_ > 0 && weight > pass_.least_weight) {
                const float share = Steadiness(gathered, weight, sample.color);
                gathered = gathered * all(share), weight *= share;
            }
        }
        const float memory = remembered > 0 ? Memory(past, outside, near) : remembered;
        Four next;
        float transparency = 0;
        if (options_.rule == Accumulation::weighted) {
            const float share = memory == remembered ? 1 : memory / remembered;
            const Four kept = sample.is_exact ? sample.sums * all(share) : sample.color * all(memory);
            next = with_last(gathered + kept, memory + weight);
            if (has_transparency_) transparency = share * past.transparency + last_of(gathered);
        } else {
            next = NextByPlainRule(x, past, gathered, weight, transparency);
        }
        store_past_caches(next, next_row_ + 4 * x);
        if (has_transparency_) pass_.next_transparency(x, line_.y) = transparency;
        Show(x, next, transparency);
        if (has_debug_) Note(x, weight, past, outside, last_of(next));
    }

    /// Locks what is thin now, and takes along what was locked where the pixel comes from.
    HWY_NOINLINE void UpdateLock(int x, int near, Past& past) const {
        float before = 0;
        if (pass_.locks.width > 0 && past.sample.weight > 0)
            before = Interpolated(pass_.locks, x, line_.y, past.motion_x, past.motion_y) * (1 - past.mismatch);
        const float now = IsThin(near) ? 1 : 0;
        past.lock = std::max(before, now);
        pass_.next_locks(x, line_.y) = std::max(before * static_cast<float>(1 - 1 / options_.lock_frames), now);
    }

    /// Whether sample `x` of the nearest row is brighter, or darker, than all about it that are not like it, and those
    /// that are do not make a square with it, as they would inside of something.
    bool IsThin(int x) const {
        const int y = line_.near_y, width = pass_.frame.color.width, height = pass_.frame.color.height;
        if (x < 1 || y < 1 || x > width - 2 || y > height - 2) return false;
        const float own = Luma(load(line_.rows.row(y) + 4 * x));
        bool is_alike[3][3];
        float low = 3e38f, high = -3e38f;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                const float luma = Luma(load(line_.rows.row(y + j - 1) + 4 * (x + i - 1)));
                is_alike[j][i] = std::max(luma, own) <= alike_luma * std::min(luma, own) + alike_noise;
                if (!is_alike[j][i]) low = std::min(low, luma), high = std::max(high, luma);
            }
        if (low > high || !(own > high || own < low)) return false;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                if (is_alike[j][i] && is_alike[j][i + 1] && is_alike[j + 1][i] && is_alike[j + 1][i + 1]) return false;
        return true;
    }

    /// What a frame weighs beside history of another luma.
    HWY_NOINLINE float Steadiness(Four gathered, float weight, Four history) const {
        const float now = Luma(gathered) / weight, then = Luma(history);
        const float most = std::max(std::max(now, then), least_luma);
        return 1 / (1 + anti_flicker_ * std::abs(now - then) / most);
    }

    static HWY_INLINE float Luma(Four rgb) {
        return first_of(spread<0>(rgb)) * 0.25f + first_of(spread<1>(rgb)) * 0.5f + first_of(spread<2>(rgb)) * 0.25f;
    }

    HWY_NOINLINE Four NextByPlainRule(int x, const Past& past, Four gathered, float weight, float& transparency) const {
        const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(line_.y);
        const float peak = pass_.gather.peak_x[column] * pass_.gather.peak_y[row];
        const float share = options_.rule == Accumulation::per_frame ? 1 : peak;
        const float remembered = past.sample.weight;
        const float alpha = remembered > 0 ? static_cast<float>(options_.alpha) * share : 1;
        const bool is_usable = std::abs(weight) > 1e-4f;
        transparency = past.transparency;
        Four next = past.sample.color;
        if (is_usable) {
            next = fma(gathered / all(weight) - next, all(alpha), next);
            transparency += alpha * (last_of(gathered) / weight - transparency);
        }
        return with_last(next, is_usable || remembered > 0 ? 1 : 0);
    }

    /// The output pixel: what is remembered, or, as far as that is too little, samples about it.
    HWY_INLINE void Show(int x, Four next, float transparency) const {
        const float memory = last_of(next);
        Four color = next / all(memory);  // with alpha: 1
        if (has_transparency_) color = with_last(color, 1 - transparency / memory);
        if (!(memory >= pass_.enough_weight)) {
            const float trust = std::clamp((memory - pass_.least_weight) * per_trust_, 0.0f, 1.0f);
            const Four samples = InterpolatedInput(x);
            color = trust > 0 ? fma(color - samples, all(trust), samples) : samples;
        }
        if (deringing_weight_ > 0 && memory < deringing_weight_)
            color = Deringed(x, color, std::max(memory, 0.0f) / deringing_weight_);
        if (options_.compresses_highlights && most_of(with_last(color, 0)) > 1) color = Restored(color);
        Write(x, color);
    }

    HWY_INLINE void Write(int x, Four color) const {
        const View<float>& out = pass_.out;
        float* const to = out_row_ + x * out.dx;
        if (out.channels == 4 && out.dc == 1) return store(color, to);
        alignas(16) float lanes[4];
        store(color, lanes);
        for (int c = 0; c < out.channels; ++c) to[c * out.dc] = lanes[c];
    }

    static HWY_NOINLINE Four Restored(Four color) {
        alignas(16) float lanes[4];
        store(color, lanes);
        restore_highlight(lanes);
        return load(lanes);
    }

    /// Held within the range of the four samples about it, but for a share.
    HWY_NOINLINE Four Deringed(int x, Four color, float share) const {
        const FourSamples s = SamplesAbout(x);
        const Four low = least(least(s.at[0], s.at[1]), least(s.at[2], s.at[3]));
        const Four high = most(most(s.at[0], s.at[1]), most(s.at[2], s.at[3]));
        const Four held = between(low, color, high);
        return with_last(fma(color - held, all(share), held), last_of(color));
    }

    /// The frame itself, interpolated, with alpha.
    HWY_NOINLINE Four InterpolatedInput(int x) const {
        const FourSamples s = SamplesAbout(x);
        const Four above = fma(s.at[1] - s.at[0], all(s.tx), s.at[0]),
                   below = fma(s.at[3] - s.at[2], all(s.tx), s.at[2]);
        const Four sample = fma(below - above, all(s.ty), above);
        return with_last(sample, 1 - last_of(sample));
    }

    /// The samples of the frame about an output pixel, by rows, and where it lies between them.
    struct FourSamples {
        Four at[4];
        float tx, ty;
    };

    HWY_INLINE FourSamples SamplesAbout(int x) const {
        const Point jitter = pass_.frame.jitter;
        const int width = pass_.frame.color.width, height = pass_.frame.color.height;
        const float at_x = (static_cast<float>(x) + 0.5f) / scale_x_ - 0.5f - static_cast<float>(jitter.x);
        const float at_y = (static_cast<float>(line_.y) + 0.5f) / scale_y_ - 0.5f - static_cast<float>(jitter.y);
        const float fx = std::floor(at_x), fy = std::floor(at_y);
        const int left = static_cast<int>(fx), top = static_cast<int>(fy);
        const auto at = [&](int i, int j) HWY_ATTR {
            return load(line_.rows.row(std::clamp(top + j, 0, height - 1)) + 4 * std::clamp(left + i, 0, width - 1));
        };
        return {{at(0, 0), at(1, 0), at(0, 1), at(1, 1)}, at_x - fx, at_y - fy};
    }

    HWY_NOINLINE void Note(int x, float weight, const Past& past, float outside, float memory) const {
        const TemporalDebug& debug = pass_.debug;
        const int y = line_.y;
        if (debug.frame_weight.width > 0) debug.frame_weight(x, y) = weight;
        if (debug.memory.width > 0) debug.memory(x, y) = memory;
        if (debug.rejection.width > 0) debug.rejection(x, y) = outside;
        if (debug.disocclusion.width > 0) debug.disocclusion(x, y) = past.mismatch;
        if (debug.motion.width > 0) debug.motion(x, y, 0) = past.motion_x, debug.motion(x, y, 1) = past.motion_y;
    }

    const TemporalPass& pass_;
    const TemporalLine& line_;
    const TemporalOptions& options_;
    int width_, height_;
    float scale_x_, scale_y_, weight_y_;
    float *next_row_, *out_row_;
    bool has_history_, has_reactive_, has_transparency_, has_debug_, compares_surfaces_;
    float exposure_, per_tolerance_, box_size_, forgets_by_mismatch_, most_still_, forget_by_motion_, doubt_,
        rectify_share_, anti_flicker_, deringing_weight_, per_trust_;
    float surface_x_ = 1, surface_y_ = 1, surface_left_ = 0, surface_top_ = 0;  ///< output pixels to samples before
};

void StepRow(const TemporalPass& pass, const TemporalLine& line) {
    RowStep(pass, line).Run();
    flush_stores();
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {

BANDLIMIT_EXPORT(FiniteRow);
BANDLIMIT_EXPORT(GuideRow);
BANDLIMIT_EXPORT(BoxRow);
BANDLIMIT_EXPORT(StepRow);

void finite_row(const TemporalPass& pass, int y, float* to) { BANDLIMIT_DISPATCH(FiniteRow)(pass, y, to); }
void guide_row(const TemporalPass& pass, int y, float* to) { BANDLIMIT_DISPATCH(GuideRow)(pass, y, to); }
void box_row(const TemporalPass& pass, const FiniteRows& rows, int y, float* to) {
    BANDLIMIT_DISPATCH(BoxRow)(pass, rows, y, to);
}
void step_row(const TemporalPass& pass, const TemporalLine& line) { BANDLIMIT_DISPATCH(StepRow)(pass, line); }

void keep_surface_row(const TemporalPass& pass, int y) {
    for (int x = 0; x < pass.next_surface.width; ++x) {
        float* const to = &pass.next_surface(x, y);
        to[0] = depth_at(pass.frame, x, y);
        to[1] = motion_at(pass.frame, x, y, 0), to[2] = motion_at(pass.frame, x, y, 1);
    }
}

void compress_highlight(float* rgb) {
    const float most = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(most > 1)) return;
    const float scale = (1 + std::log(most)) / most;
    for (int c = 0; c < 3; ++c) rgb[c] *= scale;
}

void restore_highlight(float* rgb) {
    const float most = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(most > 1)) return;
    const float scale = std::exp(most - 1) / most;
    for (int c = 0; c < 3; ++c) rgb[c] *= scale;
}

}  // namespace bandlimit
#endif
