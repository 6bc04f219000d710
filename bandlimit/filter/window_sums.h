// Sums over square windows about every sample, at a cost that does not depend on their radius.
//
//     window_sums({width, height, 8}, 1,
//                 [&](int y, IndexRange xs, double* const* planes) { /* planes[0][0] is the value at (xs.begin, y) */ },
//                 [&](int y, const double* const* sums) { /* sums[0][x] is that of the window about (x, y) */ });
// Stability: evolving.
#pragma once
#include <functional>
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// The (2 radius + 1)^2 samples about each of width x height.
struct BoxWindow {
    int width = 0, height = 0;
    int radius = 0;                 ///< in samples
    Edge edge = Edge::renormalize;  ///< this and zero add nothing for what lies outside

    static constexpr int most_radius = 32767;
};

/// Writes the values of columns [xs.begin, xs.end) of the stored row y, side by side, plane after plane. Called by any
/// thread, several times for a row, and must give the same finite values each time.
using FillRow = std::function<void(int y, IndexRange xs, double* const* planes)>;
/// Sees the sums of a row, [planes][width]; after them there is memory up to a multiple of 8 that may be read. Each row
/// comes once, from any thread.
using TakeSums = std::function<void(int y, const double* const* sums)>;

/// Sums of `planes` values per sample.
///
/// method   along y a running sum per column, begun anew in bands of rows, and wherever what leaves it is 2^20 times what
///          stays; along x sums of blocks from both of their ends, so that nothing is ever taken away
/// range    finite values whose sums are finite
/// error    about 2^-31 of the largest magnitude in the window, where something huge has just left it, and most often
///          2^-50: what lies outside a window leaves no trace in it. Same bits for any number of threads
/// cost     two calls of `fill` per row, and two more in all for each row of a band's first window; some 10 additions
///          per sample and plane
/// memory   per thread about 32 (width + 2 radius) bytes per plane
/// throws   Error for width, height or planes < 1 and a radius outside 0..32767; Stopped
void window_sums(const BoxWindow& window, int planes, const FillRow& fill, const TakeSums& take,
                 const Parallel& parallel = {});

/// How many samples the windows about each of n have along an axis: 2 radius + 1, but for Edge::renormalize, which
/// counts those inside alone.
std::vector<double> window_counts(int n, int radius, Edge edge);

}  // namespace bandlimit
