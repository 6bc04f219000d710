// Weights in two dimensions as sums of few separable ones, by their singular values.
// Stability: evolving.
#pragma once
#include <span>
#include <vector>

#include "bandlimit/kernel/terms.h"
#include "bandlimit/math/svd.h"

namespace bandlimit {

/// The singular value decomposition of a grid: `left` are columns, `right` rows.
/// throws   Error as svd()
Svd svd_of(const WeightGrid& grid);

/// How many of the descending `values` differ from 0 by more than rounding: those above
/// max(rows, columns) 2^-52 values[0]. The number of separable terms that are exact.
int numerical_rank(std::span<const double> values, int rows, int columns);

/// The first `rank` products of a decomposition: no other sum of `rank` separable terms is nearer to the grid in the
/// mean of squares (Eckart & Young 1936). Column and row are each scaled by the square root of the singular value.
/// Products beyond the numerical rank are left out.
///
/// error    the squares of the weights that are missing sum to those of the singular values that are
/// throws   Error for a rank outside 1 to the number of values
Terms low_rank(const Svd& decomposition, int rank);

/// The same of weights on a grid.
/// cost     svd_of()
Terms low_rank(const WeightGrid& grid, int rank);

/// What part of the energy, the sum of squares, the first 1, 2, ... values hold. All 1 if all values are 0.
std::vector<double> cumulative_energy(std::span<const double> values);

/// What part of their sum the first 1, 2, ... values hold. Some programs print it as energy, which it is not.
std::vector<double> cumulative_sum(std::span<const double> values);

/// The smallest rank whose terms hold at least `share` of the energy.
/// throws   Error unless 0 < share < 1 and there are values
int rank_for_energy(std::span<const double> values, double share);

}  // namespace bandlimit
