// Resampling by way of floats: every depth, encoding and kernel.
// Stability: inner.
#pragma once
#include "bandlimit/resample/plan.h"

namespace bandlimit {

/// Output rows computed together: more where their samples side by side fill no tile.
constexpr int rows_of_block(int channels) { return channels < 3 ? 32 : 16; }

/// How wide a strip is whose source rows are `rows`; borders of strips are decoded twice, so it is much wider than what
/// an output reads.
double strip_columns(double rows, int channels, double taps);

/// Appends the strips that output columns [first, last) of a plan with banks are computed in: one if the rows along x
/// are filtered first.
void add_strips(const ResizePlan& plan, int first, int last, std::vector<Strip>& strips);

/// Computes rows [begin, end) of the output in one thread, of these of the plan's strips; a radial kernel has none, and
/// computes all columns. See Resizer.
///
/// memory   the source rows that a block of output rows reads, and one more block, of one strip: about 1 MiB
bool resize_floats(const ResizePlan& plan, const std::vector<Strip>& strips, const RowRun& run, IndexRange rows);

}  // namespace bandlimit
