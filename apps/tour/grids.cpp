// Down- and upsampling by two, and where the samples lie.
#include <fmt/core.h>

#include <cmath>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/analysis/shift.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit::app {
namespace {

const Citation half_pixel{"B. Wronski",
                          "Bilinear down/upsampling, aligning pixel grids, and that infamous GPU half pixel offset",
                          "bartwronski.com", "2021"};

std::string list(const std::vector<double>& values) {
    std::string text;
    for (const double v : values) text += fmt::format("{}{:.4g}", text.empty() ? "" : "  ", v);
    return text;
}

void downsampling(Tour& tour) {
    tour.page.section("Halving: box against [1 2 1]",
                      "Two taps of 1/2 sit between two samples and share the corners of both grids; [1 2 1]/4 sits on "
                      "a sample, and so shifts the "
                      "grid by half a pixel unless a later step undoes it. The three taps alias less and blur more. "
                      "More taps are better at both.",
                      half_pixel);
    const Taps box_taps{0, {0.5, 0.5}, 2}, tent_taps{-1, {0.25, 0.5, 0.25}, 1};
    const PlacedWeights box_weights(box_taps), tent_weights(tent_taps), lanczos_weights = [] {
        const Bank bank = make_bank(lanczos(3), Axis{64, 0, 64}, Axis{32, 0, 64}, Edge::wrap);
        return PlacedWeights(bank, 16, 32.5);
    }();
    Panel panel{
        .title = "", .x_label = "cycles per source sample (from 0.25 on it folds)", .y_label = "gain", .series = {}};
    const auto gain_of = [](const PlacedWeights& w) { return [&w](double f) { return gain(w, f); }; };
    panel.series = {curve("box [1 1]/2", 0, 0.5, 200, gain_of(box_weights)),
                    curve("[1 2 1]/4", 0, 0.5, 200, gain_of(tent_weights)),
                    curve("lanczos3, 12 taps", 0, 0.5, 200, gain_of(lanczos_weights))};
    tour.page.figure(tour.plot("halving.svg", {panel}, 720, 330),
                     "What each filter passes before every second sample is dropped.",
                     "bandlimit analyze lanczos3 --from 64 --to 32 --rows 16", 720);
    const auto row = [&](const std::string& name, const PlacedWeights& w) {
        return std::vector<std::string>{name, fmt::format("{:.3f}", gain(w, 0.125)),
                                        fmt::format("{:.3f}", gain(w, 0.25)), fmt::format("{:.3f}", gain(w, 0.375)),
                                        fmt::format("{:.1f} %", 100 * alias_energy(w, 2))};
    };
    tour.page.table(
        {{"filter", "gain at 1/8", "at 1/4", "at 3/8", "alias energy"},
         row("box [1 1]/2", box_weights),
         row("[1 2 1]/4", tent_weights),
         row("lanczos3", lanczos_weights)},
        "Alias energy: for white noise, the share of the result's energy that came from above the new Nyquist "
        "frequency.",
        "echo '{\"version\":1,\"kind\":\"box\",\"factor\":2,\"taps\":{\"first\":0,\"weights\":[0.5,0.5]}}' > "
        "box.json\nbandlimit analyze box.json --frequency 1/8,1/4,3/8");
}

void upsampling(Tour& tour) {
    tour.page.section(
        "Doubling: [1/4 3/4], or copies and midpoints",
        "With shared corners every new sample lies a quarter of a pixel from an old one: weights 1/4 and 3/4 in turn, "
        "the same "
        "blur everywhere. "
        "With shared centres every second sample is a copy and the others are midpoints: sharp and soft in turn.",
        half_pixel);
    const auto phase = [](double p) { return PlacedWeights(weights_at(tent(), p).taps, p); };
    std::vector<std::vector<std::string>> rows{{"phase", "weights", "variance"}};
    for (const double p : {0.25, 0.75, 0.0, 0.5})
        rows.push_back({fmt::format("{}", p), list(phase(p).weights), fmt::format("{:.3f}", variance(phase(p)))});
    tour.page.table(rows, "The phases of doubling: 1/4 and 3/4 with shared corners, 0 and 1/2 with shared centres.",
                    "bandlimit analyze tent --phase 1/4,3/4,0,1/2");
    tour.page.headline("variance kept by [1/4 3/4] upsampling, at every sample",
                       fmt::format("{:.3f}", variance(phase(0.25))));

    // Both are one filter on the source with zeros between its samples: the phases interleaved.
    const PlacedWeights even(Taps{0, {0.125, 0.375, 0.375, 0.125}, 4}), odd(Taps{-1, {0.25, 0.5, 0.25}, 1});
    Panel panel{
        .title = "", .x_label = "cycles per new sample (above 0.25 are replicas)", .y_label = "gain", .series = {}};
    panel.series = {curve("[1 3 3 1]/8: shared corners", 0, 0.5, 200, [&](double f) { return gain(even, f); }),
                    curve("[1 2 1]/4: shared centres", 0, 0.5, 200, [&](double f) { return gain(odd, f); })};
    tour.page.figure(tour.plot("doubling.svg", {panel}, 720, 330),
                     "Seen as filters on the samples with zeros in between: the even form leaves less of the replicas.",
                     "echo "
                     "'{\"version\":1,\"kind\":\"even\",\"factor\":4,\"taps\":{\"first\":0,\"weights\":[0.125,0.375,0."
                     "375,0.125]}}' > even.json\nbandlimit analyze even.json --frequency 1/8,1/4,3/8",
                     720);
}

/// One axis of a step of a pyramid: the number of samples, and the interval they lie on.
Axis halved_on_corners(const Axis& a) { return {a.count / 2, a.begin, a.end}; }
Axis doubled_on_corners(const Axis& a) { return {a.count * 2, a.begin, a.end}; }
/// Sample i lies on sample 2i of `a`.
Axis halved_on_samples(const Axis& a) {
    const double shift = a.pitch() / 2;
    return {a.count / 2, a.begin - shift, a.end - shift};
}
/// Sample 2i lies on sample i of `a`.
Axis doubled_on_samples(const Axis& a) {
    const double shift = a.pitch() / 4;
    return {a.count * 2, a.begin + shift, a.end + shift};
}

using Step = Axis (*)(const Axis&);

/// Runs `kernel` from a grid of its own to the one that `step` makes of it: whoever runs the next step forgets the
/// offset.
Image<float> resampled(View<const float> image, const Kernel& kernel, Step step) {
    const Axis x{image.width, 0, double(image.width)}, y{image.height, 0, double(image.height)};
    const Axis to_x = step(x), to_y = step(y);
    Image<float> middle(to_x.count, image.height), result(to_x.count, to_y.count);
    apply(make_bank(kernel, x, to_x, Edge::clamp), image, middle.view());
    apply(make_bank(kernel, y, to_y, Edge::clamp), transposed(std::as_const(middle).view()), transposed(result.view()));
    return result;
}

void shifts(Tour& tour) {
    tour.page.section("That half pixel, measured",
                      "Down and up again must end where it started. Even down and even up do, odd down and odd up do; "
                      "mixed, the picture moves "
                      "by half a pixel, and once more at every level of a pyramid.",
                      half_pixel);
    const Image<float> photo = job::read_picture(tour.path("gravel.png"));
    struct Trip {
        const char *name, *file;
        Kernel down_kernel;
        Step down, up;
    };
    const Trip trips[] = {
        {"box down, [1/4 3/4] up", "trip-even-even.png", box(), halved_on_corners, doubled_on_corners},
        {"box down, copies and midpoints up", "trip-even-odd.png", box(), halved_on_corners, doubled_on_samples},
        {"[1 2 1] down, [1/4 3/4] up", "trip-odd-even.png", tent(), halved_on_samples, doubled_on_corners},
        {"[1 2 1] down, copies and midpoints up", "trip-odd-odd.png", tent(), halved_on_samples, doubled_on_samples}};
    std::vector<std::vector<std::string>> rows{{"down and up again", "shift x", "shift y"}};
    std::vector<Page::Tile> tiles;
    constexpr int left = 190, top = 200, size = 64;
    const auto show = [&](const std::string& file, View<const float> image, const std::string& name) {
        job::write_picture(tour.path(file), cropped(image, left, top, size, size));
        tiles.push_back({file, name});
    };
    show("trip-original.png", photo.view(), "original");
    for (const Trip& trip : trips) {
        const Image<float> down = resampled(photo.view(), trip.down_kernel, trip.down),
                           back = resampled(down.view(), tent(), trip.up);
        const Shift shift = estimate_shift(photo.view(), back.view(), tour.parallel);
        const auto text = [](std::optional<double> s) {
            return s ? fmt::format("{:+.2f} px", std::abs(*s) < 0.005 ? 0.0 : *s) : "undefined";
        };
        rows.push_back({trip.name, text(shift.x), text(shift.y)});
        show(trip.file, back.view(), trip.name);
        if (trip.up == doubled_on_samples && trip.down == halved_on_corners)
            tour.page.headline("shift after box down, then copies and midpoints up",
                               text(shift.x) + ", " + text(shift.y));
        if (trip.up == doubled_on_corners && trip.down == halved_on_corners)
            tour.page.headline("shift after box down, then [1/4 3/4] up", text(shift.x) + ", " + text(shift.y));
    }
    tour.page.table(rows, "Shift relative to the original, by phase correlation; negative is to the left and up.",
                    "bandlimit resize gravel.png half.png --scale 0.5 --kernel box\nbandlimit resize half.png back.png "
                    "--scale 2 --kernel tent\n"
                    "bandlimit compare gravel.png back.png");
    tour.page.gallery(
        tiles,
        "The same 64 x 64 pixels each time, enlarged: compare where stones meet the frame, and how sharp "
        "neighbouring columns are.",
        "bandlimit resize gravel.png half.png --scale 0.5 --kernel box\nbandlimit resize half.png even.png --scale 2 "
        "--kernel tent --edge clamp\nbandlimit resize half.png odd.png --size 511x511 --kernel tent --align centers",
        320);
}

void centers(Tour& tour) {
    tour.page.section(
        "What align_corners does",
        "In many libraries, the option of that name aligns the centres of the corner samples. Doubling [0 1] by linear "
        "interpolation then gives thirds, "
        "which belong to neither of the conventions above: the distance between samples is 1/3 of the "
        "old one, not 1/2.",
        half_pixel);
    Image<float> pair(2, 1);
    pair.view()(1, 0) = 1;
    const auto doubled = [&](const Axis& target) {
        Image<float> out(4, 1);
        apply(make_bank(tent(), Axis{2, 0, 2}, target, Edge::renormalize), pair.view(), out.view());
        std::vector<double> values;
        for (int i = 0; i < 4; ++i) values.push_back(static_cast<double>(out.view()(i, 0)));
        return list(values);
    };
    const std::string by_centers = doubled(center_aligned({2, 0, 2}, 4));
    tour.page.table({{"[0 1] doubled", "result"},
                     {"shared corners (default)", doubled({4, 0, 2})},
                     {"shared centres (align_corners)", by_centers}},
                    "Linear interpolation of two samples to four.",
                    "bandlimit pattern edge pair.exr --size 2x1 --angle 0\nbandlimit resize pair.exr four.exr --size "
                    "4x1 --kernel tent --align centers");
    tour.page.headline("[0 1] doubled with align_corners", by_centers);
}

}  // namespace

void tour_grids(Tour& tour) {
    downsampling(tour);
    upsampling(tour);
    shifts(tour);
    centers(tour);
}

}  // namespace bandlimit::app
