// The scene foliage: leaves and blades of grass, cut out of cards by a test of every point.
#include <cmath>
#include <memory>
#include <numbers>

#include "bandlimit/scene/hash.h"
#include "bandlimit/scene/looks.h"
#include "bandlimit/scene/scenes.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;

/// A square with five leaves, which turns about its twig.
struct Card {
    Pose rest;  ///< its middle; z is its normal
    Vector3 axis;
    double phase = 0, half = 0;
    Vector3 color;

    Pose at(double time) const {
        const double angle = 0.22 * std::sin(0.09 * time + phase) + 0.07 * std::sin(0.23 * time + 2 * phase);
        return {rest.at, turned(rest.x, axis, angle), turned(rest.y, axis, angle), turned(rest.z, axis, angle)};
    }
};

/// What the card shows at (u, v) in [-1, 1]: nothing, leaf or vein.
enum class Leaf { none, blade, vein };
Leaf leaf_at(double u, double v) {
    const double r2 = u * u + v * v;
    if (r2 >= 1) return Leaf::none;
    const double r = std::sqrt(r2), fifth = 2 * pi / 5, angle = std::atan2(v, u);
    const double beside = r * std::abs(std::sin(angle - fifth * std::round(angle / fifth)));
    if (beside < 0.02) return Leaf::vein;
    return r > 0.15 && beside < 0.24 * std::sin(pi * (r - 0.15) / 0.85) ? Leaf::blade : Leaf::none;
}

/// Blades of grass that stand in a plane of constant z, and sway together.
struct GrassRow {
    double z = 0, phase = 0;

    /// How far tips of height 1 are aside; in between it goes by the height squared.
    double sway(double time) const {
        return 0.35 * std::sin(0.07 * time + phase) + 0.12 * std::sin(0.19 * time + 3 * phase);
    }
};

constexpr double tallest = 0.55, spacing = 0.028;

/// The blade at a point of a row that does not sway, if there is one.
bool blade_at(double x, double y, std::int64_t row, Vector3& color) {
    const auto place = static_cast<std::int64_t>(std::floor(x / spacing));
    for (std::int64_t i = place - 1; i <= place + 1; ++i) {
        const std::uint64_t bits = hash_bits(i, row, 30);
        const auto unit = [bits](int which) { return double((bits >> (16 * which)) & 0xffff) / 65536; };
        const double tall = tallest * (0.35 + 0.65 * unit(0)), share = y / tall;
        if (share >= 1) continue;
        const double middle = (double(i) + unit(1)) * spacing + spacing * (unit(2) - 0.5) * share * share;
        if (std::abs(x - middle) >= 0.0075 * (1 - share)) continue;
        color = mix({0.16, 0.32, 0.05}, {0.45, 0.5, 0.13}, unit(3)) * (0.35 + 0.65 * share);
        return true;
    }
    return false;
}

struct Plants {
    std::vector<Card> cards;
    std::vector<GrassRow> rows;
    Vector3 crown_middle{};
    double crown_radius = 0;

    void see_grass(const Ray& ray, const Moment& now, Hit& hit) const {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double distance = (rows[i].z - ray.from.z) / ray.along.z;
            if (!(distance > 1e-6 && distance < hit.distance)) continue;
            const Vector3 p = ray.at(distance);
            if (p.y <= 0 || p.y >= tallest) continue;
            Vector3 color;
            if (!blade_at(p.x - rows[i].sway(now.time) * p.y * p.y, p.y, static_cast<std::int64_t>(i), color)) continue;
            hit = {.distance = distance,
                   .normal = {0, 0, ray.along.z < 0 ? 1.0 : -1.0},
                   .other = &rows[i],
                   .paint = {color}};
            hit.local.x = 1;
        }
    }

    void see_leaves(const Ray& ray, const Moment& now, Hit& hit) const {
        const auto passes = [&](const Vector3& middle, double radius) {
            const Vector3 way = middle - ray.from;
            const double ahead = dot(way, ray.along);
            return ahead > -radius && ahead - radius < hit.distance && dot(way, way) - ahead * ahead < radius * radius;
        };
        if (!passes(crown_middle, crown_radius)) return;
        for (const Card& card : cards) {
            if (!passes(card.rest.at, card.half)) continue;
            const Pose pose = card.at(now.time);
            const double slope = dot(ray.along, pose.z), distance = dot(card.rest.at - ray.from, pose.z) / slope;
            if (!(distance > 1e-6 && distance < hit.distance)) continue;
            const Vector3 p = ray.at(distance) - card.rest.at;
            const Leaf leaf = leaf_at(dot(p, pose.x) / card.half, dot(p, pose.y) / card.half);
            if (leaf == Leaf::none) continue;
            hit = {.distance = distance,
                   .normal = slope < 0 ? pose.z : -pose.z,
                   .other = &card,
                   .paint = {leaf == Leaf::vein ? card.color * 0.45 : card.color}};
        }
    }

    Vector3 where(const Hit& hit, const Vector3& point, const Moment& now, double then) const {
        if (hit.local.x != 0) {
            const GrassRow& row = *static_cast<const GrassRow*>(hit.other);
            return {point.x + (row.sway(then) - row.sway(now.time)) * point.y * point.y, point.y, point.z};
        }
        const Card& card = *static_cast<const Card*>(hit.other);
        return card.at(then).point_outward(card.at(now.time).point_inward(point));
    }
};

Plants grow() {
    Plants plants;
    plants.crown_middle = {0.5, 2.35, -0.6};
    const auto unit = [](int i, int which) { return hash_unit(i, which, 31); };
    for (int i = 0; i < 130; ++i) {
        const double height = 2 * unit(i, 0) - 1, angle = 2 * pi * unit(i, 1), level = std::sqrt(1 - height * height);
        const Vector3 out{level * std::cos(angle), height, level * std::sin(angle)};
        const double away = std::cbrt(0.25 + 0.75 * unit(i, 2));
        Card card;
        card.rest =
            pose_turned(plants.crown_middle + out * Vector3{1.6, 0.95, 1.1} * away,
                        normalized({unit(i, 3) - 0.5, unit(i, 4) - 0.5, unit(i, 5) - 0.5}), 2 * pi * unit(i, 6));
        card.axis = normalized({unit(i, 7) - 0.5, 0.4 * (unit(i, 8) - 0.5), unit(i, 9) - 0.5});
        card.phase = 2 * pi * unit(i, 10);
        card.half = 0.28 + 0.2 * unit(i, 11);
        card.color =
            mix({0.10, 0.30, 0.05}, i % 9 == 0 ? Vector3{0.75, 0.35, 0.05} : Vector3{0.40, 0.48, 0.08}, unit(i, 12));
        plants.crown_radius = std::max(plants.crown_radius, length(card.rest.at - plants.crown_middle) + card.half);
        plants.cards.push_back(card);
    }
    for (int i = 0; i < 26; ++i) plants.rows.push_back({3.1 - 0.31 * i + 0.05 * unit(i, 13), 0.55 * i});
    return plants;
}

}  // namespace

Scene foliage_scene(const SceneSetting& s) {
    const auto plants = std::make_shared<const Plants>(grow());
    World world;
    world.moment = [](double time) {
        const double swing = std::sin(0.025 * time);
        return Moment{time, looking({0.9 * swing, 1.35, 4.9}, {0.04 - 0.12 * swing, 0.03, -1}), {}};
    };
    world.ground = {spotted, {0.30, 0.27, 0.14}, {0.14, 0.17, 0.06}, 1.7};
    world.sky = cloudy_sky;
    world.sun = normalized({-0.5, 0.75, 0.5});
    world.sun_light = {1.15, 1.05, 0.85};
    world.focal_heights = 1.1;
    world.add({.shape = BodyShape::box,
               .half = {0.11, 1.0, 0.11},
               .pose = upright({0.5, 1.0, -0.6}, 0.5),
               .look = {bricks, {0.2, 0.13, 0.08}, {0.09, 0.06, 0.04}, 9}});
    world.add({.half = {0.45, 0.45, 0.45},
               .pose = upright({-1.9, 0.45, 0.2}, 0),
               .look = {spotted, {0.55, 0.53, 0.5}, {0.25, 0.24, 0.22}, 9}});
    world.add({.shape = BodyShape::box,
               .half = {2.5, 0.55, 0.12},
               .pose = upright({-2.2, 0.55, -3.4}, 0.15),
               .look = {bricks, {0.5, 0.24, 0.16}, {0.6, 0.58, 0.54}, 3}});
    world.others = [plants](const Ray& ray, const Moment& now, bool is_shadow, Hit& hit) {
        plants->see_leaves(ray, now, hit);
        if (!is_shadow || hit.is_sky()) plants->see_grass(ray, now, hit);
    };
    world.where_other = [plants](const Hit& hit, const Vector3& point, const Moment& now, double then) {
        return plants->where(hit, point, now, then);
    };
    return scene_of(std::move(world), s.width, s.height, s.speed, s.occlusion_rays);
}

}  // namespace bandlimit
