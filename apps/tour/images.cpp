// Whole images: a zone plate, a star and a photograph.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/metrics.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/signal/render.h"

namespace bandlimit::app {
namespace {

const Citation filters{"M. Agopian (pixelflinger)", "Correct application of the Lanczos filter in 2D",
                       "README of the repository pixelflinger/lanczos-2d", "2025"};
constexpr int size = 512, half = size / 2, border = half / 20;

struct Contender {
    const char *name, *file;
    Kernel kernel;
};
std::vector<Contender> contenders() {
    return {{"box", "box", box()},
            {"tent", "tent", tent()},
            {"mitchell", "mitchell", mitchell()},
            {"lanczos3", "lanczos3", lanczos(3)},
            {"shrink3", "shrink3", shrink3()},
            {"jinc3", "jinc3", jinc_lanczos(3)},
            {"radial-lanczos3 (wrong)", "radial-lanczos3", radial_lanczos(3)}};
}

/// Mean square of `image` minus `mean` over the pixels that `counts` admits.
template <class Counts>
double power(View<const float> image, double mean, Counts counts) {
    double sum = 0, n = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (counts(x, y)) {
                const double v = static_cast<double>(image(x, y)) - mean;
                sum += v * v, ++n;
            }
    return sum / std::max(1.0, n);
}

std::string decibels(double ratio) { return fmt::format("{:.1f} dB", 10 * std::log10(ratio)); }

/// Where the zone plate, halved, should be flat: its local frequency along an axis is at least a quarter above what the
/// new grid can hold.
bool should_be_flat(int x, int y) {
    const double reach = std::max(std::abs(x - half / 2), std::abs(y - half / 2)) / (half / 2.0);
    return reach > 0.625 && std::min(std::min(x, y), std::min(half - 1 - x, half - 1 - y)) >= border;
}

/// Pictures of equal size side by side, on white.
Image<float> side_by_side(const std::vector<Image<float>>& images) {
    constexpr int gap = 8;
    const int count = static_cast<int>(images.size()), width = images.front().width(), height = images.front().height();
    Image<float> strip(count * (width + gap) - gap, height);
    const View<float> all = strip.view();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < all.width; ++x) {
            const int column = x % (width + gap);
            all(x, y) = column < width ? images[static_cast<std::size_t>(x / (width + gap))].view()(column, y) : 1;
        }
    return strip;
}

/// The picture that stands for all: what goes wrong, and what is right.
void overview(const Tour& tour) {
    const Image<float> source =
        render(with_range(zone_plate({size, size}), 0.05, 0.95), size, size, Sampling::point(), tour.parallel);
    std::vector<Image<float>> halves;
    for (const Kernel& kernel : {box(), radial_lanczos(3), lanczos(3)})
        halves.push_back(
            resample(source.view(), half, half, {.reconstruction = kernel, .edge = Edge::reflect}, tour.parallel));
    job::write_picture(tour.path("overview.png"), side_by_side(halves).view());
}

void zone_plate_part(Tour& tour) {
    tour.page.section("A zone plate, halved",
                      "The frequency grows with the distance from the centre and reaches the Nyquist frequency of the "
                      "source at the border, so the outer half "
                      "must vanish when the picture is halved: every ring seen there is an alias. The exact result is "
                      "known: the same signal after an ideal low-pass, one integral per row and column.",
                      filters);
    const Signal signal = with_range(zone_plate({size, size}), 0.05, 0.95);
    const Image<float> source = render(signal, size, size, Sampling::point(), tour.parallel);
    Image<float> exact(half, half);
    render(signal, {{half, 0, size}, {half, 0, size}}, Sampling::exact(kaiser(80, 10)), exact.view(), tour.parallel);
    const double signal_power = 0.45 * 0.45 / 2;
    std::vector<std::vector<std::string>> rows{{"kernel", "PSNR against the exact result", "alias energy"}};
    std::vector<Page::Tile> tiles;
    for (const Contender& c : contenders()) {
        const Image<float> small =
            resample(source.view(), half, half, {.reconstruction = c.kernel, .edge = Edge::reflect}, tour.parallel);
        const double quality = psnr(small.view(), exact.view(), border),
                     alias = power(small.view(), 0.5, should_be_flat) / signal_power;
        const std::string file = fmt::format("zoneplate-{}.png", c.file);
        job::write_picture(tour.path(file), small.view());
        tiles.push_back({file, fmt::format("{}: {:.1f} dB, alias {}", c.name, quality, decibels(alias))});
        rows.push_back({c.name, fmt::format("{:.2f} dB", quality), decibels(alias)});
        if (c.kernel.name == "lanczos3" || c.kernel.name == "box")
            tour.page.headline(fmt::format("zone plate halved by {}, against the exact result", c.name),
                               fmt::format("{:.2f} dB", quality));
    }
    job::write_picture(tour.path("zoneplate-exact.png"), exact.view());
    tiles.push_back({"zoneplate-exact.png", "exact: ideal low-pass"});
    const std::string command =
        "bandlimit pattern zoneplate zoneplate.exr --size 512x512\nbandlimit resize zoneplate.exr half.png --scale 0.5 "
        "--kernel lanczos3";
    tour.page.gallery(tiles, "The zone plate at half its size; look at the corners and the middle of each side.",
                      command, 256);
    tour.page.table(rows,
                    "PSNR ignores 5 % at the border. The source holds point samples; with pixels that are means, as in "
                    "docs/kernels.md, kernels measure up to 2 dB better. Alias energy is the power where the "
                    "picture should be flat "
                    "(from 1.25 times the new Nyquist "
                    "frequency on), relative to that of the signal.",
                    "bandlimit pattern zoneplate plate.exr --size 512x512 --low 0.05 --high 0.95\nbandlimit resize "
                    "plate.exr half.exr --scale 0.5 --kernel lanczos3 --edge reflect\nbandlimit pattern zoneplate "
                    "exact.exr --size 256x256 --max-frequency 1 --low 0.05 --high 0.95 --antialias "
                    "kaiser:80:10\nbandlimit compare half.exr exact.exr --border 12");
}

/// The kernels that resize takes by itself, beside the one that everybody knows.
void auto_kernels_part(Tour& tour) {
    tour.page.section(
        "What auto uses: three lobes, by least squares",
        "shrink3 and grow3 have the taps of Lanczos-3. Their coefficients minimise the error on pictures, provided "
        "that a step rings no more than with Lanczos-3. To shrink, a kernel must stay near 1 below "
        "1/2 and fall fast; to grow, it must also vanish near whole frequencies, where the replicas of smooth content "
        "lie.",
        {"T. W. Parks, C. S. Burrus", "Digital Filter Design", "Wiley", "1987"});
    Panel pass{.title = "what is kept", .x_label = "cycles per sample", .y_label = "gain", .series = {}},
        stop{.title = "what is let through", .x_label = "cycles per sample", .y_label = "dB", .series = {}};
    stop.y_range = Range{-80, 0};
    for (const Kernel& kernel : {lanczos(3), shrink3(), grow3()}) {
        pass.series.push_back(curve(kernel.name, 0, 0.75, 150, [&](double f) { return relative_spectrum(kernel, f); }));
        stop.series.push_back(curve(kernel.name, 0.5, 3, 500, [&](double f) {
            return std::max(-80.0, 20 * std::log10(std::abs(relative_spectrum(kernel, f))));
        }));
    }
    tour.page.figure(
        tour.plot("kernels.svg", {pass, stop}, 1040, 360),
        "The spectra of Lanczos-3 and of the two; 1/2 is the Nyquist frequency of the coarser grid.",
        "bandlimit analyze shrink3 --frequency 0,1/6,1/3,1/2,2/3,5/6 --plot shrink3.svg\nbandlimit analyze "
        "grow3 --frequency 0,1/6,1/3,1/2,2/3,5/6 --plot grow3.svg",
        1040);
}

/// Where the halved star should be flat: its spokes are at least a quarter finer than what the new grid can hold.
bool should_be_flat_in_star(int x, int y) {
    constexpr double spokes = 72, finest = 0.5 * 1.25;  // cycles per new sample
    const double radius = std::hypot(x - half / 2, y - half / 2);
    return radius * 2 * std::numbers::pi * finest < spokes;
}

void star_part(Tour& tour) {
    tour.page.section(
        "A Siemens star, halved",
        "Spokes at all angles: what a filter does to edges of every direction, and how much of the fine middle "
        "survives without false "
        "patterns. The reference is the star itself after an ideal low-pass, from 16 x 16 samples per pixel.",
        filters);
    const Signal star = siemens_star({size, size});
    const Image<float> source = render(star, size, size, Sampling::supersampled(lanczos(3), 8), tour.parallel);
    Image<float> exact(half, half);
    render(star, {{half, 0, size}, {half, 0, size}}, Sampling::supersampled(kaiser(16, 8), 16), exact.view(),
           tour.parallel);
    std::vector<Page::Tile> tiles;
    for (const Contender& c : contenders()) {
        const Image<float> small =
            resample(source.view(), half, half, {.reconstruction = c.kernel, .edge = Edge::reflect}, tour.parallel);
        const std::string file = fmt::format("siemens-{}.png", c.file);
        job::write_picture(tour.path(file), small.view());
        const double alias = power(small.view(), 0.5, should_be_flat_in_star) / 0.25;
        tiles.push_back({file, fmt::format("{}: {:.1f} dB, alias {}", c.name, psnr(small.view(), exact.view(), border),
                                           decibels(alias))});
    }
    tour.page.gallery(
        tiles,
        "The star at half its size: PSNR against the ideal low-pass (which rings at hard edges: a yardstick, "
        "not a goal for the eye), and alias energy: the power in the middle, where the spokes are at least "
        "1.25 times too fine for the new grid.",
        "bandlimit pattern siemens star.png --size 512x512 --antialias lanczos3\nbandlimit resize "
        "star.png half.png --scale 0.5 --kernel mitchell",
        256);
}

void photograph_part(Tour& tour) {
    tour.page.section("A photograph, halved in linear light and in codes",
                      "The codes of a picture file are not amounts of light. Averaging codes makes fine contrast "
                      "darker than the scene was; averaging light does not.",
                      {"B. Wronski", "How (not) to test graphics algorithms", "bartwronski.com", "2019"});
    const Image<float> photo = job::read_picture(tour.path("gravel.png"), Space::srgb),
                       codes = job::read_picture(tour.path("gravel.png"), Space::linear);
    const Image<float> light = resample(photo.view(), half, half, {}, tour.parallel);
    Image<float> dark = resample(codes.view(), half, half, {}, tour.parallel);
    const View<float> v = dark.view();
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) v(x, y) = static_cast<float>(srgb_to_linear(static_cast<double>(v(x, y))));
    job::write_picture(tour.path("photo-light.png"), light.view());
    job::write_picture(tour.path("photo-codes.png"), dark.view());
    const double before = job::mean_of(photo.view());
    const auto change = [&](const Image<float>& image) {
        return fmt::format("{:+.2f} %", 100 * (job::mean_of(image.view()) / before - 1));
    };
    tour.page.gallery({{"photo-light.png", "in linear light: mean light " + change(light)},
                       {"photo-codes.png", "in codes: mean light " + change(dark)}},
                      "Gravel at half its size: averaged as light it stays as bright as it was, averaged as "
                      "codes it darkens.",
                      "bandlimit resize gravel.png light.png --scale 0.5\nbandlimit resize gravel.png codes.png "
                      "--scale 0.5 --space linear",
                      384);
    tour.page.headline("mean light of a photograph halved in linear light / in codes",
                       change(light) + " / " + change(dark));
}

}  // namespace

void tour_images(Tour& tour) {
    overview(tour);
    zone_plate_part(tour);
    auto_kernels_part(tour);
    star_part(tour);
    photograph_part(tour);
}

}  // namespace bandlimit::app
