#include "bandlimit/resample/float_resize.h"

#include <algorithm>
#include <variant>

#include "bandlimit/resample/caches.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/row_loader.h"
#include "bandlimit/resample/row_store.h"
#include "bandlimit/resample/rows.h"
#include "bandlimit/resample/sliding.h"

namespace bandlimit {
namespace {

/// Computes the output columns of one strip in one thread; for radial kernels, of all.
class FloatRun {
public:
    FloatRun(const ResizePlan& plan, const RowRun& run, const Strip& strip)
        : plan_(plan),
          run_(run),
          source_(run.sources[0]),
          strip_(strip),
          channels_(static_cast<std::size_t>(plan.channels)),
          width_(strip.read.count()),
          outputs_(strip.outputs()),
          loader_(source_, strip.read, plan.src.y.count, plan.options.edge, plan.edge_y(), plan.options.premultiply),
          store_(run, strip.first(), outputs_, plan.options.premultiply),
          block_(rows_of_block(plan.channels)),
          out_(block_, length(outputs_)) {
        if (plan.x_first) decoded_ = Rows(block_, length(width_));
        else if (!plan.radial) middle_ = Rows(block_, length(width_));
    }

    /// Makes `rows` of the target; returns whether something not finite was lost.
    bool make(IndexRange rows) {
        bool lost = false;
        for (int first = rows.begin; first < rows.end; first += block_) {
            const int last = std::min(first + block_, rows.end);
            lost |= make_block(first, last);
            run_.monitor.made(static_cast<std::int64_t>(last - first) * outputs_ * plan_.channels);
        }
        return lost;
    }

private:
    std::size_t length(int width) const { return static_cast<std::size_t>(width) * channels_; }
    float antiring() const { return static_cast<float>(plan_.options.antiring); }

    bool make_block(int first, int last) {
        gather_lines(plan_.rows_read(first, last));
        if (plan_.radial) filter_radial(first, last);
        else if (plan_.x_first) filter_y(first, last, out_, outputs_);
        else {
            filter_y(first, last, middle_, width_);
            const View<const float> middle = middle_.view(0, last - first, width_, plan_.channels);
            const View<float> target = store_.direct(first, last);
            filter_x(middle, target.data ? target : out_.view(0, last - first, outputs_, plan_.channels));
            if (target.data) return false;
        }
        bool lost = false;
        for (int i = first; i < last; ++i) lost |= store_.store({out_[i - first], length(outputs_)}, i);
        return lost;
    }

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

    const ResizePlan& plan_;
    const RowRun& run_;
    const SourceRows& source_;
    const Strip& strip_;
    std::size_t channels_;
    int width_, outputs_;
    RowLoader loader_;
    RowStore store_;
    int block_;  ///< output rows computed together
    SlidingWindow window_;
    Rows held_, decoded_, middle_, out_;
    std::vector<const float*> lines_;
    int begin_ = 0;  ///< the row of lines_[0]
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

bool resize_floats(const ResizePlan& plan, const std::vector<Strip>& strips, const RowRun& run, IndexRange rows) {
    if (plan.radial) {
        const Strip all{{{0, plan.dst.x.count, {}}}, {0, plan.src.x.count}};
        return FloatRun(plan, run, all).make(rows);
    }
    bool lost = false;
    for (const Strip& strip : strips) lost |= FloatRun(plan, run, strip).make(rows);
    return lost;
}

}  // namespace bandlimit
