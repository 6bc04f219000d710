// Kernels of the distance: weighted sums over discs of samples.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/mapping.h"

namespace bandlimit {

/// Resamples by a radial kernel, a row of outputs at a time, by a direct loop over the samples within the radius.
///
/// The kernel is widened per axis to the pitch of the target where that is coarser (to an ellipse, if the axes differ).
/// Weights are normalised for each output; under renormalize and zero samples outside are left out (zero keeps the
/// weights of the whole disc as the divisor). The kernel, which may jump at its radius but nowhere else, is read from a
/// table with linear interpolation. What is 1 everywhere stays exactly 1, but beside borders under zero.
///
/// error   of the table: below 1e-7 of the peak; sums are fused multiply-adds in float, row by row: the same bits for
///         any number of threads and any part of the target
/// cost    about 4 radius^2 multiply-adds per sample and channel (radius after widening), and as many table look-ups
///         per pair of distinct phases; no vector instructions
/// throws  Error for a separable kernel, and as Mapping
class RadialBank {
public:
    RadialBank(const Kernel& kernel, const Axis& src_x, const Axis& dst_x, const Axis& src_y, const Axis& dst_y,
               Edge edge_x, Edge edge_y);

    /// The rows of the source [begin, end) that output rows [first, last) read; they may lie outside it.
    IndexRange rows_read(int first, int last) const;
    int source_height() const { return height_; }

    /// Computes output row y from source rows with interleaved channels: rows[v] for each v of rows_read(y, y + 1),
    /// where rows that the edge of y does not read may be null.
    void row(int y, ConstLines rows, int channels, float antiring, float* out) const;

private:
    struct Disc;  ///< the weights of one output
    Disc disc_at(const Position& x, const Position& y) const;
    double table_value(double distance) const;

    Mapping x_, y_;
    int width_, height_, outputs_;
    Edge edge_x_, edge_y_;
    double radius_;
    double density_ = 1;         ///< table intervals per unit
    std::vector<double> table_;  ///< of the kernel from 0 up to the radius
    double at_radius_ = 0;       ///< what it is there
};

}  // namespace bandlimit
