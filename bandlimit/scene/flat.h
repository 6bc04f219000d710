// Scenes without depth: pictures that move as a whole.
// Stability: inner.
#pragma once
#include <algorithm>
#include <utility>

#include "bandlimit/scene/scene.h"
#include "bandlimit/scene/vector3.h"

namespace bandlimit {

/// What a point of a picture shows.
struct FlatPoint {
    Vector3 color{};
    double depth = 1;
    Point motion{};
};

/// A scene of what `look(x, y, frame)` returns.
template <class Look>
Scene flat_scene(bool is_still, Look look) {
    Scene scene;
    scene.is_still = is_still;
    scene.color = [look](double x, double y, int frame) -> std::array<double, 3> {
        const Vector3 color = look(x, y, frame).color;
        return {color.x, color.y, color.z};
    };
    scene.at = [look = std::move(look)](double x, double y, int frame) {
        const FlatPoint p = look(x, y, frame);
        SceneSample s;
        s.color = s.albedo = {p.color.x, p.color.y, p.color.z};
        s.depth = s.previous_depth = p.depth;
        s.motion = p.motion;
        return s;
    };
    return scene;
}

/// A picture that moves to the right by `speed` pixels a frame.
template <class Color>
Scene moved_scene(double speed, Color color) {
    return flat_scene(speed == 0, [speed, color = std::move(color)](double x, double y, int frame) {
        return FlatPoint{color(x - speed * frame, y), 1, {-speed + 0.0, 0}};
    });
}

}  // namespace bandlimit
