// Gaussian sums over the samples about each sample, by the one engine, in tiles that each have an offset of their own.
// Stability: inner.
#pragma once
#include <functional>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

struct GaussianWindow {
    int width = 0, height = 0;
    double sigma = 0;  ///< samples; weights end at 4 sigma
    Edge edge = Edge::renormalize;
    int planes = 1;
};

/// A tile: its outputs, and the stored samples that they read.
struct GaussianTile {
    IndexRange xs, ys, source_xs, source_ys;
};

/// Makes what fills rows of a tile as FillRow does, from whatever it wants to know of the tile first. Row -1 is what lies
/// outside under Edge::zero, at every column.
using FillTileRow = std::function<void(int y, IndexRange xs, double* const* planes)>;
/// Sees weighted means, [planes][columns of the tile], of a row of the tile.
using TakeTileRow = std::function<void(int y, const double* const* means)>;
struct TileWork {
    FillTileRow fill;
    TakeTileRow take;
};

/// Sums whose weights, of samples inside and outside, sum to 1.
///
/// error    as term_filter(), in floats, relative to the sum of the magnitudes of what `fill` wrote
/// throws   Stopped
void gaussian_sums(const GaussianWindow& window, const std::function<TileWork(const GaussianTile& tile)>& start,
                   const Parallel& parallel);

}  // namespace bandlimit
