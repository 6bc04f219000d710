// Filtered rows on their way to where they are stored.
// Stability: inner.
#pragma once
#include <span>
#include <vector>

#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// Columns [first, first + width) of a view of any depth.
AnyConstView columns_of(const AnyConstView& view, int first, int width);
AnyView columns_of(const AnyView& view, int first, int width);

/// Encodes rows of some columns of a target, over its background if it has one.
class RowStore {
public:
    /// `premultiply` is what the filter was asked for: its rows are multiplied by alpha also where the source was.
    RowStore(const RowRun& run, int first_column, int width, bool premultiply);

    /// Output row y, channels interleaved. Returns whether a value that is not finite became the code 0.
    bool store(std::span<const float> row, int y);

    /// Output rows [first, last), where they are floats to be stored as they come out, else an empty view.
    View<float> direct(int first, int last) const;

private:
    const TargetRows& target_;
    AnyView samples_;
    int channels_, alpha_;  ///< of the rows
    bool is_premultiplied_;
    std::vector<float> opaque_;
};

}  // namespace bandlimit
