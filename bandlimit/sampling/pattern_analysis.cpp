#include "bandlimit/sampling/pattern_analysis.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

void check_points(const char* function, std::span<const Point> points) {
    if (points.empty()) fail(function, ": there are no points; pass at least one");
}

/// From the pixel's corner: [0, 1].
std::vector<Point> from_corner(const char* function, std::span<const Point> points) {
    check_points(function, points);
    std::vector<Point> moved;
    for (const Point& p : points) {
        if (!(std::abs(p.x) <= 0.5 && std::abs(p.y) <= 0.5))
            fail(function, ": (", p.x, ", ", p.y, ") lies outside the pixel; pass points in [-1/2, 1/2]");
        moved.push_back({p.x + 0.5, p.y + 0.5});
    }
    return moved;
}

/// The part of a pixel, centred at 0, that lies before a straight line at distance t from its centre: the distribution
/// of the sum of two uniform ones.
class Area {
public:
    explicit Area(double radians)
        : longer_(std::max(std::abs(std::cos(radians)), std::abs(std::sin(radians)))),
          shorter_(std::min(std::abs(std::cos(radians)), std::abs(std::sin(radians)))) {}

    double half_way() const { return (longer_ + shorter_) / 2; }
    /// Where its formula changes.
    double knot() const { return (longer_ - shorter_) / 2; }
    double before(double t) const {
        constexpr double flat = 1e-6;  // nearer to an axis than the formula can tell
        if (shorter_ < flat) return std::clamp((t + half_way()) / (2 * half_way()), 0.0, 1.0);
        const auto square_beyond = [t](double from) { return t > from ? (t - from) * (t - from) : 0.0; };
        return (square_beyond(-half_way()) - square_beyond(-knot()) - square_beyond(knot()) +
                square_beyond(half_way())) /
               (2 * longer_ * shorter_);
    }

private:
    double longer_, shorter_;
};

struct Jump {
    double at, size;
};

std::vector<Jump> jumps_of(std::span<const Point> points, double radians) {
    constexpr double together = 1e-5;
    std::vector<double> places;
    for (const Point& p : points) places.push_back(p.x * std::cos(radians) + p.y * std::sin(radians));
    std::sort(places.begin(), places.end());
    std::vector<int> counts;
    std::vector<Jump> jumps;
    for (const double place : places) {
        if (jumps.empty() || place - jumps.back().at >= together) jumps.push_back({place, 0}), counts.push_back(0);
        jumps.back().size = static_cast<double>(++counts.back()) / static_cast<double>(points.size());
    }
    return jumps;
}

double longest_gap(const std::vector<Jump>& jumps, double half_way) {
    double before = -half_way, longest = 0;
    for (const Jump& jump : jumps) {
        const double at = std::clamp(jump.at, -half_way, half_way);
        longest = std::max(longest, at - before);
        before = at;
    }
    return std::max(longest, half_way - before);
}

/// The mean of (coverage - area)^2 over the way.
double mean_square_error(const std::vector<Jump>& jumps, const Area& area) {
    const double end = area.half_way();
    std::vector<double> ends{-end, -area.knot(), area.knot(), end};  // between them the error is a polynomial
    for (const Jump& jump : jumps) ends.push_back(std::clamp(jump.at, -end, end));
    std::sort(ends.begin(), ends.end());
    double sum = 0, coverage = 0;
    std::size_t next = 0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        while (next < jumps.size() && jumps[next].at <= ends[i - 1]) coverage += jumps[next++].size;
        if (ends[i] <= ends[i - 1]) continue;
        sum += integrate([&](double t) { return std::pow(coverage - area.before(t), 2); }, ends[i - 1], ends[i]);
    }
    return sum / (2 * end);
}

}  // namespace

EdgeSweep sweep_edge(std::span<const Point> points, double degrees) {
    check_points("sweep_edge", points);
    if (!std::isfinite(degrees)) fail("sweep_edge: ", degrees, " degrees; pass a number");
    const double radians = degrees * std::numbers::pi / 180;
    const Area area(radians);
    const std::vector<Jump> jumps = jumps_of(points, radians);
    EdgeSweep sweep{degrees,
                    static_cast<int>(jumps.size()) + 1,
                    {},
                    longest_gap(jumps, area.half_way()),
                    std::sqrt(mean_square_error(jumps, area))};
    for (const Jump& jump : jumps) sweep.steps.push_back(jump.size);
    return sweep;
}

std::vector<EdgeSweep> sweep_edges(std::span<const Point> points) {
    std::vector<EdgeSweep> sweeps;
    for (const double degrees : sweep_degrees) sweeps.push_back(sweep_edge(points, degrees));
    return sweeps;
}

double star_discrepancy(std::span<const Point> points) {
    std::vector<Point> sorted = from_corner("star_discrepancy", points);
    std::sort(sorted.begin(), sorted.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    const auto count = static_cast<double>(sorted.size());
    std::vector<double> below;  // the y of the points left of the box's side, ascending
    double worst = 0;
    // The largest difference is at a box whose sides touch points, or the pixel's: without them it is as large as can
    // be with few points, with them as small as can be with many.
    for (std::size_t i = 0; i <= sorted.size(); ++i) {
        const double x = i < sorted.size() ? sorted[i].x : 1;
        for (std::size_t k = 0; k <= below.size(); ++k) {
            const double y = k < below.size() ? below[k] : 1;
            worst = std::max(worst, x * y - static_cast<double>(k) / count);
        }
        if (i == sorted.size()) break;
        below.insert(std::upper_bound(below.begin(), below.end(), sorted[i].y), sorted[i].y);
        for (std::size_t k = 0; k < below.size(); ++k)
            worst = std::max(worst, static_cast<double>(k + 1) / count - x * below[k]);
    }
    return worst;
}

double l2_discrepancy(std::span<const Point> points) {
    const std::vector<Point> p = from_corner("l2_discrepancy", points);
    const auto count = static_cast<double>(p.size());
    double single = 0, pairs = 0;
    for (const Point& a : p) {
        single += (1 - a.x * a.x) * (1 - a.y * a.y);
        for (const Point& b : p) pairs += (1 - std::max(a.x, b.x)) * (1 - std::max(a.y, b.y));
    }
    return std::sqrt(std::max(0.0, 1.0 / 9 - single / (2 * count) + pairs / (count * count)));
}

double least_distance(std::span<const Point> points) {
    check_points("least_distance", points);
    const auto across = [](double d) { return std::abs(d - std::round(d)); };
    double least = 1;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = i + 1; k < points.size(); ++k)
            least = std::min(least, std::hypot(across(points[i].x - points[k].x), across(points[i].y - points[k].y)));
    return least;
}

PatternSpectrum pattern_spectrum(std::span<const Point> points, int highest, int per_cycle) {
    check_points("pattern_spectrum", points);
    if (highest < 1 || highest > 256 || per_cycle < 1 || per_cycle > 256)
        fail("pattern_spectrum: highest = ", highest, ", per_cycle = ", per_cycle, "; pass 1 to 256 for both");
    PatternSpectrum spectrum{2 * highest * per_cycle + 1, 1.0 / per_cycle, {}};
    for (int y = 0; y < spectrum.width; ++y)
        for (int x = 0; x < spectrum.width; ++x) {
            std::complex<double> sum = 0;
            for (const Point& p : points)
                sum += std::polar(1.0,
                                  -2 * std::numbers::pi * (spectrum.frequency(x) * p.x + spectrum.frequency(y) * p.y));
            spectrum.power.push_back(std::norm(sum) / static_cast<double>(points.size()));
        }
    return spectrum;
}

}  // namespace bandlimit
