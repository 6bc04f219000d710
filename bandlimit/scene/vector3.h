// Points, directions and poses in space.
// Stability: inner.
#pragma once
#include <cmath>

namespace bandlimit {

struct Vector3 {
    double x = 0, y = 0, z = 0;
};

constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vector3 operator*(const Vector3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
/// Component by component, as light is reflected by a colour.
constexpr Vector3 operator*(const Vector3& a, const Vector3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }
inline Vector3 normalized(const Vector3& a) { return a * (1 / length(a)); }
constexpr Vector3 mix(const Vector3& a, const Vector3& b, double share) { return a + (b - a) * share; }

/// Where a rigid body is, and how it is turned: what its own axes are in the space around it.
struct Pose {
    Vector3 at{};
    Vector3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vector3 outward(const Vector3& direction) const { return x * direction.x + y * direction.y + z * direction.z; }
    Vector3 inward(const Vector3& direction) const { return {dot(x, direction), dot(y, direction), dot(z, direction)}; }
    Vector3 point_outward(const Vector3& point) const { return at + outward(point); }
    Vector3 point_inward(const Vector3& point) const { return inward(point - at); }
};

/// `v` turned around a unit vector, counter-clockwise as seen from its tip, by radians.
inline Vector3 turned(const Vector3& v, const Vector3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}
/// At `at`, turned from no rotation.
inline Pose pose_turned(const Vector3& at, const Vector3& axis, double angle) {
    return {at, turned({1, 0, 0}, axis, angle), turned({0, 1, 0}, axis, angle), turned({0, 0, 1}, axis, angle)};
}
/// Turned around the vertical, y, alone.
inline Pose upright(const Vector3& at, double angle) { return pose_turned(at, {0, 1, 0}, angle); }

/// A camera at `at` that looks along `forward`, upright: its z points back.
inline Pose looking(const Vector3& at, const Vector3& forward) {
    const Vector3 back = normalized(-forward), right = normalized(cross({0, 1, 0}, back));
    return {at, right, cross(back, right), back};
}

/// A unit vector across `normal`, a unit vector too.
inline Vector3 across(const Vector3& normal) {
    const Vector3 other = std::abs(normal.y) < 0.9 ? Vector3{0, 1, 0} : Vector3{1, 0, 0};
    return normalized(cross(other, normal));
}

}  // namespace bandlimit
