// Whether views share memory.
// Stability: inner.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "bandlimit/core/view.h"

namespace bandlimit {

/// The bytes that the samples of a view take.
struct Footprint {
    std::uintptr_t address = 0;                     ///< of sample (0, 0, 0)
    std::int64_t sample = 0;                        ///< bytes of one
    std::array<std::int64_t, 3> counts{}, steps{};  ///< along x, y and channels; steps in bytes, of any sign
};

template <class T>
Footprint footprint_of(const View<T>& v) {
    constexpr auto bytes = static_cast<std::int64_t>(sizeof(T));
    return {reinterpret_cast<std::uintptr_t>(v.data),
            bytes,
            {v.width, v.height, v.channels},
            {v.dx * bytes, v.dy * bytes, v.dc * bytes}};
}

/// Whether a byte belongs to samples of both. Bytes between samples belong to neither: the halves of a picture, its
/// channels, or its even and odd rows do not overlap, though their addresses alternate.
///
/// Exact, except for views of the same memory whose strides differ so much that an exact answer would take more than
/// 100,000 steps: these count as overlapping.
/// cost    negligible if one lies entirely before the other, or both have the same strides
bool overlap(const Footprint& a, const Footprint& b);

/// Throws Error, in the name of `function`, where source and target of a filter overlap.
void check_apart(const char* function, const Footprint& source, const Footprint& target);

template <class S, class T>
void check_apart(const char* function, const View<S>& source, const View<T>& target) {
    check_apart(function, footprint_of(source), footprint_of(target));
}

}  // namespace bandlimit
