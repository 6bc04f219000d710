#include "bandlimit/resample/float_resize.h"

#include <algorithm>
#include <optional>
#include <variant>

#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/row_loader.h"
#include "bandlimit/resample/rows.h"
#include "bandlimit/resample/sliding.h"

namespace bandlimit {
namespace {

constexpr double strip_bytes = 1 << 20;  // of rows between source and output: half of a second cache of these days

/// Computes the output columns of one strip in one thread; for radial kernels, of all.
class FloatRun {
public:
    FloatRun(const ResizePlan& plan, const SourceRows& source, const TargetRows& target, const Strip& strip)
        : plan_(plan),
          source_(source),
          target_(target),
          strip_(strip),
          channels_(static_cast<std::size_t>(plan.channels)),
          width_(strip.read.end - strip.read.begin),
          outputs_(strip.outputs()),
          loader_(source, strip.read, plan.src.y.count, plan.options.edge, plan.edge_y(), plan.options.premultiply),
          targets_(columns_of(target.samples, strip.first(), outputs_)),
          block_(rows_of_block(plan.channels)),
          out_(block_, length(outputs_)) {
        if (plan.x_first) decoded_ = Rows(block_, length(width_));
        else if (!plan.radial) middle_ = Rows(block_, length(width_));
    }

    /// Rows [begin, end) of the target; returns whether something not finite was lost.
    bool rows(int begin, int end) {
        bool lost = false;
        for (int first = begin; first < end; first += block_) {
            const int last = std::min(first + block_, end);
            gather_lines(plan_.rows_read(first, last));
            if (plan_.radial) filter_radial(first, last);
            else if (plan_.x_first) filter_y(first, last, out_, outputs_);
            else {
                filter_y(first, last, middle_, width_);
                const View<const float> middle = middle_.view(0, last - first, width_, plan_.channels);
                if (const std::optional<View<float>> target = direct_target(first, last)) {
                    filter_x(middle, *target);
                    continue;
                }
                filter_x(middle, out_.view(0, last - first, outputs_, plan_.channels));
            }
            for (int i = first; i < last; ++i) lost |= store(i - first, i);
        }
        return lost;
    }

private:
    std::size_t length(int width) const { return static_cast<std::size_t>(width) * channels_; }
    float antiring() const { return static_cast<float>(plan_.options.antiring); }
    bool premultiplied() const { return plan_.options.premultiply || source_.encoding.associated; }

    /// Lets lines_ point to the rows `read`, which are made unless they are there.
    void gather_lines(IndexRange read) {
        lines_.clear();
        begin_ = read.begin;
        if (is_direct()) {
            for (int v = read.begin; v < read.end; ++v) lines_.push_back(direct_row(v));
            return;
        }
        window_.hold(
            read, [&](int slots) { held_ = Rows(slots, length(plan_.x_first ? outputs_ : width_)); },
            [&](int v, int slot, int count) { fill(v, slot, count); });
        for (int v = read.begin; v < read.end; ++v) lines_.push_back(held_[window_.slot_of(v)]);
    }
    ConstLines lines_at_zero() const { return lines_.data() - begin_; }

    /// Whether source rows are floats that need nothing but filtering.
    bool is_direct() const {
        const auto* floats = std::get_if<View<const float>>(&loader_.inside());
        const Encoding& from = source_.encoding;
        return floats && floats->dx == plan_.channels && (floats->dc == 1 || plan_.channels == 1) &&
               from.transfer == Transfer::linear && (from.alpha < 0 || from.associated || !plan_.options.premultiply) &&
               !plan_.x_first && width_ == floats->width && !plan_.radial;
    }
    const float* direct_row(int v) const {
        const int y = resolve(v, plan_.src.y.count, plan_.edge_y()) - source_.first_row;
        return &std::get<View<const float>>(loader_.inside())(0, y);
    }

    void filter_y(int first, int last, Rows& to, int width) {
        combine(plan_.y, first, last, antiring(), lines_at_zero(), to.lines(), length(width));
    }

    void filter_x(View<const float> from, View<float> to) {
        apply_by_tiles(plan_.x, strip_.runs, from, strip_.read.begin, to, strip_.first(), antiring());
    }

    /// Target rows [first, last), where they are floats to be stored as they come out.
    std::optional<View<float>> direct_target(int first, int last) const {
        const auto* floats = std::get_if<View<float>>(&targets_);
        const Encoding& to = target_.encoding;
        if (!floats || to.transfer != Transfer::linear || !target_.background.empty() ||
            (to.alpha >= 0 && premultiplied() != to.associated))
            return {};
        return cropped(*floats, 0, first - target_.first_row, floats->width, last - first);
    }

    void filter_radial(int first, int last) {
        for (int i = first; i < last; ++i)
            plan_.radial->row(i, lines_at_zero(), plan_.channels, antiring(), out_[i - first]);
    }

    /// Makes the rows of indices [v, v + count) in slots of the window.
    void fill(int v, int slot, int count) {
        if (!plan_.x_first) {
            for (int i = 0; i < count; ++i) loader_.load(v + i, held_[slot + i]);
            return;
        }
        for (int done = 0; done < count; done += block_) {
            const int some = std::min(block_, count - done);
            for (int i = 0; i < some; ++i) loader_.load(v + done + i, decoded_[i]);
            filter_x(decoded_.view(0, some, width_, plan_.channels),
                     held_.view(slot + done, some, outputs_, plan_.channels));
        }
    }

    bool store(int from, int i) {
        const std::span<const float> row{out_[from], length(outputs_)};
        const int y = i - target_.first_row;
        if (target_.background.empty()) return encode_row(row, premultiplied(), targets_, y, target_.encoding);
        opaque_.resize(static_cast<std::size_t>(outputs_) * (channels_ - 1));
        composite_row(row, premultiplied(), plan_.channels, source_.encoding.alpha, target_.background, opaque_);
        return encode_row(opaque_, false, targets_, y, target_.encoding);
    }

    const ResizePlan& plan_;
    const SourceRows& source_;
    const TargetRows& target_;
    const Strip& strip_;
    std::size_t channels_;
    int width_, outputs_;
    RowLoader loader_;
    AnyView targets_;
    int block_;  ///< output rows computed together
    SlidingWindow window_;
    Rows held_, decoded_, middle_, out_;
    std::vector<const float*> lines_;
    int begin_ = 0;  ///< the row of lines_[0]
    std::vector<float> opaque_;
};

}  // namespace

double strip_columns(double rows, int channels, double taps) {
    return std::max(strip_bytes / (rows * channels * sizeof(float)), 16 * taps);
}

void add_strips(const ResizePlan& plan, int first, int last, std::vector<Strip>& strips) {
    const double step = static_cast<double>(plan.src.y.count) / plan.dst.y.count;
    const double rows = rows_of_block(plan.channels) * (1 + step) + plan.y.row_info(plan.y.output_count() / 2).count;
    const std::size_t before = strips.size();
    for (const TileRun& run : tile_runs(plan.x, first, last)) {
        if (strips.size() > before) {
            Strip& strip = strips.back();
            const IndexRange both{std::min(strip.read.begin, run.read.begin), std::max(strip.read.end, run.read.end)};
            const int taps = plan.x.row_info(run.first).count;
            if (plan.x_first || both.end - both.begin <= strip_columns(rows, plan.channels, taps)) {
                strip.runs.push_back(run);
                strip.read = both;
                continue;
            }
        }
        strips.push_back({{run}, run.read});
    }
}

bool resize_floats(const ResizePlan& plan, const std::vector<Strip>& strips, const SourceRows& source,
                   const TargetRows& target, int begin, int end) {
    if (plan.radial) {
        const Strip all{{{0, plan.dst.x.count, {}}}, {0, plan.src.x.count}};
        return FloatRun(plan, source, target, all).rows(begin, end);
    }
    bool lost = false;
    for (const Strip& strip : strips) lost |= FloatRun(plan, source, target, strip).rows(begin, end);
    return lost;
}

}  // namespace bandlimit
