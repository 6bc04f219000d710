// One row of weights per output sample.
// Stability: stable.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

/// Every separable linear operation: out[i] = sum_j row(i)[j] * in[first(i) + j].
///
/// A bank is data: it can be printed, plotted, tested, run backwards or turned into a shader. Outputs that see the
/// source at the same phase share one row of weights: 4096 to 2048 samples takes one row and those that touch an edge.
struct Bank {
    /// A row of weights, and which of them belong to the nearest samples (see `antiring` in resize.h).
    struct Row {
        std::size_t offset = 0;  ///< into `weights`
        int count = 0;           ///< >= 1
        int near_begin = 0, near_count = 1;
    };
    /// Which row an output uses, and the index of the sample that its first weight multiplies.
    struct Output {
        int first = 0;  ///< may lie outside [0, inputs): `edge` tells what is read there
        int row = 0;
    };

    int inputs = 0;
    Edge edge = Edge::clamp;  ///< under zero and renormalize no row reaches outside
    std::vector<float> weights;
    std::vector<Row> rows;
    std::vector<Output> outputs;

    int output_count() const { return static_cast<int>(outputs.size()); }
    int first(int output) const { return outputs[static_cast<std::size_t>(output)].first; }
    const Row& row_info(int output) const {
        return rows[static_cast<std::size_t>(outputs[static_cast<std::size_t>(output)].row)];
    }
    std::span<const float> row(int output) const {
        const Row& r = row_info(output);
        return std::span(weights).subspan(r.offset, static_cast<std::size_t>(r.count));
    }
};

/// The weights that resample `src` to `dst` by a separable kernel.
///
/// The kernel is widened to the pitch of `dst` where that is coarser (all but nearest), so that it limits the band.
/// Weights that are exactly 0 at the ends of a row are left out. The others, rounded to floats, add up to exactly 1 as
/// combine() adds them: what is 1 everywhere stays 1. (Under Edge::zero not the rows that are cut.)
/// Equal axes give one weight of 1 for kernels that interpolate. Phases of rational scale factors are computed exactly,
/// so that the bank of a part of `dst` (Axis::cells) holds the same bits as that part of the bank of the whole.
///
/// units    both axes in the same unit; dst may be flipped, and may reach beyond src
/// error    2^-23 per weight, where partial sums stay below 2; mostly one rounding of the weight per addition of the
///          row
/// throws   Error for counts < 1, an empty or not finite interval, a radial kernel, and under zero or renormalize
///          where an output has no weight inside the source
/// cost     one evaluation of the kernel per weight of a distinct row
Bank make_bank(const Kernel& kernel, const Axis& src, const Axis& dst, Edge edge);

/// About how much memory make_bank takes for a kernel of this radius, in bytes: known before anything is allocated.
std::uint64_t bank_bytes(double radius, const Axis& src, const Axis& dst);

/// The bank that applies `taps` as they are; those that sum to 1, within 1e-9, as floats that add up to exactly 1. dst
/// must be coarser than src by exactly taps.factor, in the same place.
///
/// throws   Error as above, for no or not finite weights, where the factor does not fit the axes, and for renormalize
///          with taps of sum 0
Bank make_bank(const Taps& taps, const Axis& src, const Axis& dst, Edge edge);

/// The bank of `count` >= 1 samples to count / taps.factor of them.
Bank make_bank(const Taps& taps, int count, Edge edge);

/// Weights of a kernel at one phase: what an output reads that lies `phase` to the right of sample 0, at equal pitch.
///
/// returns  taps normalised to sum 1, and that sum before; zeros at the ends left out
/// throws   Error for a radial kernel or where all weights are 0
struct PhaseWeights {
    Taps taps;
    double sum = 1;
};
PhaseWeights weights_at(const Kernel& kernel, double phase);

}  // namespace bandlimit
