// bandlimit design kernel: piecewise polynomials with a response to order.
#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "apps/design/design.h"
#include "apps/design/report.h"
#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

using Use = KernelFitOptions::Use;

struct Options {
    KernelFitOptions options;
    std::string radius = "2", use = "grow", response = "ideal", slope = "2", max_overshoot;
    KernelFit fit;
};

void check(Options& o) {
    if (o.use != "grow" && o.use != "shrink")
        throw UsageError(fmt::format("--for: \"{}\" is not a use; choose grow or shrink", o.use));
    o.options.use = o.use == "grow" ? Use::grow : Use::shrink;
    o.options.radius = parse_number("--radius", o.radius);
    o.options.slope = parse_number("--slope", o.slope);
    if (!o.max_overshoot.empty()) o.options.max_overshoot = parse_number("--max-overshoot", o.max_overshoot);
    if (o.response != "ideal") o.options.like = parse_kernel(o.response);
    o.fit = fit_kernel(o.options);
}

std::string piece_line(const KernelPiece& piece) {
    std::string line = fmt::format("piece         {:>6.4g} to {:<6.4g}", piece.begin, piece.end);
    for (const double c : piece.coefficients) line += fmt::format(" {:>13.8f}", std::abs(c) < 1e-12 ? 0 : c);
    return line;
}

Panel spectrum_panel(const Options& o, const Kernel& kernel) {
    Panel panel{"Response", "frequency (cycles per pitch)", "gain", {}, Range{0, 2.5}};
    if (o.options.like)
        panel.series = {
            curve(o.options.like->name, 0, 2.5, 400, [&](double f) { return relative_spectrum(*o.options.like, f); })};
    else panel.series = {Series{"ideal", {0, 0.5, 0.5, 2.5}, {1, 1, 0, 0}}};
    panel.series.push_back(curve("fitted", 0, 2.5, 400, [&](double f) { return relative_spectrum(kernel, f); }));
    return panel;
}

Design make(const Options& o) {
    const Kernel kernel = piecewise_kernel(o.fit.pieces, "kernel");
    Design design;
    design.file = job::taps_file(o.fit);
    design.intermediates = 1;
    design.lines = {
        fmt::format("kernel        radius {:.6g}, degree {}, smoothness {}{}, to {}", kernel.radius, o.options.degree,
                    o.options.smoothness, o.options.interpolating ? ", interpolating" : "", o.use),
        "pieces        coefficients of powers of |x| - begin, the constant first"};
    for (const KernelPiece& piece : o.fit.pieces) design.lines.push_back(piece_line(piece));
    design.lines.push_back(
        fmt::format("error         {:.6g}, the squared error below f = 8, relative to the target; weighted by the "
                    "spectrum of pictures {:.6g}",
                    o.fit.error, o.fit.loss));
    design.lines.push_back(fmt::format("overshoot     {:.4f} of a step", o.fit.overshoot));
    design.lines.push_back(fmt::format("stop band     gain {:.4f} at most beyond f = 0.75; alias energy {:.4f}",
                                       stopband_leakage(kernel, 0.75, 8), alias_energy(kernel)));
    for (const std::string& line : response_lines("gain", [&](double f) { return relative_spectrum(kernel, f); }))
        design.lines.push_back(line);
    design.lines.push_back("use           resize --kernel FILE.json, of what -o writes");
    const double reach = 1.1 * kernel.radius;
    Panel shape{"Kernel", "distance (pitches)", "weight", {}};
    if (o.options.like) shape.series.push_back(curve(o.options.like->name, -reach, reach, 800, o.options.like->value));
    shape.series.push_back(curve(o.options.like ? "fitted" : "", -reach, reach, 800, kernel.value));
    design.panels = {shape, spectrum_panel(o, kernel)};
    return design;
}

}  // namespace

void add_design_kernel(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "kernel", "A kernel of polynomial pieces, fitted to a response; its shifted copies sum to 1",
        "bandlimit design kernel --radius 2 --interpolating --plot kernel.svg -o kernel.json", [o] { check(*o); },
        [o](Console&) { return make(*o); });
    app.add_option("--radius", o->radius, "In source pitches, 0.5 to 8; default 2").type_name("R");
    app.add_option("--pieces", o->options.pieces,
                   "Polynomials of equal length from -R to R, 1 to 64; default one per pitch, 2R")
        .type_name("P");
    app.add_option("--degree", o->options.degree, "Of the polynomials, 0 to 7; default 3").type_name("D");
    app.add_option("--smoothness", o->options.smoothness,
                   "Continuous derivatives, also at the ends; 0: only continuous itself, -1: may jump. Default 1")
        .type_name("C");
    app.add_flag("--interpolating", o->options.interpolating, "1 at 0 and 0 at the other samples");
    app.add_option("--for", o->use,
                   "grow (or keep the size), the default, or shrink: sets how much errors at each frequency count")
        .type_name("USE");
    app.add_option("--response", o->response,
                   "ideal, the default, or a kernel whose response to imitate, e.g. lanczos3")
        .type_name("KERNEL");
    app.add_option("--slope", o->slope, "Pictures have the power spectrum f^-A, 0 (white) to 2 (edges); default 2")
        .type_name("A");
    app.add_option("--max-overshoot", o->max_overshoot, "Bound of ringing at a unit step, e.g. 0.1; default none")
        .type_name("V");
}

}  // namespace bandlimit::app
