// A small world of ground, spheres, boxes and a sky, and the ray caster that looks at it.
//
// Right-handed, y up; the ground is the plane y = 0. Everything that moves is a function of time, in frames times speed.
// Stability: inner.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "bandlimit/scene/scene.h"
#include "bandlimit/scene/vector3.h"

namespace bandlimit {

/// What a surface is made of at a point.
struct Paint {
    Vector3 albedo{};
    Vector3 glow{};     ///< light of its own
    double mirror = 0;  ///< share of light from ahead that is reflected as by a mirror
};

/// What a surface is made of, in its own coordinates.
struct Look {
    Paint (*paint)(const Look&, const Vector3& point, const Vector3& normal) = nullptr;
    Vector3 bright{1, 1, 1}, dark{};
    double scale = 1;  ///< of the pattern
    double mirror = 0, glow = 0;
};

enum class BodyShape { sphere, box };

struct Body {
    BodyShape shape = BodyShape::sphere;
    Vector3 half{1, 1, 1};  ///< half the sides of a box; the radius of a sphere, three times
    Pose pose{};            ///< if it does not move
    int mover = -1;         ///< which pose of the moment it has, if it moves
    Look look{};
    bool is_thin = false;  ///< casts no ambient occlusion
    double reach = 0;      ///< farthest point from the middle; set by World::add()
};

/// Where all is at a time.
struct Moment {
    double time = 0;
    Pose camera{};
    std::array<Pose, 4> movers{};
};

struct Ray {
    Vector3 from, along;  ///< a unit vector
    Vector3 at(double distance) const { return from + along * distance; }
};

/// Where a ray meets something.
struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    Vector3 normal{};             ///< in the world, a unit vector against the ray
    const Body* body = nullptr;   ///< null: ground, or something else
    const void* other = nullptr;  ///< what World::others found
    Vector3 local{}, local_normal{};
    Paint paint{};  ///< of something else

    bool is_sky() const { return std::isinf(distance); }
};

struct World {
    std::function<Moment(double time)> moment;
    std::vector<Body> bodies{};
    Look ground{};
    Vector3 (*sky)(const Vector3& direction) = nullptr;
    Vector3 sun{};         ///< towards it, a unit vector
    Vector3 sun_light{};   ///< that a white surface facing it reflects
    double highlight = 0;  ///< how bright the sun is in a mirror
    /// More to see, such as leaves: replaces `hit` by what is nearer. `is_shadow` asks for any that is.
    std::function<void(const Ray&, const Moment&, bool is_shadow, Hit& hit)> others{};
    /// Where a point that `others` found was at another time.
    std::function<Vector3(const Hit&, const Vector3& point, const Moment& now, double then)> where_other{};
    double focal_heights = 1;  ///< focal length in heights of the image, or in 9/16 of its width if that is more

    void add(Body body);
    const Pose& pose_of(const Body& body, const Moment& moment) const {
        return body.mover < 0 ? body.pose : moment.movers[static_cast<std::size_t>(body.mover)];
    }
};

/// The nearest thing on the ray.
Hit trace(const World& world, const Ray& ray, const Moment& moment);

/// The share of the hemisphere over a point that is open, weighted by the cosine: exact within 32 half planes through
/// the normal, between them by the midpoint rule.
///
/// error  below 0.01 where nothing is nearer than a hundredth of its size
double open_share(const World& world, const Moment& moment, const Vector3& point, const Vector3& normal,
                  const Body* own);
/// The same by random rays.
double open_share_by_rays(const World& world, const Moment& moment, const Vector3& point, const Vector3& normal,
                          const Body* own, int rays, std::uint64_t seed);

/// The world as a scene for an image of width x height. At `speed` 0 it shows the moment 0 forever.
Scene scene_of(World world, int width, int height, double speed, int occlusion_rays);

}  // namespace bandlimit
