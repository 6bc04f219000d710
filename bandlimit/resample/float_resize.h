// Resampling by way of floats: every depth, encoding and kernel.
#pragma once
#include "bandlimit/resample/plan.h"

namespace bandlimit {

constexpr int block_rows = 16;  ///< output rows computed together

/// The strips that the columns of a plan with banks are computed in: one if the rows along x are filtered first.
std::vector<Strip> make_strips(const ResizePlan& plan);

/// Computes rows [begin, end) of the output in one thread; see Resizer::run.
///
/// memory   the source rows that block_rows output rows read, and block_rows more, of one strip
bool resize_floats(const ResizePlan& plan, const SourceRows& source, const TargetRows& target, int begin, int end);

}  // namespace bandlimit
