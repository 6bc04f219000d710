// The share of texels that an alpha test lets pass.
// Stability: inner.
#pragma once
#include <cstddef>
#include <vector>

#include "bandlimit/color/depth.h"

namespace bandlimit {

/// How many samples of a channel are not below the threshold, as a shader compares them: floats with the float nearest
/// to it.
std::size_t count_passing(const AnyConstView& image, int channel, double threshold);

/// The factor for alphas with which `share` of them passes once they are stored at `depth`, to half a sample, or as
/// near as equal alphas permit; 1 where it does by itself. Found from the order of the alphas, which the factor keeps.
///
/// range    alphas: any; what is not finite counts as 0, and what is 0 or less cannot pass
/// returns  > 0
double coverage_factor(std::vector<float> alphas, double share, Depth depth, double threshold);

}  // namespace bandlimit
