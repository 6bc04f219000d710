#include "apps/kernel_grid.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "apps/pictures.h"
#include "bandlimit/core/error.h"
#include "bandlimit/kernel/shapes.h"

namespace bandlimit::app {

bool is_shape_name(const std::string& text) {
    const bool has_path = text.find('/') != std::string::npos;
    return !has_path && (text.find(':') != std::string::npos || text.find('.') == std::string::npos);
}

WeightGrid read_weights(const std::string& text, Space space, int largest_side) {
    if (is_shape_name(text)) {
        WeightGrid shape = parse_shape(text);
        if (shape.width > largest_side)
            fail("shape \"", text, "\": ", shape.width, " samples to a side; pass at most ", largest_side);
        return shape;
    }
    {
        const ImageReader reader(text);
        const ImageInfo& info = reader.info();
        if (info.width > largest_side || info.height > largest_side)
            throw std::runtime_error(fmt::format("{}: {} x {} samples are too many for a kernel; pass at most {} x {}",
                                                 text, info.width, info.height, largest_side, largest_side));
        if (info.alpha >= 0)
            throw std::runtime_error(fmt::format("{}: has alpha, and a kernel has none; save it without", text));
    }
    const Image<float> picture = read_picture(text, space);
    const View<const float> view = picture.view();
    WeightGrid grid(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            for (int c = 0; c < view.channels; ++c) grid.at(x, y) += static_cast<double>(view(x, y, c));
            grid.at(x, y) /= view.channels;
        }
    }
    return grid;
}

std::string shape_lines() {
    std::string lines;
    for (const ShapeInfo& info : shape_list())
        lines += fmt::format("{}{}: {}", lines.empty() ? "" : "\n", info.name, info.summary);
    return lines;
}

}  // namespace bandlimit::app
