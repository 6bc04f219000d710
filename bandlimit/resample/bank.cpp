#include "bandlimit/resample/bank.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/bank_builder.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {
namespace {

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

PhaseRow row_of(const Taps& taps) {
    const int last = taps.first + static_cast<int>(taps.weights.size()) - 1;
    PhaseRow row{taps.first, taps.weights, taps.first, last};
    trim_zeros(row);
    return row;
}

void normalise(PhaseRow& row, const Kernel& kernel) {
    const double sum = sum_of(row.weights);
    if (cancels(row.weights))
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
    BankBuilder builder(src.count, dst.count, edge);
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
    if (edge == Edge::renormalize && cancels(row.weights))
        fail("make_bank: taps that sum to 0 cannot be renormalised; use Edge::reflect");
    BankBuilder builder(src.count, dst.count, edge);
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
