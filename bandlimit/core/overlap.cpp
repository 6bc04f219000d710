#include "bandlimit/core/overlap.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// Up to `most` steps of `length` > 0 bytes.
struct Steps {
    std::int64_t length, most;
};

std::int64_t reach_of(std::span<const Steps> steps) {
    return std::accumulate(steps.begin(), steps.end(), std::int64_t{0},
                           [](std::int64_t sum, const Steps& s) { return sum + s.length * s.most; });
}

/// Whether some of the steps lead from 0 into [low, high]; true where `tries` run out.
bool leads_into(std::span<const Steps> steps, std::int64_t low, std::int64_t high, int& tries) {
    if (high < 0 || low > reach_of(steps)) return false;
    if (steps.empty() || low <= 0) return true;
    const std::span<const Steps> shorter = steps.subspan(1);
    const auto [length, most] = steps.front();
    const std::int64_t least = low - reach_of(shorter);  // what the long steps must cover
    const std::int64_t first = least > 0 ? (least + length - 1) / length : 0, last = std::min(most, high / length);
    for (std::int64_t k = first; k <= last; ++k)
        if (--tries < 0 || leads_into(shorter, low - k * length, high - k * length, tries)) return true;
    return false;
}

/// The address of the first byte. Adds the steps that lead to all samples from there.
std::int64_t begin_of(const Footprint& f, std::map<std::int64_t, std::int64_t>& steps) {
    auto begin = static_cast<std::int64_t>(f.address);
    for (std::size_t i = 0; i < 3; ++i) {
        if (f.steps[i] == 0) continue;
        if (f.steps[i] < 0) begin += f.steps[i] * (f.counts[i] - 1);
        steps[std::abs(f.steps[i])] += f.counts[i] - 1;
    }
    return begin;
}

bool is_empty(const Footprint& f) { return *std::min_element(f.counts.begin(), f.counts.end()) < 1; }

}  // namespace

bool overlap(const Footprint& a, const Footprint& b) {
    if (is_empty(a) || is_empty(b)) return false;
    // Steps forward from the first sample of a, and from the last of b back, must make up for where they lie. Equal
    // steps of both are one kind: that makes pictures of one layout easy.
    std::map<std::int64_t, std::int64_t> of_both, of_b;
    const std::int64_t begin_b = begin_of(b, of_b), begin_a = begin_of(a, of_both);
    std::int64_t end_b = begin_b;
    for (const auto& [length, most] : of_b) {
        of_both[length] += most;
        end_b += length * most;
    }
    std::vector<Steps> steps;
    for (auto s = of_both.rbegin(); s != of_both.rend(); ++s) steps.push_back({s->first, s->second});
    int tries = 100'000;
    return leads_into(steps, end_b - begin_a - (a.sample - 1), end_b - begin_a + (b.sample - 1), tries);
}

void check_apart(const char* function, const Footprint& source, const Footprint& target) {
    if (overlap(source, target))
        fail(function, ": source and target share memory; pass a target of its own, and copy it over the source after");
}

}  // namespace bandlimit
