// How much of the sky surfaces see.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/math/random.h"
#include "bandlimit/scene/world.h"

namespace bandlimit {
namespace {

/// A direction in a half plane that the normal bounds: `up` along it, `out` away from it.
struct Direction2 {
    double out = 0, up = 1;
};
/// Above 0 if `b` is farther from the normal than `a`, by less than half a turn.
double turn(const Direction2& a, const Direction2& b) { return b.out * a.up - a.out * b.up; }

/// An interval of angles to the normal, below half a turn.
struct Sector {
    Direction2 low, high;
};

/// The share of light from within an angle t of the normal, of a half plane's, is sin^2 t.
struct Span {
    double low = 0, high = 0;
};

/// The part of a sector between the normal and the tangent.
Span visible_part(const Sector& s) {
    const auto holds = [&](const Direction2& d) { return turn(s.low, d) >= 0 && turn(d, s.high) >= 0; };
    const auto is_inside = [](const Direction2& d) { return d.out >= 0 && d.up >= 0; };
    const auto share = [](const Direction2& d) { return d.out * d.out / (d.out * d.out + d.up * d.up); };
    Span span;
    if (is_inside(s.low)) span.low = share(s.low);
    else if (!holds({0, 1})) return {};
    if (is_inside(s.high)) span.high = share(s.high);
    else if (holds({1, 0})) span.high = 1;
    return span;
}

/// Something that may hide a part of the hemisphere, seen from the point in axes of the surface.
struct Occluder {
    bool is_box = false;
    double radius = 0, reach = 0;  ///< of a sphere; of the sphere around anything
    Vector3 middle, sides[3];      ///< half the sides of a box
};

/// Spans of one half plane that are hidden.
class Spans {
public:
    void add(const Span& span) {
        if (span.high > span.low && count_ < most) spans_[count_++] = span;
    }
    double covered() {
        if (count_ < 2) return count_ == 0 ? 0 : spans_[0].high - spans_[0].low;
        std::sort(spans_, spans_ + count_, [](const Span& a, const Span& b) { return a.low < b.low; });
        double sum = 0, end = 0;
        for (int i = 0; i < count_; ++i) {
            sum += std::max(0.0, spans_[i].high - std::max(spans_[i].low, end));
            end = std::max(end, spans_[i].high);
        }
        return sum;
    }

private:
    static constexpr int most = 16;
    Span spans_[most];
    int count_ = 0;
};

/// Axes of a half plane: coordinates along its direction, and across it.
struct Slice {
    double c, s;
    Vector3 of(const Vector3& v) const { return {c * v.x + s * v.y, c * v.y - s * v.x, v.z}; }  // out, aside, up
    bool misses(const Occluder& o) const {
        const Vector3 m = of(o.middle);
        return std::abs(m.y) >= o.reach || m.x <= -o.reach;
    }
};

Span hidden_by_sphere(const Occluder& o, const Slice& slice) {
    const Vector3 m = slice.of(o.middle);
    const double disc2 = o.radius * o.radius - m.y * m.y, distance2 = m.x * m.x + m.z * m.z;
    if (disc2 <= 0 || distance2 <= disc2) return {};
    const double sine = std::sqrt(disc2 / distance2), cosine = std::sqrt(1 - disc2 / distance2);
    return visible_part({{m.x * cosine - m.z * sine, m.z * cosine + m.x * sine},
                         {m.x * cosine + m.z * sine, m.z * cosine - m.x * sine}});
}

/// The plane cuts the box in a convex polygon, whose corners lie on its edges.
Span hidden_by_box(const Occluder& o, const Slice& slice) {
    const Vector3 m = slice.of(o.middle), sides[] = {slice.of(o.sides[0]), slice.of(o.sides[1]), slice.of(o.sides[2])};
    Sector sector;
    bool is_first = true;
    for (int k = 0; k < 3; ++k)
        for (int corner = 0; corner < 4; ++corner) {
            const Vector3 base =
                m + sides[(k + 1) % 3] * (corner & 1 ? 1.0 : -1.0) + sides[(k + 2) % 3] * (corner & 2 ? 1.0 : -1.0);
            if (!(std::abs(base.y) < std::abs(sides[k].y))) continue;
            const Vector3 cut = base - sides[k] * (base.y / sides[k].y);
            const Direction2 d{cut.x, cut.z};
            if (is_first || turn(d, sector.low) > 0) sector.low = d;
            if (is_first || turn(sector.high, d) > 0) sector.high = d;
            is_first = false;
        }
    return is_first ? Span{} : visible_part(sector);
}

/// The ground hides what points down: `down` has the axes of the surface.
Span hidden_by_ground(const Vector3& down, const Slice& slice) {
    const double out = slice.of(down).x, up = down.z;
    const double share = up * up / std::max(out * out + up * up, 1e-300);  // where the horizon is
    if (up <= 0) return out > 0 ? Span{share, 1} : Span{};
    return out >= 0 ? Span{0, 1} : Span{0, share};
}

struct Occluders {
    static constexpr int most = 16;
    Occluder list[most];
    int count = 0;
    Vector3 down;
};

/// Those that hide more than a thousandth or so.
Occluders occluders_over(const World& world, const Moment& moment, const Vector3& point, const Pose& surface,
                         const Body* own) {
    Occluders result;
    result.down = surface.inward({0, -1, 0});
    for (const Body& body : world.bodies) {
        if (&body == own || body.is_thin || result.count == Occluders::most) continue;
        const Pose& pose = world.pose_of(body, moment);
        const Vector3 middle = surface.inward(pose.at - point);
        const double distance2 = dot(middle, middle), reach2 = body.reach * body.reach;
        if (middle.z + body.reach <= 0) continue;
        if (distance2 > reach2) {
            const double distance = std::sqrt(distance2), cosine = std::min(1.0, (middle.z + body.reach) / distance);
            if (reach2 / distance2 * cosine < 2e-3) continue;
        }
        Occluder& o = result.list[result.count++];
        o.is_box = body.shape == BodyShape::box;
        o.radius = body.half.x, o.reach = body.reach;
        o.middle = middle;
        o.sides[0] = surface.inward(pose.x * body.half.x);
        o.sides[1] = surface.inward(pose.y * body.half.y);
        o.sides[2] = surface.inward(pose.z * body.half.z);
    }
    return result;
}

/// The axes of a surface: z is the normal.
Pose surface_at(const Vector3& normal) {
    const Vector3 x = across(normal);
    return {{}, x, cross(normal, x), normal};
}

bool is_hidden(const Occluder& o, const Vector3& along) {
    if (!o.is_box) {
        const double ahead = dot(o.middle, along);
        return ahead > 0 && dot(o.middle, o.middle) - ahead * ahead < o.radius * o.radius;
    }
    double first = 0, last = 1e300;
    for (const Vector3& side : o.sides) {
        const double half2 = dot(side, side), to = dot(o.middle, side), a = dot(along, side);
        const double t0 = (to - half2) / a, t1 = (to + half2) / a;
        first = std::max(first, std::min(t0, t1)), last = std::min(last, std::max(t0, t1));
    }
    return first < last;
}

}  // namespace

double open_share(const World& world, const Moment& moment, const Vector3& point, const Vector3& normal,
                  const Body* own) {
    const Pose surface = surface_at(normal);
    const Occluders over = occluders_over(world, moment, point, surface, own);
    const bool sees_ground = normal.y < 1;
    if (over.count == 0) return sees_ground ? 0.5 + 0.5 * normal.y : 1;
    constexpr int half_planes = 32;
    static const auto slices = [] {
        std::array<Slice, half_planes> list{};
        for (int i = 0; i < half_planes; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / half_planes;
            list[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
        }
        return list;
    }();
    double hidden = 0;
    for (const Slice& slice : slices) {
        Spans spans;
        if (sees_ground) spans.add(hidden_by_ground(over.down, slice));
        for (int i = 0; i < over.count; ++i) {
            const Occluder& o = over.list[i];
            if (!slice.misses(o)) spans.add(o.is_box ? hidden_by_box(o, slice) : hidden_by_sphere(o, slice));
        }
        hidden += spans.covered();
    }
    return 1 - hidden / half_planes;
}

double open_share_by_rays(const World& world, const Moment& moment, const Vector3& point, const Vector3& normal,
                          const Body* own, int rays, std::uint64_t seed) {
    const Occluders over = occluders_over(world, moment, point, surface_at(normal), own);
    Random random(seed);
    int open = 0;
    for (int i = 0; i < rays; ++i) {
        const double radius2 = random.uniform(), radius = std::sqrt(radius2);
        const double angle = random.uniform(0, 2 * std::numbers::pi);
        const Vector3 along{radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - radius2)};
        const bool is_open =
            dot(along, over.down) <= 0 &&
            std::none_of(over.list, over.list + over.count, [&](const Occluder& o) { return is_hidden(o, along); });
        if (is_open) ++open;
    }
    return double(open) / rays;
}

}  // namespace bandlimit
