// Work on several cores.
// Stability: stable.
#pragma once
#include <cstddef>
#include <exception>
#include <functional>
#include <stop_token>

namespace bandlimit {

/// Runs task(0) to task(count - 1), each once, in any order and as much in parallel as it can, and returns when all are
/// done. Tasks do not throw, do not wait for each other, and may themselves call the runner.
using TaskRunner = std::function<void(int count, const std::function<void(int index)>& task)>;

/// How a function may use the machine. Results have the same bits for every value.
///
/// example  Parallel{.threads = 4}, or inside an engine with threads of its own:
///          const TaskRunner jobs = [&](int n, const auto& task) { pool.for_each(n, task); };
///          resizer.run(source, target, {.threads = pool.size(), .runner = &jobs, .stop = user.get_token()});
struct Parallel {
    int threads = 0;                     ///< most to keep busy; 0 = one per core
    const TaskRunner* runner = nullptr;  ///< the caller's threads; null: oneTBB's
    std::stop_token stop = {};           ///< asks the work to end early, with Stopped

    /// `threads`, or the number of cores for 0. Throws Error below 0.
    int count() const;
    /// The same with another number of threads.
    Parallel with_threads(int other) const { return {other, runner, stop}; }
    /// Throws Stopped if a stop was requested.
    void check_stop() const;
};

/// Thrown by work that ended early because its caller asked it to. Its output is incomplete.
class Stopped : public std::exception {
public:
    const char* what() const noexcept override { return "stopped as asked"; }
};

/// Calls body(begin, end) for ranges that together cover [0, count) once, on up to parallel.count() threads.
///
/// Ranges hold at least `grain` >= 1 items (except the last); their order and number are not defined, so the body must
/// write only what belongs to its items. An exception from the body is rethrown here, after all threads are done.
/// cost    a few microseconds; runs in the caller's thread alone for one thread or one range
/// throws  Stopped, between ranges, if parallel.stop asks for it
void parallel_for(std::ptrdiff_t count, std::ptrdiff_t grain, const Parallel& parallel,
                  const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& body);

}  // namespace bandlimit
