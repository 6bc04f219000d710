// The levels of a mip chain, each from the one above, a few rows at a time.
// Stability: inner.
#pragma once
#include <algorithm>
#include <functional>
#include <vector>

#include "bandlimit/core/parallel.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {

/// Makes levels 1, 2, ... while rows of level 0 come by, so that neither it nor the floats between levels need be in
/// memory: each level keeps the rows that the next one still reads.
///
/// Levels stay linear, multiplied by alpha, unrounded: rounding to codes is never read again, and the rows have the
/// bits of whole levels filtered one after another, for any number of threads.
/// memory   per level 200 to 600 of its rows as floats, of wide pictures 200; under Edge::wrap the whole level
/// cost     a third more than level 1 alone
class MipCascade {
public:
    /// Where rows go: level >= 1, its row `first` and those below it, channels interleaved, linear, multiplied by alpha
    /// where `stored` has alpha and the options ask for it. Called by one thread, top to bottom within a level.
    using Sink = std::function<void(int level, int first, View<const float> rows)>;

    /// `levels` counts level 0, whose rows are `width` samples of `channels` channels, stored as `stored`.
    /// throws   Error as Resizer, and for levels that a picture of this size does not have
    MipCascade(int width, int height, int channels, const Encoding& stored, int levels, const ResizeOptions& options,
               Parallel parallel = {});

    /// How often advance() must be called to make all.
    int steps() const { return steps_.empty() ? 0 : (steps_[0].height - 1) / block_ + 1; }
    /// The rows of level 0 that it reads when it is called for the (step + 1)-th time. From step to step neither end
    /// falls.
    IndexRange rows_needed(int step) const { return needed(0, step * block_); }
    /// Makes the next rows of level 1, and what they allow of the levels below it. Row 0 of `rows` is row `first` of
    /// level 0; they must hold rows_needed(), and may hold more.
    /// throws   Error if sizes or rows do not fit; what `sink` throws
    void advance(const AnyConstView& rows, int first, const Sink& sink);

private:
    /// A level, and how it is made of the one above.
    struct Step {
        Resizer resizer;
        int width, height;
        int done = 0;           ///< rows made so far
        int kept = 0;           ///< the level's row that is the first of `window`
        Image<float> window{};  ///< rows [kept, done), and room for the next block
    };

    int block_end(const Step& step, int first) const { return std::min(first + block_, step.height); }
    IndexRange needed(std::size_t i, int first) const;
    IndexRange needed(std::size_t i) const { return needed(i, steps_[i].done); }
    int largest_need(const Step& step) const;
    void make_block(std::size_t i, const SourceRows& source, const Sink& sink);
    void descend(std::size_t i, const SourceRows& source, const Sink& sink);
    void drop_rows(std::size_t i);

    Encoding stored_, between_;
    Parallel parallel_;
    int block_ = 0;  ///< rows of a level that are made at a time
    std::vector<Step> steps_;
};

}  // namespace bandlimit
