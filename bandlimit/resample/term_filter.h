// Filters that are sums of separable ones.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/kernel/terms.h"
#include "bandlimit/resample/bank.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// A product of banks.
struct BankTerm {
    Bank x, y;
    double sum_x = 1, sum_y = 1;  ///< of the weights of outputs that drop nothing
};

/// Where weights that are the same for every output run.
struct FilterDomain {
    int width = 0, height = 0;  ///< of source and output
    Edge edge_x = Edge::renormalize, edge_y = Edge::renormalize;
    bool premultiply = true;  ///< colours are filtered multiplied by alpha
};

/// A sum of products over an image.
///
/// Each source row is filtered along x by all terms once, and the results are kept while outputs need them; along y all
/// terms that read the same rows are one weighted sum. So a term costs the multiply-adds of its two passes only. A row
/// of one weight is no pass at all, but a shift: weights in two dimensions that are no sum of few products run as one
/// such term per column (direct_terms()), which is the direct convolution, by the same loop.
///
/// Under Edge::renormalize, what lies outside is dropped from the whole sum, and the rest of it is rescaled.
///
/// shapes  at least one term; all x have the same inputs, outputs and edge, and all y
/// range   any; a NaN reaches only the outputs whose rectangle of weights, of one term at least, covers it
/// error   dot_bound() of the weights along x and of those of all terms along y; same bits for any number of threads
/// memory  per thread about 1 MiB, more where a few columns of what an output reads take more
/// throws  Error for no terms, and where Edge::renormalize has nothing to rescale
RowFilter term_filter(std::vector<BankTerm> terms, bool premultiply);

/// The same for every output: weight (0, 0) of `terms` multiplies the sample at (x + first_x, y + first_y).
///
/// throws  Error as expanded(), for weights that are not finite, width or height < 1, and as above
RowFilter term_filter(const Terms& terms, int first_x, int first_y, const FilterDomain& domain);

/// `weights` as a term per column that is not all 0, and at least one: what term_filter() runs directly.
Terms direct_terms(const WeightGrid& weights);

}  // namespace bandlimit
