// Frames beside what they were made of and what they should be, to look at.
// Stability: inner.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit::job {

/// One frame in linear light, RGB or RGBA; the truth may be empty.
struct ComparedFrame {
    View<const float> input = {}, output = {}, truth = {};
};

/// Pictures of 8-bit sRGB codes, input, output and truth of each frame: of the last frames, up to 64 that hold eight
/// million pixels, the middle side by side at its own size; and all of up to eight frames, scaled down to fit a sheet.
/// The input is enlarged by repeating pixels.
/// memory   up to 24 MB
class TemporalPictures {
public:
    TemporalPictures(int width, int height, int frames);

    /// Whether frame i is shown anywhere.
    bool wants(int i) const { return is_animated(i) || column_of(i) >= 0; }
    /// Takes frame i, once and in order.
    void add(int i, const ComparedFrame& frame, const Parallel& parallel = {});

    /// Of one size, at most 960 pixels wide.
    std::vector<Image<std::uint8_t>> animation() && { return std::move(animation_); }
    /// A column per frame; rows are input, output and truth.
    Image<std::uint8_t> sheet() const;
    /// The frames of its columns.
    const std::vector<int>& columns() const { return columns_; }

private:
    bool is_animated(int i) const;
    int column_of(int i) const;

    int width_, height_, frames_;
    int panel_width_, panel_height_, animated_;
    std::vector<int> columns_;
    std::vector<std::vector<Image<std::uint8_t>>> cells_;  ///< column by column
    std::vector<Image<std::uint8_t>> animation_;
};

}  // namespace bandlimit::job
