#include "bandlimit/scene/world.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "bandlimit/scene/hash.h"

namespace bandlimit {
namespace {

constexpr double skin = 1e-7;  // rays that leave a surface begin so far outside

/// The distance at which the ray enters the sphere around 0, or infinity.
double enter_sphere(const Vector3& from, const Vector3& along, double radius) {
    const double ahead = -dot(from, along), miss2 = dot(from, from) - ahead * ahead, half2 = radius * radius - miss2;
    if (ahead <= 0 || half2 <= 0) return std::numeric_limits<double>::infinity();
    const double distance = ahead - std::sqrt(half2);
    return distance > 0 ? distance : std::numeric_limits<double>::infinity();
}

/// The same for the box around 0; `normal` is that of the side.
double enter_box(const Vector3& from, const Vector3& along, const Vector3& half, Vector3& normal) {
    double first = 0, last = std::numeric_limits<double>::infinity();
    const auto slab = [&](double f, double a, double h, const Vector3& axis) {
        if (a == 0) {
            if (std::abs(f) > h) last = -1;
            return;
        }
        const double near = (-std::copysign(h, a) - f) / a, far = (std::copysign(h, a) - f) / a;
        if (near > first) first = near, normal = a > 0 ? -axis : axis;
        last = std::min(last, far);
    };
    slab(from.x, along.x, half.x, {1, 0, 0});
    slab(from.y, along.y, half.y, {0, 1, 0});
    slab(from.z, along.z, half.z, {0, 0, 1});
    return first > 0 && first < last ? first : std::numeric_limits<double>::infinity();
}

/// Replaces the hit if the ray meets the body nearer.
void meet(const Body& body, const Pose& pose, const Ray& ray, Hit& hit) {
    const Vector3 way = pose.at - ray.from;
    const double ahead = dot(way, ray.along), miss2 = dot(way, way) - ahead * ahead;
    if (miss2 > body.reach * body.reach || ahead < -body.reach || ahead - body.reach > hit.distance) return;
    if (body.shape == BodyShape::sphere) {
        const double distance = enter_sphere(-way, ray.along, body.half.x);
        if (!(distance < hit.distance)) return;
        hit.distance = distance, hit.body = &body;
        hit.normal = (ray.at(distance) - pose.at) * (1 / body.half.x);
        return;
    }
    Vector3 normal;
    const double distance = enter_box(pose.inward(-way), pose.inward(ray.along), body.half, normal);
    if (!(distance < hit.distance)) return;
    hit.distance = distance, hit.body = &body;
    hit.normal = pose.outward(normal);
}

bool is_shadowed(const World& world, const Ray& ray, const Moment& moment, const Body* own) {
    Hit hit;
    for (const Body& body : world.bodies) {
        if (&body == own || body.look.glow > 0) continue;  // convex: does not shade itself
        meet(body, world.pose_of(body, moment), ray, hit);
        if (hit.body) return true;
    }
    if (world.others) world.others(ray, moment, true, hit);
    return !hit.is_sky();
}

Paint paint_at(const World& world, const Hit& hit, const Vector3& point, const Moment& moment) {
    if (hit.other) return hit.paint;
    if (!hit.body) return world.ground.paint(world.ground, point, {0, 1, 0});
    const Pose& pose = world.pose_of(*hit.body, moment);
    return hit.body->look.paint(hit.body->look, pose.point_inward(point), pose.inward(hit.normal));
}

/// The light that comes from the hit against the ray; mirrors show their surroundings once.
Vector3 shade(const World& world, const Ray& ray, const Hit& hit, const Moment& moment, const Paint& paint,
              bool is_mirrored) {
    const Vector3 point = ray.at(hit.distance);
    const double towards_sun = dot(hit.normal, world.sun);
    const bool is_lit =
        towards_sun > 0 && !is_shadowed(world, {point + hit.normal * skin, world.sun}, moment, hit.body);
    constexpr Vector3 from_below{0.16, 0.15, 0.13}, from_above{0.36, 0.44, 0.58};
    Vector3 light = mix(from_below, from_above, 0.5 + 0.5 * hit.normal.y);
    if (is_lit) light = light + world.sun_light * towards_sun;
    const Vector3 diffuse = paint.albedo * light + paint.glow;
    if (paint.mirror == 0 || is_mirrored) return diffuse;
    const double facing = -dot(ray.along, hit.normal), grazing = 1 - std::clamp(facing, 0.0, 1.0);
    const double share = paint.mirror + (1 - paint.mirror) * grazing * grazing * grazing * grazing * grazing;
    const Ray mirrored{point + hit.normal * skin, ray.along + hit.normal * (2 * facing)};
    const Hit seen = trace(world, mirrored, moment);
    Vector3 image = seen.is_sky() ? world.sky(mirrored.along)
                                  : shade(world, mirrored, seen, moment,
                                          paint_at(world, seen, mirrored.at(seen.distance), moment), true);
    if (is_lit) {
        constexpr double sharpness = 1800;  // half as bright 1.6 degrees from the sun
        const double peak = world.highlight * std::exp(sharpness * (dot(mirrored.along, world.sun) - 1));
        image = image + Vector3{1, 0.93, 0.8} * peak;
    }
    return mix(diffuse, image, share);
}

std::array<double, 3> array_of(const Vector3& v) { return {v.x, v.y, v.z}; }

/// How the image lies before the eye.
struct Lens {
    double middle_x = 0, middle_y = 0, focal = 1;

    Vector3 direction(double x, double y) const { return {(x - middle_x) / focal, (middle_y - y) / focal, -1}; }
    /// Where the image shows what is at `p` in camera space. What was beside or behind the eye is shown far outside.
    Point shown(const Vector3& p, double size) const {
        const double depth = std::max(-p.z, 1e-6 * size);
        return {middle_x + focal * p.x / depth, middle_y - focal * p.y / depth};
    }
};

/// A world and how it is looked at.
struct View3 {
    World world;
    Lens lens;
    double speed = 1;
    int rays = 0;

    Ray ray(double x, double y, const Pose& camera) const {
        return {camera.at, normalized(camera.outward(lens.direction(x, y)))};
    }

    std::array<double, 3> color(double x, double y, int frame) const {
        const Moment now = world.moment(frame * speed);
        const Ray look = ray(x, y, now.camera);
        const Hit hit = trace(world, look, now);
        if (hit.is_sky()) return array_of(world.sky(look.along));
        return array_of(shade(world, look, hit, now, paint_at(world, hit, look.at(hit.distance), now), false));
    }

    /// Where the point was, in the camera space of the moment before.
    Vector3 before(const Hit& hit, const Vector3& point, const Moment& now, const Moment& then) const {
        Vector3 was = point;
        if (hit.other) was = world.where_other(hit, point, now, then.time);
        if (hit.body && hit.body->mover >= 0)
            was = world.pose_of(*hit.body, then).point_outward(world.pose_of(*hit.body, now).point_inward(point));
        return then.camera.point_inward(was);
    }

    double openness(double x, double y, int frame, const Hit& hit, const Vector3& point, const Moment& now) const {
        if (rays == 0) return open_share(world, now, point, hit.normal, hit.body);
        const std::uint64_t seed = hash_bits(std::bit_cast<std::int64_t>(x), std::bit_cast<std::int64_t>(y),
                                             static_cast<std::uint64_t>(frame));
        return open_share_by_rays(world, now, point, hit.normal, hit.body, rays, seed);
    }

    SceneSample at(double x, double y, int frame) const {
        const Moment now = world.moment(frame * speed), then = world.moment((frame - 1.0) * speed);
        const Ray look = ray(x, y, now.camera);
        const Hit hit = trace(world, look, now);
        SceneSample s;
        if (hit.is_sky()) {
            const Vector3 was = then.camera.inward(look.along);
            const Point shown = lens.shown(was, 1);
            s.color = array_of(world.sky(look.along));
            s.motion = speed == 0 ? Point{} : Point{shown.x - x, shown.y - y};
            s.depth = s.previous_depth = sky_depth;
            return s;
        }
        const Vector3 point = look.at(hit.distance), was = before(hit, point, now, then);
        const Paint paint = paint_at(world, hit, point, now);
        const Point shown = lens.shown(was, hit.distance);
        s.color = array_of(shade(world, look, hit, now, paint, false));
        s.albedo = array_of(paint.albedo);
        s.depth = -now.camera.point_inward(point).z;
        s.previous_depth = -was.z;
        s.motion = speed == 0 ? Point{} : Point{shown.x - x, shown.y - y};
        s.normal = array_of(now.camera.inward(hit.normal));
        s.ambient_occlusion = openness(x, y, frame, hit, point, now);
        return s;
    }
};

}  // namespace

void World::add(Body body) {
    body.reach = body.shape == BodyShape::sphere ? body.half.x : length(body.half);
    bodies.push_back(body);
}

Hit trace(const World& world, const Ray& ray, const Moment& moment) {
    Hit hit;
    if (ray.along.y < 0 && ray.from.y > 0) {
        hit.distance = -ray.from.y / ray.along.y;
        hit.normal = {0, 1, 0};
    }
    for (const Body& body : world.bodies) meet(body, world.pose_of(body, moment), ray, hit);
    if (world.others) world.others(ray, moment, false, hit);
    return hit;
}

Scene scene_of(World world, int width, int height, double speed, int occlusion_rays) {
    const double focal = world.focal_heights * std::max(double(height), width * 9 / 16.0);
    const auto view = std::make_shared<const View3>(
        View3{std::move(world), {width / 2.0, height / 2.0, focal}, speed, occlusion_rays});
    Scene scene;
    scene.is_still = speed == 0;
    scene.focal = focal;
    scene.at = [view](double x, double y, int frame) { return view->at(x, y, frame); };
    scene.color = [view](double x, double y, int frame) { return view->color(x, y, frame); };
    return scene;
}

}  // namespace bandlimit
