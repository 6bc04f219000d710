#include "bandlimit/core/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int items = 60;

/// Adds up what three stages made of the items, through two buffers between neighbours.
long long sum_through_buffers(Parallel parallel) {
    std::array<int, 2> first{}, second{};
    long long sum = 0;
    const auto at = [](int i) { return static_cast<std::size_t>(i % 2); };
    run_pipeline(items,
                 {{[&](int i, Parallel) { first[at(i)] = i == 0 ? 1 : first[at(i + 1)] + 2; }},  // looks into the last
                  {[&](int i, Parallel) { second[at(i)] = first[at(i)] * 3; }, true},
                  {[&](int i, Parallel) { sum += second[at(i)]; }}},
                 parallel);
    return sum;
}

TEST(Pipeline, TakesEveryItemThroughEveryStageInOrder) {
    // The sum of the first n odd numbers is n squared.
    for (const int threads : {1, 2, 3, 8}) EXPECT_EQ(sum_through_buffers({threads}), 3LL * items * items) << threads;
}

TEST(Pipeline, StagesOverlap) {
    // While the second stage is at the first item, the first one begins the next: each waits for the other.
    std::atomic<bool> second_began{false}, first_went_on{false};
    const auto wait_for = [](std::atomic<bool>& flag) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!flag && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        return flag.load();
    };
    bool was_first_beside = false, was_second_beside = false;
    const auto first = [&](int i, Parallel) {
        if (i == 0) return;
        first_went_on = true;
        was_first_beside = wait_for(second_began);
    };
    const auto second = [&](int i, Parallel) {
        if (i == 1) return;
        second_began = true;
        was_second_beside = wait_for(first_went_on);
    };
    run_pipeline(2, {{first}, {second}}, {2});
    EXPECT_TRUE(was_first_beside && was_second_beside);
}

TEST(Pipeline, KeepsNoMoreThreadsBusyThanItMay) {
    for (const int threads : {1, 2, 3, 5}) {
        std::atomic<int> busy{0};
        std::atomic<int> most{0};
        const auto work = [&](int, Parallel parallel) {
            EXPECT_GE(parallel.threads, 1);
            const int now = busy += parallel.threads;
            for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
            }
            std::this_thread::yield();
            busy -= parallel.threads;
        };
        run_pipeline(items, {{work}, {work, true}, {work}}, {threads});
        EXPECT_LE(most, threads);
        EXPECT_EQ(busy, 0);
    }
}

TEST(Pipeline, OneThreadIsTheCallers) {
    const auto caller = std::this_thread::get_id();
    const auto check = [&](int, Parallel parallel) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(parallel.threads, 1);
    };
    run_pipeline(3, {{check}, {check, true}}, {1});
}

TEST(Pipeline, WhatAStageThrowsReachesTheCaller) {
    for (const int threads : {1, 2, 4})
        for (int failing = 0; failing < 3; ++failing)
            for (const int at : {0, 7, items - 1}) {
                std::array<int, 3> done{};
                const auto stage = [&](int s) {
                    return [&, s](int i, Parallel) {
                        if (s == failing && i == at) throw std::runtime_error("stage " + std::to_string(s));
                        ++done[static_cast<std::size_t>(s)];
                    };
                };
                try {
                    run_pipeline(items, {{stage(0)}, {stage(1), true}, {stage(2)}}, {threads});
                    ADD_FAILURE() << "no error";
                } catch (const std::runtime_error& e) {
                    EXPECT_EQ(e.what(), "stage " + std::to_string(failing));
                }
                // Nothing passes the stage that failed, and those before it are two items ahead at most, each.
                for (int s = 0; s < 3; ++s)
                    EXPECT_LE(done[static_cast<std::size_t>(s)], at + 2 * std::max(0, failing - s)) << s << failing;
            }
}

TEST(Pipeline, RefusesWhatMakesNoSense) {
    EXPECT_THROW(run_pipeline(1, {}, {1}), Error);
    EXPECT_THROW(run_pipeline(-1, {{[](int, Parallel) {}}}, {1}), Error);
    EXPECT_THROW(run_pipeline(1, {{[](int, Parallel) {}}}, {-1}), Error);
    EXPECT_NO_THROW(run_pipeline(0, {{[](int, Parallel) { FAIL(); }}}, {2}));
}

TEST(Pipeline, StopsBetweenItemsWhenAsked) {
    for (const int threads : {1, 2, 4}) {
        std::stop_source user;
        std::atomic<int> done{0};
        const Stage read{[](int, Parallel) {}}, work{[&](int item, Parallel p) {
            EXPECT_TRUE(p.stop.stop_possible()) << "stages are told when to stop, too";
            if (item == 3) user.request_stop();
            ++done;
        }};
        EXPECT_THROW(run_pipeline(100, {read, work}, {.threads = threads, .stop = user.get_token()}), Stopped);
        EXPECT_EQ(done, 4);
    }
}

TEST(Pipeline, OverlapsNothingOnTheThreadsOfACaller) {
    const TaskRunner runner = [](int count, const std::function<void(int)>& task) {
        for (int i = 0; i < count; ++i) task(i);
    };
    const auto caller = std::this_thread::get_id();
    const Stage stage{[&](int, Parallel p) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(p.runner, &runner);
    }};
    run_pipeline(5, {stage, stage, stage}, {.threads = 4, .runner = &runner});
}

}  // namespace
}  // namespace bandlimit
