// What lies outside a row of samples.
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

/// The edge called `name`. Throws Error, listing the names, if there is none.
Edge parse_edge(std::string_view name);

/// The stored index that index i reads in n >= 1 samples, or -1 where nothing is read (zero and renormalize outside).
/// Any i is allowed, however far outside.
int resolve(int i, int n, Edge edge);

}  // namespace bandlimit
