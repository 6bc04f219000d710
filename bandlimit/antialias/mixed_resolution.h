// Rendering with half of the samples: at a lower resolution, every other row, or a checkerboard.
//
//     Image<float> half = mixed_resolution(value, 1, 512, 512, MixedMode::checkerboard, tent());
//
// All of these sample a scene on a lattice, and reconstruct each pixel of the full image from the lattice by a kernel
// along the lattice's own axes: those of a checkerboard are the diagonals. A lattice keeps the frequencies of a cell of
// its own: of the checkerboard, a square on its corner, with all of the horizontal and vertical frequencies of the full
// image, and half of its diagonal ones.
// Stability: evolving.
#pragma once
#include <string_view>

#include "bandlimit/antialias/supersample.h"

namespace bandlimit {

/// Where samples lie, one in each pixel or in two.
enum class MixedMode {
    full,         ///< the centre of each pixel
    uniform,      ///< a grid of 1 / sqrt(2) as many columns and rows, rounded up, which shares the image's corners
    interlaced,   ///< the centres of the pixels of even rows
    checkerboard  ///< the centres of the pixels with x + y even
};

/// "full", "uniform", "interlaced" or "checkerboard". Throws Error, listing them, for others.
MixedMode parse_mixed(std::string_view name);
std::string_view name_of(MixedMode mode);

/// `value` at the samples of `mode`, reconstructed at the centres of the pixels. Channels interleaved.
///
/// The kernel's unit is the pitch of the lattice along each of its axes. With kernels that interpolate, pixels that have
/// a sample show it. No kernel meets an edge, since scenes continue.
///
/// shapes   width x height x channels, 1 to 4
/// cost     one call of `value` per sample of the image and of the kernel's reach around it
/// memory   all samples, twice that for the checkerboard
/// throws   Error for sizes and channels out of range, nearest, and kernels whose weights cancel
Image<float> mixed_resolution(const PointValue& value, int channels, int width, int height, MixedMode mode,
                              const Kernel& kernel, const Parallel& parallel = {});

}  // namespace bandlimit
