// The one inner loop: weighted sums of lines of samples.
// Stability: inner.
#pragma once
#include <cstddef>

#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// A run of contiguous samples each: lines[v] for the index v that a bank reads, which may be negative.
using ConstLines = const float* const*;
using Lines = float* const*;

/// For outputs i in [begin, end): out[i - begin][k] = sum_j row(i)[j] * lines[first(i) + j][k], for k in [0, length).
///
/// The sum starts with the product of the first tap; each further tap is one fused multiply-add, in tap order: this
/// order is the definition of every float filter here. `antiring` > 0 moves the sum by that share towards its nearest
/// value within the range of the row's nearest samples.
///
/// shapes   lines[v] holds `length` samples for every v that the rows read; no out line may overlap any line
/// range    any float; a NaN reaches only the k where it stands
/// error    |err| <= dot_bound(count, sum |w x|); same bits on every instruction set with fused multiply-add
/// cost     (end - begin) * count * length multiply-adds
void combine_scalar(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out,
                    std::size_t length);

/// The same on current_target().
void combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length);

/// A bound for the rounding error of a sum of `count` products in float, where sum_abs = sum |w x|; it holds with and
/// without fused multiply-add (Higham, Accuracy and Stability of Numerical Algorithms, 3.1), weights rounded to float.
/// So far a constant may drift; that of 1 does not, see make_bank().
constexpr double dot_bound(int count, double sum_abs) { return (count + 3) * 0x1p-24 * sum_abs; }

}  // namespace bandlimit
