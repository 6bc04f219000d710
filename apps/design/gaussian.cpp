// bandlimit design gaussian: blurs in bilinear reads.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "apps/design/design.h"
#include "apps/design/report.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

using Form = GaussianOptions::Form;

struct NamedForm {
    const char* name;
    Form form;
};
constexpr std::array forms{NamedForm{"least-squares", Form::least_squares}, NamedForm{"sampled", Form::sampled},
                           NamedForm{"integrated", Form::integrated}, NamedForm{"discrete", Form::discrete}};

struct Options {
    GaussianOptions options;
    std::string sigma, form = "least-squares";
    GaussianDesign design;
};

void check(Options& o) {
    const auto named = std::find_if(forms.begin(), forms.end(), [&](const NamedForm& f) { return o.form == f.name; });
    if (named == forms.end())
        throw UsageError(
            fmt::format("--form: \"{}\" is not a form; choose least-squares, sampled, integrated or discrete", o.form));
    o.options.form = named->form;
    o.options.sigma = parse_number("--sigma", o.sigma);
    o.design = design_gaussian(o.options);
}

std::vector<std::string> read_lines(const std::vector<LinearRead>& reads) {
    constexpr std::size_t most = 33;
    if (reads.size() > most) return {};
    std::vector<std::string> lines;
    for (const LinearRead& read : reads)
        lines.push_back(fmt::format("read          {:>12.7f}   weight {:.9f}", read.offset, read.weight));
    return lines;
}

Design make(const Options& o) {
    const GaussianDesign& d = o.design;
    const double sigma = o.options.sigma;
    Design design;
    design.file = job::taps_file(d);
    design.intermediates = 1;
    design.lines = {fmt::format("gaussian      sigma {:.6g}, {}: {} linear reads of {} taps along each axis", sigma,
                                o.form, d.reads.size(), d.taps.weights.size()),
                    weights_line(d.taps)};
    for (const std::string& line : read_lines(d.reads)) design.lines.push_back(line);
    design.lines.push_back(
        fmt::format("error         {:.3g}, the mean square error, relative to the Gaussian", d.error));
    design.lines.push_back(
        fmt::format("variance      {:.6g} of {:.6g}: sigma {:.4g}", d.variance, sigma * sigma, std::sqrt(d.variance)));
    const auto gain_at = [&d](double f) { return response(d.taps, f).real(); };
    for (const std::string& line : response_lines("gain", gain_at)) design.lines.push_back(line);
    design.lines.push_back(response_lines("ideal", [&](double f) { return gaussian_response(sigma, f); })[1]);
    design.panels = {
        weights_panel(d.taps, 0),
        response_panel("Response", "gain",
                       {curve("ideal", 0, 0.5, 400, [&](double f) { return gaussian_response(sigma, f); }),
                        curve(fmt::format("{} reads", d.reads.size()), 0, 0.5, 400, gain_at)}),
        response_panel("Error", "gain - ideal",
                       {curve("", 0, 0.5, 400, [&](double f) { return gain_at(f) - gaussian_response(sigma, f); })})};
    Series reads{"reads", {}, {}, Series::Style::stems};
    for (const LinearRead& read : d.reads) reads.x.push_back(read.offset), reads.y.push_back(read.weight);
    design.panels[0].series[0].label = "taps";
    design.panels[0].series.push_back(reads);
    return design;
}

}  // namespace

void add_design_gaussian(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "gaussian", "A Gaussian blur in as few bilinear reads as you like",
        "bandlimit design gaussian --sigma 2 --fetches 5 --emit glsl", [o] { check(*o); },
        [o](Console&) { return make(*o); });
    app.add_option("--sigma", o->sigma, "Standard deviation in source texels, 0.1 to 250").required().type_name("S");
    app.add_option("--fetches", o->options.fetches,
                   "Bilinear reads along each axis, 1 to 2048; N of them hold 2N - 1 taps. Default: enough to\n"
                   "reach 3 sigma")
        .type_name("N");
    app.add_option("--form", o->form,
                   "least-squares: the nearest to the Gaussian's response, the default; sampled: its samples;\n"
                   "integrated: its integrals over texels; discrete: exact in variance also below sigma 1")
        .type_name("NAME");
}

}  // namespace bandlimit::app
