// Whether two programs computed the same.
#pragma once
#include <span>

#include "bench/cases.h"

namespace bandlimit::bench {

/// In codes; floats count as 255 times their value.
struct Difference {
    double largest = 0, mean = 0;
};

/// Of two targets of a case, over levels of at least 64 x 64 samples without 8 at each border, where edge rules show.
Difference difference(const Case& c, std::span<const std::byte> a, std::span<const std::byte> b);

}  // namespace bandlimit::bench
