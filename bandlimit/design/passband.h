// How far a filter that changes the rate by a whole factor is from the ideal low-pass.
//
// The ideal response is 1 where |f| < 1 / (2 factor), along every axis, and 0 elsewhere up to 1/2, in cycles per sample
// of the finer of the two pictures: a square, which matches a square lattice of outputs. Errors are means of
// |H - ideal|^2. By Parseval's theorem they are sums over weights; nothing is integrated numerically:
//
//     mean |H - ideal|^2 = sum_p w_p^2 - 2 sum_p w_p s(p) + s(0)
//     s(x, y) = s(x) s(y),  s(x) = sinc(x / factor) / factor
//
// where s is the ideal filter's own weight at p, relative to the output.
// Stability: evolving.
#pragma once
#include "bandlimit/analysis/response.h"
#include "bandlimit/kernel/fetches.h"

namespace bandlimit {

/// Means of |H - ideal|^2 over the whole band, over the pass band, and over the stop band.
struct BandError {
    double whole = 0, pass = 0, stop = 0;
};

/// The errors of weights that shrink by `factor`, over |f| <= 1/2 or that square.
///
/// range   factor >= 2
/// error   1e-14 of the sum of squared weights, and of 1
/// cost    weights.size()^2
/// throws  Error for another factor
BandError band_error(const PlacedWeights& weights, int factor);
BandError band_error(const PlacedWeights2D& weights, int factor);

/// The texel weights that bilinear reads amount to, for an output `texel` right of and below a texel's centre:
/// (factor - 1) / 2 where pictures shrink by a whole factor.
///
/// units    fetches and the result in texels from the output
/// throws   Error for no fetches, or ones that are not finite or farther than 1000 texels
PlacedWeights2D weights_of(const Fetches& fetches, double texel);

/// The largest |H| of real weights, over all frequencies.
///
/// error    below 1e-6 of it, unless two peaks differ by less
/// cost     a response at 16 frequencies per weight
double max_gain(const PlacedWeights& weights);
double max_gain(const PlacedWeights2D& weights);

}  // namespace bandlimit
