// What surfaces and skies look like.
// Stability: inner.
#pragma once
#include "bandlimit/scene/world.h"

namespace bandlimit {

Paint checkered_ground(const Look& look, const Vector3& point, const Vector3& normal);
/// One colour with soft spots.
Paint spotted(const Look& look, const Vector3& point, const Vector3& normal);
/// One colour.
Paint plain(const Look& look, const Vector3& point, const Vector3& normal);
/// Squares between meridians and parallels of a sphere: `scale` is their number around the equator, even.
Paint checkered_sphere(const Look& look, const Vector3& point, const Vector3& normal);
/// Rings of a sphere around its y: `scale` of them from pole to pole.
Paint ringed_sphere(const Look& look, const Vector3& point, const Vector3& normal);
/// On the sides of a box: squares, thin lines a tenth as wide as they are apart, bricks with mortar; `scale` per unit.
Paint checkered_box(const Look& look, const Vector3& point, const Vector3& normal);
Paint lined_box(const Look& look, const Vector3& point, const Vector3& normal);
Paint bricks(const Look& look, const Vector3& point, const Vector3& normal);

/// Blue with clouds; pale at the horizon, dark below it.
Vector3 cloudy_sky(const Vector3& direction);
/// Dusk, without clouds.
Vector3 evening_sky(const Vector3& direction);

}  // namespace bandlimit
