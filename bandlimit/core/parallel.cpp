#include "bandlimit/core/parallel.h"

#include <algorithm>
#include <thread>

#include "bandlimit/core/error.h"

#ifdef BANDLIMIT_PARALLEL_STD
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
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

namespace {

using Body = std::function<void(std::ptrdiff_t, std::ptrdiff_t)>;

#ifdef BANDLIMIT_PARALLEL_STD
/// Plain threads that take ranges from a shared counter: for the thread sanitizer, which does not understand the
/// synchronisation inside a oneTBB that was built without it.
void run(std::ptrdiff_t count, std::ptrdiff_t grain, int threads, const Body& body) {
    std::atomic<std::ptrdiff_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        try {
            for (std::ptrdiff_t begin; (begin = next.fetch_add(grain)) < count;)
                body(begin, std::min(begin + grain, count));
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
        }
    };
    std::vector<std::jthread> workers;
    for (int i = 1; i < threads; ++i) workers.emplace_back(work);
    work();
    workers.clear();
    if (failure) std::rethrow_exception(failure);
}
#else
void run(std::ptrdiff_t count, std::ptrdiff_t grain, int threads, const Body& body) {
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

}  // namespace

void parallel_for(std::ptrdiff_t count, std::ptrdiff_t grain, Parallel parallel, const Body& body) {
    if (grain < 1) fail("parallel_for: grain = ", grain, "; pass 1 or more");
    if (count <= 0) return;
    const int threads = parallel.count();
    if (threads == 1 || count <= grain) return body(0, count);
    run(count, grain, threads, body);
}

}  // namespace bandlimit
