// Number formats of files, and their conversion to float and back.
// Stability: stable.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <variant>

#include "bandlimit/color/half.h"
#include "bandlimit/core/image.h"

namespace bandlimit {

/// How a sample is stored. Integers hold [0, 1]: code / 255 or code / 65535.
enum class Depth { u8, u16, f16, f32 };

std::span<const Depth> all_depths();
std::string_view name_of(Depth depth);
/// Throws Error, listing the names.
Depth parse_depth(std::string_view name);
constexpr bool is_integer(Depth depth) { return depth == Depth::u8 || depth == Depth::u16; }
/// Bytes of one sample.
std::size_t size_of(Depth depth);

/// A view of samples whose depth is known at run time; std::visit reaches the typed one.
using AnyView = std::variant<View<std::uint8_t>, View<std::uint16_t>, View<Half>, View<float>>;
using AnyConstView =
    std::variant<View<const std::uint8_t>, View<const std::uint16_t>, View<const Half>, View<const float>>;

using AnyImage = std::variant<Image<std::uint8_t>, Image<std::uint16_t>, Image<Half>, Image<float>>;

/// A new image of the given depth.
AnyImage make_image(Depth depth, int width, int height, int channels, Layout layout = Layout::interleaved);
AnyView view_of(AnyImage& image);

/// The same samples, read only.
AnyConstView const_view(const AnyView& view);
/// Rows [first, first + count) of a view.
AnyView rows_of(const AnyView& view, int first, int count);
AnyConstView rows_of(const AnyConstView& view, int first, int count);
Depth depth_of(const AnyConstView& view);

/// Like check_apart() for two views.
void check_apart(const char* function, const AnyConstView& source, const AnyView& target);

/// The dimensions of a view.
struct ViewShape {
    int width = 0, height = 0, channels = 0;
};
ViewShape shape_of(const AnyView& view);
ViewShape shape_of(const AnyConstView& view);

/// Code to value: exact for 0 and the largest code, otherwise correctly rounded.
inline float from_code(std::uint8_t code) { return static_cast<float>(code) / 255.0f; }
inline float from_code(std::uint16_t code) { return static_cast<float>(code) / 65535.0f; }

/// Value to code: clamped to [0, 1] and rounded to nearest. Values that are not finite become 0.
///
/// The product is exact in double for every float, so the rounding is that of the exact value. Written without
/// branches, for loops over rows.
template <class Code>
Code to_code(double value) {
    constexpr double largest = std::numeric_limits<Code>::max(), infinity = std::numeric_limits<double>::infinity();
    const double positive = value > 0 && value < infinity ? value : 0;
    const double clamped = positive < 1 ? positive : 1;
    return static_cast<Code>(static_cast<int>(clamped * largest + 0.5));
}

}  // namespace bandlimit
