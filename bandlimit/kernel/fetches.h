// Weights applied by the bilinear sampler of a GPU.
// Stability: stable.
#pragma once
#include <vector>

namespace bandlimit {

/// A linear read along one axis, at `offset` source samples from the position of the output.
struct LinearRead {
    double offset = 0, weight = 0;
};

/// A bilinear read of the source, at an offset in source texels from the position of the output.
struct Fetch {
    double x = 0, y = 0, weight = 0;
};

/// A filter as shaders run it: a sum of bilinear reads. The factor that they are for is kept elsewhere.
using Fetches = std::vector<Fetch>;

}  // namespace bandlimit
