// Pointers to lines by the indices that a bank reads.
// Stability: inner.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "bandlimit/resample/bank.h"

namespace bandlimit {

/// The indices that outputs [first, last) of `bank` read.
IndexRange indices_read(const Bank& bank, int first, int last);

/// A table of line pointers that may be indexed by any index in a range: edges cost one entry each, and no branch in
/// the inner loop.
class LineTable {
public:
    /// line_of(i) gives the line of the stored sample i; each index is resolved by the bank's edge.
    template <class LineOf>
    LineTable(const Bank& bank, IndexRange range, LineOf line_of) : begin_(range.begin) {
        for (int v = range.begin; v < range.end; ++v) lines_.push_back(line_of(resolve(v, bank.inputs, bank.edge)));
    }
    /// Points to the entry of index 0, which need not exist itself.
    const float* const* at_zero() const { return lines_.data() - begin_; }

private:
    std::vector<const float*> lines_;
    std::ptrdiff_t begin_;
};

}  // namespace bandlimit
