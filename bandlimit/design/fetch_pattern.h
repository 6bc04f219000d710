// Symmetric arrangements of bilinear reads, whose positions and weights are optimised together.
// Stability: inner.
#pragma once
#include <utility>
#include <vector>

#include "bandlimit/design/symmetric_grid.h"

namespace bandlimit {

/// The texels that reads lie between: texel c at origin + step * c from the output, along either axis, in samples of
/// the finer picture. Enlarging by 2, texels are 2 such samples apart, and `origin` is that of one output of four.
struct TexelLattice {
    double origin = 0.5;
    int step = 1;

    bool is_shrinking() const { return step == 1; }
};
TexelLattice lattice_of(const RateGoal& goal);

/// A distance along an axis: between texels `cell` and `cell` + 1, at the part `part` of the way.
struct Reach {
    int cell = 0;
    double part = 0.5;  ///< 0 to 1
};

/// Reads at (x, y), and at its images: mirrored and swapped, or only swapped where pictures grow.
struct Ring {
    int x = 0, y = 0;  ///< which reach; on_axis for the distance 0

    static constexpr int on_axis = -1;
};

struct FetchPattern {
    std::vector<Reach> reaches;
    std::vector<Ring> rings;

    // What optimize() found.
    std::vector<double> weights = {};  ///< of one fetch of each ring; the sum over all fetches is 1
    /// The grid's, plus what samplers add that round positions.
    double error = std::numeric_limits<double>::infinity();
};

/// How many fetches an output takes: of a ring, and of all.
int fetch_count(const Ring& ring, const TexelLattice& lattice);
int fetch_count(const FetchPattern& pattern, const TexelLattice& lattice);

/// The numbers of the grid's points that the ring reads.
std::vector<std::size_t> points_read(const FetchPattern& pattern, const Ring& ring, const SymmetricGrid& grid,
                                     const TexelLattice& lattice);

/// Sets the best weights for where the pattern reads; an infinite error if none keep the goal's limits. That of the
/// gain is kept at samples of the band, or everywhere if `exact`.
void weigh(FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal, bool exact);

/// Moves all reads within their cells, and weighs them, until nothing improves: Gauss-Newton steps on positions and
/// weights at once, damped as Levenberg and Marquardt do. A limit of the gain is kept at samples of the band.
void optimize(FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal);

/// All reads of the pattern, in texels from the output that output_texel() says.
Fetches fetches_of(const FetchPattern& pattern, const TexelLattice& lattice);

}  // namespace bandlimit
