// What makes a level of a mip chain from a larger one.
// Stability: inner.
#pragma once
#include "bandlimit/resample/row_filter.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {

/// What a level is made with, beside a filter.
struct LevelOptions {
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    bool premultiply = true;
};

/// A MipFilter ready to run between two grids. Throws Error as Resizer and term_filter().
RowFilter level_filter(const MipFilter& filter, const Grid& src, const Grid& dst, int channels,
                       const LevelOptions& options);

/// How far the weights of an output reach to either side, in source samples, with `step` of them per output.
int reach_of(const MipFilter& filter, double step);

}  // namespace bandlimit
