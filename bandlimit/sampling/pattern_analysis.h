// What a pattern of samples is good for: edges, evenness, spectrum.
//
//     for (const EdgeSweep& sweep : sweep_edges(parse_pattern("d3d:4").points))
//         std::cout << sweep.degrees << ": " << sweep.levels << " levels\n";
//
// Points are those of sampling/pattern.h: in pixels from the pixel's centre, y down.
// Stability: evolving.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "bandlimit/core/point.h"

namespace bandlimit {

/// A half plane that moves across a pixel, and the share of the points that it covers.
struct EdgeSweep {
    double degrees = 0;         ///< direction of its normal and of its way, from +x towards +y
    int levels = 0;             ///< distinct coverages, 0 and 1 included
    std::vector<double> steps;  ///< by how much coverage jumps, from the first jump to the last; sum 1
    double max_gap = 0;         ///< longest way without a jump, in pixels; from the pixel's border to the first counts
    double rms = 0;             ///< root of the mean square of coverage less the exact area, over the whole way
};

/// The half plane goes over the pixel's whole projection: |cos| + |sin| pixels. Points whose projections differ by less
/// than 1e-5 of a pixel make one jump; those outside the pixel jump before the way begins, or after it.
/// throws   Error for no points and an angle that is not finite
/// cost     that of sorting the points
EdgeSweep sweep_edge(std::span<const Point> points, double degrees);

/// The directions in which patterns are compared: 0, 45, 90, 26.565 and -26.565 degrees; tan 26.565 is 1/2.
inline constexpr std::array sweep_degrees{0.0, 45.0, 90.0, 26.565, -26.565};
/// sweep_edge() in each of sweep_degrees.
std::vector<EdgeSweep> sweep_edges(std::span<const Point> points);

/// Over all boxes from the pixel's corner (-1/2, -1/2), the largest difference between the share of points inside and
/// the area. About 1 / n for the best of n points, 1 / sqrt(n) for random ones.
/// throws   Error for no points, and for points outside [-1/2, 1/2]
/// cost     count^2 log(count)
double star_discrepancy(std::span<const Point> points);

/// The same with the root of the mean square over all boxes in place of the largest (Warnock 1972).
/// throws   as star_discrepancy()
/// cost     count^2
double l2_discrepancy(std::span<const Point> points);

/// The least distance between two points of the pattern repeated in every pixel, in pixels: 1 for a single point.
/// throws   Error for no points
double least_distance(std::span<const Point> points);

/// |sum over points of exp(-2 pi i f p)|^2 / count on a grid of frequencies.
///
/// Where every pixel has the same pattern, only whole frequencies matter: what is not small there aliases to a
/// constant. Where each pixel has another, all do. The mean is 1 for random points.
struct PatternSpectrum {
    int width = 0;              ///< columns and rows
    double step = 1;            ///< cycles per pixel between them
    std::vector<double> power;  ///< row after row; the middle one is frequency 0, where it is the count of points

    double frequency(int i) const { return (i - width / 2) * step; }
    double at(int x, int y) const {
        return power[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

/// Frequencies from -highest to highest each way, `per_cycle` to each cycle per pixel.
/// throws   Error for no points, or a range or density outside 1 to 256
/// cost     count times the number of frequencies
PatternSpectrum pattern_spectrum(std::span<const Point> points, int highest = 8, int per_cycle = 1);

}  // namespace bandlimit
