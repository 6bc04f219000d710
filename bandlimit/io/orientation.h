// Upright pictures.
// Stability: inner.
#pragma once
#include "bandlimit/core/view.h"

namespace bandlimit {

/// Whether the upright picture has the width and height of the stored one exchanged.
constexpr bool is_sideways(int orientation) { return orientation >= 5; }
/// Whether the rows of the upright picture are those of the stored one, in the same order.
constexpr bool keeps_rows(int orientation) { return orientation <= 2; }

/// The upright picture that is stored as `v`.
///
/// `orientation` is the Exif tag, 1 to 8; it says where the first stored row and the first stored column are: 1 top and
/// left, 2 top and right, 3 bottom and right, 4 bottom and left, 5 left and top, 6 right and top, 7 right and bottom,
/// 8 left and bottom.
/// source   CIPA DC-008 (Exif), tag 274
template <class T>
View<T> upright(View<T> v, int orientation) {
    if (is_sideways(orientation)) v = transposed(v);
    const bool flip_x = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool flip_y = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    if (flip_x) v = flipped_x(v);
    if (flip_y) v = flipped_y(v);
    return v;
}

}  // namespace bandlimit
