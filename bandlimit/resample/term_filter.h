// Filters that are sums of separable ones.
#pragma once
#include <span>
#include <vector>

#include "bandlimit/kernel/terms.h"
#include "bandlimit/resample/border_scale.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {

/// A product of banks.
struct BankTerm {
    Bank x, y;
    double sum_x = 1, sum_y = 1;  ///< of the weights of outputs that drop nothing
};

/// Runs sums of products over images, from stored samples to stored samples, by contiguous blocks of rows.
///
/// Each source row is filtered along x by all terms once, and the results are kept while outputs need them; along y all
/// terms that read the same rows are one weighted sum. So a term costs the multiply-adds of its two passes only. A row
/// of one weight is no pass at all, but a shift: weights in two dimensions that are no sum of few products run as one
/// such term per column (direct_terms()), which is the direct convolution, by the same loop.
///
/// Under Edge::renormalize, what lies outside is dropped from the whole sum, and the rest of it is rescaled.
///
/// range   any; a NaN reaches only the outputs whose rectangle of weights, of one term at least, covers it
/// error   dot_bound() of the weights along x and of those of all terms along y; same bits for any number of threads
/// memory  per thread about 1 MiB, more where a few columns of what an output reads take more
class TermFilter {
public:
    /// shapes  at least one term; all x have the same inputs, outputs and edge, and all y
    /// throws  Error for no terms, and where Edge::renormalize has nothing to rescale
    TermFilter(std::vector<BankTerm> terms, bool premultiply);

    /// The same for every output: weight (0, 0) of `terms` multiplies the sample at (x + first_x, y + first_y).
    ///
    /// throws  Error as expanded(), for weights that are not finite, width or height < 1, and as above
    TermFilter(const Terms& terms, int first_x, int first_y, int width, int height, Edge edge_x, Edge edge_y,
               bool premultiply);

    /// About how much memory run() takes, in bytes.
    std::uint64_t bytes(int channels, Parallel parallel) const;

    /// The stored source rows [begin, end) that output rows [first, last) are made of.
    IndexRange rows_needed(int first, int last) const;

    /// As Resizer::run, without background.
    bool run(const SourceRows& source, const TargetRows& target, Parallel parallel) const;

private:
    friend class TermRun;
    struct Strip;
    /// What makes the line of a term from a source row.
    struct Line {
        Bank x = {};            ///< where outputs have weights of their own
        bool is_shift = false;  ///< else: the source row itself, `index` columns to the right,
        int index = 0;          ///< or what row `index` of shared_x_ makes of it
    };
    /// Terms [first, first + count) that read the same rows for each output. Sample v of term first + t is line
    /// v * count + t of the bank.
    struct Group {
        int first = 0, count = 0;
        Bank y;
    };

    void add_group(std::span<const BankTerm> terms);
    std::vector<Strip> strips(int channels, Parallel parallel) const;
    Bank bank_of_chunks(int columns, int channels) const;
    IndexRange columns_read(int first, int last) const;
    IndexRange rows_read(int first, int last) const;
    static IndexRange rows_read(const Group& group, int first, int last);
    bool is_shared() const { return taps_x_ > 0; }
    int computed() const { return static_cast<int>(lines_.size()) - shifts_; }

    std::vector<Line> lines_;  ///< of each term
    int shifts_ = 0;           ///< how many are shifts
    Bank shared_x_;            ///< a row per term that is none, where all outputs have the same weights
    std::vector<Group> groups_;
    int first_x_ = 0, taps_x_ = 0;  ///< of weights that all outputs share
    int width_ = 0, height_ = 0, source_width_ = 0, source_height_ = 0;
    Edge edge_x_ = Edge::clamp, edge_y_ = Edge::clamp;
    BorderScale border_;
    bool premultiply_;
};

/// `weights` as a term per column that is not all 0, and at least one: what TermFilter runs directly.
Terms direct_terms(const WeightGrid& weights);

}  // namespace bandlimit
