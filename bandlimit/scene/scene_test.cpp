#include "bandlimit/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr int width = 160, height = 90;

double norm(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Calls visit(x, y, frame) for points of some frames, in the image and around it.
template <class Visit>
void at_random(int count, const Visit& visit) {
    Random random(11);
    for (int i = 0; i < count; ++i) {
        const int frame = random.integer(-3, 300);
        const double x = random.uniform(-5, width + 5.0);
        visit(x, random.uniform(-5, height + 5.0), frame);
    }
}

class EveryScene : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& info) { return info.param; });

// Rounding of positions, 1e-13 pixels, times the slope of colours within a texture: below 10 a pixel for the zone plate
// and for clouds. Borders of textures cross a random point within 1e-12 pixels with a probability of 1e-9.
constexpr double tolerance = 1e-9;

TEST_P(EveryScene, MotionLeadsToTheSamePointOfTheFrameBefore) {
    const Scene scene = make_scene(GetParam(), width, height, {.speed = 1.7});
    int seen = 0, hidden = 0, moved = 0;
    at_random(4000, [&](double x, double y, int frame) {
        const SceneSample now = scene.at(x, y, frame);
        const SceneSample before = scene.at(x + now.motion.x, y + now.motion.y, frame - 1);
        moved += std::hypot(now.motion.x, now.motion.y) > 0.01;
        // Depths are differences of numbers of the size of the scene, 1e1, to within 1e-15, far away of larger ones.
        const double rounding = 1e-9 * now.previous_depth * (1 + now.previous_depth / 100);
        if (before.depth < now.previous_depth - rounding) {
            ++hidden;
            return;
        }
        ++seen;
        // Nothing may be missing: were the point not there, something farther away would be seen.
        EXPECT_LT(before.depth, now.previous_depth + rounding) << x << " " << y << " " << frame;
        EXPECT_LT(difference(before.albedo, now.albedo), tolerance) << x << " " << y << " " << frame;
        const bool is_lit_alike = now.depth == sky_depth || scene.focal == 0;  // shadows and mirrors move by themselves
        EXPECT_LT(is_lit_alike ? difference(before.color, now.color) : 0, tolerance) << x << " " << y << " " << frame;
    });
    EXPECT_GT(seen, 3000);  // of 4000
    EXPECT_LT(hidden, 800);
    EXPECT_GT(moved, 150);  // a mover covers a twentieth of its image; others move everywhere
}

TEST_P(EveryScene, AtRestItIsStill) {
    const Scene scene = make_scene(GetParam(), width, height, {.speed = 0});
    EXPECT_TRUE(scene.is_still);
    at_random(200, [&](double x, double y, int frame) {
        const SceneSample now = scene.at(x, y, frame), other = scene.at(x, y, 7);
        EXPECT_EQ(now.motion.x, 0);
        EXPECT_EQ(now.motion.y, 0);
        EXPECT_EQ(now.previous_depth, now.depth);
        EXPECT_EQ(now.color, other.color);
        EXPECT_EQ(now.depth, other.depth);
        EXPECT_EQ(now.ambient_occlusion, other.ambient_occlusion);
    });
}

TEST_P(EveryScene, SamplesAreInTheirRanges) {
    const Scene scene = make_scene(GetParam(), width, height, {.speed = 1});
    EXPECT_EQ(scene.name, GetParam());
    EXPECT_FALSE(scene.summary.empty());
    EXPECT_FALSE(scene.is_still);
    at_random(1000, [&](double x, double y, int frame) {
        const SceneSample s = scene.at(x, y, frame);
        EXPECT_EQ(scene.color(x, y, frame), s.color);
        EXPECT_EQ(s.alpha, 1);
        EXPECT_GT(s.depth, 0);
        EXPECT_NEAR(norm(s.normal), 1, 1e-12);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_GE(s.color[c], 0);
            EXPECT_LT(s.color[c], 2000);
            EXPECT_GE(s.albedo[c], 0);
            EXPECT_LE(s.albedo[c], scene.focal > 0 ? 1 : 4);  // flat scenes: the colour, of the sun too
        }
        EXPECT_GE(s.ambient_occlusion, 0);
        EXPECT_LE(s.ambient_occlusion, 1);
        EXPECT_TRUE(std::isfinite(s.motion.x) && std::isfinite(s.motion.y));
    });
}

TEST_P(EveryScene, AnySizeAndFrame) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 300}, {300, 1}, {20000, 10000}})
        for (const int frame : {0, -1000000, 1000000000}) {
            const Scene scene = make_scene(GetParam(), w, h);
            const SceneSample s = scene.at(w / 2.0, h * 0.75, frame);
            EXPECT_TRUE(std::isfinite(norm(s.color)) && std::isfinite(s.depth) && std::isfinite(s.motion.x));
        }
}

// The image of a scene twice as wide and high shows the same; flat ones are in pixels.
TEST(Scene, SpatialScenesShowTheSameAtAnySize) {
    for (const std::string name : {"plane", "mover", "highlight", "foliage"}) {
        const Scene one = make_scene(name, width, height), two = make_scene(name, 2 * width, 2 * height);
        at_random(300, [&](double x, double y, int frame) {
            const SceneSample a = one.at(x, y, frame), b = two.at(2 * x, 2 * y, frame);
            EXPECT_LT(difference(a.albedo, b.albedo), tolerance) << name;
            EXPECT_NEAR(a.motion.x, b.motion.x / 2, 1e-9);
            EXPECT_NEAR(a.motion.y, b.motion.y / 2, 1e-9);
        });
    }
}

TEST(Scene, ZonePlateIsTheSignal) {
    const Signal plate = zone_plate({double(width), double(height)});
    const Scene still = make_scene("zoneplate", width, height),
                moved = make_scene("zoneplate", width, height, {.speed = 2.5});
    EXPECT_TRUE(still.is_still);
    at_random(300, [&](double x, double y, int frame) {
        EXPECT_EQ(still.color(x, y, frame)[0], plate.value(x, y));
        EXPECT_EQ(moved.color(x, y, frame)[1], plate.value(x - 2.5 * frame, y));
        EXPECT_EQ(moved.at(x, y, frame).motion.x, -2.5);
        EXPECT_EQ(moved.at(x, y, frame).motion.y, 0);
    });
}

TEST(Scene, StarMovesAlongCircles) {
    const Scene star = make_scene("siemens", width, height);
    at_random(300, [&](double x, double y, int frame) {
        const Point m = star.at(x, y, frame).motion;
        const double dx = x - width / 2.0, dy = y - height / 2.0, r = std::hypot(dx, dy);
        if (r > height / 2.0) return;
        EXPECT_NEAR(std::hypot(dx + m.x, dy + m.y), r, 1e-12 * width);
        EXPECT_NEAR(std::hypot(m.x, m.y), 2 * r * std::sin(std::numbers::pi / 360), 1e-12 * width);  // a degree
        EXPECT_LE(dx * m.y - dy * m.x, 0);  // it was more to the left of its way: it turns clockwise
    });
}

// The point before a pixel, and its neighbours, lie in the plane that depth and normal tell: exact for planes; a sphere
// of radius R bends away from it by e^2 / 2R, which at e = depth * 1e-4 / focal is far below 1e-6 of the depth.
TEST(Scene, NormalsAreThoseOfDepth) {
    for (const std::string name : {"plane", "mover", "highlight", "foliage"}) {
        const Scene scene = make_scene(name, width, height);
        int surfaces = 0;
        at_random(1500, [&](double x, double y, int frame) {
            const auto position = [&](double px, double py, double depth) {
                return std::array{depth * (px - width / 2.0) / scene.focal, depth * (height / 2.0 - py) / scene.focal,
                                  -depth};
            };
            const SceneSample s = scene.at(x, y, frame);
            if (s.depth == sky_depth) return;
            const auto p = position(x, y, s.depth);
            EXPECT_LE(s.normal[0] * p[0] + s.normal[1] * p[1] + s.normal[2] * p[2], 1e-9 * s.depth) << name;
            for (const auto& [ex, ey] : {std::pair{1e-4, 0.0}, {0.0, 1e-4}}) {
                const SceneSample next = scene.at(x + ex, y + ey, frame);
                const double near = std::abs(next.depth - s.depth) / s.depth;
                if (difference(next.normal, s.normal) > 0.01 || near > 0.001) continue;  // a border, or grazing
                const auto q = position(x + ex, y + ey, next.depth);
                double out = 0;
                for (std::size_t c = 0; c < 3; ++c) out += (q[c] - p[c]) * s.normal[c];
                EXPECT_NEAR(out / s.depth, 0, 1e-8) << name << " " << x << " " << y << " " << frame;
                ++surfaces;
            }
        });
        EXPECT_GT(surfaces, 1000) << name;
    }
}

// Sky has no parallax: all motions of a frame belong to one rotation, which keeps angles between directions.
TEST(Scene, SkyTurnsWithTheCamera) {
    for (const std::string name : {"plane", "highlight", "foliage"}) {
        const Scene scene = make_scene(name, width, height);
        const auto direction = [&](double x, double y) {
            const std::array<double, 3> d{x - width / 2.0, height / 2.0 - y, -scene.focal};
            const double n = norm(d);
            return std::array{d[0] / n, d[1] / n, d[2] / n};
        };
        const auto cosine = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
            return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        };
        const double places[][2] = {{10, 2}, {80, 5}, {155, 1}, {40, 20}};
        for (const auto& a : places)
            for (const auto& b : places) {
                const SceneSample sa = scene.at(a[0], a[1] - 30, 12), sb = scene.at(b[0], b[1] - 30, 12);
                ASSERT_EQ(sa.depth, sky_depth);
                ASSERT_EQ(sb.depth, sky_depth);
                EXPECT_GT(std::hypot(sa.motion.x, sa.motion.y), 0.01);
                EXPECT_NEAR(cosine(direction(a[0], a[1] - 30), direction(b[0], b[1] - 30)),
                            cosine(direction(a[0] + sa.motion.x, a[1] - 30 + sa.motion.y),
                                   direction(b[0] + sb.motion.x, b[1] - 30 + sb.motion.y)),
                            1e-13);
            }
    }
}

TEST(Scene, HighlightIsHundredsOfTimesWhite) {
    const Scene scene = make_scene("highlight", width, height);
    double brightest = 0;
    for (double y = 0.25; y < height; y += 0.5)
        for (double x = 0.25; x < width; x += 0.5) brightest = std::max(brightest, scene.color(x, y, 0)[0]);
    EXPECT_GT(brightest, 100);
}

// N rays have a variance of p (1 - p) / N, at most 1 / 4 N: the mean of 1200 points with 50 rays each is within
// 4 / sqrt(4 * 60000) = 0.0082 of the truth, and so is the mean of the errors.
TEST(Scene, RaysOfOcclusionAgreeWithItsTruth) {
    for (const std::string name : {"plane", "mover", "highlight", "foliage"}) {
        const Scene truth = make_scene(name, width, height),
                    noisy = make_scene(name, width, height, {.occlusion_rays = 50});
        double error = 0;
        int count = 0;
        at_random(2400, [&](double x, double y, int frame) {
            if (count == 1200) return;
            const SceneSample t = truth.at(x, y, frame), n = noisy.at(x, y, frame);
            if (t.depth == sky_depth) return;
            EXPECT_EQ(noisy.at(x, y, frame).ambient_occlusion, n.ambient_occlusion);
            EXPECT_NEAR(std::round(n.ambient_occlusion * 50), n.ambient_occlusion * 50, 1e-9);
            error += n.ambient_occlusion - t.ambient_occlusion;
            ++count;
        });
        ASSERT_GT(count, 1000);
        EXPECT_LT(std::abs(error / count), 4 / std::sqrt(4.0 * 50 * count)) << name;
    }
}

TEST(Scene, LargerPixelsSeeTheSamePoints) {
    const Scene scene = make_scene("mover", width, height), seen = with_larger_pixels(scene, 2, 3);
    at_random(200, [&](double x, double y, int frame) {
        const SceneSample at = scene.at(x, y, frame), same = seen.at(x / 2, y / 3, frame);
        EXPECT_NEAR(same.depth, at.depth, at.depth * tolerance);
        EXPECT_NEAR(same.motion.x * 2, at.motion.x, tolerance);
        EXPECT_NEAR(same.motion.y * 3, at.motion.y, tolerance);
        EXPECT_LT(difference(seen.color(x / 2, y / 3, frame), same.color), tolerance);
    });
    EXPECT_EQ(seen.focal, scene.focal / 2);
    EXPECT_THROW(with_larger_pixels(scene, 0, 1), Error);
    EXPECT_THROW(with_larger_pixels(scene, 1, -1), Error);
}

TEST(Scene, SaysWhatIsWrong) {
    EXPECT_TRUE(is_scene("foliage"));
    EXPECT_FALSE(is_scene("stripes"));
    EXPECT_THROW(make_scene("stripes", 8, 8), Error);
    EXPECT_THROW(scene_summary("stripes"), Error);
    EXPECT_THROW(make_scene("plane", 0, 8), Error);
    EXPECT_THROW(make_scene("plane", 8, -1), Error);
    EXPECT_THROW(make_scene("plane", 8, 8, {.speed = std::nan("")}), Error);
    EXPECT_THROW(make_scene("plane", 8, 8, {.occlusion_rays = -1}), Error);
}

}  // namespace
}  // namespace bandlimit
