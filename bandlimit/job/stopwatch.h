// How long pieces of a job took.
// Stability: inner.
#pragma once
#include <chrono>

namespace bandlimit::job {

/// Seconds that pieces of work took, added up.
class Stopwatch {
public:
    /// Since this watch was made.
    double total() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    template <class Work>
    decltype(auto) time(double& seconds, Work work) {
        struct Add {
            double& seconds;
            std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
            ~Add() { seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
        } add{seconds};
        return work();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace bandlimit::job
