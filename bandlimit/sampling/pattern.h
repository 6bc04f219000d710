// Patterns of samples: where in a pixel a renderer looks.
//
//     SamplePattern pattern = parse_pattern("d3d:4");
//     for (const Point& p : pattern.points) trace(x + p.x, y + p.y);   // (x, y) is the pixel's centre
//
// Common to all of them
//   units    pixels from the pixel's centre, y down. Points lie in [-1/2, 1/2), but for the largest rotated grids
//   count    `count` is the number of points, 1 to 4096
//   random   patterns with a seed are another one for each, and the same on every machine
//   throws   Error for a count out of range, or, where a square is needed, not a square
// Stability: evolving.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/core/point.h"

namespace bandlimit {

struct SamplePattern {
    std::string name;  ///< as parse_pattern() reads it, with all parameters: "sobol:16:1"
    std::vector<Point> points;

    int count() const { return static_cast<int>(points.size()); }
};

/// sqrt(count) x sqrt(count) points in the middle of equal cells. Row after row.
SamplePattern regular_pattern(int count);
/// The same turned by 45 degrees around the pixel's centre: of 4, (+-.354, 0) and (0, +-.354). From 16 on the corners
/// leave the pixel, where they find those of its neighbours.
SamplePattern rotated_pattern(int count);
/// The standard patterns of Direct3D 11 for 2, 4, 8 or 16 samples, in sixteenths of a pixel.
SamplePattern d3d_pattern(int count);
/// halton_point() from index `first` on.
SamplePattern halton_pattern(int count, std::uint32_t first = 1);
/// r2_point() from index 1 on.
SamplePattern r2_pattern(int count);
/// sobol_point() from index 0 on: Owen-scrambled.
SamplePattern sobol_pattern(int count, std::uint64_t seed = 1);
/// One point anywhere in each cell of a regular pattern.
SamplePattern jittered_pattern(int count, std::uint64_t seed = 1);
/// Independent points.
SamplePattern random_pattern(int count, std::uint64_t seed = 1);
/// As many columns and rows as points, one in the middle of a cell of each: a random permutation (Shirley 1991).
SamplePattern n_rooks_pattern(int count, std::uint64_t seed = 1);
/// Each point is the best of several random ones: the farthest from those before it, across the pixel's borders
/// (Mitchell 1991).
/// cost    count^3: 0.1 s for 256 points, 5 s for 1024, which are the most
SamplePattern best_candidate_pattern(int count, std::uint64_t seed = 1);
/// The five of a die: the centre, and (+-1/4, +-1/4).
SamplePattern quincunx_pattern();
/// The middles of the squares of one colour of a checkerboard on the pixel: 2 m^2 points on 2 m x 2 m squares. Repeated
/// in every pixel it is one lattice, turned by 45 degrees.
SamplePattern checkerboard_pattern(int count = 2);

/// The pattern that `name` describes: a name of pattern_list() with parameters after colons, as "halton:16:409". Seeds
/// and first indices can be left out.
///
/// throws  Error for an unknown name, listing the names, and for parameters that are missing, extra or out of range
SamplePattern parse_pattern(std::string_view name);

/// `pattern` as it would be with another number of points: "d3d:4" and 8 give "d3d:8".
/// throws  Error if there is none with so many
SamplePattern with_count(const SamplePattern& pattern, int count);

/// `pattern`, moved by `offset`, what leaves the pixel on one side coming back on the other: as evenly spread as it
/// was, and no longer the same in each pixel.
SamplePattern wrapped(const SamplePattern& pattern, const Point& offset);

/// One line of documentation.
struct PatternInfo {
    std::string_view name;     ///< with its parameters, as "sobol:N:SEED"
    std::string_view example;  ///< a name that parse_pattern() takes
    std::string_view summary;
};

/// All patterns, in the order of the documentation.
std::span<const PatternInfo> pattern_list();

}  // namespace bandlimit
