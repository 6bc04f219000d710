#include "bandlimit/scene/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

void expect_same(View<const float> a, View<const float> b) {
    ASSERT_TRUE(same_shape(a, b));
    for (int c = 0; c < a.channels; ++c)
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) ASSERT_EQ(a(x, y, c), b(x, y, c)) << x << " " << y << " " << c;
}

TEST(PixelPositions, AreRegularForSquares) {
    EXPECT_EQ(pixel_positions(1).size(), 1u);
    EXPECT_EQ(pixel_positions(1)[0].x, 0);
    const std::vector<Point> four = pixel_positions(4);
    EXPECT_EQ(four[1].x, 0.25);
    EXPECT_EQ(four[1].y, -0.25);
}

// Any number of them has its mean near the middle, no two alike, and none outside the pixel.
TEST(PixelPositions, AreSpreadOverThePixel) {
    for (const int samples : {2, 3, 5, 8, 16, 60, 64, 1000}) {
        std::set<std::pair<double, double>> different;
        double x = 0, y = 0;
        for (const Point& p : pixel_positions(samples)) {
            EXPECT_TRUE(p.x >= -0.5 && p.x < 0.5 && p.y >= -0.5 && p.y < 0.5);
            different.insert({p.x, p.y});
            x += p.x / samples, y += p.y / samples;
        }
        EXPECT_EQ(different.size(), static_cast<std::size_t>(samples));
        EXPECT_LT(std::hypot(x, y), 1.0 / samples + 0.02);  // the discrepancy of R2 falls almost as 1 / N
    }
    EXPECT_THROW(pixel_positions(0), Error);
}

TEST(RenderScene, HoldsTheSamplesOfPixels) {
    const Scene scene = make_scene("mover", 24, 13);
    const Point jitter{0.25, -0.375};
    const Image<float> image = render_scene(scene, 24, 13, 5, {.jitter = jitter});
    for (int j = 0; j < 13; ++j)
        for (int i = 0; i < 24; ++i) {
            const SceneSample s = scene.at(i + 0.75, j + 0.125, 5);
            const float expected[] = {
                float(s.color[0]),  float(s.color[1]),         float(s.color[2]),  1,
                float(s.depth),     float(s.motion.x),         float(s.motion.y),  float(s.normal[0]),
                float(s.normal[1]), float(s.normal[2]),        float(s.albedo[0]), float(s.albedo[1]),
                float(s.albedo[2]), float(s.ambient_occlusion)};
            for (int c = 0; c < scene_channel::count; ++c) ASSERT_EQ(image.view()(i, j, c), expected[c]) << c;
        }
}

// The mean over n x n points of the pixels that a straight edge crosses differs from its area by less than 1 / n.
TEST(RenderScene, AveragesColourAlone) {
    const Scene scene = make_scene("edge", 16, 16);
    const Image<float> one = render_scene(scene, 16, 16, 0), many = render_scene(scene, 16, 16, 0, {.samples = 400});
    const Signal edge = step_edge({16, 16});
    for (int j = 0; j < 16; ++j)
        for (int i = 0; i < 16; ++i) {
            EXPECT_NEAR(many.view()(i, j, 0), edge.mean({double(i), double(j), i + 1.0, j + 1.0}), 1 / 20.0);
            for (int c = scene_channel::alpha; c < scene_channel::count; ++c)
                EXPECT_EQ(many.view()(i, j, c), one.view()(i, j, c));
        }
}

TEST(RenderScene, SameBitsForAnyThreadsAndBands) {
    for (const std::string& name : scene_names()) {
        const Scene scene = make_scene(name, 31, 17, {.occlusion_rays = 3});
        const SceneSampling sampling{.jitter = {0.1, 0.2}, .samples = 3};
        const Image<float> whole = render_scene(scene, 31, 17, 4, sampling, {.threads = 1});
        expect_same(whole.view(), render_scene(scene, 31, 17, 4, sampling, {.threads = 5}).view());
        Image<float> bands(31, 17, scene_channel::count);
        for (int y = 0; y < 17; y += 5)
            render_scene(scene, 4, sampling, y, cropped(bands.view(), 0, y, 31, std::min(5, 17 - y)), {.threads = 2});
        expect_same(whole.view(), std::as_const(bands).view());
    }
}

TEST(RenderScene, AnySize) {
    for (const std::string& name : scene_names())
        for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {40, 1}})
            for (const float value : {render_scene(make_scene(name, w, h), w, h, 2).view()(0, 0, 0)})
                EXPECT_TRUE(std::isfinite(value));
}

TEST(RenderScene, SaysWhatIsWrong) {
    const Scene scene = make_scene("edge", 4, 4);
    Image<float> three(4, 4, 3);
    EXPECT_THROW(render_scene(scene, 0, {}, 0, three.view()), Error);
    EXPECT_THROW(render_scene(scene, 4, 4, 0, {.samples = 0}), Error);
    EXPECT_THROW(render_scene(scene, 4, 4, 0, {.jitter = {std::nan(""), 0}}), Error);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(render_scene(scene, 4, 4, 0, {}, {.stop = stop.get_token()}), Stopped);
}

}  // namespace
}  // namespace bandlimit
