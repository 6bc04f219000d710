// Rows as codecs want them: channels side by side, pixels side by side. Not for callers.
// Stability: inner.
#pragma once
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "bandlimit/core/view.h"

namespace bandlimit {

/// Whether every row lies as files have it, one behind the other.
template <class T>
bool is_packed(const View<T>& v) {
    return (v.channels == 1 || v.dc == 1) && v.dx == v.channels &&
           (v.height == 1 || v.dy >= static_cast<std::ptrdiff_t>(v.width) * v.channels);
}

/// Rows of one picture side by side in memory.
template <class T>
View<T> packed_view(T* data, int width, int height, int channels) {
    return {data, width, height, channels, channels, static_cast<std::ptrdiff_t>(width) * channels, 1};
}

/// Copies samples between views of one shape that do not overlap.
template <class T>
void copy_samples(const std::type_identity_t<View<const T>>& from, const View<T>& to) {
    const bool by_rows = is_packed(cropped(from, 0, 0, from.width, 1)) && is_packed(cropped(to, 0, 0, to.width, 1));
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(from.width) * from.channels;
    for (int y = 0; y < from.height; ++y) {
        if (by_rows) {
            std::copy_n(&from(0, y), row, &to(0, y));
            continue;
        }
        for (int x = 0; x < from.width; ++x)
            for (int c = 0; c < from.channels; ++c) to(x, y, c) = from(x, y, c);
    }
}

}  // namespace bandlimit
