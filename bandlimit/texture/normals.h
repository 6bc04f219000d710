// Normal maps: from codes to vectors, unit length, and how much vectors spread.
// Stability: inner.
#pragma once
#include <optional>

#include "bandlimit/color/depth.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

// Codes of integers hold (n + 1) / 2 and floats n itself. Two channels hold x and y, and z is what a unit vector that
// points up needs; of three or four the first three are the vector, and the fourth is no matter.

/// The vectors of a normal map, made unit if asked for.
///
/// shapes   map [w x h x 2 to 4]; the result has 3 channels, interleaved
Image<float> decode_normals(const AnyConstView& map, bool make_unit, Parallel parallel);

/// Stores mean vectors as unit vectors: as they are where their rounding is unit to what codes can tell, so that what
/// is constant stays so to the code, else divided by their length. Means too short to point anywhere (below 0.01)
/// become (0, 0, 1). A fourth sample is stored as it is.
///
/// shapes   means [w x h x 3 or 4], interleaved; target [w x h x 2 or 4], whose fourth sample is 1 where there is none
/// returns  whether a value that is not finite was stored as the code 0
struct NormalMeans {
    View<const float> samples;
    bool are_codes = false;  ///< of (n + 1) / 2 rather than n
};
bool encode_normals(const NormalMeans& means, const AnyView& target, Parallel parallel);

/// The means of unit normals over the cells of coarser grids: exact boxes of level 0, whatever filters the picture.
///
/// memory   12 bytes per texel of level 0, and of the last grid asked for
class NormalMoments {
public:
    NormalMoments(const AnyConstView& map, Parallel parallel);
    /// The mean vectors on a grid over the same picture; grids are best asked for from large to small.
    ///
    /// returns  [width x height x 3], valid until the next call
    View<const float> means(int width, int height, Parallel parallel);

private:
    Image<float> base_, last_;
};

}  // namespace bandlimit
