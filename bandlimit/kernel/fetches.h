// Weights that are run by the bilinear sampler of a GPU.
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

/// A filter as shaders run it: a sum of bilinear reads. Whoever keeps them says which factor they are for.
using Fetches = std::vector<Fetch>;

}  // namespace bandlimit
