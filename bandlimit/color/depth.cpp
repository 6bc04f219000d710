#include "bandlimit/color/depth.h"

#include <array>

#include "bandlimit/core/error.h"
#include "bandlimit/core/overlap.h"

namespace bandlimit {
namespace {

constexpr std::array depths{Depth::u8, Depth::u16, Depth::f16, Depth::f32};
constexpr std::array<std::string_view, depths.size()> names{"u8", "u16", "f16", "f32"};

}  // namespace

std::span<const Depth> all_depths() { return depths; }

std::string_view name_of(Depth depth) { return names[static_cast<std::size_t>(depth)]; }

Depth parse_depth(std::string_view name) {
    for (const Depth depth : depths)
        if (name_of(depth) == name) return depth;
    fail("depth \"", name, "\" is unknown; choose u8, u16, f16 or f32");
}

std::size_t size_of(Depth depth) { return depth == Depth::u8 ? 1 : depth == Depth::f32 ? 4 : 2; }

AnyImage make_image(Depth depth, int width, int height, int channels, Layout layout) {
    switch (depth) {
        case Depth::u8: return Image<std::uint8_t>(width, height, channels, layout);
        case Depth::u16: return Image<std::uint16_t>(width, height, channels, layout);
        case Depth::f16: return Image<Half>(width, height, channels, layout);
        case Depth::f32: break;
    }
    return Image<float>(width, height, channels, layout);
}

AnyView view_of(AnyImage& image) {
    return std::visit([](auto& i) -> AnyView { return i.view(); }, image);
}

AnyView rows_of(const AnyView& view, int first, int count) {
    return std::visit([&](auto v) -> AnyView { return cropped(v, 0, first, v.width, count); }, view);
}

AnyConstView rows_of(const AnyConstView& view, int first, int count) {
    return std::visit([&](auto v) -> AnyConstView { return cropped(v, 0, first, v.width, count); }, view);
}

ViewShape shape_of(const AnyView& view) { return shape_of(const_view(view)); }

ViewShape shape_of(const AnyConstView& view) {
    return std::visit([](const auto& v) { return ViewShape{v.width, v.height, v.channels}; }, view);
}

AnyConstView const_view(const AnyView& view) {
    return std::visit([](auto v) -> AnyConstView { return View<const std::remove_pointer_t<decltype(v.data)>>(v); },
                      view);
}

void check_apart(const char* function, const AnyConstView& source, const AnyView& target) {
    std::visit([&](const auto& from, const auto& to) { check_apart(function, from, to); }, source, target);
}

Depth depth_of(const AnyConstView& view) { return depths[view.index()]; }

}  // namespace bandlimit
