// Sequences of points that fill a pixel evenly, and the jitter of a camera made of them.
//
//     std::vector<Point> jitter = jitter_sequence(JitterKind::halton, jitter_length(2));  // 32 offsets
//     camera.shift(jitter[frame % jitter.size()]);
//
// Points are in pixels from the pixel's centre, in [-1/2, 1/2), y down. Each is a function of its index and seed: the
// same on every machine, in any order.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "bandlimit/core/point.h"

namespace bandlimit {

/// The digits of `index` to the given base, mirrored at the point: van der Corput's sequence, in [0, 1).
/// throws  Error for a base below 2
double radical_inverse(int base, std::uint64_t index);

/// Bases 2 and 3 (Halton 1960). Index 0 is the corner (-1/2, -1/2), so sequences usually begin at 1.
Point halton_point(std::uint64_t index);

/// Multiples of 1/g and 1/g^2 without their whole parts, where g^3 = g + 1, from the centre on (Roberts 2018): the
/// generalisation of the golden ratio to two dimensions. Index 0 is the centre.
Point r2_point(std::uint64_t index);

/// The first two dimensions of Sobol's sequence with Owen's scrambling (nested uniform; Owen 1995), another one per
/// seed. The first 2^m points have one point in each of the 2^m cells of 2^k columns and 2^(m - k) rows, for every k.
/// range   indices below 2^32; coordinates are multiples of 2^-33, and never 0
/// cost    64 hashes, about half a microsecond
Point sobol_point(std::uint32_t index, std::uint64_t seed);

/// Which sequence moves the camera by a part of a pixel, another one each frame.
enum class JitterKind {
    halton,        ///< halton_point() from index 1 on
    r2,            ///< r2_point() from index 1 on
    rotated_grid,  ///< a grid of `length` points in as many rows and columns, one in each, turned a little
    sobol          ///< sobol_point() of seed 1
};

/// "halton", "r2", "rotated" or "sobol". Throws Error for others, listing them.
JitterKind parse_jitter(std::string_view name);
std::string_view name_of(JitterKind kind);

/// How many frames it takes to give each pixel of the output, `scale` times as wide and high as the input, about eight
/// samples: 8 scale^2, rounded.
/// throws  Error unless scale is in (0, 16]
int jitter_length(double scale);

/// The first `length` offsets of a sequence, to be repeated. None is exactly (0, 0), so that code can take (0, 0) for
/// "no jitter"; of an odd grid, whose middle would be, all points lie 1 / (4 length) farther right and down.
///
/// throws  Error for a length outside 1 to 4096
std::vector<Point> jitter_sequence(JitterKind kind, int length = 8);

}  // namespace bandlimit
