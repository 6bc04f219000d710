// Lanczos in two dimensions: separable, radial and right, radial and wrong.
#include <fmt/core.h>

#include <cmath>

#include "apps/tour/tour.h"
#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/kernel/radial_weights.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit::app {
namespace {

const Citation lanczos_2d{"M. Agopian (pixelflinger)", "Correct application of the Lanczos filter in 2D",
                          "README of the repository pixelflinger/lanczos-2d", "2025"};

Series samples_of(const Kernel& kernel, int reach) {
    Series series;
    series.label = "at the samples";
    series.style = Series::Style::points;
    for (int i = -reach; i <= reach; ++i) series.x.push_back(i), series.y.push_back(kernel.value(i));
    return series;
}

void no_op(Tour& tour) {
    tour.page.section(
        "Lanczos leaves samples alone, unless it is applied to the distance",
        "In one dimension the kernel is 1 at its own sample and 0 at all others: centred on a sample it changes "
        "nothing. "
        "Applied per axis, this holds in two dimensions. Applied to the distance from the centre it does not: the "
        "corners "
        "of the 3 x 3 neighbourhood lie at the distance sqrt(2), in the negative lobe, and the picture is sharpened.",
        lanczos_2d);
    const Kernel kernel = lanczos(2);
    Panel panel{.title = "", .x_label = "samples from the centre", .y_label = "weight", .series = {}};
    panel.series = {curve("lanczos2", -2.5, 2.5, 400, kernel.value), samples_of(kernel, 2)};
    tour.page.figure(tour.plot("lanczos-no-op.svg", {panel}, 720, 300),
                     "Centred on a sample, Lanczos-2 reads 1 there and 0 everywhere else.",
                     "bandlimit analyze lanczos2 --at -2,-1,0,1,2 --phase 0", 720);

    const Kernel wrong = radial_lanczos(2);
    const RadialWeights weights = radial_weights_at(wrong, 0, 0);
    std::vector<std::vector<std::string>> rows{{"", "x = -1", "0", "1"}};
    for (int y = -1; y <= 1; ++y) {
        rows.push_back({fmt::format("y = {}", y)});
        for (int x = -1; x <= 1; ++x) rows.back().push_back(fmt::format("{:.4f}", wrong.value(std::hypot(x, y)) + 0.0));
    }
    tour.page.table(
        rows,
        fmt::format(
            "Weights of the wrong radial Lanczos-2 around a sample, before they are divided by their sum of {:.4f}: "
            "the corners are negative.",
            weights.sum),
        "bandlimit analyze radial-lanczos2 --phase 0 --json");
    const double gain_axis = std::abs(response(PlacedWeights2D(weights, 0, 0), 0.5, 0));
    tour.page.headline("gain of radial Lanczos-2 on samples, at Nyquist along x (a no-op would have 1)",
                       fmt::format("{:.3f}", gain_axis));
}

struct Peak {
    double frequency, gain;
};

Peak peak_of(const Kernel& kernel) {
    const auto f = [&](double q) { return relative_spectrum(kernel, q); };
    Peak best{0, 1};
    for (double q = 0; q < 1; q += 0.001)
        if (f(q) > best.gain) best = {q, f(q)};
    return best;
}

Panel profile_panel(const std::string& title, const std::vector<Kernel>& kernels) {
    Panel panel{.title = title, .x_label = "cycles per sample", .y_label = "gain, relative to 0", .series = {}};
    for (const Kernel& k : kernels)
        panel.series.push_back(curve(k.name, 0, 1, 300, [&](double q) { return relative_spectrum(k, q); }));
    return panel;
}

Kernel cut_off(std::string name, double radius, double (*value)(double)) {
    const Kernel separable = truncated_sinc(radius);
    return {std::move(name), radius, [=](double r) { return std::abs(r) < radius ? value(r) : 0; },
            Kernel::Form::radial, separable.knots};
}

void profiles(Tour& tour) {
    tour.page.section("Radial profiles: sinc, jinc, and Lanczos right and wrong",
                      "The ideal radial low-pass is the jinc, whose transform is a disc. The transform of a radial "
                      "sinc rises towards infinity at "
                      "the Nyquist frequency, and windowing it into a radial Lanczos keeps the rise. Windowing the "
                      "jinc gives a low-pass. The most commonly published form jumps at its radius; scaled to the "
                      "zeros of the jinc it ends at zero.",
                      lanczos_2d);
    // Cut where the integral over the disc is that of the whole plane, or its share at 0 would be far off.
    const Kernel sinc16 = cut_off("radial sinc, cut at 16.5", 16.5, sinc),
                 jinc16 = cut_off("jinc, cut at 15.75", 15.75, jinc);
    tour.page.figure(
        tour.plot("profiles.svg",
                  {profile_panel("ideal forms, cut off", {sinc16, jinc16}),
                   profile_panel("wrong: 1D Lanczos of the distance", {radial_lanczos(2), radial_lanczos(3)}),
                   profile_panel("right: windowed jinc", {jinc_lanczos(2), jinc_lanczos(3), jinc_lanczos_unscaled(2),
                                                          jinc_lanczos_unscaled(3)})},
                  1080, 400),
        "The wrong radial Lanczos boosts what lies below the cut-off and lets through what lies above; the windowed "
        "jinc does neither.",
        "bandlimit analyze radial-lanczos3 --frequency 0,0.1,0.2,0.3,0.38,0.5 --plot radial-lanczos3.svg", 1040);
    const Peak two = peak_of(radial_lanczos(2)), three = peak_of(radial_lanczos(3));
    tour.page.table({{"kernel", "largest gain", "at cycles per sample", "gain at Nyquist"},
                     {"radial-lanczos2", fmt::format("{:.3f}", two.gain), fmt::format("{:.3f}", two.frequency),
                      fmt::format("{:.3f}", relative_spectrum(radial_lanczos(2), 0.5))},
                     {"radial-lanczos3", fmt::format("{:.3f}", three.gain), fmt::format("{:.3f}", three.frequency),
                      fmt::format("{:.3f}", relative_spectrum(radial_lanczos(3), 0.5))},
                     {"jinc2", fmt::format("{:.3f}", peak_of(jinc_lanczos(2)).gain),
                      fmt::format("{:.3f}", peak_of(jinc_lanczos(2)).frequency),
                      fmt::format("{:.3f}", relative_spectrum(jinc_lanczos(2), 0.5))},
                     {"jinc3", fmt::format("{:.3f}", peak_of(jinc_lanczos(3)).gain),
                      fmt::format("{:.3f}", peak_of(jinc_lanczos(3)).frequency),
                      fmt::format("{:.3f}", relative_spectrum(jinc_lanczos(3), 0.5))}},
                    "Peaks of the profiles: 1 would be no boost at all.",
                    "bandlimit analyze radial-lanczos2 --frequency 0.296");
    tour.page.headline("peak gain of the wrong radial Lanczos-2, at 0.296 cycles per sample",
                       fmt::format("{:.3f}", two.gain));
    tour.page.headline("peak gain of the wrong radial Lanczos-3, at 0.380 cycles per sample",
                       fmt::format("{:.3f}", three.gain));
}

}  // namespace

void tour_lanczos(Tour& tour) {
    no_op(tour);
    profiles(tour);
}

}  // namespace bandlimit::app
