#include "bandlimit/scene/looks.h"

#include <algorithm>
#include <numbers>

#include "bandlimit/scene/hash.h"

namespace bandlimit {
namespace {

Paint paint_of(const Look& look, const Vector3& color) { return {color, color * look.glow, look.mirror}; }
Paint either(const Look& look, bool is_bright) { return paint_of(look, is_bright ? look.bright : look.dark); }

/// Coordinates on the side of a box.
struct Side {
    double u = 0, v = 0;
};
Side side_at(const Look& look, const Vector3& p, const Vector3& normal) {
    // Components of a normal that was turned back and forth are not exactly 0 and 1.
    if (std::abs(normal.x) > 0.5) return {p.z * look.scale, p.y * look.scale};
    if (std::abs(normal.y) > 0.5) return {p.x * look.scale, p.z * look.scale};
    return {p.x * look.scale, p.y * look.scale};
}

double part(double x) { return x - std::floor(x); }

}  // namespace

Paint plain(const Look& look, const Vector3&, const Vector3&) { return paint_of(look, look.bright); }

Paint spotted(const Look& look, const Vector3& p, const Vector3&) {
    const double spots = smooth_noise(p.x * look.scale, p.z * look.scale + 3 * p.y, 3);
    return paint_of(look, mix(look.dark, look.bright, spots));
}

Paint checkered_ground(const Look& look, const Vector3& p, const Vector3&) {
    const double x = p.x * look.scale, z = p.z * look.scale;
    const bool is_bright = (parity(x) ^ parity(z)) != 0;
    const auto tint =
        hash_unit(static_cast<std::int64_t>(std::floor(x / 4)), static_cast<std::int64_t>(std::floor(z / 4)), 5);
    Paint paint = either(look, is_bright);
    paint.albedo = paint.albedo * mix({1, 0.8, 0.62}, {0.72, 0.9, 1}, tint);
    return paint;
}

Paint checkered_sphere(const Look& look, const Vector3& p, const Vector3& normal) {
    constexpr double pi = std::numbers::pi;
    const double around = std::atan2(p.z, p.x) / (2 * pi), up = std::acos(std::clamp(normal.y, -1.0, 1.0)) / pi;
    return either(look, (parity(around * look.scale) ^ parity(up * look.scale / 2)) != 0);
}

Paint ringed_sphere(const Look& look, const Vector3&, const Vector3& normal) {
    const double up = std::acos(std::clamp(normal.y, -1.0, 1.0)) / std::numbers::pi;
    return either(look, parity(up * 2 * look.scale) != 0);
}

Paint checkered_box(const Look& look, const Vector3& p, const Vector3& normal) {
    const Side side = side_at(look, p, normal);
    return either(look, (parity(side.u) ^ parity(side.v)) != 0);
}

Paint lined_box(const Look& look, const Vector3& p, const Vector3& normal) {
    const Side side = side_at(look, p, normal);
    return either(look, part(side.u) < 0.1 || part(side.v) < 0.1);
}

Paint bricks(const Look& look, const Vector3& p, const Vector3& normal) {
    const Side side = side_at(look, p, normal);
    const double row = std::floor(2 * side.v), u = side.u + 0.5 * parity(row), v = 2 * side.v - row;
    if (part(u) < 0.07 || v < 0.14) return paint_of(look, look.dark);
    const double shade = hash_unit(static_cast<std::int64_t>(std::floor(u)), static_cast<std::int64_t>(row), 9);
    return paint_of(look, look.bright * (0.7 + 0.5 * shade));
}

Vector3 cloudy_sky(const Vector3& d) {
    if (d.y < 0) return {0.30, 0.28, 0.25};
    const Vector3 clear = mix({0.72, 0.80, 0.88}, {0.13, 0.28, 0.62}, std::sqrt(d.y));
    const double u = 1.6 * d.x / (d.y + 0.25), v = 1.6 * d.z / (d.y + 0.25);
    double noise = 0, weight = 0.5;
    for (int octave = 0, scale = 1; octave < 4; ++octave, scale *= 2, weight /= 2)
        noise += weight * smooth_noise(u * scale + 7 * octave, v * scale, 20);
    const double cloud = std::clamp((noise - 0.46) * 3.2, 0.0, 1.0) * std::clamp(d.y * 6, 0.0, 1.0);
    return mix(clear, {0.92, 0.91, 0.9}, 0.9 * cloud);
}

Vector3 evening_sky(const Vector3& d) {
    if (d.y < 0) return {0.04, 0.035, 0.03};
    const double height = std::sqrt(d.y);
    return mix(mix({0.85, 0.42, 0.18}, {0.28, 0.18, 0.30}, std::min(1.0, 2 * height)), {0.03, 0.05, 0.14},
               std::clamp(2 * height - 1, 0.0, 1.0));
}

}  // namespace bandlimit
