// bandlimit design sharpen: taps that undo the droop of a kernel.
#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "apps/design/design.h"
#include "apps/design/report.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

struct Options {
    SharpenOptions options;
    std::string undo, band = "0.35", max_gain, phase;
    Kernel kernel;
    SharpenDesign design;
};

void check(Options& o) {
    o.kernel = parse_kernel(o.undo);
    o.options.band = parse_number("--band", o.band);
    if (!o.max_gain.empty()) o.options.max_gain = parse_number("--max-gain", o.max_gain);
    if (!o.phase.empty()) o.options.phase = parse_number("--phase", o.phase);
    o.design = design_sharpen(o.kernel, o.options);
}

Design make(const Options& o) {
    const SharpenDesign& d = o.design;
    Design design;
    design.file = job::taps_file(d);
    design.intermediates = 1;
    const auto kernel_at = [&o](double f) { return std::abs(kernel_response(o.kernel, o.options.phase, f)); };
    const auto gain_at = [&d](double f) { return response(d.taps, f).real(); };
    const auto both_at = [&](double f) { return gain_at(f) * kernel_at(f); };
    design.lines = {
        fmt::format("sharpen       {} taps along each axis, undo {}{} below f = {:.4g}", o.options.taps, o.kernel.name,
                    o.options.phase ? fmt::format(" at phase {:.4g}", *o.options.phase) : "", o.options.band),
        weights_line(d.taps), fmt::format("error         {:.3g}, the mean square error in the band", d.error),
        fmt::format("droop         {:.4f} at most is left in the band, of {:.4f} at its end", d.droop,
                    std::abs(1 - kernel_at(o.options.band))),
        fmt::format("noise         largest gain {:.4g}; white noise of variance 1 comes out with {:.4g}", d.gain,
                    d.variance)};
    for (const std::string& line : response_lines("gain", gain_at)) design.lines.push_back(line);
    design.lines.push_back(response_lines("kernel", kernel_at)[1]);
    design.lines.push_back(response_lines("both", both_at)[1]);
    design.panels = {weights_panel(d.taps, 0),
                     response_panel("Response", "gain",
                                    {curve(o.kernel.name, 0, 0.5, 200, kernel_at),
                                     curve("sharpening", 0, 0.5, 200, gain_at), curve("both", 0, 0.5, 200, both_at),
                                     Series{"band", {o.options.band, o.options.band}, {0, 1}}})};
    return design;
}

}  // namespace

void add_design_sharpen(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "sharpen", "Taps that undo the droop of a kernel in the pass band",
        "bandlimit design sharpen --undo bspline --taps 7 --plot sharpen.svg -o sharpen.json", [o] { check(*o); },
        [o](Console&) { return make(*o); });
    app.add_option(
           "--undo", o->undo,
           "Kernel whose droop is undone, e.g. bspline (analyze --list shows all): sharpen before enlarging by\n"
           "it, or after shrinking by it")
        .required()
        .type_name("KERNEL");
    app.add_option("--taps", o->options.taps, "How many, an odd number from 3 to 63; default 7").type_name("N");
    app.add_option(
           "--band", o->band,
           "Highest frequency to correct, in cycles per sample, 0.05 to 1/2; default 0.35. Higher needs more gain")
        .type_name("F");
    app.add_option("--max-gain", o->max_gain, "Bound of the gain at all frequencies, above 1; default none")
        .type_name("G");
    app.add_option("--phase", o->phase,
                   "Undo the weights at one distance from the sample, 0 to 1; 0 gives the B-spline's prefilter;\n"
                   "default: the mean over all, the kernel's spectrum")
        .type_name("P");
}

}  // namespace bandlimit::app
