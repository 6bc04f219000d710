// Points, lines and discs that are band-limited before they are sampled.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/metrics.h"
#include "bandlimit/antialias/raster.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/job/raster_scene.h"

namespace bandlimit::app {
namespace {

const Citation slides{"K. Akeley", "Antialiasing", "slides of a course on computer graphics", ""};

/// A scene of these shapes, white on black, which is written beside the page too.
job::RasterScene scene_of(const Tour& tour, const std::string& file, int width, int height,
                          const std::vector<std::string>& shapes) {
    const std::string text =
        fmt::format("{{\"width\": {}, \"height\": {}, \"filter\": \"cone:1\", \"shapes\": [\n{}]}}\n", width, height,
                    fmt::join(shapes, ",\n"));
    AtomicFile out(tour.path(file));
    out.write(text.data(), text.size());
    out.commit();
    return job::parse_raster_scene(text, file);
}

/// One sample at the centre of each pixel.
Image<float> sampled_once(const job::RasterScene& scene, Parallel parallel) {
    Image<float> picture(scene.width, scene.height, 3);
    Rasterizer(scene.shapes, raster_filter("box")).draw_supersampled(picture.view(), 1, 0, parallel);
    return picture;
}

Image<float> prefiltered(const job::RasterScene& scene, Parallel parallel) {
    Image<float> picture(scene.width, scene.height, 3);
    draw(scene.shapes, raster_filter(scene.filter), picture.view(), parallel);
    return picture;
}

Image<float> supersampled(const job::RasterScene& scene, Parallel parallel) {
    Image<float> picture(scene.width, scene.height, 3);
    Rasterizer(scene.shapes, raster_filter(scene.filter)).draw_supersampled(picture.view(), 16, 0, parallel);
    return picture;
}

/// Lines of a pixel and less in a fan, a curve of points that get closer, and discs from a tenth of a pixel on.
std::vector<std::string> small_shapes() {
    std::vector<std::string> shapes;
    constexpr double widths[] = {1.5, 1, 0.7, 0.5, 0.35, 0.25, 0.15};
    for (int i = 0; i < 7; ++i) {
        const double angle = (2 + 13.0 * i) * std::numbers::pi / 180;
        shapes.push_back(fmt::format(R"({{"type": "line", "from": [4.3, 4.7], "to": [{:.3f}, {:.3f}], "width": {}}})",
                                     4.3 + 64 * std::cos(angle), 4.7 + 64 * std::sin(angle), widths[i]));
    }
    for (int i = 0; i < 14; ++i) {
        const double x = 46 + 58 * (1 - std::pow(0.85, i));
        shapes.push_back(fmt::format(R"({{"type": "point", "at": [{:.3f}, {:.3f}]}})", x, 62 + 6 * std::sin(0.9 * i)));
    }
    for (int i = 0; i < 9; ++i)
        shapes.push_back(fmt::format(R"({{"type": "disc", "center": [{:.3f}, {:.3f}], "radius": {:.2f}}})",
                                     76.2 + 13.37 * (i % 3), 14.6 + 14.21 * (i / 3), 0.1 + 0.08 * i * i));
    return shapes;
}

void shapes_part(Tour& tour) {
    tour.page.section(
        "Points, lines and discs, filtered before they are sampled",
        "A shape whose form is known need not be sampled more often: the integral of a filter over it can be computed, "
        "for each pixel, exactly. Filtered that way a line may be as thin as it likes: it keeps its light at any "
        "angle. "
        "One sample per pixel draws a staircase, or nothing.",
        slides);
    const job::RasterScene scene = scene_of(tour, "small.json", 110, 74, small_shapes());
    const Image<float> once = sampled_once(scene, tour.parallel), exact = prefiltered(scene, tour.parallel),
                       truth = supersampled(scene, tour.parallel);
    const auto rms = [&](const Image<float>& picture) { return std::sqrt(mse(picture.view(), truth.view())); };
    job::write_picture(tour.path("small-once.png"), once.view());
    job::write_picture(tour.path("small-exact.png"), exact.view());
    job::write_picture(tour.path("small-truth.png"), truth.view());
    tour.page.gallery({{"small-once.png", fmt::format("1 sample per pixel: RMS error {:.3f}", rms(once))},
                       {"small-exact.png", fmt::format("prefiltered by a cone of radius 1: {:.4f}", rms(exact))},
                       {"small-truth.png", "256 samples per pixel, through the same cone"}},
                      "Lines 1.5 to 0.15 pixels wide, discs of radius 0.1 to 5, and points that get closer. Follow the "
                      "thinnest lines, and look for the smallest discs. The second picture takes no samples at all; "
                      "what differs from the third is the error of that one, and where shapes cross.",
                      "bandlimit raster small.json small.png --compare 16", 330);
    tour.page.headline("lines, points and discs against 256 samples: one sample / prefiltered, RMS",
                       fmt::format("{:.3f} / {:.4f}", rms(once), rms(exact)));

    std::vector<std::vector<std::string>> rows{
        {"distance of the pixel's centre", "0", "1/4", "1/2", "3/4", "1", "5/4"}};
    for (const char* name : {"cone:1", "gaussian:0.5", "bspline"})
        for (const double width : {1.0, 0.25}) {
            const RasterFilter filter = raster_filter(name);
            rows.push_back({fmt::format("{}, line of width {}", name, width)});
            for (int i = 0; i <= 5; ++i)
                rows.back().push_back(fmt::format("{:.4f}", line_coverage(filter, i / 4.0, width)));
        }
    tour.page.table(rows,
                    "The coverage of a pixel near a long line, by the distance of its centre from the line's axis. A "
                    "quarter of the width gives about a quarter of the light.",
                    "bandlimit raster small.json small.exr --filter gaussian:0.5");
}

void discs_part(Tour& tour) {
    tour.page.section("Discs that are almost band-limited",
                      "The spectrum of a disc never ends, and a disc without higher frequencies has no end in space. A "
                      "filter of finite extent comes near: through a tent the spectrum is multiplied by sinc^2, "
                      "through a quadratic B-spline by sinc^3. What is left above 1/2 aliases.",
                      slides);
    Panel panel{.title = "", .x_label = "cycles per pixel", .y_label = "dB", .series = {}};
    constexpr double radius = 1, area = std::numbers::pi * radius * radius;
    panel.y_range = Range{-80, 0};
    for (const auto& [label, name] : {std::pair{"box: sinc", "box"},
                                      {"tent: sinc^2", "tent"},
                                      {"quadratic: sinc^3", "quadratic"},
                                      {"cone of radius 1", "cone:1"}}) {
        const RasterFilter filter = raster_filter(name);
        panel.series.push_back(curve(label, 0, 2.5, 250, [&](double f) {
            return std::max(-80.0, 20 * std::log10(std::abs(disc_spectrum(filter, radius, f, 0)) / area));
        }));
    }
    tour.page.figure(
        tour.plot("discs.svg", {panel}, 720, 380),
        "The spectrum of a disc of radius 1 along x, through four filters. Right of 1/2 lower is better: there "
        "sinc^2 and sinc^3 fall faster.",
        "", 720);
}

void seams_part(Tour& tour) {
    tour.page.section("Seams, and where there need be none",
                      "Coverage blends like alpha: C' = (1 - A) C + A F. It does not know which part of a pixel a "
                      "shape covers. Two triangles that share an edge each cover half of its pixels, and together "
                      "1/2 + 1/2 * 1/2 = 3/4: a seam. Shapes that are known to abut can be added up instead.",
                      slides);
    std::vector<std::string> triangles;
    constexpr int count = 9;
    for (int i = 0; i < count; ++i) {
        const auto corner = [](int k) {
            const double angle = (k * 360.0 / count + 7) * std::numbers::pi / 180;
            return fmt::format("[{:.3f}, {:.3f}]", 30.3 + 26 * std::cos(angle), 30.1 + 26 * std::sin(angle));
        };
        triangles.push_back(fmt::format(R"({{"type": "polygon", "points": [[30.3, 30.1], {}, {}]}})", corner(i),
                                        corner((i + 1) % count)));
    }
    const job::RasterScene apart = scene_of(tour, "seams.json", 60, 60, triangles);
    const job::RasterScene group =
        scene_of(tour, "group.json", 60, 60,
                 {fmt::format("{{\"type\": \"group\", \"shapes\": [\n{}]}}", fmt::join(triangles, ",\n"))});
    const std::pair<const char*, Image<float>> pictures[] = {{"seams-once.png", sampled_once(apart, tour.parallel)},
                                                             {"seams-apart.png", prefiltered(apart, tour.parallel)},
                                                             {"seams-group.png", prefiltered(group, tour.parallel)}};
    for (const auto& [file, picture] : pictures) job::write_picture(tour.path(file), picture.view());
    tour.page.gallery({{"seams-once.png", "1 sample: no seam, and a jagged outline"},
                       {"seams-apart.png", "prefiltered, one after the other"},
                       {"seams-group.png", "prefiltered, as a group"}},
                      "Nine white triangles around a point.",
                      "bandlimit raster seams.json seams.png\nbandlimit raster group.json group.png", 300);
}

}  // namespace

void tour_raster(Tour& tour) {
    shapes_part(tour);
    discs_part(tour);
    seams_part(tour);
}

}  // namespace bandlimit::app
