// How rows of weights become a bank.
// Stability: inner.
#pragma once
#include <map>
#include <span>
#include <vector>

#include "bandlimit/resample/bank.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {

/// Weights of one phase, before any edge: sample whole + first + j has weights[j].
struct PhaseRow {
    int first = 0;
    std::vector<double> weights;
    int near_first = 0, near_last = 0;  ///< the nearest samples, both ends included
};

/// Leaves out the zeros at both ends, unless all are.
void trim_zeros(PhaseRow& row);

/// Weights as floats. Each carries the rounding of those before it, so that the sum of the floats is that of the doubles
/// to the rounding of the last one. Where the sum is 1, within 1e-9, they add up to exactly 1 one after the other, as
/// combine() adds them: what is 1 everywhere, as alpha often is, stays 1. Zeros stay zeros.
std::vector<float> rounded_weights(std::span<const double> weights);

/// What becomes of a row that reaches outside under Edge::zero and Edge::renormalize, where no row of a bank may.
enum class CutRows {
    finished,   ///< scaled to the sum of the whole row under renormalize; one without a weight inside is refused
    unfinished  ///< left as they are, if with a weight of 0: what they are part of is rescaled as a whole
};

/// Collects the rows of a bank: those that lie inside are shared by phase, the others cut to what the edge lets them
/// read.
class BankBuilder {
public:
    BankBuilder(int inputs, int outputs, Edge edge, CutRows cut = CutRows::finished);

    /// The next output lies at `at` and has the weights of `row`.
    void add(const Position& at, const PhaseRow& row);
    Bank take() { return std::move(bank_); }

private:
    void append_row(const PhaseRow& row);
    void add_cut(const Position& at, const PhaseRow& row, int first);
    void check_inside(const Position& at, const PhaseRow& inside) const;

    Bank bank_;
    CutRows cut_;
    std::map<std::int64_t, int> row_of_phase_;
};

}  // namespace bandlimit
