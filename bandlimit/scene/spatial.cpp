// The scenes plane, mover and highlight.
#include <cmath>
#include <numbers>

#include "bandlimit/scene/hash.h"
#include "bandlimit/scene/looks.h"
#include "bandlimit/scene/scenes.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;

Scene scene_of(World world, const SceneSetting& s) {
    return scene_of(std::move(world), s.width, s.height, s.speed, s.occlusion_rays);
}

/// `count` of them stand along the camera's round, by turns inside and outside of it.
void add_bystanders(World& world, double round, int count) {
    constexpr Vector3 colors[] = {{0.75, 0.12, 0.08}, {0.10, 0.30, 0.65}, {0.80, 0.55, 0.10}, {0.12, 0.45, 0.20}};
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * pi * (i + 0.4 * hash_unit(i, 0)) / count;
        const double away = round + (i % 2 == 0 ? -1 : 1) * (2.1 + 2 * hash_unit(i, 1));
        const double size = 0.55 + 0.6 * hash_unit(i, 2);
        const Vector3 color = colors[i % 4], place{away * std::cos(angle), size, -away * std::sin(angle)};
        Body body{.half = {size, size, size}, .pose = upright(place, 2 * pi * hash_unit(i, 3))};
        if (i % 3 == 0) {
            body.look = {
                i % 2 == 0 ? checkered_sphere : ringed_sphere, {0.85, 0.83, 0.78}, color, i % 2 == 0 ? 24.0 : 10.0};
        } else {
            body.shape = BodyShape::box;
            body.half = {size * 0.8, size * (0.8 + hash_unit(i, 4)), size * 0.6};
            body.pose.at.y = body.half.y;
            constexpr Paint (*paints[])(const Look&, const Vector3&, const Vector3&) = {bricks, checkered_box,
                                                                                        lined_box};
            const int kind = i % 4 == 3 ? 2 : i % 2;
            body.look = {paints[kind], kind == 0 ? color : Vector3{0.82, 0.8, 0.75},
                         kind == 0 ? Vector3{0.6, 0.58, 0.55} : color,
                         kind == 0   ? 4.0
                         : kind == 1 ? 6.0
                                     : 12.0};
        }
        world.add(body);
    }
}

}  // namespace

Scene plane_scene(const SceneSetting& s) {
    constexpr double round = 14;  // radius of the camera's way: it moves forward and turns for ever
    World world;
    world.moment = [](double time) {
        const double angle = 0.006 * time, c = std::cos(angle), sine = std::sin(angle);
        return Moment{time, looking({round * c, 1.5, -round * sine}, {-sine, -0.1, -c}), {}};
    };
    world.ground = {checkered_ground, {0.8, 0.8, 0.78}, {0.05, 0.05, 0.06}, 1};
    world.sky = cloudy_sky;
    world.sun = normalized({0.5, 0.65, 0.35});
    world.sun_light = {1.05, 0.96, 0.82};
    world.focal_heights = 0.95;
    add_bystanders(world, round, 30);
    return scene_of(std::move(world), s);
}

Scene mover_scene(const SceneSetting& s) {
    World world;
    constexpr double ball = 0.5;
    world.moment = [](double time) {
        Moment m{time, looking({0.2, 1.7, 6.2}, {-0.02, -0.13, -1}), {}};
        const Vector3 box{1.9 * std::sin(0.05 * time), 1.55 + 0.2 * std::sin(0.083 * time),
                          0.9 * std::cos(0.05 * time)};
        m.movers[0] = pose_turned(box, normalized({1, 2, 0.5}), 0.06 * time);
        const double way = 2.3 * std::sin(0.04 * time + 2);  // it rolls without slipping
        m.movers[1] = pose_turned({way, ball, 2.4}, {0, 0, 1}, -way / ball);
        return m;
    };
    world.ground = {checkered_ground, {0.62, 0.60, 0.56}, {0.16, 0.16, 0.17}, 2};
    world.sky = cloudy_sky;
    world.sun = normalized({-0.4, 0.8, 0.55});
    world.sun_light = {1.05, 0.98, 0.86};
    world.focal_heights = 1.05;
    world.add({.shape = BodyShape::box,
               .half = {0.62, 0.62, 0.62},
               .mover = 0,
               .look = {checkered_box, {0.9, 0.88, 0.82}, {0.75, 0.1, 0.06}, 5}});
    world.add(
        {.half = {ball, ball, ball}, .mover = 1, .look = {checkered_sphere, {0.9, 0.85, 0.3}, {0.08, 0.2, 0.5}, 16}});
    world.add({.shape = BodyShape::box,
               .half = {4.2, 1.05, 0.25},
               .pose = upright({0, 1.05, -3}, 0.05),
               .look = {bricks, {0.5, 0.26, 0.18}, {0.62, 0.6, 0.56}, 2.5}});
    world.add({.half = {0.8, 0.8, 0.8},
               .pose = upright({2.9, 0.8, -0.6}, 0.3),
               .look = {ringed_sphere, {0.8, 0.8, 0.78}, {0.1, 0.4, 0.2}, 9}});
    world.add({.shape = BodyShape::box,
               .half = {0.45, 0.9, 0.45},
               .pose = upright({-3, 0.9, -0.8}, 0.6),
               .look = {lined_box, {0.1, 0.12, 0.3}, {0.8, 0.78, 0.7}, 8}});
    for (int i = 0; i < 9; ++i)  // poles: about a pixel wide in an image of 270 rows
        world.add({.shape = BodyShape::box,
                   .half = {0.008, 0.55, 0.008},
                   .pose = upright({-2.8 + 0.7 * i, 0.55, 3.2}, 0.4),
                   .look = {plain, {0.8, 0.8, 0.8}},
                   .is_thin = true});
    return scene_of(std::move(world), s);
}

Scene highlight_scene(const SceneSetting& s) {
    World world;
    world.moment = [](double time) {
        const double angle = 0.5 * std::sin(0.022 * time), far = 4.6 + 0.5 * std::sin(0.017 * time);
        const Vector3 from{far * std::sin(angle), 1.9, far * std::cos(angle)};
        return Moment{time, looking(from, Vector3{0, 0.85, -0.4} - from), {}};
    };
    world.ground = {checkered_ground, {0.42, 0.40, 0.38}, {0.06, 0.06, 0.07}, 1.5};
    world.sky = evening_sky;
    world.sun = normalized({-0.55, 0.62, 0.6});
    world.sun_light = {1.0, 0.72, 0.45};
    world.highlight = 1200;
    world.focal_heights = 1.05;
    world.add({.half = {1, 1, 1},
               .pose = upright({0, 1, 0}, 0.2),
               .look = {ringed_sphere, {0.06, 0.09, 0.22}, {0.03, 0.03, 0.05}, 7, 0.3}});
    world.add({.shape = BodyShape::box,
               .half = {0.45, 0.45, 0.45},
               .pose = upright({1.9, 0.45, 0.5}, 0.5),
               .look = {lined_box, {0.9, 0.7, 0.3}, {0.1, 0.02, 0.02}, 5, 0.08}});
    world.add(
        {.half = {0.4, 0.4, 0.4}, .pose = upright({-1.7, 0.4, 0.9}, 0), .look = {plain, {0.9, 0.6, 0.25}, {}, 1, 0.6}});
    for (int i = 0; i < 9; ++i) {
        const double x = -4.4 + 1.1 * i, z = -3.2 - 0.5 * (i % 3);
        world.add(
            {.half = {0.035, 0.035, 0.035},
             .pose = upright({x, 1.6, z}, 0),
             .look = {plain, i % 3 == 1 ? Vector3{0.55, 0.75, 1} : Vector3{1, 0.7, 0.35}, {}, 1, 0, 40.0 + 15 * i},
             .is_thin = true});
        world.add({.shape = BodyShape::box,
                   .half = {0.012, 0.78, 0.012},
                   .pose = upright({x, 0.78, z}, 0),
                   .look = {plain, {0.25, 0.25, 0.26}},
                   .is_thin = true});
    }
    return scene_of(std::move(world), s);
}

}  // namespace bandlimit
