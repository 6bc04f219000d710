// Zone plate, star, edge, lines and fence.
#include "bandlimit/scene/flat.h"

#include <cmath>
#include <numbers>

#include "bandlimit/scene/hash.h"
#include "bandlimit/scene/scenes.h"
#include "bandlimit/signal/coverage.h"

namespace bandlimit {
namespace {

Frame frame_of(const SceneSetting& setting) { return {double(setting.width), double(setting.height)}; }

constexpr Vector3 grey(double value) { return {value, value, value}; }

Scene scene_of(const Signal& signal, double speed) {
    return moved_scene(speed, [value = signal.value](double x, double y) { return grey(value(x, y)); });
}

/// Parallel lines without end.
struct Lines {
    UnitVector across;
    double period = 0, offset = 0, width = 0;
    Vector3 color;

    bool shows(double x, double y) const {
        const double t = across.along(x, y) - offset;
        return std::abs(t - period * std::round(t / period)) < width / 2;
    }
};

/// Hills below a sky, soft and with hard borders, in heights of the image.
Vector3 hills(double x, double y) {
    constexpr Vector3 colors[] = {{0.30, 0.42, 0.52}, {0.16, 0.30, 0.24}, {0.10, 0.20, 0.07}};
    Vector3 color = mix({0.25, 0.45, 0.85}, {0.95, 0.78, 0.60}, std::clamp(y * 1.6, 0.0, 1.0));
    if (std::hypot(x - 1.25, y - 0.27) < 0.09) color = {2.5, 2.2, 1.6};
    for (int i = 0; i < 3; ++i) {
        const double ridge = 0.48 + 0.16 * i +
                             (0.11 - 0.02 * i) * (smooth_noise(2.3 * x + 0.9 * i, 0, 40 + std::uint64_t(i)) - 0.5) +
                             0.02 * (smooth_noise(11 * x, 0, 50 + std::uint64_t(i)) - 0.5);
        if (y > ridge) color = colors[i] * (1 + 0.25 * smooth_noise(9 * x, 30 * y, 60 + std::uint64_t(i)));
    }
    return color;
}

/// The fence of `fence` at a point in pixels; nothing where one looks through.
std::optional<Vector3> fence(double x, double y, double height) {
    const double wires = y + 0.02 * x;  // they climb slowly, and cross every phase of the rows
    constexpr double widths[] = {0.2, 0.35, 0.6, 1.0};
    const double post = x - 61 * std::floor(x / 61 + 0.5);
    if (std::abs(post) < 1.6 && y > 0.12 * height) return Vector3{0.33, 0.2, 0.1};
    for (int i = 0; i < 4; ++i) {
        const double sag = 4e-4 * (post * post - 30.5 * 30.5);
        if (std::abs(wires + sag - (0.16 + 0.07 * i) * height) < widths[i] / 2) return Vector3{0.9, 0.92, 0.95};
    }
    // Pickets lean a little and are as wide as the row of the fence says: a whole pixel above, a third of it below.
    const double rows[] = {0.46, 0.62, 0.78, 0.94};
    for (int i = 0; i < 3; ++i) {
        if (y < rows[i] * height || y > rows[i + 1] * height) continue;
        if (y < rows[i] * height + 0.8) return Vector3{0.6, 0.55, 0.5};
        const double period = 5.3 - 0.9 * i, t = (x - 0.03 * y) / period;
        if (std::abs(t - std::round(t)) * period < (0.5 - 0.17 * i)) return Vector3{0.75, 0.72, 0.66};
    }
    return {};
}

}  // namespace

Scene zone_plate_scene(const SceneSetting& s) { return scene_of(zone_plate(frame_of(s)), s.speed); }
Scene edge_scene(const SceneSetting& s) { return scene_of(step_edge(frame_of(s)), s.speed); }

Scene siemens_scene(const SceneSetting& s) {
    constexpr double turn = std::numbers::pi / 180;  // a frame, clockwise
    const Point middle{s.width / 2.0, s.height / 2.0};
    const double radius = std::min(s.width, s.height) / 2.0;
    const auto look = [=, speed = s.speed, star = siemens_star(frame_of(s)).value](double x, double y, int frame) {
        const double dx = x - middle.x, dy = y - middle.y;
        const auto turned_back = [=](double angle) {
            const double c = std::cos(angle), sine = std::sin(angle);
            return Point{c * dx + sine * dy, c * dy - sine * dx};
        };
        const Point at_first = turned_back(turn * speed * frame), before = turned_back(turn * speed);
        FlatPoint p{grey(star(middle.x + at_first.x, middle.y + at_first.y)), 1, {}};
        if (speed != 0 && dx * dx + dy * dy <= radius * radius) p.motion = {before.x - dx, before.y - dy};
        return p;
    };
    return flat_scene(s.speed == 0, look);
}

Scene line_scene(const SceneSetting& s) {
    std::array<Lines, 8> families;
    constexpr double degrees[] = {2, 17, 38, 52, 71, 88, 117, 155}, widths[] = {1, 0.3, 0.5, 0.2, 0.7, 0.4, 0.25, 1.4};
    constexpr Vector3 colors[] = {{1, 1, 1},     {1, 0.75, 0.4}, {0.5, 0.8, 1}, {1, 1, 1},
                                  {0.6, 1, 0.6}, {1, 1, 1},      {1, 0.5, 0.5}, {0.8, 0.7, 1}};
    const double size = std::max(16, std::min(s.width, s.height));
    for (std::size_t i = 0; i < families.size(); ++i)
        families[i] = {direction_at(degrees[i]), size * (0.21 + 0.037 * double(i)), size * 0.11 * double(i), widths[i],
                       colors[i]};
    return moved_scene(s.speed, [families](double x, double y) {
        for (const Lines& lines : families)
            if (lines.shows(x, y)) return lines.color;
        return Vector3{0.01, 0.012, 0.02};
    });
}

Scene fence_scene(const SceneSetting& s) {
    return flat_scene(s.speed == 0, [speed = s.speed, height = double(s.height)](double x, double y, int frame) {
        if (const auto front = fence(x - speed * frame, y, height)) return FlatPoint{*front, 1, {-speed + 0.0, 0}};
        // Twice as far, it moves half as fast.
        return FlatPoint{hills((x - speed / 2 * frame) / height, y / height), 2, {-speed / 2 + 0.0, 0}};
    });
}

}  // namespace bandlimit
