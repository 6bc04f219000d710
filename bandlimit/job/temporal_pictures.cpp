#include "bandlimit/job/temporal_pictures.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/color/encoding.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::job {
namespace {

constexpr int most_animated = 64, most_pixels = 8'000'000;
constexpr int most_columns = 8, most_width = 960, gap = 4;
constexpr int most_panel_width = (most_width - 2 * gap) / 3, most_panel_height = 200;
constexpr int most_cell = (most_width - 7 * gap) / most_columns;

/// RGB of a picture, whose pixels are repeated to fill width x height.
Image<float> enlarged(View<const float> picture, int width, int height) {
    Image<float> result(width, height, 3, Layout::interleaved);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                result.view()(x, y, c) = std::clamp(picture(static_cast<int>((x + 0.5) * picture.width / width),
                                                            static_cast<int>((y + 0.5) * picture.height / height), c),
                                                    0.0f, 1.0f);
    return result;
}

/// Its sRGB codes; rows of `linear` lie interleaved.
Image<std::uint8_t> codes_of(View<const float> linear) {
    Image<std::uint8_t> codes(linear.width, linear.height, 3, Layout::interleaved);
    for (int y = 0; y < linear.height; ++y)
        encode_row({&linear(0, y), static_cast<std::size_t>(linear.width) * 3}, false, codes.view(), y,
                   {.transfer = Transfer::srgb});
    return codes;
}

Image<std::uint8_t> white(int width, int height) {
    Image<std::uint8_t> picture(width, height, 3, Layout::interleaved);
    std::fill_n(picture.view().data, std::ptrdiff_t{3} * width * height, std::uint8_t{255});
    return picture;
}

void paste(const Image<std::uint8_t>& from, Image<std::uint8_t>& to, int x, int y) {
    for (int row = 0; row < from.height(); ++row)
        std::copy_n(&from.view()(0, row), std::ptrdiff_t{3} * from.width(), &to.view()(x, y + row));
}

}  // namespace

TemporalPictures::TemporalPictures(int width, int height, int frames)
    : width_(width),
      height_(height),
      frames_(frames),
      panel_width_(std::min(width, most_panel_width)),
      panel_height_(std::min(height, most_panel_height)),
      animated_(std::min(most_animated, most_pixels / (3 * panel_width_ * panel_height_))) {
    const int count = std::min(frames, most_columns);
    for (int i = 0; i < count; ++i)
        columns_.push_back(count == 1 ? 0 : static_cast<int>(std::lround(double(i) * (frames - 1) / (count - 1))));
}

bool TemporalPictures::is_animated(int i) const { return i >= frames_ - animated_; }

int TemporalPictures::column_of(int i) const {
    const auto found = std::ranges::find(columns_, i);
    return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

void TemporalPictures::add(int i, const ComparedFrame& frame, const Parallel& parallel) {
    if (!wants(i)) return;
    const double shrink = std::min(1.0, double(most_cell) / std::max(width_, height_));
    const int cell_width = std::max(1, static_cast<int>(width_ * shrink)),
              cell_height = std::max(1, static_cast<int>(height_ * shrink));
    const int panels = frame.truth.width > 0 ? 3 : 2;
    Image<std::uint8_t> strip = white(panels * (panel_width_ + gap) - gap, panel_height_);
    std::vector<Image<std::uint8_t>> cells;
    int at = 0;
    for (const View<const float>& picture : {frame.input, frame.output, frame.truth}) {
        if (picture.width == 0) continue;
        const Image<float> whole = enlarged(picture, width_, height_);
        paste(codes_of(cropped(whole.view(), (width_ - panel_width_) / 2, (height_ - panel_height_) / 2, panel_width_,
                               panel_height_)),
              strip, at, 0);
        at += panel_width_ + gap;
        if (column_of(i) < 0) continue;
        cells.push_back(
            codes_of(resample(whole.view(), cell_width, cell_height, {}, parallel, Layout::interleaved).view()));
    }
    if (is_animated(i)) animation_.push_back(std::move(strip));
    if (!cells.empty()) cells_.push_back(std::move(cells));
}

Image<std::uint8_t> TemporalPictures::sheet() const {
    if (cells_.empty()) return {};
    const int step_x = cells_[0][0].width() + gap, step_y = cells_[0][0].height() + gap;
    Image<std::uint8_t> sheet =
        white(static_cast<int>(cells_.size()) * step_x - gap, static_cast<int>(cells_[0].size()) * step_y - gap);
    for (std::size_t column = 0; column < cells_.size(); ++column)
        for (std::size_t row = 0; row < cells_[column].size(); ++row)
            paste(cells_[column][row], sheet, static_cast<int>(column) * step_x, static_cast<int>(row) * step_y);
    return sheet;
}

}  // namespace bandlimit::job
