// The pictures that an audit shows beside the line probe, and what their results tell.
// Stability: inner.
#pragma once
#include "bandlimit/analysis/audit.h"

namespace bandlimit {

/// Checkerboards and constant greys, one below the other.
Image<float> light_scene(const Ratio& ratio, double code);
LightReport read_light(View<const float> result, const Ratio& ratio, double code);

/// Colour beside transparent colour, a checkerboard of alpha, and a half transparent constant. 4 channels.
Image<float> alpha_scene(const Ratio& ratio);
AlphaReport read_alpha(View<const float> result, const Ratio& ratio, double code);

/// A zone plate, impulses and edges, of values that are linear in `light`.
struct PictureScene {
    Ratio ratio;
    Light light;
    double code = 0;
    int width = 0, strip = 0;  ///< source pixels; the plate is width x width, three strips lie below it

    int height() const { return width + 3 * strip; }
    int target(int source) const { return source / ratio.from * ratio.to; }
};
PictureScene picture_scene(const Ratio& ratio, Light light, double code);
Image<float> draw(const PictureScene& scene);
/// Whether impulses became products of a column and a row; `rest` is the share, in amplitude, of what did not.
std::optional<bool> is_separable(const PictureScene& scene, View<const float> result, double& rest);
/// Fills what a scale's report tells of pictures; its kernels must be known already.
void read_pictures(const PictureScene& scene, View<const float> result, ScaleReport& report);

}  // namespace bandlimit
