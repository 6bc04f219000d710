#include "bandlimit/resample/row_loader.h"

#include <algorithm>

#include "bandlimit/resample/row_store.h"

namespace bandlimit {
namespace {

IndexRange part_inside(IndexRange read, int count) {
    const int begin = std::clamp(0, read.begin, read.end);
    return {begin, std::clamp(count, begin, read.end)};
}

}  // namespace

RowLoader::RowLoader(const SourceRows& source, IndexRange columns, int height, Edge edge_x, Edge edge_y,
                     bool premultiply)
    : source_(source),
      columns_(columns),
      width_(shape_of(source.samples).width),
      height_(height),
      channels_(static_cast<std::size_t>(shape_of(source.samples).channels)),
      edge_x_(edge_x),
      edge_y_(edge_y),
      premultiply_(premultiply),
      existing_(part_inside(columns, width_)),
      inside_(columns_of(source.samples, existing_.begin < existing_.end ? existing_.begin : 0,
                         existing_.end - existing_.begin)) {}

void RowLoader::load(int v, float* row) const {
    const int y = resolve(v, height_, edge_y_);
    if (y < 0) return static_cast<void>(std::fill_n(row, length(columns_.end - columns_.begin), 0.0f));
    const std::size_t before = length(existing_.begin - columns_.begin);
    if (existing_.begin < existing_.end) decode(inside_, y, {row + before, length(existing_.end - existing_.begin)});
    for (int x = columns_.begin; x < existing_.begin; ++x) load_outside(x, y, row);
    for (int x = existing_.end; x < columns_.end; ++x) load_outside(x, y, row);
}

void RowLoader::load_outside(int x, int y, float* row) const {
    const int from = resolve(x, width_, edge_x_);
    float* const to = row + length(x - columns_.begin);
    if (from < 0) std::fill_n(to, channels_, 0.0f);
    else if (from >= existing_.begin && from < existing_.end)
        std::copy_n(row + length(from - columns_.begin), channels_, to);
    else decode(columns_of(source_.samples, from, 1), y, {to, channels_});
}

void RowLoader::decode(const AnyConstView& from, int y, std::span<float> row) const {
    decode_row(from, y - source_.first_row, source_.encoding, premultiply_, row);
}

}  // namespace bandlimit
