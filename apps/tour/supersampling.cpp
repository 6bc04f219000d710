// Aliasing and supersampling, patterns of samples, and half of the samples.
#include <fmt/core.h>

#include <array>

#include "apps/page/pattern_plot.h"
#include "apps/tour/tour.h"
#include "bandlimit/antialias/mixed_resolution.h"
#include "bandlimit/antialias/supersample.h"
#include "bandlimit/core/axis.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/job/supersample.h"
#include "bandlimit/sampling/pattern_analysis.h"
#include "bandlimit/scene/scene.h"

namespace bandlimit::app {
namespace {

const Citation slides{"K. Akeley", "Antialiasing", "slides of a course on computer graphics", ""};
const Citation grids{"B. Wronski", "Checkerboard rendering, rotated anti-aliasing and grid frequencies",
                     "bartwronski.com", "2018"};

PointValue values_of(const Signal& signal) {
    return [value = signal.value](double x, double y, std::span<float> to) { to[0] = static_cast<float>(value(x, y)); };
}

void write_rgb(const Tour& tour, const std::string& file, View<const float> picture) {
    job::write_picture(tour.path(file), channels_of(picture, 0, 3));
}

/// A way to make pixels of samples.
struct Resolve {
    std::string label, file;
    SupersampleOptions options;
};
std::vector<Resolve> resolves() {
    return {{"1 sample", "1", {.pattern = regular_pattern(1), .kernel = box()}},
            {"16 samples, their mean (box)", "16", {.pattern = regular_pattern(16), .kernel = box()}},
            {"64 samples, Blackman-Harris", "64", {.pattern = sobol_pattern(64), .kernel = blackman_harris()}}};
}

void plate_part(Tour& tour) {
    tour.page.section(
        "Aliasing: more samples, or a better filter",
        "A frequency that pixels cannot hold does not vanish: it comes back as a lower one, and no filter can tell it "
        "from a real one any more. More samples per pixel push that limit up; what lies between the limit of the "
        "samples and that of the pixels must then be filtered away. The mean over the pixel does that badly, a "
        "filter of a few pixels well. Nothing of this ends aliasing: there is always a finer pattern.",
        slides);
    constexpr int size = 160;
    constexpr double highest = 2;  // cycles per pixel, at the middle of the sides
    const Signal plate = zone_plate({size, size}, {.max_frequency = highest});
    std::vector<Page::Tile> tiles;
    for (const Resolve& r : resolves()) {
        const std::string file = fmt::format("aliases-{}.png", r.file);
        job::write_picture(tour.path(file),
                           supersample(values_of(plate), 1, {0, 0, size, size}, r.options, tour.parallel).view());
        tiles.push_back(
            {file, fmt::format("{}: {:.1f} % is left", r.label, 100 * job::alias_energy(r.options, tour.parallel))});
    }
    tour.page.gallery(tiles,
                      "A zone plate up to 2 cycles per pixel. There is one set of rings, in the middle quarter of the "
                      "width; everything farther out should be grey. Below: how much of the energy out there is left.",
                      "bandlimit supersample zoneplate plate.png --size 160x160 --pattern sobol:64:1 --kernel "
                      "blackman-harris --json",
                      320);

    std::vector<std::vector<std::string>> rows{{"samples", "box", "tent", "mitchell", "blackman-harris", "lanczos3"}};
    for (const char* pattern : {"regular:1", "regular:4", "d3d:4", "regular:16", "sobol:16:1", "sobol:64:1"}) {
        std::vector<std::string> row{pattern};
        for (const Kernel& kernel : {box(), tent(), mitchell(), blackman_harris(), lanczos(3)})
            row.push_back(fmt::format("{:.2f} %",
                                      100 * job::alias_energy({.pattern = parse_pattern(pattern), .kernel = kernel})));
        rows.push_back(std::move(row));
    }
    const double box_alias = 100 * job::alias_energy({.pattern = regular_pattern(16), .kernel = box()});
    const double wide_alias =
        100 * job::alias_energy({.pattern = sobol_pattern(64), .kernel = blackman_harris()}, tour.parallel);
    tour.page.table(
        rows,
        "Alias energy: the share of a zone plate's energy between 1/2 and 2 cycles per pixel that is "
        "still there. Along a row the filter improves, down a column the samples. With one sample there "
        "is nothing to filter, and wide filters only blur aliases.",
        "bandlimit supersample zoneplate plate.png --size 160x160 --pattern regular:16 --kernel box --json");
    tour.page.headline("alias energy with 16 samples and box / 64 and Blackman-Harris",
                       fmt::format("{:.1f} % / {:.2f} %", box_alias, wide_alias));
}

void scenes_part(Tour& tour) {
    tour.page.section("Aliasing: a checkered plane, and a fence",
                      "A plane to the horizon holds every frequency, and pickets thinner than a pixel are hit or "
                      "missed. With one sample the plane breaks into false patterns, and the fence into pieces.",
                      slides);
    constexpr int width = 160, height = 90;
    for (const char* name : {"plane", "fence"}) {
        const Scene scene = make_scene(name, width, height);
        std::vector<Page::Tile> tiles;
        for (const Resolve& r : resolves()) {
            const std::string file = fmt::format("{}-{}.png", name, r.file);
            write_rgb(tour, file, supersample(scene, width, height, 0, r.options, tour.parallel).view());
            tiles.push_back({file, r.label});
        }
        tour.page.gallery(
            tiles,
            scene.focal > 0
                ? "The plane, each pixel enlarged: look below the horizon, and at the outlines of what stands on it."
                : "The fence: look at the thin wires above, and the row of thin pickets below.",
            fmt::format("bandlimit supersample {} {}.png --size 160x90 --pattern sobol:64:1 --kernel blackman-harris",
                        name, name),
            320);
    }

    std::vector<std::vector<std::string>> rows{{"8 samples per pixel", "shading as it is", "filtered first (mips)"}};
    const std::vector<job::ShadingError> errors = job::shading_errors(d3d_pattern(8), tour.parallel);
    for (const char* shading : {"multisample", "supersample"}) {
        rows.push_back({fmt::format("{}d", shading)});
        for (const job::ShadingError& e : errors)
            if (e.shading == shading) rows.back().push_back(fmt::format("{:.3f}", e.rmse));
    }
    tour.page.table(rows,
                    "The RMS error of an outline with fine stripes inside. Multisampling tests what is visible at 8 "
                    "places and shades once: that smooths outlines, and leaves what aliases inside a surface, which "
                    "mip maps remove.",
                    "bandlimit supersample plane plane.png --size 160x90 --pattern d3d:8 --kernel box --json");
}

// ---- Patterns

std::vector<std::string> edge_cells(const SamplePattern& pattern) {
    std::vector<std::string> row{pattern.name};
    for (const double degrees : {0.0, 45.0, sweep_degrees[3], sweep_degrees[4]}) {
        const EdgeSweep e = sweep_edge(pattern.points, degrees);
        row.push_back(fmt::format("{}  {:.2f}  {:.3f}", e.levels, e.max_gap, e.rms));
    }
    return row;
}

/// One panel for each pattern.
template <class MakePanel>
std::vector<Panel> panels_of(const std::vector<SamplePattern>& patterns, const MakePanel& panel_of) {
    std::vector<Panel> panels;
    for (const SamplePattern& pattern : patterns) {
        panels.push_back(panel_of(pattern));
        panels.back().title = pattern.name;
        if (panels.size() > 1) panels.back().y_label = "";
    }
    return panels;
}

void patterns_part(Tour& tour) {
    tour.page.section(
        "Where samples lie in a pixel",
        "As an edge crosses a pixel, its grey should rise in many small and equal steps. A grid gives few of them "
        "where most edges of pictures lie, upright and level. Turned by 45 degrees it has a double step in the middle; "
        "n-rooks, with one sample in each row and column, have equal ones. Random samples crowd, and leave gaps.",
        grids);
    const std::vector<SamplePattern> four{regular_pattern(4), rotated_pattern(4), d3d_pattern(4), n_rooks_pattern(4)};
    const std::vector<SamplePattern> sixteen{regular_pattern(16), halton_pattern(16), sobol_pattern(16),
                                             random_pattern(16)};
    tour.page.figure(tour.plot("points-4.svg", panels_of(four, points_panel), 1080, 290), "Four samples in a pixel.",
                     "bandlimit analyze --pattern d3d:4 --plot d3d4.svg", 1032);
    std::vector<Panel> coverage = panels_of({four[0], four[1], four[2]}, coverage_panel);
    for (Panel& panel : coverage) panel.x_label = "edge from the centre (pixels)";
    tour.page.figure(tour.plot("coverage-4.svg", coverage, 1080, 350),
                     "What share of the four an edge covers on its way across the pixel: along x, and in the two "
                     "directions in which leaning patterns differ most.",
                     "bandlimit analyze --pattern rotated:4", 1032);
    tour.page.figure(tour.plot("points-16.svg", panels_of(sixteen, points_panel), 1080, 290),
                     "Sixteen samples. Halton's and Sobol's sequences are as even as a grid, and share no columns.",
                     "bandlimit analyze --pattern sobol:16:1 --plot sobol16.svg", 1032);
    std::vector<std::vector<std::string>> rows{{"pattern", "0 degrees", "45 degrees", "26.565", "-26.565"}};
    for (const auto* patterns : {&four, &sixteen})
        for (const SamplePattern& pattern : *patterns) rows.push_back(edge_cells(pattern));
    tour.page.table(rows,
                    "Per direction of the edge's normal: levels of grey, the longest way in pixels without a step, "
                    "and the RMS error against the exact area.",
                    "bandlimit analyze --pattern n-rooks:4:1\nbandlimit analyze --pattern sobol:16:1 --json");
    tour.page.headline("levels of an upright edge with 4 samples: regular / rotated / n-rooks",
                       fmt::format("{} / {} / {}", sweep_edge(four[0].points, 0).levels,
                                   sweep_edge(four[1].points, 0).levels, sweep_edge(four[3].points, 0).levels));

    tour.page.figure(
        tour.plot("spectra-4.png", panels_of(four, spectrum_panel), 1080, 290),
        "What the mean over the samples of a pixel leaves of a frequency of the scene: white nothing, brown all, which "
        "then aliases. In the middle is 0. The other spots of a grid lie on a grid; turned by 45 degrees, they lie "
        "farther away along the axes; those of Direct3D's pattern lean, and those of n-rooks crowd.",
        "bandlimit analyze --pattern rotated:4 --plot rotated4.svg", 1032);
    tour.page.figure(tour.plot("spectra-16.png", panels_of(sixteen, spectrum_panel), 1080, 290),
                     "The same for sixteen samples. The middle of a grid stands alone, and what aliases, aliases "
                     "wholly. Sequences keep the nearest surroundings of the middle white, and spread the rest; "
                     "random samples alias a little of everything.",
                     "bandlimit analyze --pattern halton:16 --plot halton16.svg", 1032);
}

void leaning_part(Tour& tour) {
    tour.page.section("A pattern that leans: Direct3D's four samples",
                      "The standard pattern of four is no mirror image of itself. Edges that lean one way by about "
                      "26.565 degrees, whose tangent is 1/2, meet its samples two at a time and get 3 levels; "
                      "edges that lean the other way get all 5.",
                      grids);
    constexpr int size = 24;
    std::vector<Page::Tile> tiles;
    for (const SamplePattern& pattern : {d3d_pattern(4), rotated_pattern(4)})
        for (const double lean : {1.0, -1.0}) {
            const EdgeSweep sweep = sweep_edge(pattern.points, lean * sweep_degrees[3]);
            // A little more than 26.565 degrees, so that the edge passes pixels at every distance from their centres.
            const Signal edge = step_edge({size, size}, {.angle = lean * 29});
            const std::string file =
                fmt::format("lean-{}-{}.png", pattern.name.substr(0, 3), lean > 0 ? "plus" : "minus");
            job::write_picture(tour.path(file), supersample(values_of(edge), 1, {0, 0, size, size},
                                                            {.pattern = pattern, .kernel = box()}, tour.parallel)
                                                    .view());
            tiles.push_back({file, fmt::format("{} at {:+.3f} degrees: {} levels, RMS {:.3f}", pattern.name,
                                               lean * sweep_degrees[3], sweep.levels, sweep.rms)});
        }
    tour.page.gallery(tiles,
                      "Count the greys along the edge: one alone in the first picture, three in the second. Turned by "
                      "45 degrees, a grid treats both alike.",
                      "bandlimit analyze --pattern d3d:4", 240);
}

// ---- Half of the samples

Series outline(const std::string& label, const std::vector<std::array<double, 2>>& corners) {
    Series series{label, {}, {}};
    for (const auto& [x, y] : corners) series.x.push_back(x), series.y.push_back(y);
    series.x.push_back(series.x.front()), series.y.push_back(series.y.front());
    return series;
}

Series box_outline(const std::string& label, double x, double y) {
    return outline(label, {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
}

/// What share of the error of a full picture's zone plate each way has.
double mixed_error(const std::vector<job::MixedError>& errors, MixedMode mode, const std::string& kernel) {
    for (const job::MixedError& e : errors)
        if (e.mode == mode && e.kernel == kernel) return e.rmse;
    return 0;
}

void mixed_part(Tour& tour) {
    tour.page.section(
        "Half of the samples: smaller, interlaced, or a checkerboard",
        "A lattice of samples holds the frequencies of a cell of its own, whose area is the number of samples. A "
        "smaller picture holds a smaller square. Every other row holds all along x and half along y. A checkerboard "
        "is a grid turned by 45 degrees: all along x and y, half along the diagonals, where a grid has most to spare.",
        grids);
    Panel panel{.title = "", .x_label = "cycles per pixel along x", .y_label = "along y", .series = {}};
    panel.series = {box_outline("full", 0.5, 0.5), box_outline("uniform, 1/sqrt(2)", 0.3535, 0.3535),
                    box_outline("interlaced", 0.5, 0.25),
                    outline("checkerboard", {{{-0.5, 0}, {0, -0.5}, {0.5, 0}, {0, 0.5}}})};
    panel.x_range = panel.y_range = Range{-0.6, 0.6};
    tour.page.figure(tour.plot("lattices.svg", {panel}, 520, 520), "The frequencies that each way of sampling holds.",
                     "", 520);

    constexpr int size = 124;
    const double middle = Axis{size, 0, size}.position(size / 2);
    const PointValue plate =
        values_of(zone_plate({size, size}, {.center = Point{middle, middle}, .radius = size / 2.0}));
    const std::vector<job::MixedError> errors = job::mixed_errors(tent(), tour.parallel);
    std::vector<std::vector<std::string>> rows{{"RMS error, rebuilt by", "tent", "catmull-rom", "lanczos3"}};
    std::vector<Page::Tile> tiles;
    for (const MixedMode mode : {MixedMode::full, MixedMode::uniform, MixedMode::interlaced, MixedMode::checkerboard}) {
        const std::string name(name_of(mode)), file = fmt::format("half-{}.png", name);
        job::write_picture(tour.path(file), mixed_resolution(plate, 1, size, size, mode, tent(), tour.parallel).view());
        if (mode == MixedMode::full) {
            tiles.push_back({file, "full: all samples"});
            continue;
        }
        rows.push_back({name});
        for (const Kernel& kernel : {tent(), catmull_rom(), lanczos(3)})
            rows.back().push_back(fmt::format("{:.3f}", mixed_error(errors, mode, kernel.name)));
        tiles.push_back({file, fmt::format("{}: RMS {}", name, rows.back()[1])});
        tour.page.headline(fmt::format("error of half the samples on a zone plate, {}", name), rows.back()[1]);
    }
    const std::string command =
        "bandlimit supersample zoneplate half.png --size 124x124 --mixed checkerboard --kernel tent --json";
    tour.page.gallery(tiles,
                      "A zone plate that reaches the limit of the pixels at the middle of each side, rebuilt by linear "
                      "interpolation. Rings that are not centred are aliases: of the smaller picture on all four "
                      "sides, of every other row above and below, of the checkerboard in the corners.",
                      command, 248);
    tour.page.table(rows,
                    "Where the plate is below .35 cycles per pixel (64 x 64). With a tent a smaller picture and a "
                    "checkerboard are equally wrong, and interlacing is worst. Better kernels help the first two; of "
                    "rows left out, vertical frequencies above 1/4 have become others for good.",
                    command);
}

}  // namespace

void tour_supersampling(Tour& tour) {
    plate_part(tour);
    scenes_part(tour);
    patterns_part(tour);
    leaning_part(tour);
    mixed_part(tour);
}

}  // namespace bandlimit::app
