// Lists of bilinear reads as sums of separable banks.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/kernel/fetches.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {

/// One of the products that a list of fetches is the sum of.
struct FetchTerm {
    std::vector<LinearRead> x, y;
};

/// The fetches as a sum of products along x and y: the fewest rows of equal patterns, at most one per distinct y.
/// downsample8() takes three: its four inner reads, and its two arms.
std::vector<FetchTerm> separate(const Fetches& fetches);

/// The banks that halve src to dst by fetches, whose offsets are stretched by the ratio of the pitches to 2.
///
/// throws  Error for no fetches, weights or offsets that are not finite, and as Mapping
std::vector<BankTerm> bank_terms(const Fetches& fetches, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y);

/// The banks of taps, which leave an axis alone that keeps its size. Throws Error as make_bank.
std::vector<BankTerm> bank_terms(const Taps& taps, const Grid& src, const Grid& dst, Edge edge_x, Edge edge_y);

}  // namespace bandlimit
