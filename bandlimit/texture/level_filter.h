// What makes a level of a mip chain from a larger one.
#pragma once
#include <variant>

#include "bandlimit/resample/term_filter.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {

/// A MipFilter ready to run between two grids.
class LevelFilter {
public:
    struct Options {
        Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
        bool premultiply = true;
    };
    /// throws  Error as Resizer and TermFilter
    LevelFilter(const MipFilter& filter, const Grid& src, const Grid& dst, int channels, const Options& options);

    /// As Resizer::run, of whole images, without background.
    bool run(const SourceRows& source, const TargetRows& target, Parallel parallel) const;

private:
    std::variant<Resizer, TermFilter> filter_;
};

/// How far the weights of an output reach to either side, in source samples, with `step` of them per output.
int reach_of(const MipFilter& filter, double step);

}  // namespace bandlimit
