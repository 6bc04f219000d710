#include "bandlimit/design/downsample.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/design/symmetric_grid.h"

namespace bandlimit {
namespace {

constexpr int most_taps = 256, most_side = 32;

/// Where points lie on an axis with an even or odd number of them.
double origin_of(int count) { return count % 2 == 0 ? 0.5 : 0; }

void check_count(const char* function, int count, int most, const RateGoal& goal) {
    if (count < 1 || count > most) fail(function, ": count = ", count, "; pass 1 to ", most);
    if (!goal.upsample && count % 2 != goal.factor % 2)
        fail(function, ": ", count, " taps are not symmetric about the output of a factor of ", goal.factor, "; pass ",
             count + 1);
}

[[noreturn]] void fail_gain(const char* function, const RateGoal& goal) {
    fail(function, ": nothing keeps below a gain of ", *goal.max_gain, " there; allow more, or more taps or fetches");
}

/// The best weights on the points that are kept; the others are 0.
std::vector<double> best_weights(const SymmetricGrid& grid, const std::vector<bool>& kept, const RateGoal& goal) {
    std::vector<Unknown> unknowns;
    for (std::size_t u = 0; u < grid.size(); ++u) {
        if (!kept[u]) continue;
        Unknown unknown{std::vector<double>(grid.size())};
        unknown.column[u] = 1;
        if (goal.non_negative) unknown.least = 0;
        unknowns.push_back(std::move(unknown));
    }
    GainLimit limit{goal.max_gain.value_or(0), true};
    return fit(grid, unknowns, goal.max_gain ? &limit : nullptr).weights;
}

/// The weights of all points of a square, row after row.
PlacedWeights2D spread_out(const SymmetricGrid& grid, int count, const std::vector<double>& weights) {
    const double first = (1 - count) / 2.0;
    PlacedWeights2D result(first, first, count, {});
    const auto distance = [&](int i) { return static_cast<int>(std::abs(first + i)); };  // rounds 1/2 down
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) result.weights.push_back(weights[grid.index(distance(x), distance(y))]);
    return result;
}

}  // namespace

double output_texel(const RateGoal& goal) { return goal.upsample ? 0.25 : (goal.factor - 1) / 2.0; }

void check_taps(const char* function, int count, const RateGoal& goal) {
    check_goal(function, goal);
    check_count(function, count, most_taps, goal);
}

Taps downsample_taps(int count, const RateGoal& goal) {
    check_taps("downsample_taps", count, goal);
    const int points = goal.upsample ? 2 * count : count;
    const SymmetricGrid grid(1, origin_of(points), (points + 1) / 2, goal);
    const std::vector<double> half = best_weights(grid, std::vector<bool>(grid.size(), true), goal);
    if (half.empty()) fail_gain("downsample_taps", goal);
    const double first = (1 - points) / 2.0;
    Taps taps{static_cast<int>(std::floor(first + output_texel(goal))), {}, goal.upsample ? 1 : goal.factor};
    if (!goal.upsample) {
        for (int j = 0; j < points; ++j) taps.weights.push_back(half[static_cast<std::size_t>(std::abs(first + j))]);
        return taps;
    }
    // Texel k is 2 k - 1/2 from the output on the finer grid; all within `count` are read.
    taps.first = -((count - 1) / 2);
    for (int k = taps.first; std::abs(2 * k - 0.5) < count; ++k)
        taps.weights.push_back(2 * half[static_cast<std::size_t>(std::abs(2 * k - 0.5))]);
    return taps;
}

SparseWeights downsample_weights(int count, double threshold, const RateGoal& goal) {
    check_goal("downsample_weights", goal);
    check_count("downsample_weights", count, most_side, goal);
    if (goal.upsample) fail("downsample_weights: the goal enlarges; pass one that shrinks");
    if (!(threshold >= 0)) fail("downsample_weights: threshold = ", threshold, "; pass 0 or more, e.g. 0.02");
    const SymmetricGrid grid(2, origin_of(count), (count + 1) / 2, goal);
    std::vector<bool> kept(grid.size(), true);
    const std::vector<double> all = best_weights(grid, kept, goal);
    if (all.empty()) fail_gain("downsample_weights", goal);
    std::vector<double> dropped = all;
    double sum = 0;
    for (std::size_t u = 0; u < grid.size(); ++u) {
        kept[u] = std::abs(all[u]) >= threshold;
        if (!kept[u]) dropped[u] = 0;
        sum += grid.images(u) * dropped[u];
    }
    if (!(sum > 0)) fail("downsample_weights: threshold = ", threshold, " leaves no weights; pass less, e.g. 0.02");
    for (double& w : dropped) w /= sum;
    const std::vector<double> optimized = best_weights(grid, kept, goal);
    if (optimized.empty()) fail_gain("downsample_weights", goal);
    return {spread_out(grid, count, all), spread_out(grid, count, dropped), spread_out(grid, count, optimized)};
}

PlacedWeights whole_filter(const Taps& taps, const RateGoal& goal) {
    if (taps.weights.empty()) fail("whole_filter: no taps; pass at least one");
    if (!goal.upsample) return taps;
    // Half of each weight, at twice its distance, for the output right of the texel and for its mirror image.
    const PlacedWeights one(taps, output_texel(goal));
    const double last = one.first + static_cast<double>(one.weights.size() - 1);
    const double reach = 2 * std::max(std::abs(one.first), std::abs(last));
    PlacedWeights both(-reach, std::vector<double>(static_cast<std::size_t>(std::lround(2 * reach)) + 1));
    for (std::size_t j = 0; j < one.weights.size(); ++j)
        for (const double at : {2 * (one.first + static_cast<double>(j)), -2 * (one.first + static_cast<double>(j))})
            both.weights[static_cast<std::size_t>(std::lround(at + reach))] += one.weights[j] / 2;
    return both;
}

PlacedWeights2D whole_filter(const Fetches& fetches, const RateGoal& goal) {
    const PlacedWeights2D one = weights_of(fetches, output_texel(goal));
    if (!goal.upsample) return one;
    const auto width = static_cast<std::size_t>(one.width), height = one.weights.size() / width;
    const double reach = 2 * std::max({std::abs(one.first_x), std::abs(one.first_x + static_cast<double>(width - 1)),
                                       std::abs(one.first_y), std::abs(one.first_y + static_cast<double>(height - 1))});
    const auto side = static_cast<std::size_t>(std::lround(2 * reach)) + 1;
    PlacedWeights2D all(-reach, -reach, static_cast<int>(side), std::vector<double>(side * side));
    for (std::size_t i = 0; i < one.weights.size(); ++i) {
        const double x = 2 * (one.first_x + static_cast<double>(i % width));
        const double y = 2 * (one.first_y + static_cast<double>(i / width));
        for (const double at_y : {y, -y})
            for (const double at_x : {x, -x})
                all.weights[static_cast<std::size_t>(std::lround(at_y + reach)) * side +
                            static_cast<std::size_t>(std::lround(at_x + reach))] += one.weights[i] / 4;
    }
    return all;
}

}  // namespace bandlimit
