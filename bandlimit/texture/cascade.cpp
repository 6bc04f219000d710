#include "bandlimit/texture/cascade.h"

#include <algorithm>

#include "bandlimit/texture/texture.h"

namespace bandlimit {
namespace {

/// How many rows of a level are made at a time: enough for all threads, where the floats of level 1 then take no more
/// than `most_bytes`. The fewer, the more of the rows above are decoded twice.
int rows_per_block(int width, int channels, Parallel parallel) {
    constexpr int per_thread = 96, least = 64;
    constexpr std::int64_t most_bytes = 32 << 20;
    const std::int64_t row = std::int64_t{mip_length(width, 1)} * channels * static_cast<std::int64_t>(sizeof(float));
    const int rows = per_thread * parallel.count();
    return rows * row > most_bytes ? least : rows;
}

}  // namespace

MipCascade::MipCascade(int width, int height, int channels, const Encoding& stored, int levels,
                       const ResizeOptions& options, Parallel parallel)
    : stored_(stored),
      between_{Transfer::linear, stored.alpha, stored.associated || options.premultiply},
      parallel_(parallel),
      block_(rows_per_block(width, channels, parallel)) {
    if (width < 1 || height < 1 || levels < 1 || levels > mip_count(width, height))
        fail("MipCascade: ", levels, " levels of ", width, " x ", height, "; pass a size of at least 1 x 1 and 1 to ",
             mip_count(std::max(width, 1), std::max(height, 1)), " levels");
    check_encoding("MipCascade", stored, channels);
    for (int level = 1; level < levels; ++level) {
        const Grid above{{mip_length(width, level - 1)}, {mip_length(height, level - 1)}};
        const Grid grid{{mip_length(width, level)}, {mip_length(height, level)}};
        steps_.push_back({Resizer(above, grid, channels, options), grid.x.count, grid.y.count});
    }
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        Step& step = steps_[i];
        const int kept = i + 1 < steps_.size() ? largest_need(steps_[i + 1]) : 0;
        const int rows = std::min(step.height, kept + std::min(step.height, block_));
        step.window = Image<float>(step.width, rows, channels, Layout::interleaved);
    }
}

/// The rows of the level above that the block of level i + 1 from row `first` on reads. Under Edge::wrap its last rows
/// read the first ones, which must stay.
IndexRange MipCascade::needed(std::size_t i, int first) const {
    const Step& step = steps_[i];
    const IndexRange next = step.resizer.rows_needed(first, block_end(step, first));
    const IndexRange last = step.resizer.rows_needed(step.height - 1, step.height);
    return {std::min(next.begin, last.begin), next.end};
}

/// How many rows of the level above a block of `step` needs at most.
int MipCascade::largest_need(const Step& step) const {
    int largest = 0;
    for (int first = 0; first < step.height; first += block_) {
        const IndexRange range = step.resizer.rows_needed(first, block_end(step, first));
        largest = std::max(largest, range.end - range.begin);
    }
    return largest;
}

/// Forgets the rows of a level that the next one no longer reads.
void MipCascade::drop_rows(std::size_t i) {
    Step& step = steps_[i];
    const bool is_read = i + 1 < steps_.size() && steps_[i + 1].done < steps_[i + 1].height;
    const int first = is_read ? std::min(needed(i + 1).begin, step.done) : step.done;
    if (first == step.kept) return;
    const View<float> v = step.window.view();
    std::copy(&v(0, 0) + (first - step.kept) * v.dy, &v(0, 0) + (step.done - step.kept) * v.dy, &v(0, 0));
    step.kept = first;
}

void MipCascade::make_block(std::size_t i, const SourceRows& source, const Sink& sink) {
    drop_rows(i);
    Step& step = steps_[i];
    const int end = block_end(step, step.done);
    const View<float> rows = cropped(step.window.view(), 0, step.done - step.kept, step.width, end - step.done);
    step.resizer.run(source, {rows, step.done, between_, {}}, parallel_);
    sink(static_cast<int>(i) + 1, step.done, rows);
    step.done = end;
}

/// Makes a block of level i + 1, and what that allows of the levels below it, before it gets rows again.
void MipCascade::descend(std::size_t i, const SourceRows& source, const Sink& sink) {
    make_block(i, source, sink);
    const std::size_t below = i + 1;
    const Step& step = steps_[i];
    while (below < steps_.size() && steps_[below].done < steps_[below].height && needed(below).end <= step.done) {
        const View<const float> window = step.window.view();
        descend(below, {cropped(window, 0, 0, step.width, step.done - step.kept), step.kept, between_}, sink);
    }
}

void MipCascade::advance(const AnyConstView& rows, int first, const Sink& sink) {
    if (steps_.empty() || steps_[0].done == steps_[0].height)
        fail("MipCascade::advance: all rows are made; call it steps() times");
    descend(0, {rows, first, stored_}, sink);
}

}  // namespace bandlimit
