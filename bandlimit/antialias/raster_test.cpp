#include "bandlimit/antialias/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

Image<float> drawn(const std::vector<RasterShape>& shapes, const RasterFilter& filter, int width, int height,
                   Parallel parallel = {}) {
    Image<float> image(width, height, 4);
    draw(shapes, filter, image.view(), parallel);
    return image;
}

Image<float> truth(const std::vector<RasterShape>& shapes, const RasterFilter& filter, int width, int height,
                   int samples) {
    Image<float> image(width, height, 4);
    Rasterizer(shapes, filter).draw_supersampled(image.view(), samples);
    return image;
}

double sum_of(const Image<float>& image, int channel = 3) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += double(image.view()(x, y, channel));
    return sum;
}

double largest_difference(const Image<float>& a, const Image<float>& b) {
    double largest = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < 4; ++c)
                largest = std::max(largest, std::abs(double(a.view()(x, y, c)) - double(b.view()(x, y, c))));
    return largest;
}

double rms_difference(const Image<float>& a, const Image<float>& b) {
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) sum += std::pow(double(a.view()(x, y, 3)) - double(b.view()(x, y, 3)), 2);
    return std::sqrt(sum / a.width() / a.height());
}

std::string refusal(const RasterShape& shape) {
    try {
        check(shape);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

Point turned(Point p, double angle, Point around) {
    const double x = p.x - around.x, y = p.y - around.y;
    return {around.x + x * std::cos(angle) - y * std::sin(angle), around.y + x * std::sin(angle) + y * std::cos(angle)};
}

const std::vector<std::string> all_filters{"cone:1",    "gaussian:0.5", "box",   "tent",
                                           "quadratic", "bspline",      "jinc3", "lanczos3"};

TEST(Raster, LinesHaveThePublishedCoverage) {
    const float cone[] = {.7799f, .7032f, .5000f, .2757f, .1101f, .0210f},
                gaussian[] = {.6827f, .6247f, .4772f, .3023f, .1573f, .0666f};
    for (int i = 0; i < 6; ++i) {
        const double x = 20.5 + 0.25 * i;  // of the axis, from the centre of pixel 20
        const std::vector<RasterShape> line{{LineShape{{x, -5}, {x, 50}, 1}}};
        EXPECT_NEAR(drawn(line, raster_filter("cone:1"), 40, 40).view()(20, 20, 0), cone[i], 6e-5f);
        EXPECT_NEAR(drawn(line, raster_filter("gaussian:0.5"), 40, 40).view()(20, 20, 0), gaussian[i], 6e-5f);
    }
}

/// The splines add up to 1 over all pixels wherever a point is: so coverages add up to the area exactly.
TEST(Raster, CoveragesAddUpToTheArea) {
    Random random(1);
    for (const std::string name : {"box", "tent", "quadratic", "bspline"}) {
        const RasterFilter filter = raster_filter(name);
        for (int i = 0; i < 12; ++i) {
            const double angle = random.uniform(0, 2 * pi), width = random.uniform(0.02, 6);
            const Point middle{32 + random.uniform(-1, 1), 32 + random.uniform(-1, 1)};
            const auto at = [&](double x, double y) { return turned({middle.x + x, middle.y + y}, angle, middle); };
            const auto area = [&](ShapeGeometry shape) { return sum_of(drawn({{shape}}, filter, 64, 64)); };
            const double each = 3e-6 * 64 * (width + 4);  // the error of a table, over the pixels of a rim
            EXPECT_NEAR(area(LineShape{at(-20, 0), at(20, 0), 0.1}), 40 * 0.1, each) << name;
            EXPECT_NEAR(area(LineShape{at(-15, 0), at(15, 0), width, LineCap::round}),
                        30 * width + pi * width * width / 4, each)
                << name;
            EXPECT_NEAR(area(DiscShape{middle, width}), pi * width * width, each) << name;
            EXPECT_NEAR(area(PointShape{middle}), 1, each) << name;
            EXPECT_NEAR(area(PolygonShape{{at(-9, -3), at(7, -5), at(3, 11)}}), 0.5 * (16 * 14 + 2 * 12), each) << name;
            // Bends: the outer side has a sector of the turn's angle, the inner side lacks a kite.
            const double turn = 2.0, cut = width / 2 * std::tan(turn / 2);
            const PolylineShape bend{{at(-20, 0), at(0, 0), at(20 * std::cos(turn), 20 * std::sin(turn))}, width};
            EXPECT_NEAR(area(bend), 40 * width + turn * width * width / 8 - cut * width / 2, each) << name;
        }
    }
}

/// Other filters alias a little: what the spectrum of the line has at whole frequencies.
TEST(Raster, ThinLinesKeepTheirLightAtAnyAngle) {
    const double length = 40, width = 0.1;
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(pi * x) / (pi * x); };
    for (const std::string name : {"cone:1", "gaussian:0.5", "jinc3"}) {
        const RasterFilter filter = raster_filter(name);
        for (double angle = 0; angle < pi; angle += 0.11) {
            const Point along{std::cos(angle), std::sin(angle)};
            double alias = 0;
            for (int y = -4; y <= 4; ++y)
                for (int x = -4; x <= 4; ++x)
                    if (x != 0 || y != 0)
                        alias += std::abs(filter.response(x, y) * sinc(length * (x * along.x + y * along.y)) *
                                          sinc(width * (y * along.x - x * along.y)));
            const LineShape line{{32 - 20 * along.x, 32 - 20 * along.y}, {32 + 20 * along.x, 32 + 20 * along.y}, width};
            EXPECT_NEAR(sum_of(drawn({{line}}, filter, 64, 64)) / (length * width), 1, alias + 1e-3) << name << angle;
        }
    }
}

std::vector<RasterShape> each_kind(Point shift = {}) {
    const auto at = [&](double x, double y) { return Point{x + shift.x, y + shift.y}; };
    return {{LineShape{at(5.3, 7.1), at(27.4, 22.9), 3}},
            {LineShape{at(5.3, 7.1), at(27.4, 22.9), 0.3}},
            {LineShape{at(8, 25), at(14, 6), 7, LineCap::round}},
            {LineShape{at(12.2, 16.1), at(12.2, 16.1), 5, LineCap::round}},
            {DiscShape{at(16.1, 15.2), 9.3}},
            {DiscShape{at(16.1, 15.2), 0.8}},
            {PolygonShape{{at(4, 5), at(28, 9), at(14, 27)}}},
            {PolygonShape{{at(4, 5), at(28, 6), at(29, 6.2)}}},
            {PolygonShape{{at(15.2, 15.3), at(15.9, 15.4), at(15.7, 16)}}},
            {PolylineShape{{at(4, 20), at(14, 8), at(20, 24), at(28, 6)}, 3.5, LineCap::round}},
            {PolylineShape{{at(8, 8), at(24, 10), at(22, 24), at(9, 21)}, 2, LineCap::butt, true}}};
}

/// N samples per axis know an edge to 1 / N along its normal, and each row of samples on its own: errors of N rows
/// within the radius average out. The bound is generous for edges along the samples.
TEST(Raster, SingleShapesEqualTheSupersampledTruth) {
    constexpr int samples = 16;
    for (const std::string& name : all_filters)
        for (const RasterShape& shape : each_kind()) {
            const RasterFilter filter = raster_filter(name);
            const Image<float> fast = drawn({shape}, filter, 32, 32), slow = truth({shape}, filter, 32, 32, samples);
            EXPECT_LT(largest_difference(fast, slow), 0.6 / samples) << name << ", shape " << shape.geometry.index();
            EXPECT_LT(rms_difference(fast, slow), 0.08 / samples) << name << ", shape " << shape.geometry.index();
        }
}

TEST(Raster, RadialFiltersDoNotKnowDirections) {
    const Point pixel{20.5, 20.5};
    for (const std::string name : {"cone:1", "gaussian:0.5", "jinc3"}) {
        const RasterFilter filter = raster_filter(name);
        for (double angle = 0; angle < 2 * pi; angle += 0.37) {
            const auto at = [&](double x, double y) { return turned({x, y}, angle, pixel); };
            const std::vector<RasterShape> shapes{{PolygonShape{{at(20.9, 19.8), at(21.4, 26), at(12, 21)}}},
                                                  {LineShape{at(20.2, 20.6), at(30, 25), 0.7, LineCap::round}},
                                                  {PolylineShape{{at(14, 20), at(20.6, 20.6), at(21, 28)}, 1.2}}};
            const std::vector<RasterShape> straight{{PolygonShape{{{20.9, 19.8}, {21.4, 26}, {12, 21}}}},
                                                    {LineShape{{20.2, 20.6}, {30, 25}, 0.7, LineCap::round}},
                                                    {PolylineShape{{{14, 20}, {20.6, 20.6}, {21, 28}}, 1.2}}};
            for (std::size_t i = 0; i < shapes.size(); ++i)
                EXPECT_NEAR(drawn({shapes[i]}, filter, 40, 40).view()(20, 20, 0),
                            drawn({straight[i]}, filter, 40, 40).view()(20, 20, 0), 1e-5)
                    << name << ", shape " << i << " at " << angle;
        }
    }
}

TEST(Raster, MirroredShapesGiveMirroredPictures) {
    for (const std::string& name : all_filters) {
        const RasterFilter filter = raster_filter(name);
        const PolygonShape here{{{4, 5}, {28, 9}, {14, 27}}}, mirrored{{{28, 5}, {4, 9}, {18, 27}}},
            transposed{{{5, 4}, {9, 28}, {27, 14}}};
        const Image<float> a = drawn({{here}}, filter, 32, 32), b = drawn({{mirrored}}, filter, 32, 32),
                           c = drawn({{transposed}}, filter, 32, 32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                EXPECT_NEAR(a.view()(x, y, 0), b.view()(31 - x, y, 0), 1e-5) << name;
                EXPECT_NEAR(a.view()(x, y, 0), c.view()(y, x, 0), 1e-5) << name;
            }
    }
}

TEST(Raster, CornersMayBeGivenInEitherOrderAndTwice) {
    const RasterFilter filter = raster_filter("cone:1");
    const Image<float> one = drawn({{PolygonShape{{{4, 5}, {28, 9}, {14, 27}}}}}, filter, 32, 32);
    EXPECT_LT(largest_difference(one, drawn({{PolygonShape{{{14, 27}, {28, 9}, {4, 5}}}}}, filter, 32, 32)), 1e-6);
    const PolygonShape twice{{{4, 5}, {4, 5}, {16, 7}, {28, 9}, {14, 27}, {14, 27}, {4, 5}}};
    EXPECT_LT(largest_difference(one, drawn({{twice}}, filter, 32, 32)), 1e-6);
}

TEST(Raster, CoverageStaysWithinZeroAndOne) {
    Random random(3);
    for (const std::string name : {"cone:1", "gaussian:0.5", "bspline"})
        for (int i = 0; i < 30; ++i) {
            const auto at = [&] { return Point{random.uniform(0, 24), random.uniform(0, 24)}; };
            const double width = random.uniform(0.01, 8);
            const std::vector<RasterShape> shapes{{LineShape{at(), at(), width}},
                                                  {PolygonShape{{at(), at(), at()}}},
                                                  {PolylineShape{{at(), at(), at(), at()}, width, LineCap::round}}};
            for (const RasterShape& shape : shapes) {
                const Image<float> image = drawn({shape}, raster_filter(name), 24, 24);
                for (int y = 0; y < 24; ++y)
                    for (int x = 0; x < 24; ++x) {
                        ASSERT_GE(image.view()(x, y, 3), 0);
                        ASSERT_LE(image.view()(x, y, 3), 1);
                    }
            }
        }
}

TEST(Raster, AbuttingShapesLeaveASeamUnlessTheyAreOneGroup) {
    // Two halves of a square that meet in the middle of pixel column 10.
    const auto halves = [](int group) {
        return std::vector<RasterShape>{
            {PolygonShape{{{2, 2}, {10.5, 2}, {10.5, 18}, {2, 18}}}, {1, 1, 1, 1}, group},
            {PolygonShape{{{10.5, 2}, {18, 2}, {18, 18}, {10.5, 18}}}, {1, 1, 1, 1}, group}};
    };
    const RasterFilter filter = raster_filter("cone:1");
    EXPECT_NEAR(drawn(halves(0), filter, 20, 20).view()(10, 10, 0), 0.75, 1e-6);
    EXPECT_NEAR(drawn(halves(1), filter, 20, 20).view()(10, 10, 0), 1, 1e-6);
    EXPECT_NEAR(truth(halves(0), filter, 20, 20, 16).view()(10, 10, 0), 1, 1e-6);
    // In a group the whole picture is that of the whole square.
    const Image<float> whole = drawn({{PolygonShape{{{2, 2}, {18, 2}, {18, 18}, {2, 18}}}}}, filter, 20, 20);
    EXPECT_LT(largest_difference(drawn(halves(1), filter, 20, 20), whole), 1e-5);
}

TEST(Raster, GroupsMixColoursByCoverage) {
    const std::vector<RasterShape> halves{{PolygonShape{{{2, 2}, {10.5, 2}, {10.5, 18}, {2, 18}}}, {1, 0, 0, 1}, 7},
                                          {PolygonShape{{{10.5, 2}, {18, 2}, {18, 18}, {10.5, 18}}}, {0, 4, 0, 1}, 7}};
    const Image<float> image = drawn(halves, raster_filter("bspline"), 20, 20);
    EXPECT_NEAR(image.view()(10, 10, 0), 0.5, 1e-5);
    EXPECT_NEAR(image.view()(10, 10, 1), 2, 1e-5);
    EXPECT_NEAR(image.view()(10, 10, 3), 1, 1e-5);
}

TEST(Raster, OverlapInAGroupSharesThePixel) {
    const DiscShape disc{{10, 10}, 6};
    const Image<float> image =
        drawn({{disc, {1, 0, 0, 1}, 1}, {disc, {0, 1, 0, 1}, 1}}, raster_filter("cone:1"), 20, 20);
    EXPECT_NEAR(image.view()(10, 10, 0), 0.5, 1e-6);
    EXPECT_NEAR(image.view()(10, 10, 1), 0.5, 1e-6);
    EXPECT_NEAR(image.view()(10, 10, 3), 1, 1e-6);
}

TEST(Raster, ALineThatCrossesItselfIsDrawnOnce) {
    const std::vector<RasterShape> loop{
        {PolylineShape{{{2, 10}, {18, 10}, {18, 18}, {10, 18}, {10, 2}}, 5}, {1, 1, 1, 0.5}}};
    EXPECT_NEAR(drawn(loop, raster_filter("cone:1"), 20, 20).view()(10, 10, 3), 0.5, 1e-6);
    EXPECT_NEAR(truth(loop, raster_filter("cone:1"), 20, 20, 8).view()(10, 10, 3), 0.5, 1e-6);
}

TEST(Raster, BlendsOverWhatIsThere) {
    Image<float> image(5, 5, 4);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x)
            for (int c = 0; c < 4; ++c) image.view()(x, y, c) = 1;
    const std::vector<RasterShape> shapes{{PolygonShape{{{-9, -9}, {2.5, -9}, {2.5, 9}, {-9, 9}}}, {0, 3, 0, 0.5}}};
    draw(shapes, raster_filter("cone:1"), image.view());
    EXPECT_NEAR(image.view()(2, 2, 0), 0.75, 1e-6);  // coverage 1/2, alpha 1/2
    EXPECT_NEAR(image.view()(2, 2, 1), 0.75 + 0.25 * 3, 1e-6);
    EXPECT_NEAR(image.view()(2, 2, 3), 1, 1e-6);
    EXPECT_EQ(image.view()(4, 2, 0), 1);
    EXPECT_NEAR(image.view()(0, 2, 0), 0.5, 1e-6);
}

TEST(Raster, BandsAndThreadsDoNotMatter) {
    std::vector<RasterShape> shapes = each_kind();
    shapes[2].group = shapes[3].group = 1;
    const Rasterizer rasterizer(shapes, raster_filter("gaussian:0.5"));
    const Image<float> whole = drawn(shapes, raster_filter("gaussian:0.5"), 32, 32, {1});
    Image<float> bands(32, 32, 4), sampled(32, 32, 4), sampled_bands(32, 32, 4);
    rasterizer.draw_supersampled(sampled.view(), 4);
    for (int y = 0; y < 32; y += 5) {
        const int rows = std::min(5, 32 - y);
        rasterizer.draw(cropped(bands.view(), 0, y, 32, rows), y, {3});
        rasterizer.draw_supersampled(cropped(sampled_bands.view(), 0, y, 32, rows), 4, y, {3});
    }
    EXPECT_EQ(largest_difference(whole, bands), 0);
    EXPECT_EQ(largest_difference(sampled, sampled_bands), 0);
}

TEST(Raster, HugeCoordinatesDrawWhatIsInside) {
    for (const std::string name : {"cone:1", "bspline"}) {
        const RasterFilter filter = raster_filter(name);
        const Image<float> short_line = drawn({{LineShape{{-100, -84}, {132, 148}, 2}}}, filter, 32, 32),
                           long_line = drawn({{LineShape{{-9e8 + 0, -9e8 + 16}, {9e8, 9e8 + 16}, 2}}}, filter, 32, 32);
        EXPECT_LT(largest_difference(short_line, long_line), 1e-5) << name;  // 1e9 is known to 1e-7
        const Image<float> everything = drawn({{DiscShape{{0, 0}, 1e9}}}, filter, 32, 32);
        EXPECT_EQ(sum_of(everything), 32 * 32) << name;
        const Image<float> half =
            drawn({{PolygonShape{{{-1e9, -1e9}, {16, -1e9}, {16, 1e9}, {-1e9, 1e9}}}}}, filter, 32, 32);
        EXPECT_NEAR(sum_of(half), 16 * 32, 1e-3) << name;
        EXPECT_EQ(sum_of(drawn({{LineShape{{1e8, 1e8}, {9e8, 2e8}, 50}}}, filter, 32, 32)), 0) << name;
    }
}

TEST(Raster, NothingIsDrawnForWhatHasNoArea) {
    const RasterFilter filter = raster_filter("cone:1");
    EXPECT_EQ(sum_of(drawn({{LineShape{{9, 9}, {9, 9}, 3}}}, filter, 20, 20)), 0);
    EXPECT_EQ(sum_of(drawn({{PolygonShape{{{2, 2}, {9, 9}, {5, 5}}}}}, filter, 20, 20)), 0);
    EXPECT_EQ(sum_of(drawn({{PolylineShape{{{4, 4}, {4, 4}}, 3}}}, filter, 20, 20)), 0);
    const Image<float> round = drawn({{LineShape{{9, 9}, {9, 9}, 3, LineCap::round}}}, filter, 20, 20);
    EXPECT_LT(largest_difference(round, drawn({{DiscShape{{9, 9}, 1.5}}}, filter, 20, 20)), 1e-6);
}

/// A polyline along a straight line is that line: bends of no angle leave nothing behind.
TEST(Raster, PolylinesThroughAStraightLineAreThatLine) {
    for (const std::string name : {"cone:1", "bspline"}) {
        const RasterFilter filter = raster_filter(name);
        const Image<float> line = drawn({{LineShape{{3, 5}, {27, 17}, 2.5}}}, filter, 32, 24);
        const PolylineShape pieces{{{3, 5}, {5, 6}, {5.2, 6.1}, {15, 11}, {27, 17}}, 2.5};
        EXPECT_LT(largest_difference(line, drawn({{pieces}}, filter, 32, 24)), 2e-5) << name;
    }
}

/// Many short segments around a circle, and the ring between two circles.
TEST(Raster, ClosedPolylinesAreRings) {
    std::vector<Point> circle;
    for (int i = 0; i < 720; ++i)
        circle.push_back({16 + 10 * std::cos(2 * pi * i / 720), 16 + 10 * std::sin(2 * pi * i / 720)});
    const RasterFilter filter = raster_filter("cone:1");
    const Image<float> ring = drawn({{PolylineShape{circle, 4, LineCap::butt, true}}}, filter, 32, 32),
                       outer = drawn({{DiscShape{{16, 16}, 12}}}, filter, 32, 32),
                       inner = drawn({{DiscShape{{16, 16}, 8}}}, filter, 32, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)  // the outline is off the circle by 10 (1 - cos(pi / 720)) = 1e-4
            EXPECT_NEAR(ring.view()(x, y, 3), outer.view()(x, y, 3) - inner.view()(x, y, 3), 3e-4);
}

TEST(Raster, RefusesWhatNoShapeCanBe) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal({PolygonShape{{{0, 0}, {9, 0}, {2, 2}, {0, 9}}}}).find("not convex at its point 2"),
              std::string::npos);
    EXPECT_NE(refusal({PolygonShape{{{0, 9}, {2, 2}, {9, 0}, {0, 0}}}}).find("not convex at its point 1"),
              std::string::npos);
    std::vector<Point> star;
    for (int i = 0; i < 5; ++i) star.push_back({std::cos(4 * pi * i / 5), std::sin(4 * pi * i / 5)});
    EXPECT_NE(refusal({PolygonShape{star}}).find("2 times"), std::string::npos);
    EXPECT_NE(refusal({PolygonShape{{{0, 0}, {1, 1}}}}).find("at least 3"), std::string::npos);
    EXPECT_NE(refusal({PolylineShape{{{0, 0}}, 1}}).find("at least 2"), std::string::npos);
    EXPECT_NE(refusal({LineShape{{0, 0}, {1, nan}, 1}}).find("out of range"), std::string::npos);
    EXPECT_NE(refusal({LineShape{{0, 0}, {1e10, 0}, 1}}).find("out of range"), std::string::npos);
    EXPECT_NE(refusal({LineShape{{0, 0}, {1, 0}, 0}}).find("width"), std::string::npos);
    EXPECT_NE(refusal({DiscShape{{0, 0}, -1}}).find("radius"), std::string::npos);
    EXPECT_NE(refusal({DiscShape{{0, 0}, 1}, {0, 0, 0, 2}}).find("alpha"), std::string::npos);
    EXPECT_NE(refusal({DiscShape{{0, 0}, 1}, {float(nan), 0, 0, 1}}).find("colour"), std::string::npos);
    EXPECT_EQ(refusal({PolygonShape{{{0, 0}, {4, 0}, {8, 0}, {8, 8}}}}), "");  // a corner on an edge
    Image<float> grey(4, 4, 1), rgb(4, 4, 3);
    EXPECT_THROW(draw({}, raster_filter("box"), grey.view()), Error);
    EXPECT_THROW(Rasterizer({}, raster_filter("cone:0.2")).draw_supersampled(rgb.view(), 2), Error);
    EXPECT_THROW(Rasterizer({}, raster_filter("box")).draw_supersampled(rgb.view(), 65), Error);
}

TEST(Raster, StopsWhenAsked) {
    std::stop_source user;
    user.request_stop();
    Image<float> image(64, 64, 4);
    const std::vector<RasterShape> shapes = each_kind();
    EXPECT_THROW(draw(shapes, raster_filter("cone:1"), image.view(), {.threads = 2, .stop = user.get_token()}),
                 Stopped);
}

}  // namespace
}  // namespace bandlimit
