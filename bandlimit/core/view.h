// Samples that somebody else owns.
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

namespace bandlimit {

/// Non-owning samples: (x, y, c) is data[x*dx + y*dy + c*dc].
///
/// Strides count elements and may be negative, so planar, interleaved, cropped, flipped and transposed pixels are one
/// type and cost nothing. A View never allocates and never checks: functions that take one check its shape.
template <class T>
struct View {
    T* data = nullptr;
    int width = 0, height = 0, channels = 1;
    std::ptrdiff_t dx = 1, dy = 0, dc = 0;

    T& operator()(int x, int y, int c = 0) const { return data[x * dx + y * dy + c * dc]; }
    operator View<const T>() const requires(!std::is_const_v<T>) { return {data, width, height, channels, dx, dy, dc}; }
};

template <class T>
View<T> transposed(View<T> v) {
    std::swap(v.width, v.height);
    std::swap(v.dx, v.dy);
    return v;
}

template <class T>
View<T> flipped_x(View<T> v) {
    v.data += (v.width - 1) * v.dx;
    v.dx = -v.dx;
    return v;
}

template <class T>
View<T> flipped_y(View<T> v) {
    v.data += (v.height - 1) * v.dy;
    v.dy = -v.dy;
    return v;
}

/// The cells [x, x + width) by [y, y + height) of `v`, which must lie inside it.
template <class T>
View<T> cropped(View<T> v, int x, int y, int width, int height) {
    v.data += x * v.dx + y * v.dy;
    v.width = width;
    v.height = height;
    return v;
}

/// `count` channels of `v`, from `first` on.
template <class T>
View<T> channels_of(View<T> v, int first, int count = 1) {
    v.data += first * v.dc;
    v.channels = count;
    return v;
}

/// Whether two views have the same width, height and number of channels.
template <class A, class B>
bool same_shape(const View<A>& a, const View<B>& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels;
}

}  // namespace bandlimit
