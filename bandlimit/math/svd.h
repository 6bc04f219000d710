// The singular value decomposition.
// Stability: evolving.
#pragma once
#include <span>
#include <vector>

namespace bandlimit {

/// A matrix as a sum of products: m(row, column) = sum_k values[k] * left[k][row] * right[k][column].
struct Svd {
    std::vector<double> values;                    ///< >= 0, the largest first; min(rows, columns) of them
    std::vector<std::vector<double>> left, right;  ///< orthonormal vectors
};

/// Decomposes `matrix`, rows x columns, row after row. The sign of each pair is such that the entry of `left` that is
/// largest in magnitude is positive.
///
/// error   about 1e-15 of the largest value
/// throws  Error for rows or columns < 1, a size that does not fit, and entries that are not finite
/// cost    about 20 n^3; 255 x 255 in 0.1 s
Svd svd(std::span<const double> matrix, int rows, int columns);

}  // namespace bandlimit
