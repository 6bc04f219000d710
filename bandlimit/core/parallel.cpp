#include "bandlimit/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "bandlimit/core/error.h"

#ifndef BANDLIMIT_PARALLEL_STD
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace bandlimit {

int Parallel::count() const {
    if (threads < 0) fail("Parallel: threads = ", threads, "; pass 0 for all cores or the number wanted");
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void Parallel::check_stop() const {
    if (stop.stop_requested()) throw Stopped();
}

namespace {

using Body = std::function<void(std::ptrdiff_t, std::ptrdiff_t)>;

#ifdef BANDLIMIT_PARALLEL_STD
/// Plain threads: for the thread sanitizer, which does not understand the synchronisation inside a oneTBB that was
/// built without it.
const TaskRunner* own_runner() {
    static const TaskRunner plain_threads = [](int count, const std::function<void(int)>& task) {
        std::vector<std::jthread> workers;
        for (int i = 1; i < count; ++i) workers.emplace_back([&task, i] { task(i); });
        task(0);
    };
    return &plain_threads;
}
#else
const TaskRunner* own_runner() { return nullptr; }

void run_by_tbb(std::ptrdiff_t count, std::ptrdiff_t grain, int threads, const Body& body) {
    namespace tbb = oneapi::tbb;
    // More than there are cores would not be faster, and makes oneTBB print a warning.
    tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::ptrdiff_t>(0, (count + grain - 1) / grain), [&](const auto& range) {
            body(range.begin() * grain, std::min(range.end() * grain, count));
        });
    });
}
#endif

/// A task per thread, which take ranges from a shared counter. No exception reaches the runner.
void run_by_tasks(const TaskRunner& runner, std::ptrdiff_t count, std::ptrdiff_t grain, int threads, const Body& body) {
    std::atomic<std::ptrdiff_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const std::ptrdiff_t ranges = (count - 1) / grain + 1;
    runner(static_cast<int>(std::min<std::ptrdiff_t>(threads, ranges)), [&](int) {
        try {
            for (std::ptrdiff_t begin; (begin = next.fetch_add(grain)) < count;)
                body(begin, std::min(begin + grain, count));
        } catch (...) {
            next = count;  // the others need not go on
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
        }
    });
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

void parallel_for(std::ptrdiff_t count, std::ptrdiff_t grain, const Parallel& parallel, const Body& body) {
    if (grain < 1) fail("parallel_for: grain = ", grain, "; pass 1 or more");
    if (count <= 0) return;
    parallel.check_stop();
    const int threads = parallel.count();
    if (count <= grain || (threads == 1 && !parallel.stop.stop_possible())) return body(0, count);
    const Body checked = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        parallel.check_stop();
        body(begin, end);
    };
    if (threads == 1) {
        for (std::ptrdiff_t begin = 0; begin < count; begin += grain) checked(begin, std::min(begin + grain, count));
        return;
    }
    const TaskRunner* runner = parallel.runner != nullptr ? parallel.runner : own_runner();
    if (runner != nullptr) return run_by_tasks(*runner, count, grain, threads, checked);
#ifndef BANDLIMIT_PARALLEL_STD
    run_by_tbb(count, grain, threads, checked);
#endif
}

}  // namespace bandlimit
