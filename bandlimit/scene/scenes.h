// One function per scene. `speed` is that of SceneOptions; name and summary are set by make_scene().
// Stability: inner.
#pragma once
#include "bandlimit/scene/scene.h"

namespace bandlimit {

struct SceneSetting {
    int width = 1, height = 1;
    double speed = 0;
    int occlusion_rays = 0;
};

Scene zone_plate_scene(const SceneSetting& setting);
Scene siemens_scene(const SceneSetting& setting);
Scene edge_scene(const SceneSetting& setting);
Scene line_scene(const SceneSetting& setting);
Scene fence_scene(const SceneSetting& setting);
Scene glyphs_scene(const SceneSetting& setting);
Scene plane_scene(const SceneSetting& setting);
Scene mover_scene(const SceneSetting& setting);
Scene highlight_scene(const SceneSetting& setting);
Scene foliage_scene(const SceneSetting& setting);

}  // namespace bandlimit
