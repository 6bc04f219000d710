// What makes `bandlimit pattern` draw a scene.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "apps/console/common.h"
#include "bandlimit/job/scene_picture.h"

namespace bandlimit::app {

struct SceneRequest {
    job::ScenePictureJob job;
    std::vector<Option> options = {};  ///< those that only scenes have

    bool is_asked_for() const;  ///< one of them is given
};

/// Adds --frame, --jitter, --spp, --speed and --ao-rays.
void add_scene_options(Verb kind, SceneRequest& scene);

/// What is the same for scenes and signals, read from the command line.
struct DrawingOptions {
    std::string out, size;
    std::optional<Depth> depth;
    int tile = 0;
    Parallel parallel;
    bool json = false;
};

/// Throws what the command line alone shows to be wrong.
void check_scene(const SceneRequest& scene, const DrawingOptions& drawing);
void run_scene(const SceneRequest& scene, const DrawingOptions& drawing, Console& console);

}  // namespace bandlimit::app
