#include "bandlimit/resample/bank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {
namespace {

/// Weights of one phase, before any edge: sample whole + first + j has weights[j].
struct PhaseRow {
    int first = 0;
    std::vector<double> weights;
    int near_first = 0, near_last = 0;  ///< the nearest samples, both ends included
};

void trim_zeros(PhaseRow& row) {
    const auto not_zero = [](double w) { return w != 0; };
    const auto begin = std::find_if(row.weights.begin(), row.weights.end(), not_zero);
    const auto end = std::find_if(row.weights.rbegin(), row.weights.rend(), not_zero).base();
    if (begin >= end) return;  // all zero: the caller refuses it
    row.first += static_cast<int>(begin - row.weights.begin());
    row.weights = {begin, end};
}

double overlap(double a0, double a1, double b0, double b1) {
    return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

/// Sample s sees the kernel at (s * units - offset) / span. These are integers where sizes are: what lies on a jump of
/// the kernel, or halfway, lies there exactly, and mirrored outputs have mirrored weights.
struct Footing {
    double offset, units, span;
};

PhaseRow sampled_row(const Kernel& kernel, const Footing& at) {
    PhaseRow row;
    if (kernel.form == Kernel::Form::nearest) {
        row.first = 2 * at.offset >= at.units ? 1 : 0;
        row.weights = {1};
        row.near_first = row.near_last = row.first;
        return row;
    }
    const bool area = kernel.form == Kernel::Form::area && at.span > at.units;
    // A cell that overlaps the target's cell may have its centre up to half a cell outside it.
    const double half_cell = at.units / 2, radius = kernel.radius * at.span + (area ? half_cell : 0);
    row.first = static_cast<int>(std::ceil((at.offset - radius) / at.units));
    const int last = static_cast<int>(std::floor((at.offset + radius) / at.units));
    for (int s = row.first; s <= last; ++s) {
        const double x = s * at.units - at.offset;
        row.weights.push_back(area ? overlap(x - half_cell, x + half_cell, -at.span / 2, at.span / 2)
                                   : kernel.value(x / at.span));
    }
    row.near_first = static_cast<int>(std::floor((at.offset - at.span) / at.units)) + 1;
    row.near_last = static_cast<int>(std::ceil((at.offset + at.span) / at.units)) - 1;
    trim_zeros(row);
    return row;
}

double sum_of(std::span<const double> w) { return std::accumulate(w.begin(), w.end(), 0.0); }

/// Floats of `scale` times the weights. Each carries the rounding of those before it, so that the sum of the floats is
/// that of the doubles to the rounding of the last one. Zeros stay zeros.
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

/// Collects the rows of a bank: those that lie inside are shared by phase, the others cut to what the edge lets them
/// read.
class Builder {
public:
    Builder(int inputs, int outputs, Edge edge) {
        bank_.inputs = inputs;
        bank_.edge = edge;
        bank_.outputs.reserve(static_cast<std::size_t>(outputs));
    }

    void add(const Position& at, const PhaseRow& row) {
        const int first = static_cast<int>(at.whole) + row.first;
        const int last = first + static_cast<int>(row.weights.size()) - 1;
        const bool cut = bank_.edge == Edge::zero || bank_.edge == Edge::renormalize;
        if (cut && (first < 0 || last >= bank_.inputs)) return add_cut(at, row, first);
        auto [entry, is_new] = row_of_phase_.try_emplace(at.phase, static_cast<int>(bank_.rows.size()));
        if (is_new) append_row(row);
        bank_.outputs.push_back({first, entry->second});
    }

    Bank take() { return std::move(bank_); }

private:
    void append_row(const PhaseRow& row) {
        const int count = static_cast<int>(row.weights.size());
        const int near_begin = std::clamp(row.near_first - row.first, 0, count - 1);
        const int near_end = std::clamp(row.near_last - row.first + 1, near_begin + 1, count);
        bank_.rows.push_back({bank_.weights.size(), count, near_begin, near_end - near_begin});
        const bool has_unit_sum = std::abs(sum_of(row.weights) - 1) < 1e-9;
        const std::vector<float> floats = has_unit_sum ? rounded_to_unit_sum(row.weights) : rounded(row.weights);
        bank_.weights.insert(bank_.weights.end(), floats.begin(), floats.end());
    }

    /// A row of its own for an output that reaches outside, with only what lies inside.
    void add_cut(const Position& at, const PhaseRow& row, int first) {
        const int skip = std::max(0, -first);
        const int keep = std::min(static_cast<int>(row.weights.size()), bank_.inputs - first) - skip;
        PhaseRow inside{row.first + skip, {}, row.near_first, row.near_last};
        if (keep > 0) inside.weights.assign(row.weights.begin() + skip, row.weights.begin() + skip + keep);
        trim_zeros(inside);
        const double sum = sum_of(inside.weights), whole_sum = sum_of(row.weights);
        if (inside.weights.empty() || (bank_.edge == Edge::renormalize && std::abs(sum) < 1e-9))
            fail("make_bank: output ", bank_.outputs.size(), " lies at source sample ",
                 static_cast<double>(at.whole) + at.fraction, " of ", bank_.inputs,
                 " and has no weight inside; use Edge::clamp, or axes that overlap");
        if (bank_.edge == Edge::renormalize)
            for (double& w : inside.weights) w *= whole_sum / sum;
        bank_.outputs.push_back({static_cast<int>(at.whole) + inside.first, static_cast<int>(bank_.rows.size())});
        append_row(inside);
    }

    Bank bank_;
    std::map<std::int64_t, int> row_of_phase_;
};

PhaseRow row_of(const Taps& taps) {
    const int last = taps.first + static_cast<int>(taps.weights.size()) - 1;
    PhaseRow row{taps.first, taps.weights, taps.first, last};
    trim_zeros(row);
    return row;
}

void normalise(PhaseRow& row, const Kernel& kernel) {
    const double sum = sum_of(row.weights);
    if (!(std::abs(sum) > 1e-9))
        fail("make_bank: the weights of ", kernel.name, " sum to ", sum, " and cannot be normalised");
    if (sum == 1) return;
    for (double& w : row.weights) w /= sum;
}

void check_separable(const Kernel& kernel) {
    if (is_radial(kernel))
        fail("make_bank: ", kernel.name,
             " is radial, not separable; resample with radial.h, or choose a separable kernel");
}

/// Indices, and the number of weights of a row, must fit an int.
void check_reach(const Kernel& kernel, const Mapping& mapping) {
    const double reach = kernel.radius * mapping.stretch();
    if (reach > 1 << 29)
        fail("make_bank: ", kernel.name, " would reach over ", reach, " samples to either side; pass more outputs");
}

}  // namespace

Bank make_bank(const Kernel& kernel, const Axis& src, const Axis& dst, Edge edge) {
    check_separable(kernel);
    const Mapping mapping(src, dst);
    check_reach(kernel, mapping);
    Builder builder(src.count, dst.count, edge);
    std::map<std::int64_t, PhaseRow> known;
    for (int i = 0; i < dst.count; ++i) {
        const Position at = mapping(i);
        auto [entry, is_new] = known.try_emplace(at.phase);
        if (is_new) {
            entry->second = sampled_row(kernel, {at.offset, mapping.units(), mapping.span()});
            normalise(entry->second, kernel);
        }
        builder.add(at, entry->second);
    }
    return builder.take();
}

std::uint64_t bank_bytes(double radius, const Axis& src, const Axis& dst) {
    const Mapping mapping(src, dst);
    const double count = dst.count, taps = 2 * radius * mapping.stretch() + 2;
    const double phases = mapping.units() > 1 ? mapping.units() / 2 : count;  // no ratio: every output has its own
    const double cut = 2 * taps / std::abs(mapping.step());                   // rows that reach outside, at both ends
    // A row is held in double while it is made, and vectors grow by doubling; the rest are nodes and book-keeping.
    const double bytes_per_row = 24 * taps + 256;
    return static_cast<std::uint64_t>(count * sizeof(Bank::Output) + std::min(count, phases + cut) * bytes_per_row);
}

Bank make_bank(const Taps& taps, const Axis& src, const Axis& dst, Edge edge) {
    if (taps.weights.empty() ||
        !std::all_of(taps.weights.begin(), taps.weights.end(), [](double w) { return std::isfinite(w); }))
        fail("make_bank: taps need at least one weight, and finite ones");
    const Mapping mapping(src, dst);
    const Position start = mapping(0);
    const double offset = output_offset(taps) - start.fraction;
    if (!mapping.is_whole_step(taps.factor) || offset != std::floor(offset))
        fail("make_bank: these taps take every ", taps.factor, ". sample; the axes ask for a step of ", mapping.step(),
             " from sample ", static_cast<double>(start.whole) + start.fraction);
    const PhaseRow row = row_of(taps);
    if (edge == Edge::renormalize && std::abs(sum_of(row.weights)) < 1e-9)
        fail("make_bank: taps that sum to 0 cannot be renormalised; use Edge::reflect");
    Builder builder(src.count, dst.count, edge);
    for (int i = 0; i < dst.count; ++i) {
        Position at = mapping(i);
        at.whole -= static_cast<std::int64_t>(offset);  // taps count from input sample i * factor
        builder.add(at, row);
    }
    return builder.take();
}

Bank make_bank(const Taps& taps, int count, Edge edge) {
    const int outputs = taps.factor < 1 ? 0 : count / taps.factor;
    if (outputs < 1)
        fail("make_bank: ", count, " samples and taps of factor ", taps.factor, "; at least one output must result");
    return make_bank(taps, Axis{count, 0, double(count)}, Axis{outputs, 0, double(outputs) * taps.factor}, edge);
}

PhaseWeights weights_at(const Kernel& kernel, double phase) {
    check_separable(kernel);
    if (!(std::abs(phase) <= 1 << 30)) fail("weights_at: phase = ", phase, "; pass a number of source samples");
    const double whole = std::floor(phase);
    PhaseRow row = sampled_row(kernel, {phase - whole, 1, 1});
    const double sum = sum_of(row.weights);
    normalise(row, kernel);
    return {{row.first + static_cast<int>(whole), row.weights, 1}, sum};
}

}  // namespace bandlimit
