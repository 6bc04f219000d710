// Frames of scenes as images.
//
//     Image<float> frame = render_scene(make_scene("plane", 480, 270), 480, 270, 3, {.jitter = {0.25, -0.125}});
//     View<float> motion = channels_of(frame.view(), scene_channel::motion, 2);
// Stability: evolving.
#pragma once
#include <array>
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/scene/scene.h"

namespace bandlimit {

/// The first channel of each part of a rendered scene.
namespace scene_channel {
inline constexpr int color = 0, alpha = 3, depth = 4, motion = 5, normal = 7, albedo = 10, ambient_occlusion = 13;
inline constexpr int count = 14;
}  // namespace scene_channel

/// What these channels are called in files. Beware: Vector is in pixels, y down, and says where the point was in the
/// frame before, minus where it is; other programs write y up.
inline constexpr std::array<const char*, scene_channel::count> scene_channel_names{
    "R",        "G",        "B",        "A",        "Depth.Z",  "Vector.X", "Vector.Y",
    "Normal.X", "Normal.Y", "Normal.Z", "Albedo.R", "Albedo.G", "Albedo.B", "AO"};

/// Where a frame is sampled.
struct SceneSampling {
    Point jitter =
        {};  ///< pixels, y down, up to 1e3: pixel (i, j) is sampled around (i + 0.5 + jitter.x, j + 0.5 + jitter.y)
    int samples = 1;  ///< per pixel, 1 to 1048576, at pixel_positions()
};

/// Where `samples` of a pixel lie, from its middle, in [-1/2, 1/2): a regular grid if their number is a square, else
/// the sequence R2 (Roberts 2018), which begins in the middle. Throws Error unless there are 1 to 1048576.
std::vector<Point> pixel_positions(int samples);

/// Throws the Error with which render_scene() would refuse this sampling.
void check_sampling(const SceneSampling& sampling);

/// Draws rows [first_row, first_row + image.height) of a frame. Colour is the mean over the samples of the pixel, all
/// with the same weight, in linear light; everything else is that of the middle of the (jittered) pixel, so that edges
/// of depth and motion are hard even where those of colour are smooth.
///
/// shapes   image [width x rows x 14]
/// cost     a Scene::at() per pixel, and a Scene::color() per sample if there are several. Same bits for any number of
///          threads and for any part of the frame
/// throws   Error for another number of channels and a sampling out of range; Stopped
void render_scene(const Scene& scene, int frame, const SceneSampling& sampling, int first_row, View<float> image,
                  const Parallel& parallel = {});

/// All of a frame of width x height, which should be those of the scene.
Image<float> render_scene(const Scene& scene, int width, int height, int frame, const SceneSampling& sampling = {},
                          const Parallel& parallel = {});

}  // namespace bandlimit
