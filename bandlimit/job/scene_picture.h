// Frames of scenes as picture files.
//
//     job::ScenePictureJob job{.scene = "plane", .size = {480, 270}, .out = "plane_003.exr", .frame = 3};
//     job.sampling.jitter = {0.25, -0.125};
//     job::scene_picture(job);
//
// EXR files get all channels of scene/render_scene.h, by the names given there, in 32-bit floats: R, G, B, A, Depth.Z,
// Vector.X, Vector.Y, Normal.X, Normal.Y, Normal.Z, Albedo.R, Albedo.G, Albedo.B, AO. Vector is in pixels, y down: where
// the point was in the frame before, minus where it is. Files of other formats get the colour alone.
// Stability: evolving.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/job/signals.h"
#include "bandlimit/scene/render_scene.h"

namespace bandlimit::job {

struct ScenePictureJob {
    std::string scene;  ///< a name of scene_names()
    PatternSize size;
    std::string out{};  ///< the extension names the format
    int frame = 0;
    SceneSampling sampling{};
    SceneOptions options{};
    std::optional<Depth> depth{};  ///< default: f32 for formats of linear light, else u8; f32 alone for EXR
    int tile = 0;                  ///< as ImageTarget
};

struct ScenePictureReport {
    int channels = 0;
    Depth depth = Depth::f32;
    Transfer transfer = Transfer::linear;
    double seconds_rendering = 0, seconds_writing = 0;
};

/// Throws Error for what the options alone show to be wrong.
void check(const ScenePictureJob& job);

/// Draws a frame into a file, a band of rows at a time.
///
/// memory   some 30 MB, or two rows if they take more
/// throws   OptionError for options as check(); std::runtime_error for files; Stopped. The file appears whole or not
///          at all
ScenePictureReport scene_picture(const ScenePictureJob& job, const Context& context = {});

}  // namespace bandlimit::job
