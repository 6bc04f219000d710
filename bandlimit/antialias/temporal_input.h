// One frame as temporal antialiasing reads it.
// Stability: inner.
#pragma once
#include "bandlimit/antialias/temporal.h"

namespace bandlimit {

/// Compresses what is above 1, so that means of highlights and what is about them look like means of what a display
/// shows: the colour is scaled so that its largest channel v becomes 1 + log(v).
void compress_highlight(float* rgb);
/// The way back.
void restore_highlight(float* rgb);

/// What is worked out once per input sample, all interleaved.
struct TemporalInput {
    Image<float> color;  ///< [w x h x 3 or 4] finite, highlights compressed
    Image<float> guide;  ///< [w x h x 4] motion x and y to use, the depth that it is of, and the sample's own depth
    Image<float> box;  ///< [w x h x 6] centre and half extent of the colours of 3 x 3 samples; empty if none are wanted
};
TemporalInput temporal_input(const TemporalFrame& frame, const TemporalOptions& options, const Parallel& parallel);

/// RGB to luma and chroma and back, in place: Y = (r + 2 g + b) / 4, Co = (r - b) / 2, Cg = (2 g - r - b) / 4.
void to_ycocg(float* rgb);
void to_rgb(float* ycocg);

}  // namespace bandlimit
