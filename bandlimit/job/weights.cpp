#include "bandlimit/job/weights.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/kernel/shapes.h"

namespace bandlimit::job {
namespace {

ConvolutionWeights weights_of(const Taps& taps, TapsAxis axis) {
    const Taps one{0, {1}};
    const Taps &x = axis == TapsAxis::y ? one : taps, &y = axis == TapsAxis::x ? one : taps;
    return {Terms{{y.weights, x.weights}}, x.first, y.first};
}

/// Bilinear reads as the weights of the four samples about each.
ConvolutionWeights weights_of(const Fetches& fetches, const std::string& name) {
    constexpr double most = 2048;
    double left = 0, right = 0, top = 0, bottom = 0;
    for (const Fetch& f : fetches) {
        left = std::min(left, std::floor(f.x)), right = std::max(right, std::floor(f.x) + 1);
        top = std::min(top, std::floor(f.y)), bottom = std::max(bottom, std::floor(f.y) + 1);
    }
    if (!(right - left <= most && bottom - top <= most))
        throw std::runtime_error(fmt::format("{}: fetches lie {} x {} texels apart; the limit is {}", name,
                                             right - left, bottom - top, most));
    WeightGrid grid(static_cast<int>(right - left) + 1, static_cast<int>(bottom - top) + 1);
    for (const Fetch& f : fetches) {
        const int x = static_cast<int>(std::floor(f.x) - left), y = static_cast<int>(std::floor(f.y) - top);
        const double u = f.x - std::floor(f.x), v = f.y - std::floor(f.y);
        grid.at(x, y) += f.weight * (1 - u) * (1 - v);
        grid.at(x + 1, y) += f.weight * u * (1 - v);
        grid.at(x, y + 1) += f.weight * (1 - u) * v;
        grid.at(x + 1, y + 1) += f.weight * u * v;
    }
    return {grid, static_cast<int>(left), static_cast<int>(top)};
}

template <class... Values>
[[noreturn]] void refuse(fmt::format_string<Values...> format, Values&&... values) {
    throw OptionError(fmt::format(format, std::forward<Values>(values)...));
}

/// The mean of a sample's colours.
double weight_of(const float* sample, const ImageInfo& in) {
    const bool has_colour = in.channels() > 1;
    double sum = 0;
    for (int c = 0; c < in.channels(); ++c)
        if (c != in.alpha || !has_colour) sum += static_cast<double>(sample[c]);
    return sum / (in.channels() - (in.alpha >= 0 && has_colour ? 1 : 0));
}

}  // namespace

bool is_shape_name(const std::string& text) {
    const bool has_path = text.find('/') != std::string::npos;
    return !has_path && (text.find(':') != std::string::npos || text.find('.') == std::string::npos);
}

WeightGrid read_weights(const std::string& path, Space space, int largest_side) {
    ImageReader reader(path);
    const ImageInfo& in = reader.info();
    if (largest_side > 0 && std::max(in.width, in.height) > largest_side)
        throw std::runtime_error(fmt::format("{}: {} x {} samples are too many for a kernel; pass at most {} x {}",
                                             path, in.width, in.height, largest_side, largest_side));
    const std::uint64_t samples = static_cast<std::uint64_t>(in.width) * static_cast<std::uint64_t>(in.height);
    require_memory(samples * sizeof(double), "weights of " + path);
    Encoding encoding = in.encoding(space);
    encoding.alpha = in.alpha, encoding.associated = in.associated;
    PictureRows rows(reader, encoding, true, 1);
    Image<float> row(in.width, 1, in.channels(), Layout::interleaved);
    WeightGrid grid(in.width, in.height);
    for (int y = 0; y < in.height; ++y) {
        rows.read(y, row.view());
        for (int x = 0; x < in.width; ++x) {
            const double weight = weight_of(&row.view()(x, 0), in);
            if (!std::isfinite(weight))
                throw std::runtime_error(
                    fmt::format("{}: the weight at {}, {} is {}; weights must be finite", path, x, y, weight));
            grid.at(x, y) = weight;
        }
    }
    return grid;
}

WeightGrid shape_or_image(const std::string& text, Space space, int largest_side) {
    if (!is_shape_name(text)) return read_weights(text, space, largest_side);
    WeightGrid shape = parse_shape(text);
    if (shape.width > largest_side)
        fail("shape \"", text, "\": ", shape.width, " samples to a side; pass at most ", largest_side);
    return shape;
}

ConvolutionWeights weights_of(const TapsFile& file, const std::string& name, TapsAxis axis, double radius) {
    if (file.factor != 1)
        refuse(
            "{}: made for a factor of {}, and a convolution keeps the size; resize with it, or use weights of "
            "factor 1",
            name, file.factor);
    if (axis != TapsAxis::both && !file.taps) refuse("{}: has no taps of one axis; leave the axis out", name);
    if (radius > 0 && (file.components.empty() || !file.terms.empty()))
        refuse("{}: has its size; leave the radius out, which only components without terms need", name);
    if (file.taps) return weights_of(*file.taps, axis);
    if (!file.terms.empty()) return centred(file.terms);
    if (!file.fetches.empty()) return weights_of(file.fetches, name);
    if (radius > 0) return centred(separable_terms(file.components, radius, reach_for(file.components, radius)));
    if (is_kernel(file)) refuse("{}: holds a kernel, whose weights depend on a scale; resize with it", name);
    if (file.components.empty()) refuse("{}: holds no weights; pass taps, fetches, terms or components", name);
    refuse("{}: has components, which fit any radius; pass a radius in pixels", name);
}

}  // namespace bandlimit::job
