// How much of a measured kernel is signal.
// Stability: evolving.
#pragma once
#include <span>

namespace bandlimit {

/// The factor of the median singular value of a rows x columns matrix of a signal and white noise, below which a
/// singular value is better taken for noise: 2.858 for a square one.
///
/// error    about 1e-9
/// throws   Error for rows or columns < 1
/// source   Gavish & Donoho 2014, "The optimal hard threshold for singular values is 4/sqrt(3)", for unknown noise; the
///          median of the Marchenko-Pastur distribution is integrated
double noise_threshold(int rows, int columns);

/// How many of `values`, those of a noisy kernel on rows x columns samples, which fall, are above the noise; at
/// least 1. Terms of that rank are the kernel with least noise added back, where the noise has one unknown strength
/// everywhere and the rank of what it is added to is well below half the number of values. Without noise that is the
/// exact rank.
///
/// throws   Error as noise_threshold, and unless there are min(rows, columns) values
int rank_above_noise(std::span<const double> values, int rows, int columns);

}  // namespace bandlimit
