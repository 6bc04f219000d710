// What a Resizer has worked out before it runs.
// Stability: inner.
#pragma once
#include <optional>
#include <vector>

#include "bandlimit/resample/bank.h"
#include "bandlimit/resample/byte_resize.h"
#include "bandlimit/resample/radial.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/resample/tiles.h"

namespace bandlimit {

/// Output columns [runs.front().first, runs.back().last) that are computed from top to bottom before the next ones, so
/// that what lies between source and output stays in the second cache, however wide the image is.
struct Strip {
    std::vector<TileRun> runs;
    IndexRange read;  ///< the source columns read; may reach outside the image

    int first() const { return runs.front().first; }
    int outputs() const { return runs.back().last - runs.front().first; }
};

struct ResizePlan {
    Grid src, dst;
    int channels;
    ResizeOptions options;
    Bank x, y;                         ///< of separable kernels
    std::optional<RadialBank> radial;  ///< instead of both
    bool x_first = false;
    std::vector<Strip> strips;             ///< of separable kernels
    std::optional<BytePlan> bytes;         ///< where codes of 8 bits run in integers; refers to x and y
    std::vector<Strip> strips_past_bytes;  ///< the columns that integers do not fit

    Edge edge_y() const { return options.edge_y.value_or(options.edge); }
    IndexRange rows_read(int first, int last) const {
        return radial ? radial->rows_read(first, last) : indices_read(y, first, last);
    }
    /// Whether the stored codes are what is to be filtered, and stored again as they come out.
    bool is_plain(const Encoding& from, const TargetRows& target) const {
        const Encoding& to = target.encoding;
        const bool multiplied = from.alpha >= 0 && options.premultiply && !from.associated;
        const bool converted = to.alpha >= 0 && (options.premultiply || from.associated) != to.associated;
        return from.transfer == Transfer::linear && to.transfer == Transfer::linear && !multiplied && !converted &&
               options.antiring == 0 && target.background.empty();
    }
};

}  // namespace bandlimit
