// Convolution by Fourier transforms.
// Stability: evolving.
#pragma once

#include "bandlimit/kernel/terms.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {

/// Samples along one axis that are transformed together, and how many outputs they give: overlap-save.
struct FftTiles {
    int size = 1, outputs = 1, count = 1;
};

/// The tiles that take the fewest operations for `weights` weights on `samples` outputs: products of 2, 3 and 5, of at
/// most 1024 samples or four times the weights.
FftTiles fft_tiles(int weights, int samples);

/// Any weights, at a cost that hardly depends on how many they are. Weight (0, 0) multiplies the sample at
/// (x + first_x, y + first_y).
///
/// Tiles of the image are transformed in double, two channels at a time as the parts of complex numbers. What is not
/// finite is left out of that, where it would reach all of a tile.
///
/// range   any; what is not finite makes NaN of the outputs whose rectangle of weights covers it, in its channel
/// error   1e-15 of the largest sample of a tile times sum |w|, and the rounding to float; the same bits for any
///         number of threads, and for parts of an image
/// memory  per thread 16 bytes per sample of a tile, and once more for the weights
/// cost    docs/convolve.md
/// throws  Error for empty weights or such as are not finite, width or height < 1, and as BorderScale
RowFilter fft_filter(const WeightGrid& weights, int first_x, int first_y, const FilterDomain& domain);

}  // namespace bandlimit
