// bandlimit design derivative: taps that differentiate.
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "apps/design/design.h"
#include "apps/design/report.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

using Optimal = DerivativeOptions::Optimal;

struct Options {
    DerivativeOptions options;
    std::string optimal = "taylor", band = "1/2";
    DerivativeDesign design;
};

void check(Options& o) {
    if (o.optimal != "taylor" && o.optimal != "least-squares")
        throw UsageError(
            fmt::format("--optimal: \"{}\" is not a criterion; choose taylor or least-squares", o.optimal));
    o.options.optimal = o.optimal == "taylor" ? Optimal::taylor : Optimal::least_squares;
    o.options.band = parse_number("--band", o.band);
    o.design = design_derivative(o.options);
}

/// H / i about the place where the derivative is taken.
double height_at(const DerivativeDesign& d, double f) { return response(PlacedWeights(d.taps, d.position), f).imag(); }

/// Without the rounding of what should be 0.
double ramp_gain(const DerivativeDesign& d) { return std::abs(d.ramp_gain) < 1e-9 ? 0 : d.ramp_gain; }

std::string ramp_line(const DerivativeDesign& d) {
    const double gain = ramp_gain(d);
    std::string line = fmt::format("ramp          a slope of 1 comes out as {:.6g}", gain);
    if (std::abs(gain - 1) > 1e-9)
        line += gain == 0 ? ": slopes are lost; keep them with --ramp" : "; make it 1 with --ramp";
    return line;
}

Design make(const Options& o) {
    const DerivativeDesign& d = o.design;
    Design design;
    design.file = job::taps_file(d);
    const double pi = std::numbers::pi;
    const bool is_taylor = o.options.optimal == Optimal::taylor;
    design.lines = {
        fmt::format("derivative    {} taps, {}; taken {}", o.options.taps,
                    is_taylor ? "of the highest order" : "least squares",
                    d.position == 0 ? "on sample i" : "halfway between samples i and i + 1"),
        weights_line(d.taps),
        fmt::format("error         {:.6g}, the mean square error below f = {:.4g}, relative to the derivative", d.error,
                    o.options.band),
        ramp_line(d), fmt::format("noise         white noise of variance 1 comes out with {:.4g}", variance(d.taps))};
    for (const std::string& line :
         response_lines("H / ideal", [&](double f) { return f == 0 ? ramp_gain(d) : height_at(d, f) / (2 * pi * f); }))
        design.lines.push_back(line);
    design.lines.push_back("one axis      the cost below is that of the derivative along x; y costs the same again");
    design.panels = {weights_panel(d.taps, d.position),
                     response_panel("Response", "gain (per sample)",
                                    {curve("ideal", 0, 0.5, 2, [&](double f) { return 2 * pi * f; }),
                                     curve(fmt::format("{} taps", o.options.taps), 0, 0.5, 400,
                                           [&](double f) { return height_at(d, f); })})};
    return design;
}

}  // namespace

void add_design_derivative(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "derivative", "Taps that differentiate along an axis, for gradients and normals",
        "bandlimit design derivative --taps 9 --optimal least-squares --ramp --plot derivative.svg", [o] { check(*o); },
        [o](Console&) { return make(*o); });
    app.add_option("--taps", o->options.taps,
                   "How many, 2 to 255: odd on a sample, even halfway between two. Default 5")
        .type_name("N");
    app.add_option("--optimal", o->optimal,
                   "taylor: exact for polynomials of the highest degree, the default;\n"
                   "least-squares: the smallest mean square error over the band")
        .type_name("NAME");
    app.add_flag("--ramp", o->options.exact_ramp,
                 "With least-squares: slopes come out exactly. taylor always keeps them");
    app.add_option("--band", o->band,
                   "Errors are measured below this frequency, in cycles per sample, 0.05 to 1/2; default 1/2")
        .type_name("F");
}

}  // namespace bandlimit::app
