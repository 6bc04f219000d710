#include "bandlimit/resample/bank_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

double sum_of(std::span<const double> w) { return std::accumulate(w.begin(), w.end(), 0.0); }

/// Floats of `scale` times the weights, each with the rounding of those before it.
std::vector<float> rounded(std::span<const double> weights, double scale = 1) {
    std::vector<float> floats;
    floats.reserve(weights.size());
    double carry = 0;
    for (const double w : weights) {
        floats.push_back(w == 0 ? 0 : static_cast<float>(scale * w + carry));
        carry += scale * w - static_cast<double>(floats.back());
    }
    return floats;
}

/// What a row makes of ones: combine() adds its weights one by one, and rounds each sum.
float sum_as_executed(std::span<const float> row) { return std::accumulate(row.begin(), row.end(), 0.0f); }

/// The differences of the weights' partial sums, rounded to a step so coarse that floats hold all of these numbers, and
/// no addition of them rounds.
std::vector<float> differences_of_sums(std::span<const double> weights) {
    double largest = 0, sum = 0;
    for (const double w : weights) largest = std::max({largest, std::abs(w), std::abs(sum += w)});
    const double step = std::ldexp(1.0, std::ilogb(largest) + 1 - std::numeric_limits<float>::digits);
    std::vector<float> floats;
    double before = sum = 0;
    for (const double w : weights) {
        const double next = w == 0 ? before : std::round((sum += w) / step) * step;
        floats.push_back(static_cast<float>(next - before));
        before = next;
    }
    return floats;
}

/// Floats of weights whose sum is 1 that add up to exactly 1 when executed, so that what is 1 everywhere, as alpha
/// often is, stays 1. To scale all by less than a rounding mostly does; where steps of sums above 1, which are
/// twice as coarse as those below, lead past it every time, the weights become differences.
std::vector<float> rounded_to_unit_sum(std::span<const double> weights) {
    constexpr int tries = 8;
    const double largest = std::abs(*std::max_element(weights.begin(), weights.end(),
                                                      [](double a, double b) { return std::abs(a) < std::abs(b); }));
    const double most = 0x1p-24 / largest;  // changes no weight by more than differences may
    double scale = 1;
    for (int i = 0; i < tries && std::abs(scale - 1) <= most; ++i) {
        std::vector<float> floats = rounded(weights, scale);
        const double lack = 1 - static_cast<double>(sum_as_executed(floats));
        if (lack == 0) return floats;
        scale += lack / 2;
    }
    return differences_of_sums(weights);
}

}  // namespace

void trim_zeros(PhaseRow& row) {
    const auto not_zero = [](double w) { return w != 0; };
    const auto begin = std::find_if(row.weights.begin(), row.weights.end(), not_zero);
    const auto end = std::find_if(row.weights.rbegin(), row.weights.rend(), not_zero).base();
    if (begin >= end) return;  // all zero: the caller refuses it
    row.first += static_cast<int>(begin - row.weights.begin());
    row.weights = {begin, end};
}

std::vector<float> rounded_weights(std::span<const double> weights) {
    return std::abs(sum_of(weights) - 1) < 1e-9 ? rounded_to_unit_sum(weights) : rounded(weights);
}

BankBuilder::BankBuilder(int inputs, int outputs, Edge edge, CutRows cut) : cut_(cut) {
    bank_.inputs = inputs;
    bank_.edge = edge;
    bank_.outputs.reserve(static_cast<std::size_t>(outputs));
}

void BankBuilder::add(const Position& at, const PhaseRow& row) {
    const int first = static_cast<int>(at.whole) + row.first;
    const int last = first + static_cast<int>(row.weights.size()) - 1;
    const bool drops = bank_.edge == Edge::zero || bank_.edge == Edge::renormalize;
    if (drops && (first < 0 || last >= bank_.inputs)) return add_cut(at, row, first);
    auto [entry, is_new] = row_of_phase_.try_emplace(at.phase, static_cast<int>(bank_.rows.size()));
    if (is_new) append_row(row);
    bank_.outputs.push_back({first, entry->second});
}

void BankBuilder::append_row(const PhaseRow& row) {
    const int count = static_cast<int>(row.weights.size());
    const int near_begin = std::clamp(row.near_first - row.first, 0, count - 1);
    const int near_end = std::clamp(row.near_last - row.first + 1, near_begin + 1, count);
    bank_.rows.push_back({bank_.weights.size(), count, near_begin, near_end - near_begin});
    const std::vector<float> floats = rounded_weights(row.weights);
    bank_.weights.insert(bank_.weights.end(), floats.begin(), floats.end());
}

void BankBuilder::check_inside(const Position& at, const PhaseRow& inside) const {
    if (inside.weights.empty() || (bank_.edge == Edge::renormalize && cancels(inside.weights)))
        fail("make_bank: output ", bank_.outputs.size(), " lies at source sample ",
             static_cast<double>(at.whole) + at.fraction, " of ", bank_.inputs,
             " and has no weight inside; use Edge::clamp, or axes that overlap");
}

/// A row of its own for an output that reaches outside, with only what lies inside.
void BankBuilder::add_cut(const Position& at, const PhaseRow& row, int first) {
    const int skip = std::max(0, -first);
    const int keep = std::min(static_cast<int>(row.weights.size()), bank_.inputs - first) - skip;
    PhaseRow inside{row.first + skip, {}, row.near_first, row.near_last};
    if (keep > 0) inside.weights.assign(row.weights.begin() + skip, row.weights.begin() + skip + keep);
    if (cut_ == CutRows::finished) {
        trim_zeros(inside);
        check_inside(at, inside);
        if (bank_.edge == Edge::renormalize) {
            const double scale = sum_of(row.weights) / sum_of(inside.weights);
            for (double& w : inside.weights) w *= scale;
        }
    } else if (inside.weights.empty()) {
        inside.first = -static_cast<int>(at.whole);
        inside.weights = {0};
    }
    bank_.outputs.push_back({static_cast<int>(at.whole) + inside.first, static_cast<int>(bank_.rows.size())});
    append_row(inside);
}

}  // namespace bandlimit
