#include "bench/timing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "bandlimit/core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/timing.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bandlimit::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Twelve chains hide the latency of the multiply-add on every processor that has two units for it. They start apart:
/// of chains that are equal the compiler would compute one.
float MultiplyAdds(int rounds, float start) {
    const hn::ScalableTag<float> d;
    const auto factor = hn::Set(d, 0.5f), term = hn::Set(d, start);
    const auto apart = [&](int i) { return hn::Set(d, start + static_cast<float>(i)); };
    auto a = apart(1), b = apart(2), c = apart(3), e = apart(4), f = apart(5), g = apart(6);
    auto h = apart(7), i = apart(8), j = apart(9), k = apart(10), l = apart(11), m = apart(12);
    for (int round = 0; round < rounds; ++round) {
        a = hn::MulAdd(a, factor, term), b = hn::MulAdd(b, factor, term), c = hn::MulAdd(c, factor, term);
        e = hn::MulAdd(e, factor, term), f = hn::MulAdd(f, factor, term), g = hn::MulAdd(g, factor, term);
        h = hn::MulAdd(h, factor, term), i = hn::MulAdd(i, factor, term), j = hn::MulAdd(j, factor, term);
        k = hn::MulAdd(k, factor, term), l = hn::MulAdd(l, factor, term), m = hn::MulAdd(m, factor, term);
    }
    const auto sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, i)));
    return hn::GetLane(hn::Add(sum, hn::Add(hn::Add(j, k), hn::Add(l, m))));
}

std::uint64_t ReadAndWrite(const std::byte* from, std::size_t read, std::byte* to, std::size_t written) {
    const hn::ScalableTag<std::uint64_t> d;
    const std::size_t lanes = hn::Lanes(d), step = lanes * sizeof(std::uint64_t);
    auto a = hn::Zero(d), b = a, c = a, e = a;
    std::size_t i = 0;
    for (; i + 4 * step <= read; i += 4 * step) {
        const auto* words = reinterpret_cast<const std::uint64_t*>(from + i);
        a = hn::Add(a, hn::LoadU(d, words));
        b = hn::Add(b, hn::LoadU(d, words + lanes));
        c = hn::Add(c, hn::LoadU(d, words + 2 * lanes));
        e = hn::Add(e, hn::LoadU(d, words + 3 * lanes));
    }
    auto sum = hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
    for (; i < read; ++i) sum += std::to_integer<std::uint64_t>(from[i]);
    const auto fill = hn::Set(d, sum);
    for (i = 0; i + step <= written; i += step) hn::StoreU(fill, d, reinterpret_cast<std::uint64_t*>(to + i));
    for (; i < written; ++i) to[i] = static_cast<std::byte>(sum);
    return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit::bench {

HWY_EXPORT(MultiplyAdds);
HWY_EXPORT(ReadAndWrite);

namespace {

constexpr int chains = 12;

/// What is stored here the compiler must compute.
volatile double sink;

/// The part of `all` that piece i of n is; all but the last are whole lines of the cache.
template <class T>
std::span<T> piece(std::span<T> all, std::ptrdiff_t i, std::ptrdiff_t n) {
    const auto at = [&](std::ptrdiff_t k) {
        return k == n ? all.size() : all.size() * static_cast<std::size_t>(k) / static_cast<std::size_t>(n) / 64 * 64;
    };
    return all.subspan(at(i), at(i + 1) - at(i));
}

/// Calls body(i) for the pieces of a picture, a contiguous run of them per thread.
void for_pieces(int threads, const std::function<void(std::ptrdiff_t i, std::ptrdiff_t n)>& body) {
    constexpr std::ptrdiff_t pieces = 256;
    parallel_for(pieces, pieces / threads, {threads}, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) body(i, pieces);
    });
}

/// Seconds since the system started in which some thread waited for a core; 0 where Linux does not tell.
double waiting_seconds() {
    std::ifstream file("/proc/pressure/cpu");
    std::string word;
    while (file >> word)
        if (word.starts_with("total=")) return 1e-6 * std::strtod(word.c_str() + 6, nullptr);
    return 0;
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return NAN;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

double probe_nanoseconds(int threads) {
    constexpr int rounds = 8000;
    std::vector<double> best(static_cast<std::size_t>(threads), 1e9);
    parallel_for(threads, 1, {threads}, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i)
            for (int repeat = 0; repeat < 5; ++repeat) {
                double& seconds = best[static_cast<std::size_t>(i)];
                const auto work = [&] { sink = HWY_DYNAMIC_DISPATCH(MultiplyAdds)(rounds, 1.0f); };
                seconds = std::min(seconds, seconds_of(work));
            }
    });
    return 1e9 * *std::max_element(best.begin(), best.end()) / (rounds * chains);
}

double floor_seconds(std::span<const std::byte> from, std::span<std::byte> to, int threads) {
    return seconds_of([&] {
        for_pieces(threads, [&](std::ptrdiff_t i, std::ptrdiff_t n) {
            const auto source = piece(from, i, n);
            const auto target = piece(to, i, n);
            sink = static_cast<double>(
                HWY_DYNAMIC_DISPATCH(ReadAndWrite)(source.data(), source.size(), target.data(), target.size()));
        });
    });
}

double memcpy_seconds(std::span<const std::byte> from, std::span<std::byte> to, int threads) {
    return seconds_of([&] {
        for_pieces(threads, [&](std::ptrdiff_t i, std::ptrdiff_t n) {
            const auto source = piece(from, i, n);
            std::memcpy(piece(to, i, n).data(), source.data(), source.size());
        });
    });
}

double Clock::probe(int threads) {
    const double nanoseconds = probe_nanoseconds(threads);
    double& best = best_probe_[threads > 1];
    best = std::min(best, nanoseconds);
    return nanoseconds;
}

bool Clock::quiet(const Sample& sample, int threads) const {
    return sample.probe <= limits_.slow * best_probe(threads) && sample.waited <= limits_.waited;
}

std::vector<Sample> Clock::measure(const std::function<double(int k)>& run, const Buffers& buffers, int threads) {
    run(0);  // for what is made by the first run
    std::vector<Sample> samples;
    double spent = 0;
    for (int attempt = 0; attempt < limits_.attempts; ++attempt) {
        const int k = attempt % buffers.count(), other = (attempt + 1) % buffers.count();
        Sample sample;
        const double waited = waiting_seconds();
        const auto start = std::chrono::steady_clock::now();
        const double before = probe(threads);
        sample.floor = floor_seconds(buffers.sources[static_cast<std::size_t>(other)],
                                     buffers.targets[static_cast<std::size_t>(other)], threads);
        sample.seconds = run(k);
        sample.probe = std::max(before, probe(threads));
        const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
        sample.waited = (waiting_seconds() - waited) / all.count();
        samples.push_back(sample);
        spent += sample.seconds;
        const auto good =
            std::count_if(samples.begin(), samples.end(), [&](const Sample& s) { return quiet(s, threads); });
        if (good >= limits_.samples) break;
        if (spent > limits_.seconds && samples.size() >= 3) break;
    }
    return samples;
}

Timing Clock::summary(const std::vector<Sample>& samples, int threads) const {
    std::vector<Sample> counted;
    for (const Sample& sample : samples)
        if (quiet(sample, threads)) counted.push_back(sample);
    const bool busy = 2 * counted.size() < std::min(samples.size(), static_cast<std::size_t>(limits_.samples));
    if (busy) counted = samples;
    std::vector<double> seconds, floors, ratios;
    for (const Sample& sample : counted) {
        seconds.push_back(sample.seconds);
        floors.push_back(sample.floor);
        ratios.push_back(sample.seconds / sample.floor);
    }
    return {median(seconds), median(floors), median(ratios), static_cast<int>(counted.size()), busy};
}

}  // namespace bandlimit::bench
#endif  // HWY_ONCE
