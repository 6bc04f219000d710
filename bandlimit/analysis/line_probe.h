// Measuring the weights of a resizer from its output.
//
// A single impulse shows one weight, which drowns in the rounding of 8-bit codes. So all trains of impulses that fit
// between each other are shown at once: band k of the probe shows column j high or low by the sign of a Hadamard
// matrix, and the inverse of that matrix separates the trains again. The noise of a weight falls with the square root
// of the number of bands.
//
// Source: Harwit & Sloane, Hadamard Transform Optics, 1979; the columns of a Sylvester matrix except the constant one.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/image.h"

namespace bandlimit {

/// A scale as the ratio of two sizes, in lowest terms: to samples of the target for every `from` of the source.
struct Ratio {
    int to = 1, from = 1;

    double scale() const { return static_cast<double>(to) / from; }
    /// Source samples per target sample.
    double step() const { return static_cast<double>(from) / to; }
    /// Source samples per sample of the coarser grid: by how much a kernel is widened that limits the band.
    double stretch() const { return to < from ? step() : 1; }
    bool shrinks() const { return to < from; }
    /// Whether positions fall on more phases than the few that say nothing of a table's resolution.
    bool is_whole() const { return to == 1 || from == 1; }
};

/// The ratio nearest to `scale` whose larger number is at most 128.
///
/// throws  Error unless it is within 1e-6 of `scale`, and within 1/8 to 8
Ratio ratio_of(double scale);

/// The layout of a probe: `order` bands below each other, constant along y, each as tall as the filter may reach.
struct LineProbe {
    Ratio ratio;
    double reach = 5;  ///< radius of the widest kernel that is measured whole, in pitches of the coarser grid
    int inputs = 0, outputs = 0;  ///< samples along x
    int order = 0;                ///< bands: a power of 2
    int band = 0;                 ///< source rows of a band

    /// Distance of the impulses of a train: inputs at that distance cannot be distinguished.
    int period() const { return order - 1; }
    int height() const { return order * band; }
    int out_height() const { return height() / ratio.from * ratio.to; }
};

/// The smallest layout that measures kernels up to `reach` at every phase that occurs, away from the borders and at
/// them. Throws Error unless 1 <= reach <= 16.
LineProbe line_probe(const Ratio& ratio, double reach = 5);

/// The probe, drawn in two values.
/// shapes   [inputs x height() x 1]
Image<float> draw(const LineProbe& probe, float low, float high);

/// Weights that were measured: those of output i by the input's index modulo `period`.
struct MeasuredBank {
    Ratio ratio;
    double reach = 5;
    int inputs = 0, outputs = 0, period = 0;
    std::vector<double> weights;  ///< [outputs][period]
    double bias = 0;              ///< mean of what came out less the mean of what went in, away from the borders
    double noise = 0;  ///< standard deviation of a weight, by the rounding of codes the caller states; 0 if exact

    std::vector<double>::const_iterator row(int output) const {
        return weights.begin() + std::ptrdiff_t(output) * period;
    }
    /// The weight of input j, which must lie within half a period of the output's own place.
    double weight(int output, int j) const { return row(output)[((j % period) + period) % period]; }
    /// The outputs [begin, end) whose kernel lies inside the source.
    int interior_begin() const;
    int interior_end() const { return outputs - interior_begin(); }
    /// Where output i lies among the source samples if both images share their corners.
    double corner_position(int output) const;
};

/// Separates the trains in `result`, a probe after the resizer.
///
/// shapes   result [outputs x out_height() x 1], in the light that was filtered, as `low` and `high` are
/// error    weights of kernels beyond probe.reach come out on the wrong inputs; noise / ((high - low) / 2 sqrt(order))
///          for a result with noise of that standard deviation
/// throws   Error for another shape or low == high
MeasuredBank measure(const LineProbe& probe, View<const float> result, double low, double high, double noise = 0);

}  // namespace bandlimit
