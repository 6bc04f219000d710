// Stages of work that overlap.
#pragma once
#include <functional>
#include <vector>

#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// What is done to one item after another, as reading, filtering or writing a band of rows.
struct Stage {
    std::function<void(int item, Parallel parallel)> run;
    bool scales = false;  ///< may keep all threads busy that are free; else it gets one
};

/// Takes items 0 to count - 1 through all stages, each stage one item at a time and in order, the stages side by side:
/// while the last one works on item i, those before it may be at i + 1 and i + 2.
///
/// A stage begins item i when the one before it is done with i, and the one after it with i - 2: so two buffers between
/// neighbours are enough, and item i may still look into the buffer of item i - 1.
///
/// threads  at most parallel.count() are busy at a time. The first stage runs in the caller's thread; with one thread
///          all do, and nothing overlaps
/// cost     some microseconds per item, and a thread per stage but the first
/// throws   what a stage threw first, after all of them stopped; Error for no stages or count < 0
void run_pipeline(int count, const std::vector<Stage>& stages, Parallel parallel);

}  // namespace bandlimit
