#include "bandlimit/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/scene/scenes.h"

namespace bandlimit {
namespace {

struct Entry {
    std::string name, summary;
    double speed;  ///< by default
    Scene (*make)(const SceneSetting&);
};

const std::array<Entry, 10>& entries() {
    static const std::array<Entry, 10> list{{
        {"zoneplate", "Rings whose frequency grows with the distance from the centre", 0, zone_plate_scene},
        {"siemens", "A rotating star of spokes", 1, siemens_scene},
        {"edge", "A slanted step from black to white", 0, edge_scene},
        {"line", "Bright lines of sub-pixel width at many angles", 0, line_scene},
        {"fence", "Pickets and wires of sub-pixel width before hills that move half as fast", 0, fence_scene},
        {"glyphs", "Lines of text-like glyphs, 6 to 40 pixels high", 0, glyphs_scene},
        {"plane", "A checkered plane to the horizon, spheres and boxes; the camera drives through", 1, plane_scene},
        {"mover", "A spinning box and a rolling ball before a camera at rest", 1, mover_scene},
        {"highlight", "A glossy ball in the sun, and lamps; the camera swings", 1, highlight_scene},
        {"foliage", "Leaves and grass that sway, cut out of cards", 1, foliage_scene},
    }};
    return list;
}

const Entry& entry(std::string_view name) {
    std::string names;
    for (const Entry& e : entries()) {
        if (e.name == name) return e;
        names += (names.empty() ? "" : ", ") + e.name;
    }
    fail("scene \"", name, "\" is unknown; choose one of: ", names);
}

}  // namespace

const std::vector<std::string>& scene_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Entry& e : entries()) list.push_back(e.name);
        return list;
    }();
    return names;
}

bool is_scene(std::string_view name) {
    return std::any_of(entries().begin(), entries().end(), [&](const Entry& e) { return e.name == name; });
}

const std::string& scene_summary(std::string_view name) { return entry(name).summary; }

Scene make_scene(std::string_view name, int width, int height, const SceneOptions& options) {
    const Entry& e = entry(name);
    if (width < 1 || height < 1)
        fail("make_scene: size ", width, " x ", height, "; pass a width and height of at least 1");
    const double speed = options.speed.value_or(e.speed);
    if (!(speed >= -1e4 && speed <= 1e4)) fail("make_scene: speed = ", speed, "; pass -10000 to 10000");
    if (options.occlusion_rays < 0 || options.occlusion_rays > 1000000)
        fail("make_scene: occlusion_rays = ", options.occlusion_rays, "; pass 0 (the truth) to 1000000");
    Scene scene = e.make({width, height, speed, options.occlusion_rays});
    scene.name = e.name, scene.summary = e.summary;
    return scene;
}

Scene with_larger_pixels(const Scene& scene, double x, double y) {
    if (!(x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)))
        fail("with_larger_pixels: ", x, " x ", y, " times as large; pass numbers above 0");
    Scene seen = scene;
    seen.at = [at = scene.at, x, y](double px, double py, int frame) {
        SceneSample sample = at(px * x, py * y, frame);
        sample.motion.x /= x, sample.motion.y /= y;
        return sample;
    };
    seen.color = [color = scene.color, x, y](double px, double py, int frame) { return color(px * x, py * y, frame); };
    seen.focal = scene.focal / x;
    return seen;
}

}  // namespace bandlimit
