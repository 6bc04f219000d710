#include "bandlimit/core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

using Range = std::pair<std::ptrdiff_t, std::ptrdiff_t>;

std::vector<Range> ranges_of(std::ptrdiff_t count, std::ptrdiff_t grain, int threads) {
    std::vector<Range> ranges;
    std::mutex mutex;
    parallel_for(count, grain, {threads}, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        const std::lock_guard lock(mutex);
        ranges.emplace_back(begin, end);
    });
    std::sort(ranges.begin(), ranges.end());
    return ranges;
}

TEST(Parallel, RangesCoverEachItemOnceAndHoldTheGrain) {
    for (const int threads : {0, 1, 2, 3, 7})
        for (const std::ptrdiff_t grain : {1, 2, 5, 32, 1000})
            for (std::ptrdiff_t count = 0; count <= 40; ++count) {
                std::ptrdiff_t at = 0;
                for (const auto& [begin, end] : ranges_of(count, grain, threads)) {
                    ASSERT_EQ(begin, at) << "a gap or an overlap";
                    ASSERT_TRUE(end - begin >= grain || end == count);
                    ASSERT_LT(begin, end);
                    at = end;
                }
                ASSERT_EQ(at, count);
            }
}

TEST(Parallel, KeepsNoMoreThreadsBusyThanAsked) {
    for (const int threads : {1, 2, 3}) {
        std::atomic<int> busy{0}, most{0};
        parallel_for(64, 1, {threads}, [&](std::ptrdiff_t, std::ptrdiff_t) {
            const int now = ++busy;
            for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
            }
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            --busy;
        });
        EXPECT_LE(most, threads);
    }
}

TEST(Parallel, OneThreadOrOneRangeStaysInTheCaller) {
    const auto caller = std::this_thread::get_id();
    const auto here = [&](std::ptrdiff_t, std::ptrdiff_t) { EXPECT_EQ(std::this_thread::get_id(), caller); };
    parallel_for(100, 1, {1}, here);
    parallel_for(100, 100, {4}, here);
}

TEST(Parallel, ThrowsWhatTheBodyThrew) {
    for (const int threads : {1, 2, 7}) {
        std::atomic<int> running{0};
        EXPECT_THROW(parallel_for(100, 1, {threads},
                                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                                      ++running;
                                      const bool unlucky = begin <= 50 && 50 < end;
                                      --running;
                                      if (unlucky) throw std::domain_error("fifty");
                                  }),
                     std::domain_error);
        EXPECT_EQ(running, 0);
    }
}

/// Runs tasks one after another, from the last to the first, and counts them.
struct BackwardRunner {
    int tasks = 0;
    TaskRunner runner = [this](int count, const std::function<void(int)>& task) {
        tasks += count;
        for (int i = count - 1; i >= 0; --i) task(i);
    };
};

TEST(Parallel, RunsOnTheThreadsOfACallersRunnerAlone) {
    const auto caller = std::this_thread::get_id();
    BackwardRunner backward;
    std::vector<int> visits(100);
    parallel_for(100, 3, {4, &backward.runner}, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        for (std::ptrdiff_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
    });
    EXPECT_EQ(backward.tasks, 4);
    EXPECT_EQ(visits, std::vector<int>(100, 1));
    const auto unlucky = [](std::ptrdiff_t, std::ptrdiff_t) {
        throw std::domain_error("no exception reaches a runner");
    };
    EXPECT_THROW(parallel_for(100, 1, {4, &backward.runner}, unlucky), std::domain_error);
}

TEST(Parallel, StopsBetweenRangesWhenAsked) {
    BackwardRunner backward;
    for (const int threads : {1, 2, 7})
        for (const TaskRunner* runner : {static_cast<const TaskRunner*>(nullptr), &std::as_const(backward.runner)}) {
            std::stop_source user;
            std::atomic<int> done{0};
            EXPECT_THROW(parallel_for(1000, 1, {threads, runner, user.get_token()},
                                      [&](std::ptrdiff_t, std::ptrdiff_t) {
                                          const int now = ++done;
                                          if (now == 10) user.request_stop();
                                          // The thread that asks may be slow to do so: nobody runs on until then.
                                          while (now > 10 && !user.stop_requested()) std::this_thread::yield();
                                      }),
                         Stopped);
            EXPECT_LT(done, 10 + 2 * threads);
            EXPECT_THROW(parallel_for(1, 1, {threads, runner, user.get_token()}, [](auto, auto) {}), Stopped);
        }
}

TEST(Parallel, RefusesNonsense) {
    const auto nothing = [](std::ptrdiff_t, std::ptrdiff_t) {};
    EXPECT_THROW(parallel_for(10, 0, {}, nothing), Error);
    EXPECT_THROW(parallel_for(10, 1, {-1}, nothing), Error);
    EXPECT_EQ(Parallel{5}.count(), 5);
    EXPECT_GE(Parallel{}.count(), 1);
}

}  // namespace
}  // namespace bandlimit
