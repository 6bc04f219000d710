// The samples of one frame, weighted about each output pixel.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// r = sum w(x) w(y) sample, as a filter of rows, and K = x[i] y[j], the sums of those weights.
struct FrameGather {
    RowFilter rows;
    std::vector<float> x, y;            ///< sums of weights along each axis
    std::vector<float> peak_x, peak_y;  ///< the largest weights
    std::vector<int> near_x, near_y;    ///< the input sample nearest to each output
    double mean_weight = 1;             ///< of x[i] y[j], over all phases
};

/// How much weight has to be gathered ...
struct WeightLimits {
    float least;   ///< ... to be divided by
    float enough;  ///< ... to be shown alone
};

/// A kernel with negative weights may gather samples that nearly cancel: nothing is divided by that.
WeightLimits weight_limits(const Kernel& kernel);

/// throws   Error for a kernel that is not separable, and jitter that is not finite or beyond a pixel
FrameGather frame_gather(const Kernel& kernel, bool is_input_sized, int in_width, int in_height, int out_width,
                         int out_height, Point jitter);

}  // namespace bandlimit
