// Owning images.
// Stability: stable.
#pragma once
#include <cstddef>
#include <vector>

#include "bandlimit/core/allocator.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

/// How the channels of an Image lie in memory.
enum class Layout {
    planar,      ///< all of channel 0, then all of channel 1, ...
    interleaved  ///< the channels of a pixel side by side, as most files store them
};

/// Owning, zeroed samples. Moves; copies only when asked, with clone().
///
/// shapes   width, height >= 0, channels >= 1; rows are not padded
/// throws   Error for a negative size or no channel; std::bad_alloc if memory runs out
template <class T>
class Image {
public:
    Image() = default;
    explicit Image(int width, int height, int channels = 1, Layout layout = Layout::planar)
        : width_(width), height_(height), channels_(channels), layout_(layout) {
        if (width < 0 || height < 0 || channels < 1)
            fail("Image: size ", width, " x ", height, " x ", channels,
                 "; need width and height of at least 0 and at least 1 channel");
        samples_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
    }
    Image(Image&&) noexcept = default;
    Image& operator=(Image&&) noexcept = default;

    Image clone() const {
        Image copy;
        copy.samples_ = samples_;
        copy.width_ = width_, copy.height_ = height_, copy.channels_ = channels_, copy.layout_ = layout_;
        return copy;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    View<T> view() { return view_of(samples_.data()); }
    View<const T> view() const { return view_of(samples_.data()); }

private:
    template <class U>
    View<U> view_of(U* data) const {
        return layout_ == Layout::interleaved ? interleaved(data, width_, height_, channels_)
                                              : planar(data, width_, height_, channels_);
    }

    std::vector<T, SampleAllocator<T>> samples_;
    int width_ = 0, height_ = 0, channels_ = 1;
    Layout layout_ = Layout::planar;
};

}  // namespace bandlimit
