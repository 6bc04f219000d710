// Work on several cores.
#pragma once
#include <cstddef>
#include <functional>

namespace bandlimit {

/// How many threads a function may keep busy. Results have the same bits for every value.
struct Parallel {
    int threads = 0;  ///< 0 = one per core

    /// The number meant: `threads`, or the number of cores for 0. Throws Error below 0.
    int count() const;
};

/// Calls body(begin, end) for ranges that together cover [0, count) once, on up to parallel.count() threads.
///
/// Ranges hold at least `grain` >= 1 items (but the last one); their order and number are not defined, so the body must
/// write only what belongs to its items. An exception of the body is thrown again here, after all threads are done.
/// cost  a few microseconds; runs in the caller's thread alone for one thread or one range
void parallel_for(std::ptrdiff_t count, std::ptrdiff_t grain, Parallel parallel,
                  const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& body);

}  // namespace bandlimit
