// Pictures for tests of mip chains, and how they are read.
#pragma once
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

#include "bandlimit/math/random.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {

inline std::vector<Role> all_roles() {
    std::vector<Role> roles;
    for (const RoleTraits& traits : role_table()) roles.push_back(traits.role);
    return roles;
}

/// An interleaved picture of f(x, y, c).
template <class T, class F>
Image<T> picture(int width, int height, int channels, F f) {
    Image<T> image(width, height, channels, Layout::interleaved);
    const View<T> v = image.view();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) v(x, y, c) = static_cast<T>(f(x, y, c));
    return image;
}

inline Image<std::uint8_t> noise_codes(int width, int height, int channels, std::uint64_t seed = 1) {
    Random random(seed);
    return picture<std::uint8_t>(width, height, channels, [&](int, int, int) { return random.bits() >> 24 & 255; });
}

/// A sample as a number: codes as codes.
inline double sample(const AnyImage& image, int x, int y, int c = 0) {
    return std::visit(
        [&](const auto& i) -> double {
            const auto value = i.view()(x, y, c);
            if constexpr (std::is_same_v<decltype(value), const Half>) return static_cast<double>(to_float(value));
            else return static_cast<double>(value);
        },
        image);
}
inline int width_of(const AnyImage& image) {
    return std::visit([](const auto& i) { return i.width(); }, image);
}
inline int height_of(const AnyImage& image) {
    return std::visit([](const auto& i) { return i.height(); }, image);
}
inline int channels_of(const AnyImage& image) {
    return std::visit([](const auto& i) { return i.channels(); }, image);
}

/// The largest difference between samples of two images of one shape.
inline double difference(const AnyImage& a, const AnyImage& b) {
    double most =
        width_of(a) == width_of(b) && height_of(a) == height_of(b) && channels_of(a) == channels_of(b) ? 0 : INFINITY;
    if (most > 0) return most;
    for (int y = 0; y < height_of(a); ++y)
        for (int x = 0; x < width_of(a); ++x)
            for (int c = 0; c < channels_of(a); ++c)
                most = std::max(most, std::abs(sample(a, x, y, c) - sample(b, x, y, c)));
    return most;
}

inline const Encoding srgb_alpha{Transfer::srgb, 3, false}, linear_alpha{Transfer::linear, 3, false}, plain{};
inline const TexelFormat rgba8_srgb{4, Depth::u8, true, false}, rgba8{4, Depth::u8, false, false},
    r8{1, Depth::u8, false, false}, rg8{2, Depth::u8, false, false}, r32f{1, Depth::f32, false, false},
    rgba32f{4, Depth::f32, false, false};

}  // namespace bandlimit
