// Reading the history where it was.
// Stability: inner.
#pragma once
#include "bandlimit/antialias/temporal.h"

namespace bandlimit {

/// Weights of four samples -1, 0, 1, 2 for a place t in [0, 1) from sample 0. They sum to 1, and for t = 0 all kernels
/// but bspline read sample 0 alone.
void history_weights(HistoryKernel kernel, float t, float* weights);

/// What the history holds at a place.
struct HistorySample {
    float color[3] = {};  ///< mean colour there; 0 without memory
    float weight = 0;     ///< how much memory it has
    float sums[4] = {};   ///< where it is read at a sample: that one, as it is
    bool is_exact = false;
};

/// `sums` [w x h x 4] interleaved: RGB and 1 times weights. The place is sample (x, y) moved by (dx, dy) samples; what
/// lies outside is clamped to the border. Between samples the colour is kept within that of the four about it.
HistorySample sample_history(View<const float> sums, HistoryKernel kernel, int x, int y, float dx, float dy,
                             float least_weight);

}  // namespace bandlimit
