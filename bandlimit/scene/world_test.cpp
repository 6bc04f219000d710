#include "bandlimit/scene/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/math/random.h"
#include "bandlimit/scene/looks.h"

namespace bandlimit {
namespace {

Vector3 white_sky(const Vector3&) { return {1, 1, 1}; }

World empty_world() {
    World world;
    world.moment = [](double time) { return Moment{time, looking({0, 2, 8}, {0, 0, -1}), {}}; };
    world.ground = {plain, {1, 1, 1}};
    world.sky = white_sky;
    world.sun = {0, 1, 0};
    return world;
}

Vector3 random_direction(Random& random) {
    for (;;) {
        const Vector3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (const double n = dot(v, v); n <= 1 && n > 0.01) return normalized(v);
    }
}

// A surface sees the part (1 + n.y) / 2 of what is above the horizon, by the cosine.
TEST(Occlusion, GroundHidesWhatPointsDown) {
    const World world = empty_world();
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Vector3 n = random_direction(random);
        EXPECT_NEAR(open_share(world, {}, {0, 1, 0}, n, nullptr), 0.5 + 0.5 * n.y, 1e-12);
    }
}

// A sphere that is above the tangent plane as a whole hides cos(angle) (radius / distance)^2 of a surface. At its
// outline the hidden span of a half plane falls to 0 as the root of the azimuth does, which the midpoint rule sums with
// an error of up to .21 sqrt(2 / w) / 32^1.5 at either side, w the half of its width in turns: 0.01 for w = .1.
TEST(Occlusion, OfASphereIsKnown) {
    Random random(4);
    for (int i = 0; i < 200; ++i) {
        World world = empty_world();
        const double angle = random.uniform(0, 1.2), radius = random.uniform(0.1, 1.0) * 5 * std::cos(angle) * 0.99;
        const double around = random.uniform(0, 6.3);
        world.add({.half = {radius, radius, radius},
                   .pose = {.at = {5 * std::sin(angle) * std::cos(around), 5 * std::cos(angle),
                                   5 * std::sin(angle) * std::sin(around)}}});
        EXPECT_NEAR(open_share(world, {}, {0, 0, 0}, {0, 1, 0}, nullptr), 1 - std::cos(angle) * radius * radius / 25,
                    0.01)
            << angle << " " << radius;
    }
}

// A square of side 2 a straight over the surface at height h hides, by Lambert's formula for its four edges,
// (4 / pi) (a / s) atan(a / s), s^2 = h^2 + a^2. The lower side of a box is all of it that one sees.
TEST(Occlusion, OfABoxIsKnown) {
    for (const double a : {0.2, 0.5, 1.0, 3.0})
        for (const double turn : {0.0, 0.3, 0.7}) {
            World world = empty_world();
            world.add({.shape = BodyShape::box, .half = {a, 0.25, a}, .pose = upright({0, 1.25, 0}, turn)});
            const double s = std::hypot(1, a);
            EXPECT_NEAR(open_share(world, {}, {0, 0, 0}, {0, 1, 0}, nullptr),
                        1 - 4 / std::numbers::pi * a / s * std::atan(a / s), 2e-3);
        }
}

TEST(Occlusion, ManyRaysAgreeAboutManyThings) {
    Random random(5);
    for (int i = 0; i < 40; ++i) {
        World world = empty_world();
        for (int k = 0; k < 5; ++k) {
            const double size = random.uniform(0.3, 0.8);
            world.add({.shape = k % 2 == 0 ? BodyShape::sphere : BodyShape::box,
                       .half = {size, size, size},
                       .pose = pose_turned({random.uniform(-2, 2), random.uniform(1.4, 3), random.uniform(-2, 2)},
                                           random_direction(random), 1)});
        }
        const Vector3 point{random.uniform(-2, 2), 1e-9, random.uniform(-2, 2)};
        const Vector3 normal = normalized(random_direction(random) + Vector3{0, 1.5, 0});
        const double truth = open_share(world, {}, point, normal, nullptr);
        // Four standard deviations of 40000 rays, and the 0.01 that the header promises.
        EXPECT_NEAR(open_share_by_rays(world, {}, point, normal, nullptr, 40000, 1), truth, 0.01 + 4 * 0.5 / 200) << i;
    }
}

TEST(Trace, MeetsTheSurfaceOfABox) {
    Random random(6);
    World world = empty_world();
    world.add(
        {.shape = BodyShape::box, .half = {0.5, 1, 0.25}, .pose = pose_turned({0, 3, 0}, normalized({1, 1, 0}), 0.7)});
    const Body& box = world.bodies[0];
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const Vector3 from = box.pose.at + random_direction(random) * 2.5;
        const Ray ray{from, normalized(box.pose.at + random_direction(random) - from)};
        const Hit hit = trace(world, ray, {});
        if (hit.body != &box) continue;
        ++hits;
        const Vector3 p = box.pose.point_inward(ray.at(hit.distance)), n = box.pose.inward(hit.normal);
        // The normal says on which side the point lies; it lies on it, and on no side is it outside.
        EXPECT_NEAR(dot(p, n), std::abs(dot(box.half, n)), 1e-12);
        EXPECT_LT(std::abs(p.x), 0.5 + 1e-12);
        EXPECT_LT(std::abs(p.y), 1 + 1e-12);
        EXPECT_LT(std::abs(p.z), 0.25 + 1e-12);
        EXPECT_LT(dot(ray.along, hit.normal), 0);
    }
    EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace bandlimit
