#include "bandlimit/sampling/pattern_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/sampling/pattern.h"

namespace bandlimit {
namespace {

/// The share of a pixel before a line, by brute force.
double area_before(double t, double radians) {
    constexpr int n = 200;
    int inside = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            inside += ((i + 0.5) / n - 0.5) * std::cos(radians) + ((j + 0.5) / n - 0.5) * std::sin(radians) < t;
    return double(inside) / (n * n);
}

/// The RMS of coverage less area, by brute force.
double rms_by_force(const SamplePattern& pattern, double degrees) {
    const double radians = degrees * std::numbers::pi / 180;
    const double half = (std::abs(std::cos(radians)) + std::abs(std::sin(radians))) / 2;
    constexpr int steps = 200;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (2 * (i + 0.5) / steps - 1) * half;
        double covered = 0;
        for (const Point& p : pattern.points)
            covered += p.x * std::cos(radians) + p.y * std::sin(radians) < t ? 1.0 / pattern.count() : 0.0;
        sum += std::pow(covered - area_before(t, radians), 2) / steps;
    }
    return std::sqrt(sum);
}

void expect_steps(const EdgeSweep& sweep, const std::vector<double>& steps) {
    ASSERT_EQ(sweep.steps.size(), steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(sweep.steps[i], steps[i], 1e-12);
    EXPECT_EQ(sweep.levels, static_cast<int>(steps.size()) + 1);
}

TEST(EdgeSweep, OfOneSampleIsHalfWrong) {
    const std::vector<Point> centre{{0, 0}};
    const EdgeSweep sweep = sweep_edge(centre, 0);
    expect_steps(sweep, {1});
    EXPECT_NEAR(sweep.max_gap, 0.5, 1e-12);
    EXPECT_NEAR(sweep.rms, std::sqrt(1 / 12.0), 1e-12);  // area - step is uniform in [-1/2, 1/2]
    EXPECT_NEAR(sweep_edge(std::vector<Point>{{-0.25, 0}}, 0).max_gap, 0.75, 1e-12);
    // Along a diagonal of half length d the area is ((t + d) / d)^2 / 2: the integral of its fourth power is d / 20.
    EXPECT_NEAR(sweep_edge(centre, 45).rms, std::sqrt(1 / 20.0), 1e-12);
    EXPECT_NEAR(sweep_edge(centre, 45).max_gap, std::sqrt(0.5), 1e-12);
}

TEST(EdgeSweep, RotatedGridHasTheMiddleStepTwice) {
    const std::vector<Point> points = rotated_pattern(4).points;
    for (const double degrees : {0.0, 90.0}) expect_steps(sweep_edge(points, degrees), {0.25, 0.5, 0.25});
    expect_steps(sweep_edge(points, 45), {0.5, 0.5});
}

TEST(EdgeSweep, RooksHaveEqualLevels) {
    for (const double degrees : {0.0, 90.0}) {
        const EdgeSweep sweep = sweep_edge(n_rooks_pattern(4, 3).points, degrees);
        expect_steps(sweep, {0.25, 0.25, 0.25, 0.25});
        EXPECT_NEAR(sweep.max_gap, 0.25, 1e-12);
        EXPECT_NEAR(sweep.rms, 0.25 * std::sqrt(1 / 12.0), 1e-12);
        expect_steps(sweep_edge(d3d_pattern(4).points, degrees), {0.25, 0.25, 0.25, 0.25});
    }
}

TEST(EdgeSweep, Direct3DsPatternIsNotTheSameInBothDirections) {
    const EdgeSweep worse = sweep_edge(d3d_pattern(4).points, 26.565),
                    better = sweep_edge(d3d_pattern(4).points, -26.565);
    EXPECT_EQ(worse.levels, 3);
    EXPECT_NEAR(worse.rms, 0.133, 0.0005);
    EXPECT_EQ(better.levels, 5);
    EXPECT_NEAR(better.rms, 0.0775, 0.0005);
}

TEST(EdgeSweep, EqualsBruteForce) {
    // Of the area, 200^2 points are off by half a row at most; of the way, 200 steps by half a step at each jump.
    for (const char* name : {"d3d:8", "halton:5", "rotated:16", "quincunx"})
        for (const double degrees : {0.0, 10.0, 26.565, 45.0, 120.0, -80.0, 1e-5})
            EXPECT_NEAR(sweep_edge(parse_pattern(name).points, degrees).rms, rms_by_force(parse_pattern(name), degrees),
                        0.004)
                << name << " at " << degrees;
}

TEST(EdgeSweep, StepsSumToOneInEveryDirection) {
    const std::vector<EdgeSweep> sweeps = sweep_edges(sobol_pattern(32).points);
    ASSERT_EQ(sweeps.size(), sweep_degrees.size());
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        EXPECT_EQ(sweeps[i].degrees, sweep_degrees[i]);
        double sum = 0;
        for (const double step : sweeps[i].steps) sum += step;
        EXPECT_NEAR(sum, 1, 1e-12);
    }
    EXPECT_THROW(sweep_edge({}, 0), Error);
    EXPECT_THROW(sweep_edge(d3d_pattern(2).points, NAN), Error);
}

/// Over boxes from the corner whose sides touch points, open and closed.
double star_by_force(const std::vector<Point>& points) {
    std::vector<double> xs{1}, ys{1};
    for (const Point& p : points) xs.push_back(p.x + 0.5), ys.push_back(p.y + 0.5);
    double worst = 0;
    for (const double x : xs)
        for (const double y : ys) {
            double open = 0, closed = 0;
            for (const Point& p : points) {
                open += p.x + 0.5 < x && p.y + 0.5 < y;
                closed += p.x + 0.5 <= x && p.y + 0.5 <= y;
            }
            const auto n = static_cast<double>(points.size());
            worst = std::max({worst, x * y - open / n, closed / n - x * y});
        }
    return worst;
}

TEST(Discrepancy, OfTheCentreAlone) {
    const std::vector<Point> centre{{0, 0}};
    EXPECT_NEAR(star_discrepancy(centre), 0.75, 1e-12);  // the closed box of a quarter holds everything
    EXPECT_NEAR(l2_discrepancy(centre), std::sqrt(1 / 9.0 - 0.75 * 0.75 / 2 + 0.25), 1e-12);
}

TEST(Discrepancy, EqualsBruteForce) {
    for (const char* name : {"d3d:8", "halton:20", "regular:16", "random:17:3", "quincunx"})
        EXPECT_NEAR(star_discrepancy(parse_pattern(name).points), star_by_force(parse_pattern(name).points), 1e-12)
            << name;
}

TEST(Discrepancy, SequencesAreMoreEvenThanChance) {
    const double chance = l2_discrepancy(random_pattern(256, 1).points);
    for (const char* name : {"halton:256", "r2:256", "sobol:256:1"}) {
        EXPECT_LT(l2_discrepancy(parse_pattern(name).points), chance / 4) << name;
        EXPECT_LT(star_discrepancy(parse_pattern(name).points), 0.03) << name;
    }
    EXPECT_THROW(star_discrepancy(rotated_pattern(16).points), Error);  // its corners leave the pixel
    EXPECT_THROW(l2_discrepancy({}), Error);
}

TEST(LeastDistance, GoesAcrossBorders) {
    EXPECT_EQ(least_distance(regular_pattern(1).points), 1);
    EXPECT_NEAR(least_distance(regular_pattern(16).points), 0.25, 1e-12);
    EXPECT_NEAR(least_distance(std::vector<Point>{{-0.45, 0}, {0.45, 0}}), 0.1, 1e-12);
    EXPECT_NEAR(least_distance(checkerboard_pattern().points), std::sqrt(0.5), 1e-12);
}

TEST(Spectrum, OfAGridIsTheDualGrid) {
    const PatternSpectrum spectrum = pattern_spectrum(regular_pattern(16).points, 8);
    ASSERT_EQ(spectrum.width, 17);
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 17; ++x) {
            const bool is_dual = std::fmod(spectrum.frequency(x), 4) == 0 && std::fmod(spectrum.frequency(y), 4) == 0;
            EXPECT_NEAR(spectrum.at(x, y), is_dual ? 16 : 0, 1e-9);
        }
    // A lattice turned by 45 degrees: of two per pixel, where fx + fy is even.
    const PatternSpectrum turned = pattern_spectrum(checkerboard_pattern().points, 3);
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 7; ++x) EXPECT_NEAR(turned.at(x, y), (x + y) % 2 == 0 ? 2 : 0, 1e-9);
}

TEST(Spectrum, OfRandomPointsIsFlat) {
    const PatternSpectrum spectrum = pattern_spectrum(random_pattern(1024, 9).points, 16);
    double sum = 0;
    for (const double power : spectrum.power) sum += power;
    // Less the 1024 at zero, 33^2 - 1 values, half of them free, of mean and deviation 1: within five deviations.
    const double count = 33 * 33 - 1;
    EXPECT_NEAR((sum - 1024) / count, 1, 5 / std::sqrt(count / 2));
    EXPECT_THROW(pattern_spectrum({}, 4), Error);
    EXPECT_THROW(pattern_spectrum(random_pattern(4).points, 0), Error);
}

}  // namespace
}  // namespace bandlimit
