// Non-owning views of samples.
// Stability: stable.
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

namespace bandlimit {

/// Non-owning samples: (x, y, c) is data[x*dx + y*dy + c*dc].
///
/// interleaved() and planar() make one. Strides count elements and may be negative, so planar, interleaved, cropped, flipped and transposed pixels are one
/// type and cost nothing. A View never allocates and never checks: functions that take one check its shape.
template <class T>
struct View {
    T* data = nullptr;
    int width = 0, height = 0, channels = 1;
    std::ptrdiff_t dx = 1, dy = 0, dc = 0;

    T& operator()(int x, int y, int c = 0) const { return data[x * dx + y * dy + c * dc]; }
    operator View<const T>() const requires(!std::is_const_v<T>) { return {data, width, height, channels, dx, dy, dc}; }
};

/// Pixels whose channels lie side by side, row after row: `row_stride` elements from one row to the next, width *
/// channels if it is 0, and negative for rows stored from the bottom up (`data` is the top one in either case).
///
/// example  interleaved(bytes, 640, 480, 4, pitch)   // a picture of RGBA bytes inside a larger one
template <class T>
View<T> interleaved(T* data, int width, int height, int channels, std::ptrdiff_t row_stride = 0) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(width) * channels;
    return {data, width, height, channels, channels, row_stride != 0 ? row_stride : row, 1};
}

/// Pixels whose channels lie in planes: one element apart along a row, `row_stride` from one row to the next (0: width)
/// and `plane_stride` from one channel to the next (0: height rows).
template <class T>
View<T> planar(T* data, int width, int height, int channels = 1, std::ptrdiff_t row_stride = 0,
               std::ptrdiff_t plane_stride = 0) {
    const std::ptrdiff_t row = row_stride != 0 ? row_stride : width;
    return {data, width, height, channels, 1, row, plane_stride != 0 ? plane_stride : row * height};
}

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
