// Linear, quadratic and cubic interpolation at fractional offsets.
#include <fmt/core.h>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/response.h"

namespace bandlimit::app {
namespace {

struct Phase {
    const char* name;
    double value;
};
constexpr Phase phases[] = {{"0", 0}, {"1/6", 1.0 / 6}, {"1/3", 1.0 / 3}, {"1/2", 0.5}};

struct Interpolation {
    const char* title;
    Kernel kernel;
};

PlacedWeights at_phase(const Kernel& kernel, double phase) { return {weights_at(kernel, phase).taps, phase}; }

}  // namespace

void tour_splines(Tour& tour) {
    tour.page.section(
        "What bilinear filtering does between the samples",
        "Read at a fractional position, an interpolation is a different filter at every phase. Linear interpolation "
        "ranges from no change at a sample to a strong blur halfway, and detail pulses as a texture moves. The cubic "
        "B-spline is "
        "softer, and nearly the "
        "same at every phase. The quadratic B-spline lies between; measured from the sample, as here, it too is "
        "sharpest there.",
        {"B. Wronski", "Bilinear texture filtering: artifacts, alternatives, and frequency domain analysis",
         "bartwronski.com", "2020"});
    const Interpolation interpolations[] = {
        {"linear (tent)", tent()}, {"quadratic B-spline", quadratic_bspline()}, {"cubic B-spline", bspline()}};
    std::vector<Panel> panels;
    for (const Interpolation& i : interpolations) {
        Panel panel{.title = i.title, .x_label = "cycles per sample", .y_label = "gain", .series = {}};
        for (const Phase& phase : phases)
            panel.series.push_back(curve(std::string("offset ") + phase.name, 0, 0.5, 100,
                                         [&](double f) { return gain(at_phase(i.kernel, phase.value), f); }));
        panels.push_back(panel);
    }
    tour.page.figure(tour.plot("splines-responses.svg", panels, 1080, 340),
                     "Frequency responses at four offsets from a sample: the further the curves lie apart, the more a "
                     "picture pulses when it moves.",
                     "bandlimit analyze bspline --phase 0,1/6,1/3,1/2 --plot bspline.svg", 1040);

    Panel variances{.title = "", .x_label = "offset from a sample", .y_label = "variance kept", .series = {}};
    for (const Interpolation& i : interpolations)
        variances.series.push_back(
            curve(i.title, 0, 1, 120, [&](double p) { return variance(at_phase(i.kernel, p)); }));
    tour.page.figure(tour.plot("splines-variance.svg", {variances}, 720, 320),
                     "Sum of the squared weights, by which the variance of noise is scaled, over the offset.",
                     "bandlimit analyze tent --phase 0,0.25,0.5,0.75", 720);

    std::vector<std::vector<std::string>> rows{{"kernel", "offset 0", "1/6", "1/3", "1/2"}};
    for (const Interpolation& i : interpolations) {
        rows.push_back({i.title});
        for (const Phase& phase : phases)
            rows.back().push_back(fmt::format("{:.5f}", variance(at_phase(i.kernel, phase.value))));
    }
    tour.page.table(rows, "Variance at the four offsets.", "bandlimit analyze bspline --phase 0,1/6,1/3,1/2 --json");
    tour.page.headline("variance kept by linear interpolation on a sample, and halfway",
                       fmt::format("{:.3g} / {:.3g}", variance(at_phase(tent(), 0)), variance(at_phase(tent(), 0.5))));
    tour.page.headline(
        "variance kept by the cubic B-spline on a sample, and halfway",
        fmt::format("{:.4g} / {:.5f}", variance(at_phase(bspline(), 0)), variance(at_phase(bspline(), 0.5))));
}

}  // namespace bandlimit::app
