// Filters that halve pictures, or shrink them by another whole factor, with as little aliasing as possible: the least
// squared distance from the ideal low-pass of passband.h, as taps, as weights, or as bilinear reads.
//
// All are symmetric about their output, and sum to 1. Weights solve a small quadratic program; where fetches read is
// searched over the texels they lie between, and then optimised together with their weights by Gauss-Newton steps with
// exact derivatives.
//
// source  B. Wronski, Fast, GPU friendly, antialiasing downsampling filter, bartwronski.com, 2022. Ours solves for
//         positions and weights at once, in place of folding pairs of weights, and for any number of fetches. Without
//         limits the best taps are those of the ideal filter plus a constant that makes them sum to 1.
// Stability: evolving.
#pragma once
#include <optional>
#include <vector>

#include "bandlimit/design/passband.h"
#include "bandlimit/kernel/fetches.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

/// What a filter that changes the rate by a whole factor should achieve.
struct RateGoal {
    int factor = 2;                           ///< 2 to 16
    bool upsample = false;                    ///< enlarge by the factor, which must be 2 then, instead of shrink
    double pass_weight = 1, stop_weight = 1;  ///< of the squared error in either part of the band; > 0
    std::optional<double> max_gain = {};      ///< the most that |H| may be, >= 1
    bool non_negative = false;                ///< no weight below 0
};

/// Where the output of a filter lies, in texels right of and below its texel's centre.
///
/// Where pictures shrink that is the middle of the `factor` texels under it. Where they double there are two outputs
/// per texel and axis, and filters are made for the one 1/4 texel to the right; mirrored they are the other's.
double output_texel(const RateGoal& goal);

/// The best `count` taps. Of filters that enlarge, for the outputs 1/4 texel right of texel i: taps of factor 1.
///
/// range   shrinking, count is even for even factors and odd for odd ones, so that taps are symmetric; 1 to 256
/// throws  Error for a goal or a count out of range, or a gain limit that so few taps cannot meet
/// cost    linear without limits and band weights, otherwise about count^3
/// example downsample_taps(8)     // .46369 .16358 -.07650 -.05078, mirrored
Taps downsample_taps(int count, const RateGoal& goal = {});

/// Throws Error, naming `function`, for arguments that alone are out of range: those of downsample_taps().
void check_taps(const char* function, int count, const RateGoal& goal);

/// The best weights on count x count texels, and what dropping the small ones costs.
struct SparseWeights {
    PlacedWeights2D all;        ///< the best of the whole square
    PlacedWeights2D dropped;    ///< those of at least `threshold` in magnitude, divided by their sum
    PlacedWeights2D optimized;  ///< the best that leave out the same ones
};
/// range   as downsample_taps; count to 32, threshold >= 0; goals that shrink
/// throws  Error as downsample_taps, and for a threshold that leaves nothing
SparseWeights downsample_weights(int count, double threshold, const RateGoal& goal = {});

/// Where fetches may read.
enum class FetchLayout {
    free,    ///< anywhere, symmetrically: whatever has the least error
    cross,   ///< four around the output, or one on it, and along the axes
    square,  ///< at the crossings of n rows and n columns
};

struct FetchOptions {
    FetchLayout layout = FetchLayout::free;
    int taps = 0;          ///< texels a side that may be read; 0: 24 at factor 2, else 8 times the factor; 8 to enlarge
    double threshold = 0;  ///< and of these only such as downsample_weights() keeps
};

/// A filter of fetches, and its error as band_error() has it, whatever the weights of the goal.
struct FetchDesign {
    Fetches fetches;
    double error = 0;
};

/// The best filters of 1 to `most` fetches, with fewer of them first.
///
/// Counts are those that symmetry allows: shrinking, multiples of four and one more than such; enlarging, all; of
/// squares the square numbers. A count is left out if it does not lower the error by a ten thousandth, by the goal's
/// own weights, or if the texels that may be read have no room for it.
///
/// range   most 1 to 64
/// units   see Fetch; of filters that enlarge, for the outputs 1/4 texel right of and below a texel's centre
/// error   local optima, the best of many starts: there is no proof that they are global
/// cost    20 fetches at factor 2 in 0.2 s, 64 in some seconds; same result on every run
/// throws  Error for goals and options out of range, and if no filter keeps the limit of the gain
std::vector<FetchDesign> downsample_curve(int most, const RateGoal& goal = {}, const FetchOptions& options = {});

/// The last filter of that curve: of `count` fetches, or of fewer where more do not lower the error.
/// throws  Error as downsample_curve, and for counts that no symmetric filter has
/// example downsample_fetches(8)    // error .02779, as the published filter
FetchDesign downsample_fetches(int count, const RateGoal& goal = {}, const FetchOptions& options = {});

/// As check_taps(), of downsample_fetches().
void check_fetches(const char* function, int count, const RateGoal& goal, const FetchOptions& options);

/// The weights that downsample_weights() keeps, folded into as few fetches as cover them: neighbours of one sign share
/// one, as good as its position and weight, optimised with all others, allow.
FetchDesign downsample_folded(int count, double threshold, const RateGoal& goal = {});

/// The filter on the finer of the two pictures: what its weights there are, relative to an output, as band_error(),
/// max_gain() and response() measure it. Shrinking, those that are read; enlarging, all outputs' filters together, as
/// what a texel spreads to, scaled to sum 1.
/// throws   Error for fetches or taps that are none, or not finite
PlacedWeights whole_filter(const Taps& taps, const RateGoal& goal = {});
PlacedWeights2D whole_filter(const Fetches& fetches, const RateGoal& goal = {});

}  // namespace bandlimit
