// Stages of work that overlap.
#pragma once
#include <functional>
#include <vector>

#include "bandlimit/core/parallel.h"

namespace bandlimit::app {

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
/// throws   what a stage threw first, after all of them stopped
void run_pipeline(int count, const std::vector<Stage>& stages, Parallel parallel);

/// How many threads codecs may use for what they do in parallel, and how many are left for the stages of a pipeline
/// that reads and writes through them: together no more than the caller allows.
struct Shares {
    Parallel codecs, stages;
};
Shares shares_of(Parallel parallel);

}  // namespace bandlimit::app
