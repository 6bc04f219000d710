// What Edge::renormalize does to filters of two dimensions.
// Stability: inner.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "bandlimit/core/edge.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// A sum of weights, and of their magnitudes.
struct WeightSum {
    double sum = 0, magnitude = 0;
};

/// By how much each output is scaled so that what was dropped outside does not darken it: the sum of all weights over
/// the sum of those inside. Outputs that see the border in the same way share one number.
class BorderScale {
public:
    /// Scales nothing.
    BorderScale() = default;

    /// Of `weights`, the first of which multiplies the sample at (x + first_x, y + first_y), on width x height samples.
    /// Where an edge is not renormalize, nothing is dropped beyond it.
    /// cost    a number per kind of output: at most those of the weights
    /// throws  Error where all weights, or those inside, cancels() in kernel/taps.h, and where next to none are inside
    BorderScale(const WeightGrid& weights, int first_x, int first_y, int width, int height, Edge edge_x, Edge edge_y);

    /// The same of a sum of products, in memory for their columns and rows, not for the weights that they stand for.
    /// cost    a number per kind of output, each of which takes as many multiply-adds as there are terms
    BorderScale(const Terms& terms, int first_x, int first_y, int width, int height, Edge edge_x, Edge edge_y);

    /// Of a sum of products, whose sums along x and y are given for each output: inside_x[output][term].
    /// whole[term] are the two sums of each term where nothing is dropped. Throws as above.
    BorderScale(std::span<const std::pair<double, double>> whole, const std::vector<std::vector<double>>& inside_x,
                const std::vector<std::vector<double>>& inside_y);

    /// Scales samples of row y from column first_x on, channels interleaved.
    void apply(std::span<float> row, int first_x, int y, int channels) const;

private:
    /// Calls inside(a, b) for an output of every kind along x and y each, and fills the table of scales.
    template <class Inside>
    void fill(const WeightSum& whole, const std::vector<int>& example_x, const std::vector<int>& example_y,
              Inside inside);

    std::vector<int> kind_x_, kind_y_;  ///< of each output; 0: nothing is dropped. Empty: nothing is anywhere
    int kinds_x_ = 0;
    std::vector<float> scale_;  ///< by kind_y, then kind_x
};

}  // namespace bandlimit
