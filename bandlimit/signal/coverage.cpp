#include "bandlimit/signal/coverage.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

/// How a cell looks along a direction: as the density of a sum of two uniform variables, a trapezoid around `center`
/// with a base of wide + narrow and a top of wide - narrow.
struct Profile {
    double center, wide, narrow;

    Profile(const Cell& cell, const UnitVector& direction) {
        const Point at = middle(cell);
        const double u = std::abs(direction.x) * (cell.x1 - cell.x0), v = std::abs(direction.y) * (cell.y1 - cell.y0);
        center = direction.along(at.x, at.y);
        wide = std::max(u, v);
        narrow = std::min(u, v);
    }
    double base() const { return (wide + narrow) / 2; }
    double top() const { return (wide - narrow) / 2; }
    double density(double t) const {
        const double distance = std::abs(t - center);
        if (distance <= top()) return 1 / wide;
        return distance < base() ? (base() - distance) / (wide * narrow) : 0;
    }
};

/// The part of a cell in x >= 0, y >= 0 that a disc covers: under the chord of its arc, and between chord and arc.
double quadrant_area(const Cell& cell, double radius) {
    const auto height = [radius](double x) { return std::sqrt(std::max(0.0, (radius - x) * (radius + x))); };
    // The arc leaves the cell's top at `left` and its bottom at `right`.
    const double left = cell.y1 < radius ? std::clamp(height(cell.y1), cell.x0, cell.x1) : cell.x0;
    const double right = cell.y0 < radius ? std::clamp(height(cell.y0), cell.x0, cell.x1) : cell.x0;
    double covered = (left - cell.x0) * (cell.y1 - cell.y0);
    if (right <= left) return covered;
    const double from = std::min(height(left), cell.y1), to = std::max(height(right), cell.y0);
    covered += (right - left) * ((from - cell.y0) + (to - cell.y0)) / 2;
    const double chord = std::hypot(right - left, from - to);
    const double angle = 2 * std::asin(std::min(1.0, chord / (2 * radius)));
    return covered + radius * radius * (angle - std::sin(angle)) / 2;
}

}  // namespace

UnitVector direction_at(double degrees) {
    const double turn = std::fmod(degrees, 360.0);
    return {sin_pi((turn + 90) / 180), sin_pi(turn / 180)};
}

Extent extent_along(const Cell& cell, const UnitVector& direction) {
    const Profile profile(cell, direction);
    return {profile.center - profile.base(), profile.center + profile.base()};
}

int panels_for(double periods) {
    if (!(periods < 1e6))
        fail("signal: ", periods, " periods under one sample; stay nearer to the frame of the signal");
    return 1 + static_cast<int>(periods);
}

double share_below(const Cell& cell, const UnitVector& direction, double t) {
    const Profile profile(cell, direction);
    const double from_center = t - profile.center;
    const double in = profile.base() - std::abs(from_center);  // how far the line is inside, from the nearer side
    double share = 0;
    if (in >= profile.narrow) share = (in - profile.narrow / 2) / profile.wide;
    else if (in > 0) share = in * in / (2 * profile.wide * profile.narrow);
    return from_center > 0 ? 1 - share : share;
}

double mean_along(const Cell& cell, const UnitVector& direction, const std::function<double(double)>& f,
                  std::vector<double> knots, double frequency) {
    const Profile profile(cell, direction);
    const auto [begin, end] = extent_along(cell, direction);
    knots.insert(knots.end(), {begin, profile.center - profile.top(), profile.center + profile.top(), end});
    std::sort(knots.begin(), knots.end());
    double mean = 0;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        const double from = std::max(knots[i - 1], begin), to = std::min(knots[i], end);
        if (from >= to) continue;
        const auto weighted = [&](double t) { return f(t) * profile.density(t); };
        mean += integrate(weighted, from, to, panels_for((to - from) * frequency));
    }
    return mean;
}

double disc_area(const Cell& cell, double radius) {
    const double far_x = std::max(std::abs(cell.x0), std::abs(cell.x1));
    const double far_y = std::max(std::abs(cell.y0), std::abs(cell.y1));
    if (far_x * far_x + far_y * far_y <= radius * radius) return area(cell);
    double covered = 0;
    for (const double sx : {-1.0, 1.0})
        for (const double sy : {-1.0, 1.0}) {
            // Mirrored into the first quadrant; what is left of it there may be nothing.
            const auto [x0, x1] = std::minmax({sx * cell.x0, sx * cell.x1});
            const auto [y0, y1] = std::minmax({sy * cell.y0, sy * cell.y1});
            if (x1 > 0 && y1 > 0) covered += quadrant_area({std::max(0.0, x0), std::max(0.0, y0), x1, y1}, radius);
        }
    return covered;
}

double bright_length(double x, double period, double duty) {
    const double periods = x / period, whole = std::floor(periods);
    return period * (whole * duty + std::min(periods - whole, duty));
}

}  // namespace bandlimit
