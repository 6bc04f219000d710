// Threads of codecs and of stages.
// Stability: inner.
#pragma once
#include "bandlimit/core/parallel.h"

namespace bandlimit::job {

/// How many threads codecs may use for what they do in parallel, and how many are left for the stages of a pipeline
/// that reads and writes through them: together no more than the caller allows.
struct Shares {
    Parallel codecs, stages;
};
Shares shares_of(Parallel parallel);

}  // namespace bandlimit::job
