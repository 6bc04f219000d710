// How every program in this folder is timed: beside the floor, beside a probe of the machine's speed, never from a
// cache.
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace bandlimit::bench {

/// Seconds that `work` takes.
template <class Work>
double seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values);

/// Nanoseconds of one multiply-add of a whole vector in a loop that nothing but the clock of the core limits, on each
/// of `threads` threads at once, the slowest: what shows that the machine runs slower than it did. Takes about 0.3 ms.
double probe_nanoseconds(int threads);

/// Seconds for summing all bytes of `from` and filling `to` with ordinary stores, a piece of one after a piece of the
/// other: what any program needs that reads the one and writes the other.
double floor_seconds(std::span<const std::byte> from, std::span<std::byte> to, int threads);

/// Seconds for copying `from` to `to`, which is as long, with memcpy.
double memcpy_seconds(std::span<const std::byte> from, std::span<std::byte> to, int threads);

/// The buffers of one case, several of each so that a source has left the caches when its turn comes again.
/// Targets are touched: their memory is there.
struct Buffers {
    std::vector<std::span<const std::byte>> sources;
    std::vector<std::span<std::byte>> targets;
    int count() const { return static_cast<int>(sources.size()); }
};

/// What was measured around one run.
struct Sample {
    double seconds = 0, floor = 0;
    double probe = 0;   ///< nanoseconds; the slower of before and after
    double waited = 0;  ///< part of the time in which some thread of the machine waited for a core
};

/// When a sample counts, and when to stop.
struct Limits {
    int samples = 9;       ///< wanted from a quiet machine
    int attempts = 27;     ///< after which busy samples are taken as they are
    double slow = 1.15;    ///< a sample is busy when its probe takes longer than the best one by this factor,
    double waited = 0.05;  ///< or when there were more threads than cores for more than this part of the time
    double seconds = 25;   ///< after which three samples must do
};

/// The median of the samples taken while the machine was quiet, or of all where fewer than half of `wanted` were.
struct Timing {
    double seconds = 0;
    double floor = 0;  ///< seconds
    double ratio = 0;  ///< median of seconds / floor, sample by sample
    int samples = 0;   ///< that count
    bool busy = false;
};

/// Measures one thing after the other, and remembers the best probe of all.
class Clock {
public:
    explicit Clock(Limits limits) : limits_(limits) {}

    /// run(k) uses buffer k of each kind and returns its seconds.
    std::vector<Sample> measure(const std::function<double(int k)>& run, const Buffers& buffers, int threads);

    /// To be called after all is measured, because what is quiet is known only then.
    Timing summary(const std::vector<Sample>& samples, int threads) const;

    /// Nanoseconds.
    double best_probe(int threads) const { return best_probe_[threads > 1]; }

private:
    bool quiet(const Sample& sample, int threads) const;
    double probe(int threads);

    Limits limits_;
    double best_probe_[2] = {1e9, 1e9};  ///< of one thread, of several
};

}  // namespace bandlimit::bench
