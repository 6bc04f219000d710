// Buffers of rows between source and output.
// Stability: inner.
#pragma once
#include <cstddef>
#include <vector>

#include "bandlimit/core/allocator.h"
#include "bandlimit/core/view.h"
#include "bandlimit/resample/combine.h"

namespace bandlimit {

/// Rows of interleaved floats, side by side.
class Rows {
public:
    Rows() = default;
    Rows(int count, std::size_t length)
        : pitch_((length + 15) / 16 * 16 + 16 * 9),  // no power of two: rows must not share places in a cache
          samples_(static_cast<std::size_t>(count) * pitch_),
          pointers_(static_cast<std::size_t>(count)) {
        for (std::size_t i = 0; i < pointers_.size(); ++i) pointers_[i] = samples_.data() + i * pitch_;
    }
    float* operator[](int i) { return pointers_[static_cast<std::size_t>(i)]; }
    Lines lines() const { return pointers_.data(); }

    /// Rows first, first + step, ... as an image of `count` rows.
    View<float> view(int first, int count, int width, int channels, int step = 1) {
        return {(*this)[first], width, count, channels, channels, step * static_cast<std::ptrdiff_t>(pitch_), 1};
    }

private:
    std::size_t pitch_ = 0;
    std::vector<float, SampleAllocator<float>> samples_;
    std::vector<float*> pointers_;
};

}  // namespace bandlimit
