#include "bandlimit/resample/bank.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double position_limit = 1 << 30;  // so that indices fit an int with room for any radius

/// p / q, with q >= 1.
struct Ratio {
    std::int64_t p = 0, q = 1;
};

/// The simplest fraction within a few roundings of r, if there is one with a modest denominator.
std::optional<Ratio> as_ratio(double r) {
    constexpr double tolerance = 1e-13;
    constexpr std::int64_t limit = 1 << 20;
    // Continued fraction: each convergent is the best approximation for its denominator.
    std::int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    double rest = r;
    while (std::abs(rest) < position_limit) {
        const double whole = std::floor(rest);
        const auto a = static_cast<std::int64_t>(whole);
        const std::int64_t p = a * p1 + p0, q = a * q1 + q0;
        if (q > limit || std::abs(p) > std::int64_t{1} << 30) return {};
        if (std::abs(static_cast<double>(p) / static_cast<double>(q) - r) <= tolerance * std::abs(r)) return Ratio{p, q};
        p0 = p1, q0 = q1, p1 = p, q1 = q;
        rest = 1 / (rest - whole);
    }
    return {};
}

/// A fractional source index, in two parts so that equal phases have equal bits.
struct Position {
    std::int64_t whole = 0;
    double fraction = 0;     ///< in [0, 1)
    std::int64_t phase = 0;  ///< equal for outputs with equal fractions
};

/// Where the outputs lie in source samples: t(i) = shift + (i + 1/2) step - 1/2 for the cell centres of both axes.
class Mapping {
public:
    Mapping(const Axis& src, const Axis& dst) : src_(src), dst_(dst), step_(dst.pitch() / src.pitch()) {
        ratio_ = as_ratio(step_);
        if (!ratio_) return;
        // All positions are multiples of 1/(2q), counted from the begin of dst.
        units_ = 2 * ratio_->q;
        const double shift = (dst.begin - src.begin) / src.pitch() * static_cast<double>(units_);
        const double snapped = std::round(shift);
        const bool exact = std::abs(shift - snapped) <= 1e-12 * std::max(1.0, std::abs(shift));
        shift_ = static_cast<std::int64_t>(exact ? snapped : std::floor(shift));
        shift_fraction_ = exact ? 0 : shift - std::floor(shift);
    }

    double step() const { return step_; }
    bool is_whole_step(int factor) const { return ratio_ && ratio_->p == factor && ratio_->q == 1; }

    Position operator()(int i) const {
        if (!ratio_) {
            const double t = src_.index(dst_.position(i)), whole = std::floor(t);
            return {static_cast<std::int64_t>(whole), t - whole, i};
        }
        const std::int64_t at = (2 * std::int64_t{i} + 1) * ratio_->p - ratio_->q + shift_;
        const std::int64_t whole = at >= 0 ? at / units_ : -((-at + units_ - 1) / units_);
        const std::int64_t phase = at - whole * units_;
        return {whole, (static_cast<double>(phase) + shift_fraction_) / static_cast<double>(units_), phase};
    }

private:
    Axis src_, dst_;
    double step_;
    std::optional<Ratio> ratio_;
    std::int64_t units_ = 0, shift_ = 0;
    double shift_fraction_ = 0;
};

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

double overlap(double a0, double a1, double b0, double b1) { return std::max(0.0, std::min(a1, b1) - std::max(a0, b0)); }

PhaseRow sampled_row(const Kernel& kernel, double fraction, double stretch) {
    PhaseRow row;
    if (kernel.form == Kernel::Form::nearest) {
        row.first = fraction >= 0.5 ? 1 : 0;
        row.weights = {1};
        row.near_first = row.near_last = row.first;
        return row;
    }
    const bool area = kernel.form == Kernel::Form::area && stretch > 1;
    // A cell that overlaps the target's cell may have its centre up to half a cell outside it.
    const double radius = kernel.radius * stretch + (area ? 0.5 : 0);
    row.first = static_cast<int>(std::ceil(fraction - radius));
    for (int s = row.first; s <= fraction + radius; ++s)
        row.weights.push_back(area ? overlap(s - 0.5, s + 0.5, fraction - stretch / 2, fraction + stretch / 2)
                                   : kernel.value((s - fraction) / stretch));
    row.near_first = static_cast<int>(std::floor(fraction - stretch)) + 1;
    row.near_last = static_cast<int>(std::ceil(fraction + stretch)) - 1;
    trim_zeros(row);
    return row;
}

double sum_of(std::span<const double> w) { return std::accumulate(w.begin(), w.end(), 0.0); }

/// Appends weights as floats. Each carries the rounding of those before it, so that the sum of the floats is the sum of
/// the doubles to the rounding of the last one.
void append_rounded(std::vector<float>& to, std::span<const double> weights) {
    double carry = 0;
    for (const double w : weights) {
        const float rounded = static_cast<float>(w + carry);
        carry += w - static_cast<double>(rounded);
        to.push_back(rounded);
    }
}

void check_axes(const Axis& src, const Axis& dst) {
    if (src.count < 1 || dst.count < 1)
        fail("make_bank: src.count = ", src.count, ", dst.count = ", dst.count, "; both must be at least 1");
    const double step = dst.pitch() / src.pitch();
    const double first = src.index(dst.position(0)), last = src.index(dst.position(dst.count - 1));
    if (!(std::isfinite(step) && step != 0 && std::abs(first) < position_limit && std::abs(last) < position_limit))
        fail("make_bank: intervals [", src.begin, ", ", src.end, "] and [", dst.begin, ", ", dst.end,
             "]; both must be finite and not empty, and lie together");
}

/// Collects the rows of a bank; `sum_kept` is what renormalize restores.
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
        if (is_new) append_row(row.weights, row, row.first);
        bank_.outputs.push_back({first, entry->second});
    }

    Bank take() { return std::move(bank_); }

private:
    void append_row(std::span<const double> weights, const PhaseRow& row, int first) {
        const int count = static_cast<int>(weights.size());
        const int near_begin = std::clamp(row.near_first - first, 0, count - 1);
        const int near_end = std::clamp(row.near_last - first + 1, near_begin + 1, count);
        bank_.rows.push_back({bank_.weights.size(), count, near_begin, near_end - near_begin});
        append_rounded(bank_.weights, weights);
    }

    /// A row of its own for an output that reaches outside, with only what lies inside.
    void add_cut(const Position& at, const PhaseRow& row, int first) {
        const int skip = std::max(0, -first);
        const int keep = std::min(static_cast<int>(row.weights.size()), bank_.inputs - first) - skip;
        std::vector<double> weights;
        if (keep > 0) weights.assign(row.weights.begin() + skip, row.weights.begin() + skip + keep);
        const double sum = sum_of(weights), whole_sum = sum_of(row.weights);
        if (weights.empty() || (bank_.edge == Edge::renormalize && std::abs(sum) < 1e-9))
            fail("make_bank: output ", bank_.outputs.size(), " lies at source sample ",
                 static_cast<double>(at.whole) + at.fraction, " of ", bank_.inputs,
                 " and has no weight inside; use Edge::clamp, or axes that overlap");
        if (bank_.edge == Edge::renormalize)
            for (double& w : weights) w *= whole_sum / sum;
        bank_.outputs.push_back({first + skip, static_cast<int>(bank_.rows.size())});
        append_row(weights, row, row.first + skip);
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
    if (!(std::abs(sum) > 1e-9)) fail("make_bank: the weights of ", kernel.name, " sum to ", sum, " and cannot be normalised");
    if (sum == 1) return;
    for (double& w : row.weights) w /= sum;
}

void check_separable(const Kernel& kernel) {
    if (is_radial(kernel))
        fail("make_bank: ", kernel.name, " is radial, not separable; resample with radial.h, or choose a separable kernel");
}

}  // namespace

Bank make_bank(const Kernel& kernel, const Axis& src, const Axis& dst, Edge edge) {
    check_separable(kernel);
    check_axes(src, dst);
    const Mapping mapping(src, dst);
    const double stretch = std::max(1.0, std::abs(mapping.step()));
    Builder builder(src.count, dst.count, edge);
    std::map<std::int64_t, PhaseRow> known;
    for (int i = 0; i < dst.count; ++i) {
        const Position at = mapping(i);
        auto [entry, is_new] = known.try_emplace(at.phase);
        if (is_new) {
            entry->second = sampled_row(kernel, at.fraction, stretch);
            normalise(entry->second, kernel);
        }
        builder.add(at, entry->second);
    }
    return builder.take();
}

Bank make_bank(const Taps& taps, const Axis& src, const Axis& dst, Edge edge) {
    check_axes(src, dst);
    if (taps.weights.empty() || !std::all_of(taps.weights.begin(), taps.weights.end(), [](double w) { return std::isfinite(w); }))
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
    const double whole = std::floor(phase);
    PhaseRow row = sampled_row(kernel, phase - whole, 1);
    const double sum = sum_of(row.weights);
    normalise(row, kernel);
    return {{row.first + static_cast<int>(whole), row.weights, 1}, sum};
}

}  // namespace bandlimit
