#include "bandlimit/scene/render_scene.h"

#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int most_samples = 1 << 20;

/// The mean colour around (x, y).
std::array<double, 3> mean_color(const Scene& scene, double x, double y, int frame, const std::vector<Point>& around) {
    std::array<double, 3> sum{};
    for (const Point& p : around) {
        const std::array<double, 3> color = scene.color(x + p.x, y + p.y, frame);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
    }
    for (double& c : sum) c /= static_cast<double>(around.size());
    return sum;
}

void store(const SceneSample& s, int i, int j, View<float> image) {
    const auto put = [&](int channel, double value) { image(i, j, channel) = static_cast<float>(value); };
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        put(scene_channel::color + c, s.color[k]);
        put(scene_channel::normal + c, s.normal[k]);
        put(scene_channel::albedo + c, s.albedo[k]);
    }
    put(scene_channel::alpha, s.alpha);
    put(scene_channel::depth, s.depth);
    put(scene_channel::motion, s.motion.x);
    put(scene_channel::motion + 1, s.motion.y);
    put(scene_channel::ambient_occlusion, s.ambient_occlusion);
}

}  // namespace

std::vector<Point> pixel_positions(int samples) {
    if (samples < 1 || samples > 1 << 20) fail("pixel_positions: samples = ", samples, "; pass 1 to 1048576 per pixel");
    std::vector<Point> positions;
    const int side = static_cast<int>(std::lround(std::sqrt(samples)));
    if (side * side == samples) {
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) positions.push_back({(i + 0.5) / side - 0.5, (j + 0.5) / side - 0.5});
        return positions;
    }
    constexpr double plastic = 1.32471795724474602596;  // the root of x^3 = x + 1
    const auto part = [](double x) { return x - std::floor(x); };
    for (int k = 0; k < samples; ++k)
        positions.push_back({part(0.5 + k / plastic) - 0.5, part(0.5 + k / (plastic * plastic)) - 0.5});
    return positions;
}

void check_sampling(const SceneSampling& sampling) {
    if (sampling.samples < 1 || sampling.samples > most_samples)
        fail("render_scene: samples = ", sampling.samples, "; pass 1 to ", most_samples, " per pixel");
    for (const double jitter : {sampling.jitter.x, sampling.jitter.y})
        if (!(std::abs(jitter) <= 1e3)) fail("render_scene: jitter = ", jitter, "; pass -1000 to 1000 pixels");
}

void render_scene(const Scene& scene, int frame, const SceneSampling& sampling, int first_row, View<float> image,
                  const Parallel& parallel) {
    if (image.channels != scene_channel::count)
        fail("render_scene: an image of ", image.channels, " channels; pass one of ", scene_channel::count);
    check_sampling(sampling);
    const std::vector<Point> positions = pixel_positions(sampling.samples);
    parallel_for(image.height, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int j = static_cast<int>(begin); j < end; ++j) {
            const double y = first_row + j + 0.5 + sampling.jitter.y;
            for (int i = 0; i < image.width; ++i) {
                const double x = i + 0.5 + sampling.jitter.x;
                SceneSample s = scene.at(x, y, frame);
                if (positions.size() > 1) s.color = mean_color(scene, x, y, frame, positions);
                store(s, i, j, image);
            }
        }
    });
}

Image<float> render_scene(const Scene& scene, int width, int height, int frame, const SceneSampling& sampling,
                          const Parallel& parallel) {
    Image<float> image(width, height, scene_channel::count, Layout::interleaved);
    render_scene(scene, frame, sampling, 0, image.view(), parallel);
    return image;
}

}  // namespace bandlimit
