// Convolution by Fourier transforms.
#pragma once

#include "bandlimit/kernel/terms.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/resample/border_scale.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {

/// Samples along one axis that are transformed together, and how many outputs they give: overlap-save.
struct FftTiles {
    int size = 1, outputs = 1, count = 1;
};

/// The tiles that take the fewest operations for `weights` weights on `samples` outputs: products of 2, 3 and 5, of at
/// most 1024 samples or four times the weights.
FftTiles fft_tiles(int weights, int samples);

/// Any weights, at a cost that hardly depends on how many they are.
///
/// Tiles of the image are transformed in double, two channels at a time as the parts of complex numbers. What is not
/// finite is left out of that, where it would reach all of a tile.
///
/// range   any; what is not finite makes NaN of the outputs whose rectangle of weights covers it, in its channel
/// error   1e-15 of the largest sample of a tile times sum |w|, and the rounding to float; the same bits for any
///         number of threads, and for parts of an image
/// memory  per thread 16 bytes per sample of a tile, and once more for the weights
/// cost    docs/convolve.md
class FftFilter {
public:
    /// Weight (0, 0) of `weights` multiplies the sample at (x + first_x, y + first_y).
    /// throws  Error for empty weights or such as are not finite, width or height < 1, and as BorderScale
    FftFilter(const WeightGrid& weights, int first_x, int first_y, int width, int height, Edge edge_x, Edge edge_y,
              bool premultiply);

    /// About how much memory run() takes beside what this holds, in bytes.
    std::uint64_t bytes(int channels, Parallel parallel) const;

    /// The stored source rows [begin, end) that output rows [first, last) are made of: those of whole tiles.
    IndexRange rows_needed(int first, int last) const;

    /// As Resizer::run, without background.
    bool run(const SourceRows& source, const TargetRows& target, Parallel parallel) const;

private:
    friend class FftRun;

    ComplexGrid response_;  ///< of the weights, conjugate
    FftTiles x_, y_;
    int taps_x_, taps_y_, first_x_, first_y_, width_, height_;
    Edge edge_x_, edge_y_;
    BorderScale border_;
    bool premultiply_;
};

}  // namespace bandlimit
