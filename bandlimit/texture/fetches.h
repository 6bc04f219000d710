// Filters that are sums of separable ones, as lists of bilinear reads are.
#pragma once
#include <span>
#include <vector>

#include "bandlimit/resample/resize.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {

/// One of the products that a list of fetches is the sum of.
struct FetchTerm {
    std::vector<LinearRead> x, y;
};

/// The fetches as a sum of products along x and y: the fewest rows of equal patterns, at most one per distinct y.
/// downsample8() takes three: its four inner reads, and its two arms.
std::vector<FetchTerm> separate(const Fetches& fetches);

/// Runs sums of products of banks over whole images.
///
/// Under Edge::renormalize, what lies outside is dropped from the whole sum, and the rest of it is rescaled.
/// memory  per thread the source rows that 16 output rows read, in floats
/// cost    of each term that of its banks
class TermFilter {
public:
    /// throws  Error for no fetches, weights or offsets that are not finite, and where all that an output reads is
    ///         dropped
    TermFilter(const Fetches& fetches, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y, bool premultiply);
    /// One term of taps, which leave an axis alone that keeps its size.
    TermFilter(const Taps& taps, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y, bool premultiply);

    /// As Resizer::run, of whole images, without background.
    bool run(const SourceRows& source, const TargetRows& target, Parallel parallel) const;

private:
    struct Term {
        Bank x, y;
        std::vector<double> sum_x, sum_y;  ///< of the weights per output that are not dropped
    };
    bool rows(const SourceRows& source, const TargetRows& target, int first, int last) const;
    void add_term(Bank x, Bank y, double whole_x, double whole_y);
    Image<float> source_rows(const SourceRows& source, int begin, int end) const;
    void rescale(std::span<float> row, int y, int channels) const;
    double sum_at(int x, int y) const;
    void find_borders();

    std::vector<Term> terms_;
    std::vector<char> border_x_, border_y_;  ///< which outputs lack some of the weights
    double whole_ = 0;                       ///< of all weights
    Edge edge_x_, edge_y_;
    bool premultiply_;
};

}  // namespace bandlimit
