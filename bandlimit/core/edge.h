// What lies outside a row of samples.
// Stability: stable.
#pragma once
#include <span>
#include <string_view>

namespace bandlimit {

/// How samples outside [0, n) are read. Sample -1 of [a b c d] is: clamp a, reflect a (and -2 b), wrap d, zero 0;
/// renormalize drops it and rescales the other weights of the row to the sum the whole row had.
enum class Edge { clamp, reflect, wrap, zero, renormalize };

/// All five, in the order of the enum.
std::span<const Edge> all_edges();

/// "clamp", "reflect", ...
std::string_view name_of(Edge edge);

/// The edge called `name`. Throws Error, listing the names, for any other.
Edge parse_edge(std::string_view name);

/// The stored index that index i reads in n >= 1 samples, or -1 if nothing is read (zero and renormalize, outside).
/// Any i is allowed, however far outside.
int resolve(int i, int n, Edge edge);

/// The indices [begin, end); where they are what is read, begin may be negative and end beyond the samples.
struct IndexRange {
    int begin = 0, end = 0;

    int count() const { return end - begin; }
};

/// A range of the `n` stored indices that holds all that `read` leads to; {0, 0} if that is none. The smallest, but
/// where indices wrap, or n and more are read.
IndexRange stored_indices(IndexRange read, int n, Edge edge);

}  // namespace bandlimit
