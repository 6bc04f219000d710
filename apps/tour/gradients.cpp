// Gradients: what operators see, and what structure tensors say.
#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "apps/page/false_color.h"
#include "apps/tour/tour.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/filter/gradients.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::app {
namespace {

const Citation source{"B. Wronski", "Computing gradients on grids of pixels and voxels", "bartwronski.com", "2021"};
constexpr int size = 64;

template <class F>
Image<float> drawn(F f) {
    Image<float> image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) image.view()(x, y) = static_cast<float>(f(x, y));
    return image;
}

struct TestPicture {
    const char* name;
    Image<float> samples;
};

/// Stripes and a checkerboard of single pixels, a square, and a star that gets finer than pixels.
std::vector<TestPicture> test_pictures() {
    std::vector<TestPicture> pictures;
    pictures.push_back({"stripes", drawn([](int x, int y) { return y < size / 2 ? x % 2 : (x + y) % 2; })});
    pictures.push_back({"square", drawn([](int x, int y) { return x >= 16 && x < 48 && y >= 16 && y < 48 ? 1 : 0; })});
    pictures.push_back({"star", drawn([](int x, int y) {
                            const double angle = std::atan2(y - 31.5, x - 31.5);
                            return std::cos(14 * angle) > 0 ? 1 : 0;
                        })});
    return pictures;
}

Image<float> result_of(View<const float> picture, const char* name, GradientResult result, Parallel parallel) {
    Image<float> out(picture.width, picture.height, channels_of(result, picture.channels));
    gradient_filter(parse_derivative(name), picture.width, picture.height, {.result = result})
        .run({picture, 0, {}}, {out.view(), 0, {}, {}}, parallel);
    return out;
}

void operators_part(Tour& tour) {
    tour.page.section(
        "Gradients that miss the finest detail, and such that do not",
        "Central differences, and Sobel's and Scharr's operators with them, skip the pixel that they are at: stripes "
        "of "
        "one pixel do not exist for them. Differences along the diagonals of 2 x 2 pixels see the stripes, though not "
        "the "
        "checkerboard; the four of them about a pixel, whose squares are averaged, lie on the pixel again.",
        source);
    constexpr const char* names[] = {"forward", "central", "sobel", "scharr", "diagonal", "diagonal3", "laplacian4"};
    std::vector<Page::Tile> tiles;
    for (const TestPicture& picture : test_pictures()) {
        const std::string stem = fmt::format("gradient-{}", picture.name);
        job::write_data(tour.path(stem + ".png"), picture.samples.view());
        tiles.push_back({stem + ".png", picture.name});
        for (const char* name : names) {
            const Image<float> found =
                result_of(picture.samples.view(), name, GradientResult::magnitude, tour.parallel);
            const std::string file = fmt::format("{}-{}.png", stem, name);
            job::write_data(tour.path(file), ramp_of(found.view(), std::numbers::sqrt2).view());
            tiles.push_back({file, name});
        }
    }
    tour.page.gallery(
        tiles,
        "Magnitudes, brightest at the square root of 2. The upper half of the first picture is stripes, the "
        "lower half a checkerboard.",
        "bandlimit gradients gradient-star.png star.png --space data --operator diagonal3", 128);
}

void responses_part(Tour& tour) {
    tour.page.section(
        "Differentiators against the ideal one",
        "The derivative of a wave is larger the finer it is: an ideal differentiator multiplies frequency f "
        "by 2 pi f. What samples can do ends at 1/2.",
        source);
    Panel panel{.title = "", .x_label = "cycles per pixel", .y_label = "gain", .series = {}};
    panel.series.push_back(curve("ideal", 0, 0.5, 100, [](double f) { return 2 * std::numbers::pi * f; }));
    for (const auto& [label, name] : {std::pair{"forward and diagonal, at half a pixel", "forward"},
                                      {"central, Sobel, Scharr, Prewitt", "central"},
                                      {"Gaussian of sigma 0.7", "gaussian:0.7"},
                                      {"Gaussian of sigma 1.5", "gaussian:1.5"}}) {
        const Gradient gradient = std::get<Gradient>(parse_derivative(name));
        panel.series.push_back(
            curve(label, 0, 0.5, 100, [&](double f) { return gain(PlacedWeights(gradient.along), f); }));
    }
    tour.page.figure(tour.plot("gradient-responses.svg", {panel}, 720, 380),
                     "The gain along an axis. Nearer to the ideal is better, if noise is no matter.",
                     "bandlimit design derivative --taps 9 --optimal least-squares", 720);
}

void structure_part(Tour& tour) {
    tour.page.section(
        "What gradients about a pixel have in common",
        "The structure tensor is the mean of gradients times themselves. Its larger eigenvalue says how "
        "strong they are, its eigenvector which way they go, and its coherence whether they go one way at "
        "all: edges are coherent, corners and noise are not.",
        source);
    const Image<float> photo = job::read_picture(tour.path("coffee.png"), Space::automatic, tour.parallel);
    const Image<float> tensor = result_of(photo.view(), "diagonal3", GradientResult::tensor, tour.parallel);
    const View<const float> strength = channels_of(tensor.view(), 3), angle = channels_of(tensor.view(), 4);
    const double peak = peak_of(strength, 0.99, 1e-6);
    Image<float> doubled(tensor.width(), tensor.height(), 2);  // orientations: half a turn is none
    for (int y = 0; y < tensor.height(); ++y)
        for (int x = 0; x < tensor.width(); ++x) {
            doubled.view()(x, y, 0) = strength(x, y) * std::cos(2 * angle(x, y));
            doubled.view()(x, y, 1) = strength(x, y) * std::sin(2 * angle(x, y));
        }
    job::write_data(tour.path("tensor-strength.png"), ramp_of(strength, peak).view());
    job::write_data(tour.path("tensor-orientation.png"), directions_of(std::as_const(doubled).view(), peak).view());
    job::write_data(tour.path("tensor-coherence.png"), channels_of(tensor.view(), 5));
    tour.page.gallery({{"tensor-strength.png", "strength"},
                       {"tensor-orientation.png", "orientation: red across upright edges, cyan across level ones"},
                       {"tensor-coherence.png", "coherence, white at 1"}},
                      "Of the photograph, over a Gaussian window of sigma 1.5.",
                      "bandlimit gradients coffee.png tensor.exr --operator diagonal3 --result tensor", 330);
}

}  // namespace

void tour_gradients(Tour& tour) {
    operators_part(tour);
    responses_part(tour);
    structure_part(tour);
}

}  // namespace bandlimit::app
