// Scenes with a known truth: what any point of any frame shows, and how it moves, for tests of antialiasing in space
// and time.
//
//     Scene mover = make_scene("mover", 480, 270);
//     SceneSample s = mover.at(240.5, 135.5, 3);  // the middle of pixel (240, 135) of frame 3
//
// Common to all of them
//   units      positions in pixels of the image, (0, 0) its upper left corner, y down: pixel (i, j) covers
//              [i, i + 1] x [j, j + 1]. Scenes continue outside the image. Frames are numbered from 0, any number
//   colour     linear light, not multiplied by alpha; highlights go far above 1. Nothing is filtered: surfaces have no
//              mips, and what is thinner than a pixel is there or not
//   motion     where the point was in the frame before, minus where it is, in pixels; jitter plays no part in it. What
//              is far away (sky) moves too when the camera turns. Mirrored pictures and shadows move in their own way,
//              which the motion of the surface, as everywhere, does not tell
//   depth      along the camera's axis, not the distance to the eye; flat scenes have 1 (the background of fence: 2)
//   normals    unit vectors of the camera's space: x right, y up, z towards the camera; (0, 0, 1) in flat scenes and
//              in the sky. Leaves and blades of grass turn the side towards the camera that the ray meets
//   occlusion  the share of the hemisphere over the surface that is open, weighted by the cosine to the normal.
//              Spheres, boxes and the ground occlude; leaves, blades of grass and thin poles do not
//   threads    at() and color() may be called from several at once; they allocate nothing
//   cost       color(): 0.01 to 2 microseconds. at(): the same, and up to 5 microseconds for the truth of occlusion
// Stability: evolving.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// What a point shows.
struct SceneSample {
    std::array<double, 3> color{};
    double alpha = 1;  ///< 1: there is always something behind
    double depth = 1;
    Point motion{};
    std::array<double, 3> normal{0, 0, 1};
    std::array<double, 3> albedo{};  ///< 0 for the sky, which gives light and reflects none
    double ambient_occlusion = 1;    ///< the share of the hemisphere that is open, 0 to 1
    /// The depth that the point had in the frame before. If that frame shows a smaller one at the point's position
    /// then, something hid it: the point is disoccluded.
    double previous_depth = 1;
};

/// The depth of what is infinitely far away.
inline constexpr double sky_depth = 1e10;

struct Scene {
    std::string name, summary;
    bool is_still = false;  ///< whether all frames are alike
    std::function<SceneSample(double x, double y, int frame)> at;
    /// at().color alone, which is quicker: for the many samples of a pixel.
    std::function<std::array<double, 3>(double x, double y, int frame)> color;
    /// The distance of the image plane from the eye, in pixels, straight before the middle of the image; 0: flat.
    /// The point seen at (x, y) is depth * ((x - width / 2) / focal, (height / 2 - y) / focal, -1) in camera space.
    double focal = 0;
};

struct SceneOptions {
    /// How fast things and camera move: 1 is the scene's own speed, 0 makes it still. Scenes that are still by
    /// themselves move by so many pixels a frame to the right; default: 0 for these, 1 for others.
    std::optional<double> speed = {};
    int occlusion_rays = 0;  ///< rays for ambient occlusion, other ones in every point; 0: its truth, to about 1 %
};

/// The names of all scenes: zoneplate, siemens, edge, line, fence, glyphs, plane, mover, highlight, foliage.
const std::vector<std::string>& scene_names();
/// Whether it is one of them.
bool is_scene(std::string_view name);
/// What the scene of that name shows, in one line. Throws as make_scene().
const std::string& scene_summary(std::string_view name);

/// The scene of that name for an image of width x height.
/// throws  Error for another name, listing them, for a size below 1, a speed that is not within -1e4 to 1e4, and a
///         number of rays that is not within 0 to 1e6
Scene make_scene(std::string_view name, int width, int height, const SceneOptions& options = {});

/// The same scene in pixels `x` times as wide and `y` times as high, both above 0: what the input of an upscaler sees,
/// whose output ought to be `scene`.
Scene with_larger_pixels(const Scene& scene, double x, double y);

}  // namespace bandlimit
