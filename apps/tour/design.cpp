// Designed filters: downsampling in few reads, low rank, phasors, and bokeh made of them.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/tour/tour.h"
#include "bandlimit/design/disk.h"
#include "bandlimit/design/downsample.h"
#include "bandlimit/design/separable.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/resample/term_filter.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit::app {
namespace {

constexpr const char* circle = "disc:50:0.8";

const Citation low_rank_source{"B. Wronski",
                               "Separate your filters! Separability, SVD and low-rank approximation of 2D image "
                               "processing filters",
                               "bartwronski.com", "2020"};

/// Weights as a picture: 0 is a quarter grey, so that what is negative shows darker; 1 is near white.
void write_weights(const std::string& path, const WeightGrid& grid, int zoom) {
    Image<float> image(grid.width * zoom, grid.height * zoom);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            image.view()(x, y) = static_cast<float>(std::clamp(0.25 + 0.65 * grid.at(x / zoom, y / zoom), 0.0, 1.0));
    job::write_data(path, image.view());
}

/// A photograph at night: dark, and with small lamps in many colours, up to a few hundred times as bright as white.
Image<float> night(View<const float> day) {
    Image<float> image(day.width, day.height, 3, Layout::interleaved);
    const View<float> v = image.view();
    for (int y = 0; y < day.height; ++y)
        for (int x = 0; x < day.width; ++x)
            for (int c = 0; c < 3; ++c) v(x, y, c) = 0.08f * day(x, y, c) * (c == 2 ? 1.5f : 1);
    Random random(11);
    constexpr int lamps = 60;
    for (int i = 0; i < lamps; ++i) {
        const int left = random.integer(0, day.width - 3), top = random.integer(0, day.height - 3);
        const double bright = std::exp2(random.uniform(3, 8));
        const std::array<double, 3> tint{random.uniform(0.5, 1), random.uniform(0.25, 0.9), random.uniform(0.1, 0.8)};
        for (int y = top; y < top + 3; ++y)
            for (int x = left; x < left + 3; ++x)
                for (int c = 0; c < 3; ++c)
                    v(x, y, c) += static_cast<float>(bright * tint[static_cast<std::size_t>(c)]);
    }
    return image;
}

Image<float> night_of_coffee(const Tour& tour) {
    return night(job::read_picture(tour.path("coffee.png"), Space::automatic, tour.parallel).view());
}

/// `image` blurred by weights that are scaled to a sum of 1.
Image<float> blurred(const Tour& tour, const Image<float>& image, const Terms& weights) {
    const Terms unit = with_unit_sum(weights);
    const RowFilter filter = term_filter(unit, centred_first(static_cast<int>(unit[0].row.size())),
                                         centred_first(static_cast<int>(unit[0].column.size())),
                                         {image.width(), image.height(), Edge::reflect, Edge::reflect, false});
    Image<float> result(image.width(), image.height(), image.channels(), Layout::interleaved);
    filter.run({AnyConstView(image.view()), 0, {}}, {AnyView(result.view()), 0, {}, {}}, tour.parallel);
    return result;
}

void reads_part(Tour& tour) {
    tour.page.section(
        "Halving in few reads",
        "A bilinear read weights four texels at once. Fetches are placed and weighted together, for the least squared "
        "distance from the ideal low-pass. The published filter has eight of them; more of them come closer.",
        {"B. Wronski", "Fast, GPU friendly, antialiasing downsampling filter", "bartwronski.com", "2022"});
    const std::string command = "bandlimit design downsample --fetches 8 --plot downsample.svg";
    std::vector<std::vector<std::string>> rows{{"filter", "reads", "error"}};
    const auto add = [&](const std::string& name, const Fetches& fetches) {
        rows.push_back({name, fmt::format("{}", fetches.size()),
                        fmt::format("{:.5f}", band_error(whole_filter(fetches), 2).whole)});
    };
    add("box", {{0, 0, 1}});
    add("as published", downsample8());
    Panel along{"along an axis", "frequency (cycles per source texel)", "gain", {}}, across = along;
    across.title = "along a diagonal";
    const auto draw_response = [&](const std::string& name, const Fetches& fetches) {
        const PlacedWeights2D weights = whole_filter(fetches);
        along.series.push_back(curve(name, 0, 0.5, 200, [&](double f) { return std::abs(response(weights, f, 0)); }));
        across.series.push_back(curve(name, 0, 0.5, 200, [&](double f) { return std::abs(response(weights, f, f)); }));
    };
    draw_response("box", {{0, 0, 1}});
    for (const int count : {8, 12, 16, 20}) {
        const FetchDesign design = downsample_fetches(count);
        add("designed", design.fetches);
        if (count != 12) draw_response(fmt::format("{} reads", count), design.fetches);
        if (count == 8)
            tour.page.headline("mean squared distance from the ideal low-pass: box / 8 reads",
                               rows[1][2] + " / " + rows.back()[2]);
    }
    tour.page.figure(tour.plot("downsample.svg", {along, across}, 900, 400),
                     "What passes. The ideal is 1 up to a quarter, and 0 beyond it.", command, 900);
    tour.page.table(rows, "The error is the mean of |H - ideal|^2 over all frequencies that texels can represent.",
                    command);
}

void rank_part(Tour& tour) {
    tour.page.section(
        "Low rank",
        "Any kernel is a sum of separable ones; the singular values tell how many matter. The energy that they hold is "
        "their squares: the circle's first four hold 97.7 %, not the 75.5 % of the plain sum.",
        low_rank_source);
    std::vector<std::vector<std::string>> rows{
        {"shape", "singular values", "rank", "rank of 99.9 % of the energy", "energy of the first four"}};
    for (const std::string shape : {circle, "polygon:50:8:0.9:0", "difference-of-gaussians:50:5:6", "gaussian:50:5"}) {
        const Svd found = svd_of(parse_shape(shape));
        std::string values;
        for (std::size_t i = 0; i < 4; ++i) values += fmt::format("{}{:.3f}", i ? ", " : "", found.values[i]);
        rows.push_back({shape, values, fmt::format("{}", numerical_rank(found.values, 50, 50)),
                        fmt::format("{}", rank_for_energy(found.values, 0.999)),
                        fmt::format("{:.2f} %", 100 * cumulative_energy(found.values)[3])});
    }
    const WeightGrid shape = parse_shape(circle);
    std::vector<Page::Tile> tiles;
    for (const int rank : {1, 2, 4, 8, 14}) {
        const std::string file = fmt::format("circle-rank{}.png", rank);
        write_weights(tour.path(file), expanded(low_rank(shape, rank)), 4);
        tiles.push_back({file, fmt::format("rank {}", rank)});
    }
    const std::string command = fmt::format("bandlimit design separable {} --rank 4", circle);
    tour.page.gallery(tiles, "The circle of 50 x 50 weights. Darker than the background is negative.", command, 170);
    tour.page.table(rows, "Singular values as published.", command);
    tour.page.headline("singular values of the 50 x 50 circle", rows[1][1] + "; rank " + rows[1][2]);
}

void loss_part(Tour& tour) {
    tour.page.section("Low rank without ringing",
                      "The nearest kernel of rank 4 rings, and leaks into corners. Two more terms in the loss remove "
                      "that, at the expense of its shape. From left to right: keep-zeros 0, 0.3, 0.8; from top "
                      "to bottom: non-negative 0, 0.5, 1.5.",
                      {"B. Wronski", "Using JAX, numpy, and optimization techniques to improve separable image filters",
                       "bartwronski.com", "2020"});
    const WeightGrid shape = parse_shape(circle);
    const Terms start = low_rank(shape, 4);
    std::vector<std::vector<std::string>> rows{{"non-negative", "keep-zeros", "loss before", "loss"}};
    std::vector<Page::Tile> tiles, blurs;
    const Image<float> lights = night_of_coffee(tour);
    for (const double non_negative : {0.0, 0.5, 1.5}) {
        for (const double keep_zeros : {0.0, 0.3, 0.8}) {
            const SeparableFit fit = optimise_separable(shape, start, {non_negative, keep_zeros});
            const std::string file = fmt::format("circle-{}-{}.png", non_negative, keep_zeros);
            write_weights(tour.path(file), expanded(fit.terms), 4);
            const std::string caption = fmt::format("keep-zeros {}, non-negative {}", keep_zeros, non_negative);
            tiles.push_back({file, fmt::format("{}: loss {:.5f}", caption, fit.loss)});
            const std::string blur = fmt::format("night-{}-{}.png", non_negative, keep_zeros);
            job::write_picture(tour.path(blur), blurred(tour, lights, fit.terms).view());
            blurs.push_back({blur, caption});
            rows.push_back({fmt::format("{}", non_negative), fmt::format("{}", keep_zeros),
                            fmt::format("{:.5f}", fit.start_loss), fmt::format("{:.5f}", fit.loss)});
            if (non_negative == 0.5 && keep_zeros == 0.3)
                tour.page.headline("loss of the circle at rank 4, keep-zeros 0.3, non-negative 0.5",
                                   fmt::format("{:.5f}", fit.loss));
        }
    }
    const std::string command =
        fmt::format("bandlimit design separable {} --rank 4 --optimise --keep-zeros 0.3 --non-negative 0.5", circle);
    tour.page.gallery(tiles, "The circle at rank 4.", command, 256);
    tour.page.gallery(
        blurs,
        "The same on a photograph at night, with lamps: what is negative makes dark dots, what leaks makes "
        "plaid around the lamps.",
        command + " -o circle.json\nbandlimit convolve night.exr night.png --taps circle.json", 256);
    tour.page.table(rows, "The loss of the nearest kernel of rank 4, and after optimisation.", command);
}

void disk_part(Tour& tour) {
    tour.page.section("Discs out of phasors",
                      "A complex phasor times a Gaussian is separable and circular in magnitude. One gives a disc that "
                      "rings, three a good one.",
                      {"O. Niemitalo", "Circularly symmetric convolution and lens blur", "yehar.com", "2011"});
    Panel panel{"profile", "distance from the centre (radii)", "weight", {}};
    panel.series.push_back(curve("disc", 0, 1.6, 800, [](double r) { return r < 1 ? 1.0 : 0.0; }));
    std::vector<std::vector<std::string>> rows{{"components", "error", "ringing inside", "ringing outside"}};
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        const DiskProfile profile = disk_profile(fit);
        rows.push_back({fmt::format("{}", count), fmt::format("{:.4f}", disk_error(fit)),
                        fmt::format("{:.3f}", profile.inner_ringing), fmt::format("{:.3f}", profile.outer_ringing)});
        if (count <= 3)
            panel.series.push_back(curve(fmt::format("{} component{}", count, count > 1 ? "s" : ""), 0, 1.6, 400,
                                         [&](double r) { return value_at(fit, r); }));
    }
    const std::string command = "bandlimit design disk --components 2 --plot disk.svg";
    tour.page.figure(tour.plot("disk.svg", {panel}, 760, 400), "Fitted by least squares over the plane.", command, 760);
    tour.page.table(rows, "The error is the integral of (K - disc)^2 divided by that of disc^2.", command);
    tour.page.headline("error of a disc out of 1 / 2 / 3 phasors",
                       rows[1][1] + " / " + rows[2][1] + " / " + rows[3][1]);
}

void bokeh_part(Tour& tour) {
    constexpr int radius = 20;
    tour.page.section(
        "Bokeh",
        "The cost of an exact disc grows with its area. That of terms and phasors grows with its radius, but their "
        "errors show on bright lights: low rank leaves squares and corners of negative weight, few phasors leave "
        "rings.",
        low_rank_source);
    const Image<float> lights = night_of_coffee(tour);
    job::write_picture(tour.path("night.exr"), lights.view(), Depth::f16);
    const WeightGrid disc = parse_shape("disc:1", 2 * radius + 1);
    const Image<float> exact =
        blurred(tour, lights, low_rank(disc, numerical_rank(svd_of(disc).values, disc.width, disc.height)));
    std::vector<Page::Tile> tiles;
    const auto add = [&](const std::string& name, const Image<float>& image, const std::string& caption) {
        job::write_picture(tour.path(name + ".png"), image.view());
        tiles.push_back({name + ".png", caption});
    };
    add("bokeh-exact", exact, "exact");
    const std::array<const char*, 4> artefacts{"squares", "corners, cut by dark dots", "small dark dots at the corners",
                                               "the same to the eye"};
    for (std::size_t i = 0; i < artefacts.size(); ++i) {
        const int rank = 1 << i;
        add(fmt::format("bokeh-rank{}", rank), blurred(tour, lights, low_rank(disc, rank)),
            fmt::format("rank {}: {}", rank, artefacts[i]));
    }
    const std::array<const char*, 3> rings{"a dark middle and a dark ring around", "rings inside and around",
                                           "faint rings"};
    for (int count = 1; count <= 3; ++count) {
        const Components fit = fit_disk(count);
        add(fmt::format("bokeh-phasors{}", count),
            blurred(tour, lights, separable_terms(fit, radius, reach_for(fit, radius))),
            fmt::format("{} phasor{}: {}", count, count > 1 ? "s" : "", rings[static_cast<std::size_t>(count - 1)]));
    }
    tour.page.gallery(
        tiles, "A photograph at night, with lamps, under a disc of 20 pixels radius.",
        "bandlimit bokeh night.exr bokeh.png --shape disc --radius 20 --rank 4\nbandlimit bokeh night.exr "
        "bokeh.png --shape disc --radius 20 --components 2",
        420);
}

}  // namespace

void tour_design(Tour& tour) {
    reads_part(tour);
    rank_part(tour);
    loss_part(tour);
    disk_part(tour);
    bokeh_part(tour);
}

}  // namespace bandlimit::app
