#include "bandlimit/core/pipeline.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// Who may begin what, and with how many threads.
class Schedule {
public:
    Schedule(std::size_t stages, int threads) : done_(stages), free_(threads) {}

    /// Waits until stage s may begin `item`; the threads it may use, or 0 after a failure.
    int begin(std::size_t s, int item, bool scales) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return failure_ || (free_ > 0 && is_ready(s, item)); });
        if (failure_) return 0;
        const int taken = scales ? free_ : 1;
        free_ -= taken;
        return taken;
    }
    void end(std::size_t s, int taken) {
        const std::lock_guard lock(mutex_);
        ++done_[s];
        free_ += taken;
        changed_.notify_all();
    }
    /// Ends all stages; the first failure counts.
    void fail(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(failure);
        changed_.notify_all();
    }
    /// Once no stage runs any more.
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    bool is_ready(std::size_t s, int item) const {
        return (s == 0 || done_[s - 1] > item) && (s + 1 == done_.size() || done_[s + 1] > item - 2);
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<int> done_;  ///< items, per stage
    int free_;               ///< threads
    std::exception_ptr failure_;
};

void run_stage(Schedule& schedule, std::size_t s, const Stage& stage, int count, const Parallel& parallel) {
    try {
        for (int item = 0; item < count; ++item) {
            const int threads = schedule.begin(s, item, stage.scales);
            if (threads == 0) return;
            parallel.check_stop();
            stage.run(item, parallel.with_threads(threads));
            schedule.end(s, threads);
        }
    } catch (...) {
        schedule.fail(std::current_exception());
    }
}

}  // namespace

void run_pipeline(int count, const std::vector<Stage>& stages, const Parallel& parallel) {
    if (count < 0 || stages.empty())
        fail("run_pipeline: ", count, " items through ", stages.size(), " stages; pass at least 0 and 1");
    const int threads = parallel.count();
    if (threads == 1 || count == 1 || stages.size() == 1 || parallel.runner != nullptr) {
        for (int item = 0; item < count; ++item)
            for (const Stage& stage : stages) {
                parallel.check_stop();
                stage.run(item, parallel.with_threads(stage.scales ? threads : 1));
            }
        return;
    }
    Schedule schedule(stages.size(), threads);
    {
        std::vector<std::jthread> workers;
        try {
            for (std::size_t s = 1; s < stages.size(); ++s)
                workers.emplace_back([&, s] { run_stage(schedule, s, stages[s], count, parallel); });
            run_stage(schedule, 0, stages[0], count, parallel);
        } catch (...) {  // no more threads are to be had
            schedule.fail(std::current_exception());
        }
    }
    schedule.rethrow();
}

}  // namespace bandlimit
