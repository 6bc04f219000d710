#include "bandlimit/antialias/raster_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

const std::vector<std::string> continuous{"cone:1",  "gaussian:0.5", "tent", "quadratic",
                                          "bspline", "mitchell",     "jinc3"};
const std::vector<std::string> positive{"cone:1", "cone:1.5", "gaussian:0.5", "box", "tent", "quadratic", "bspline"};
constexpr double table_error = 2e-6, jump_error = 2e-5;  // as raster_filter.h says

double tolerance(const RasterFilter& filter) { return filter.is_continuous() ? table_error : jump_error; }

/// The integral of a filter over what lies inside: its chords along x, found by halving.
template <class Inside>
double integral_over(const RasterFilter& filter, const std::vector<double>& knots_y, const Inside& chord) {
    const double r = filter.radius();
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots_y.size(); ++i)
        sum += integrate(
            [&](double y) {
                const auto [a, b] = chord(y);
                const double low = std::max(a, -r), high = std::min(b, r);
                if (!(low < high)) return 0.0;
                return integrate([&](double x) { return filter.value(x, y); }, low, high, 12);
            },
            knots_y[i], knots_y[i + 1], 12);
    return sum;
}

/// The chord of a convex polygon, whose corners turn from x towards y, by its half planes.
std::pair<double, double> polygon_chord(const std::vector<Point>& corners, double y) {
    double low = -1e3, high = 1e3;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a.y == b.y) continue;
        const double x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
        (b.y > a.y ? high : low) = b.y > a.y ? std::min(high, x) : std::max(low, x);
    }
    return {low, high};
}

TEST(RasterFilter, LinesHaveThePublishedCoverage) {
    const double distances[] = {0, .25, .5, .75, 1, 1.25};
    const double cone[] = {.7799, .7032, .5000, .2757, .1101, .0210},
                 gaussian[] = {.6827, .6247, .4772, .3023, .1573, .0666};
    for (int i = 0; i < 6; ++i)
        for (const double towards : {0.0, 0.3, 1.1, pi / 2, 2.0}) {
            EXPECT_NEAR(line_coverage(raster_filter("cone:1"), distances[i], 1, towards), cone[i], 6e-5);
            EXPECT_NEAR(line_coverage(raster_filter("gaussian:0.5"), distances[i], 1, towards), gaussian[i], 6e-5);
        }
}

TEST(RasterFilter, GaussianEdgesAreErrorFunctions) {
    const RasterFilter filter = gaussian_filter(0.7);
    for (double d = -4; d <= 4; d += 0.0371)  // what is cut off beyond 5 sigma is exp(-12.5)
        EXPECT_NEAR(edge_coverage(filter, d), std::erfc(-d / 0.7 / std::numbers::sqrt2) / 2,
                    std::exp(-12.5) + table_error);
}

TEST(RasterFilter, EdgesOfBoxAndTentArePolynomials) {
    for (double d = -1.2; d <= 1.2; d += 0.013) {
        EXPECT_NEAR(edge_coverage(raster_filter("box"), d), std::clamp(d + 0.5, 0.0, 1.0), table_error);
        const double t = std::min(1.0, 1 - std::abs(d)), tail = t > 0 ? t * t / 2 : 0;
        EXPECT_NEAR(edge_coverage(raster_filter("tent"), d), d < 0 ? tail : 1 - tail, table_error);
        // Along the diagonal, a box is seen as a tent.
        const double u = std::max(0.0, 1 - std::abs(d) * std::numbers::sqrt2);
        EXPECT_NEAR(edge_coverage(raster_filter("box"), d, pi / 4), d < 0 ? u * u / 2 : 1 - u * u / 2, jump_error);
    }
}

TEST(RasterFilter, EdgesRiseFromZeroToOne) {
    for (const std::string& name : positive) {
        const RasterFilter filter = raster_filter(name);
        EXPECT_TRUE(filter.is_positive());
        for (const double towards : {0.0, 0.2, pi / 4, 1.0, 2.5}) {
            const double reach = filter.reach();
            EXPECT_NEAR(edge_coverage(filter, -reach, towards), 0, tolerance(filter)) << name;
            EXPECT_NEAR(edge_coverage(filter, reach, towards), 1, tolerance(filter)) << name;
            double before = 0;
            for (double d = -reach; d <= reach; d += reach / 300) {
                const double here = edge_coverage(filter, d, towards);
                EXPECT_GE(here, before - 2 * tolerance(filter)) << name << " at " << d;
                EXPECT_NEAR(here + edge_coverage(filter, -d, towards), 1, tolerance(filter)) << name;
                before = here;
            }
        }
    }
}

TEST(RasterFilter, FluxThroughTheOutlineIsTheIntegralInside) {
    const std::vector<std::vector<Point>> polygons{
        {{-.5, -.2}, {.9, .1}, {.2, .6}},            // a triangle within
        {{-5, -.3}, {7, .2}, {7, .25}, {-5, -.25}},  // a thin line
        {{.1, .2}, {9, 1}, {4, 9}},                  // a corner
        {{-1e-3, -1e-3}, {1e-3, -1e-3}, {0, 1e-3}},  // less than a table's step
        {{-.3, -8}, {.4, -8}, {.4, .3}, {-.3, .3}},  // an end of a line
    };
    for (const std::string& name : continuous) {
        const RasterFilter filter = raster_filter(name);
        for (const auto& corners : polygons) {
            double flux = 0;
            std::vector<double> knots;
            for (std::size_t i = 0; i < corners.size(); ++i) {
                flux += filter.edge_flux(corners[i], corners[(i + 1) % corners.size()]);
                knots.push_back(std::clamp(corners[i].y, -filter.radius(), filter.radius()));
            }
            std::sort(knots.begin(), knots.end());
            const double integral = integral_over(filter, knots, [&](double y) { return polygon_chord(corners, y); });
            EXPECT_NEAR(flux, integral, 3 * table_error) << name << ", polygon of " << corners[0].x;
        }
    }
}

TEST(RasterFilter, DiscsAreTheIntegralInside) {
    for (const std::string& name : continuous)
        for (const double radius : {0.02, 0.4, 1.0, 3.0, 50.0})
            for (const double distance : {0.0, 0.3, 0.98 * radius, radius, radius + 0.7}) {
                const RasterFilter filter = raster_filter(name);
                const Point c{distance * std::cos(0.4), distance * std::sin(0.4)};
                const auto chord = [&](double y) {
                    const double half = std::sqrt(std::max(0.0, radius * radius - (y - c.y) * (y - c.y)));
                    return std::pair(c.x - half, c.x + half);
                };
                const double r = filter.radius(), low = std::clamp(c.y - radius, -r, r),
                             high = std::clamp(c.y + radius, -r, r);
                EXPECT_NEAR(disc_coverage(filter, c, radius),
                            integral_over(filter, {low, (low + high) / 2, high}, chord), 1e-5)
                    << name << ", radius " << radius << " at " << distance;
            }
}

TEST(RasterFilter, LargeDiscsHaveStraightEdges) {
    for (const std::string& name : continuous) {
        const RasterFilter filter = raster_filter(name);
        const double radius = 1e7;  // the rim is off the tangent by r^2 / 2e7
        for (double d = -1; d <= 1; d += 0.25)
            EXPECT_NEAR(disc_coverage(filter, {radius - d, 0}, radius), edge_coverage(filter, d), 5e-6) << name;
    }
}

TEST(RasterFilter, ResponsesAreKnown) {
    for (const std::string& name : continuous) EXPECT_NEAR(raster_filter(name).response(0, 0), 1, 1e-6) << name;
    const double f = 0.37, x = pi * f;
    EXPECT_NEAR(raster_filter("tent").response(f, 0), std::pow(std::sin(x) / x, 2), 1e-6);
    EXPECT_NEAR(raster_filter("quadratic").response(f, 0), std::pow(std::sin(x) / x, 3), 1e-6);
    EXPECT_NEAR(raster_filter("gaussian:0.5").response(f, 0.2), std::exp(-2 * pi * pi * .25 * (f * f + .04)), 1e-5);
}

/// Sampled, the spectrum of a disc repeats at every whole frequency.
TEST(RasterFilter, SampledDiscsHaveTheRepeatedSpectrum) {
    const RasterFilter filter = raster_filter("quadratic");
    const double radius = 2.3, fx = 0.21, fy = -0.13;
    std::complex<double> sampled = 0;
    for (int y = -5; y <= 5; ++y)
        for (int x = -5; x <= 5; ++x)
            sampled +=
                disc_coverage(filter, {-double(x), -double(y)}, radius) * std::polar(1.0, -2 * pi * (fx * x + fy * y));
    double repeated = 0;
    for (int y = -6; y <= 6; ++y)
        for (int x = -6; x <= 6; ++x) repeated += disc_spectrum(filter, radius, fx + x, fy + y);
    // What is left out falls as f^-1.5 from the disc and as f^-3 along an axis from the filter.
    EXPECT_NEAR(sampled.real(), repeated, 1e-3);
    EXPECT_NEAR(sampled.imag(), 0, 1e-5);
    EXPECT_GT(std::abs(disc_spectrum(filter, radius, fx, fy) - repeated), 1e-3);  // the alias is there
}

TEST(RasterFilter, RefusesWhatIsNoFilter) {
    const auto refusal = [](const char* name) {
        try {
            raster_filter(name);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal("cone").find("cone:R"), std::string::npos);
    EXPECT_NE(refusal("cone:0").find("out of range"), std::string::npos);
    EXPECT_NE(refusal("cone:nan").find("cone"), std::string::npos);
    EXPECT_NE(refusal("gaussian:1e9").find("out of range"), std::string::npos);
    EXPECT_NE(refusal("nearest").find("covers no area"), std::string::npos);
    EXPECT_NE(refusal("sinc:100").find("radius"), std::string::npos);
    EXPECT_NE(refusal("conus:1").find("unknown"), std::string::npos);
    EXPECT_EQ(refusal("cone:2"), "");
}

}  // namespace
}  // namespace bandlimit
