#include "apps/page/pattern_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bandlimit/sampling/pattern_analysis.h"

namespace bandlimit::app {

Panel points_panel(const SamplePattern& pattern) {
    Panel panel{pattern.name, "x (pixels from the centre)", "y, downwards", {{"", {}, {}, Series::Style::points}}};
    double reach = 0.5;
    for (const Point& p : pattern.points) {
        panel.series.front().x.push_back(p.x);
        panel.series.front().y.push_back(p.y);
        reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
    }
    panel.x_range = Range{-reach, reach};
    panel.y_range = Range{reach, -reach};
    return panel;
}

Panel coverage_panel(const SamplePattern& pattern) {
    Panel panel{"coverage by an edge", "distance of the edge from the centre (pixels)", "share of the points", {}};
    for (const double degrees : {0.0, 26.565, -26.565}) {
        const double radians = degrees * std::numbers::pi / 180;
        const auto coverage = [&](double t) {
            const auto covered = std::count_if(pattern.points.begin(), pattern.points.end(), [&](const Point& p) {
                return p.x * std::cos(radians) + p.y * std::sin(radians) < t;
            });
            return double(covered) / pattern.count();
        };
        panel.series.push_back(curve(fmt::format("{:.4g} deg.", degrees), -0.75, 0.75, 600, coverage));
    }
    return panel;
}

Panel spectrum_panel(const SamplePattern& pattern) {
    constexpr int highest = 12, per_cycle = 4;
    PatternSpectrum spectrum = pattern_spectrum(pattern.points, highest, per_cycle);
    constexpr double peak = 4;  // times what random points have
    for (double& power : spectrum.power) power = std::min(power, peak);
    HeatMap map{spectrum.width, spectrum.width, spectrum.power, peak, spectrum.frequency(0), spectrum.step};
    return {"spectrum", "cycles per pixel along x", "along y", {}, {}, {}, std::move(map)};
}

}  // namespace bandlimit::app
