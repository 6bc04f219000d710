// Stages of work that overlap.
// Stability: inner.
#pragma once
#include <functional>
#include <vector>

#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// Work done to one item after another, such as reading, filtering or writing a band of rows.
struct Stage {
    std::function<void(int item, Parallel parallel)> run;
    bool scales = false;  ///< may use all free threads; otherwise it gets one
};

/// Takes items 0 to count - 1 through all stages: each stage one item at a time and in order, the stages in parallel:
/// while the last one works on item i, those before it may be at i + 1 and i + 2.
///
/// A stage begins item i when the one before it is done with i, and the one after it with i - 2: so two buffers between
/// neighbours are enough, and item i may still look into the buffer of item i - 1.
///
/// threads  at most parallel.count() are busy at a time. The first stage runs in the caller's thread; with one thread,
///          or a runner of the caller's, whose tasks may not wait for each other, all do, and nothing overlaps
/// cost     a few microseconds per item, and a thread for each stage except the first
/// throws   the first exception of a stage, after all of them have stopped; Stopped, between items, if parallel.stop
///          asks for it; Error for no stages or count < 0
void run_pipeline(int count, const std::vector<Stage>& stages, const Parallel& parallel);

}  // namespace bandlimit
