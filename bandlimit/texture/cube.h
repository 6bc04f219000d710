// The faces of a cube, and what lies beyond their edges.
// Stability: inner.
#pragma once
#include <array>
#include <span>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit {

/// A point or direction in whole numbers.
using IntVector = std::array<int, 3>;

/// How a face lies: the point of its texels is outward + u * right + v * down, u and v from -1 to 1.
struct CubeFace {
    IntVector outward, right, down;
};
/// +x -x +y -y +z -z, as Direct3D, OpenGL and Vulkan have them (Vulkan 1.3, "Cube Map Face Selection").
const std::array<CubeFace, 6>& cube_faces();

/// Which texel lies under a place of a face's plane.
struct CubeTexel {
    int face = 0, x = 0, y = 0;
};
/// The texel at (x, y) of `face`, which may lie up to `size` texels beyond one edge of it: those are the neighbour's,
/// as if it were unfolded into the plane.
CubeTexel cube_texel(int face, int x, int y, int size);

/// A face with a margin of its neighbours' texels.
///
/// Beyond a corner, where three faces meet, nothing unfolds: such a texel is the mean of the two that a quarter turn
/// about the corner takes there, so that both neighbours count alike.
/// shapes   faces six of [n x n x c], interleaved; 0 <= margin <= n; the result is [(n + 2 margin)^2 x c]
Image<float> extended_face(std::span<const View<const float>> faces, int face, int margin, Parallel parallel);

}  // namespace bandlimit
