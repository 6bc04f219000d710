// Stored rows on their way into filters.
// Stability: inner.
#pragma once
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// Decodes a run of columns of an image, row by row, with what its edges put beside and above it.
class RowLoader {
public:
    /// `columns` may reach outside the image, which is source's columns by `height` rows.
    RowLoader(const SourceRows& source, IndexRange columns, int height, Edge edge_x, Edge edge_y, bool premultiply);

    /// Row v, which may lie outside too: the samples of the columns, channels interleaved, to `row`. Rows that the edge
    /// leads to must be among those of the source.
    void load(int v, float* row) const;
    /// Those columns that exist, as they are stored.
    const AnyConstView& inside() const { return inside_; }

private:
    std::size_t length(int width) const { return static_cast<std::size_t>(width) * channels_; }
    void load_outside(int x, int y, float* row) const;
    void decode(const AnyConstView& from, int y, std::span<float> row) const;

    const SourceRows& source_;
    IndexRange columns_;
    int width_, height_;  ///< of the image
    std::size_t channels_;
    Edge edge_x_, edge_y_;
    bool premultiply_;
    IndexRange existing_;  ///< the part of columns_ that exists; empty, within them, where nothing does
    AnyConstView inside_;
};

}  // namespace bandlimit
