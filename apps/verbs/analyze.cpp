// bandlimit analyze: kernels and taps, their weights and what they do to frequencies; patterns of samples.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "apps/page/pattern_plot.h"
#include "apps/page/plot.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/job/analyze.h"
#include "bandlimit/job/shaders.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/shader/kernels.h"

namespace bandlimit::app {
namespace {

using job::Analysis, job::PhaseReport, job::ResponseAt, job::RowReport, job::Subject;
using nlohmann::ordered_json;

struct Options {
    std::string kernel, pattern, at, phase, frequency, rows, plot;
    std::optional<int> from, to;
    std::optional<Dialect> emit;
    bool list = false, list_patterns = false, json = false;
};

std::vector<int> rows_of(const Options& o) {
    std::vector<int> rows;
    if (o.rows.empty()) {
        for (int i = 0; o.to && i < *o.to; ++i) rows.push_back(i);
        return rows;
    }
    for (const double r : parse_numbers("--rows", o.rows)) {
        if (!(r >= 0 && r < *o.to && r == std::floor(r)))
            throw UsageError(fmt::format("--rows: {} is not a row; pass whole numbers from 0 to {}", r, *o.to - 1));
        rows.push_back(static_cast<int>(r));
    }
    return rows;
}

job::AnalyzeOptions analysis_of(const Options& o) {
    job::AnalyzeOptions options;
    if (!o.at.empty()) options.positions = parse_numbers("--at", o.at);
    if (!o.phase.empty()) options.phases = parse_numbers("--phase", o.phase);
    if (!o.frequency.empty()) options.frequencies = parse_numbers("--frequency", o.frequency);
    if (o.to) options.bank = job::BankRows{*o.from, *o.to, rows_of(o)};
    return options;
}

void check_pattern(const Options& o) {
    if (!o.kernel.empty())
        throw UsageError("analyze: --pattern is a subject of its own; leave out the kernel, or --pattern");
    if (!o.at.empty() || !o.phase.empty() || !o.frequency.empty() || !o.rows.empty() || o.from || o.to || o.emit)
        throw UsageError("analyze: --pattern goes with --plot and --json only; leave out the others");
    parse_pattern(o.pattern);
    if (!o.plot.empty()) check_plot_format(o.plot);
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    if (o.list || o.list_patterns) return;
    if (!o.pattern.empty()) return check_pattern(o);
    if (o.kernel.empty())
        throw UsageError(
            "analyze: a kernel is missing; name one (analyze --list shows them), a taps.json, or a --pattern");
    if (o.emit && o.json) throw UsageError("analyze: --emit and --json both print to stdout; leave one out");
    if (o.emit && !o.plot.empty())
        throw UsageError("analyze: --emit prints a shader and draws nothing; leave out --plot");
    if (o.emit && !job::is_taps_name(o.kernel)) {
        job::kernel_shader_names(o.kernel);
        return;
    }
    if (o.from.has_value() != o.to.has_value())
        throw UsageError("analyze: --from and --to belong together; give both or none");
    if (!o.rows.empty() && !o.to)
        throw UsageError("--rows: there is no bank to show rows of; choose one with --from N --to M");
    try {
        job::check_analysis(analysis_of(o));
    } catch (const Error& e) {  // begins with the name of the field, which is that of the option
        throw UsageError(std::string("--") + e.what());
    }
    if (!job::is_taps_name(o.kernel) && is_radial(parse_kernel(o.kernel)) && o.to) {
        throw UsageError(
            fmt::format("analyze: {} is radial and has no rows along an axis; leave out --from and --to", o.kernel));
    }
    if (!o.plot.empty()) check_plot_format(o.plot);
}

// ---- Printing

ordered_json to_json(const std::vector<ResponseAt>& responses) {
    ordered_json list = ordered_json::array();
    for (const auto& [f, h] : responses)
        list.push_back({{"f", f}, {"re", h.real()}, {"im", h.imag()}, {"gain", std::abs(h)}});
    return list;
}

ordered_json to_json(const PhaseReport& p) {
    ordered_json out{{"phase", p.phase}, {"first", p.first}};
    if (p.first_y) out["first_y"] = *p.first_y;
    out["weights"] = p.first_y ? ordered_json(p.weights) : ordered_json(p.weights.front());
    out["sum"] = p.sum;
    out["variance"] = p.variance;
    out["centroid"] = p.centroid;
    out["response"] = to_json(p.responses);
    if (!p.diagonal.empty()) out["response_diagonal"] = to_json(p.diagonal);
    return out;
}

ordered_json to_json(const Analysis& r) {
    ordered_json values = ordered_json::array(), profile = values, phases = values, rows = values;
    for (const auto& [x, value] : r.values) values.push_back({{"x", x}, {"value", value}});
    for (const auto& [f, gain] : r.profile) profile.push_back({{"f", f}, {"gain", gain}});
    for (const PhaseReport& p : r.phases) phases.push_back(to_json(p));
    // A float as a double prints with all the digits that lead back to it.
    for (const RowReport& row : r.rows)
        rows.push_back({{"output", row.output}, {"first", row.first}, {"weights", row.weights}});
    return {{"kernel", r.name},
            {"radius", r.radius ? ordered_json(*r.radius) : ordered_json()},
            {"separable", r.separable},
            {"values", values},
            {"phases", phases},
            {"profile", profile},
            {"rows", rows}};
}

std::string cells(const std::vector<double>& numbers) {
    std::string text;
    for (const double v : numbers) text += fmt::format("{:>11}", fmt::format("{:.6f}", std::abs(v) < 5e-7 ? 0.0 : v));
    return text;
}

void print_phase(Console& console, const PhaseReport& p) {
    console.print("\nphase {:.6g}: first {}", p.phase, p.first);
    if (p.first_y) console.print(", first row {}", *p.first_y);
    console.print(", sum {:.6f}, variance {:.6f}, centroid {:.6f}\n", p.sum, p.variance, p.centroid);
    constexpr std::size_t widest = 16;  // what fits a terminal; --json has all
    if (p.weights.size() > 1 && p.weights.front().size() > widest)
        return console.print("  {} x {} weights\n", p.weights.front().size(), p.weights.size());
    for (const std::vector<double>& row : p.weights) console.print("  {}\n", cells(row));
}

void print_gains(Console& console, const Analysis& r) {
    std::vector<double> line;
    for (const ResponseAt& at : r.phases.front().responses) line.push_back(at.f);
    console.print("\n{:<14}{}\n", "gain at f", cells(line));
    for (const PhaseReport& p : r.phases) {
        line.clear();
        for (const ResponseAt& at : p.responses) line.push_back(std::abs(at.h));
        console.print("{:<14}{}\n", fmt::format("phase {:.4g}", p.phase), cells(line));
        line.clear();
        for (const ResponseAt& at : p.diagonal) line.push_back(std::abs(at.h));
        if (!line.empty()) console.print("{:<14}{}\n", "at (f, f)", cells(line));
    }
    if (r.profile.empty()) return;
    line.clear();
    for (const auto& [f, gain] : r.profile) line.push_back(gain);
    console.print("{:<14}{}\n", "continuous", cells(line));
}

void print(Console& console, const Analysis& r) {
    console.print("{}", r.name);
    if (r.radius) console.print(": {}, radius {:.6g}", r.separable ? "separable" : "radial", *r.radius);
    console.print("\n");
    if (!r.values.empty()) console.print("\n{:>10}{:>12}\n", "x", "value");
    for (const auto& [x, value] : r.values) console.print("{:>10.4f}{:>12.6f}\n", x, value);
    for (const PhaseReport& p : r.phases) print_phase(console, p);
    print_gains(console, r);
    if (!r.rows.empty()) console.print("\n{:>8}{:>8}  weights\n", "output", "first");
    for (const RowReport& row : r.rows)
        console.print("{:>8}{:>8}  {}\n", row.output, row.first, fmt::join(row.weights, " "));
}

/// Kernels or patterns, a line each.
template <class Infos>
void print_list(Console& console, const char* key, const Infos& infos, bool json) {
    ordered_json list = ordered_json::array();
    for (const auto& info : infos) {
        list.push_back({{"name", info.name}, {"example", info.example}, {"summary", info.summary}});
        if (!json) console.print("{:<24}{}\n", info.name, info.summary);
    }
    if (json) console.print_json({{key, list}});
}

// ---- Drawing

Panel shape_panel(const Subject& subject) {
    Panel panel{"", "distance from the output (source samples)", "weight", {}};
    if (const auto* kernel = std::get_if<Kernel>(&subject)) {
        panel.title = kernel->name;
        const double reach = kernel->radius * 1.1;
        panel.series = {curve("", -reach, reach, 800, kernel->value)};
        return panel;
    }
    const TapsFile& file = std::get<TapsFile>(subject);
    if (!file.taps && file.fetches.empty()) {
        const WeightGrid grid = expanded(file.terms);
        const double peak = std::abs(*std::max_element(grid.weights.begin(), grid.weights.end(),
                                                       [](double a, double b) { return std::abs(a) < std::abs(b); }));
        return {"sum of terms", "column", "row", {}, {}, {}, HeatMap{grid.width, grid.height, grid.weights, peak}};
    }
    if (!file.taps) {
        panel = {"fetches", "x (source texels from the output)", "y", {{"", {}, {}, Series::Style::points}}};
        for (const Fetch& f : file.fetches) {
            panel.series.front().x.push_back(f.x);
            panel.series.front().y.push_back(f.y);
        }
        return panel;
    }
    const PlacedWeights placed(*file.taps, job::output_position(file));
    panel.title = "taps";
    panel.series = {stems("", placed.first, placed.weights)};
    return panel;
}

Panel response_panel(const Analysis& r, const Subject& subject) {
    constexpr int steps = 200;
    std::vector<double> frequencies;
    for (int i = 0; i <= steps; ++i) frequencies.push_back(0.5 * i / steps);
    Panel panel{"response", "frequency (cycles per source sample)", "gain", {}};
    const auto add = [&](const std::string& label, const std::vector<ResponseAt>& responses) {
        Series series{label, {}, {}, Series::Style::line};
        for (const auto& [f, h] : responses) {
            series.x.push_back(f);
            series.y.push_back(std::abs(h));
        }
        panel.series.push_back(std::move(series));
    };
    for (const PhaseReport& p : r.phases) {
        const PhaseReport fine = job::phase_of(subject, p.phase, frequencies);
        add(r.phases.size() > 1     ? fmt::format("phase {:.3g}", p.phase)
            : fine.diagonal.empty() ? ""
                                    : "(f, 0)",
            fine.responses);
        if (!fine.diagonal.empty()) add("(f, f)", fine.diagonal);
    }
    return panel;
}

void plot(const Options& o, const Analysis& r, const Subject& subject) {
    std::vector<Panel> panels{shape_panel(subject), response_panel(r, subject)};
    if (std::holds_alternative<Kernel>(subject)) {
        Panel panel{"variance of white noise", "phase (source samples)", "sum of squared weights", {}};
        panel.series = {curve("", 0, 0.999, 120, [&](double p) { return job::phase_of(subject, p, {}).variance; })};
        panel.x_range = Range{0, 1};
        panels.push_back(std::move(panel));
    }
    draw(panels, o.plot, 400 * static_cast<int>(panels.size()), 360);
}

Analysis analyze(const Options& o, const Subject& subject) {
    if (const auto* kernel = std::get_if<Kernel>(&subject)) return job::analyze_kernel(*kernel, analysis_of(o));
    if (!o.phase.empty() || !o.at.empty())
        throw UsageError("analyze: --phase and --at are for kernels; taps have one phase, and no values in between");
    try {
        return job::analyze_taps(std::get<TapsFile>(subject), o.kernel, analysis_of(o));
    } catch (const Error& e) {  // what was asked for does not go with the file
        throw UsageError(e.what());
    }
}

void emit(const Options& o, Console& console, const std::string& command) {
    if (job::is_taps_name(o.kernel)) {
        const TapsFile file = read_taps(o.kernel);
        const std::vector<ShaderFile> files = job::emit_shaders(file, {file.kind, command, {}}, *o.emit);
        return console.write(files.front().text);
    }
    for (const std::string_view name : job::kernel_shader_names(o.kernel))
        console.write(kernel_shader(name, command, *o.emit));
}

// ---- Patterns

ordered_json to_json(const job::PatternAnalysis& r) {
    ordered_json points = ordered_json::array(), edges = points;
    for (const Point& p : r.pattern.points) points.push_back({p.x, p.y});
    for (const EdgeSweep& e : r.edges)
        edges.push_back(
            {{"degrees", e.degrees}, {"levels", e.levels}, {"steps", e.steps}, {"max_gap", e.max_gap}, {"rms", e.rms}});
    ordered_json out{{"pattern", r.pattern.name}, {"points", points}, {"edges", edges}};
    out["least_distance"] = r.least_distance;
    if (r.star_discrepancy) out["discrepancy"] = {{"star", *r.star_discrepancy}, {"l2", *r.l2_discrepancy}};
    return out;
}

void print(Console& console, const job::PatternAnalysis& r) {
    constexpr std::size_t most = 16;  // what is read with pleasure; --json has all
    console.print("{}: {} point{} per pixel\n", r.pattern.name, r.pattern.count(), r.pattern.count() == 1 ? "" : "s");
    if (r.pattern.points.size() <= most) {
        console.print("\n{:>10}{:>10}\n", "x", "y");
        for (const Point& p : r.pattern.points) console.print("{:>10.4f}{:>10.4f}\n", p.x, p.y);
    }
    console.print("\n{:>10}{:>8}{:>10}{:>10}  steps of an edge at that angle\n", "degrees", "levels", "max gap", "rms");
    for (const EdgeSweep& e : r.edges) {
        console.print("{:>10.5g}{:>8}{:>10.4f}{:>10.4f}", e.degrees, e.levels, e.max_gap, e.rms);
        if (e.steps.size() <= most) console.print("  {:.4g}", fmt::join(e.steps, " "));
        console.print("\n");
    }
    console.print("\nleast distance between points {:.4f} pixels\n", r.least_distance);
    if (r.star_discrepancy)
        console.print("discrepancy: star {:.4f}, L2 {:.5f}\n", *r.star_discrepancy, *r.l2_discrepancy);
}

void run_pattern(const Options& o, Console& console) {
    if (!o.plot.empty()) check_output_path(o.plot);
    const job::PatternAnalysis report = job::analyze_pattern(parse_pattern(o.pattern));
    if (!o.plot.empty()) {
        const SamplePattern& pattern = report.pattern;
        draw({points_panel(pattern), coverage_panel(pattern), spectrum_panel(pattern)}, o.plot, 1200, 400);
    }
    if (o.json) console.print_json(to_json(report));
    else print(console, report);
}

void run(const Options& o, Console& console, const std::string& command) {
    if (o.list) return print_list(console, "kernels", kernel_list(), o.json);
    if (o.list_patterns) return print_list(console, "patterns", pattern_list(), o.json);
    if (!o.pattern.empty()) return run_pattern(o, console);
    if (o.emit) return emit(o, console, command);
    if (!o.plot.empty()) check_output_path(o.plot);
    const Subject subject = job::read_subject(o.kernel);
    const Analysis report = analyze(o, subject);
    if (!o.plot.empty()) plot(o, report, subject);
    if (o.json) console.print_json(to_json(report));
    else print(console, report);
}

}  // namespace

void add_analyze(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("analyze", "Show what a kernel, taps or a pattern of samples do",
                                 "bandlimit analyze bspline --phase 0,1/6,1/3,1/2 --plot bspline.svg\n"
                                 "  bandlimit analyze --pattern d3d:4 --plot d3d4.svg");
    verb.add_option("KERNEL", o->kernel, "A kernel (analyze --list shows them), or a taps file, which ends in .json");
    verb.add_flag("--list", o->list, "List the kernels with a line each");
    verb.add_flag("--list-patterns", o->list_patterns, "List the patterns of samples with a line each");
    verb.add_option(
            "--pattern", o->pattern,
            "Instead of a kernel: a pattern of samples in a pixel, such as d3d:4 or sobol:16:1 (--list-patterns\n"
            "shows them). Prints its points, how its coverage steps as an edge crosses the pixel, and its\n"
            "discrepancy. Points are in pixels from the centre, y down; degrees are those of the edge's\n"
            "normal, from +x towards +y")
        .type_name("NAME[:N]");
    verb.add_option("--at", o->at, "Positions to print the kernel's value at, between commas; default 0,0.5,... radius")
        .type_name("X,...");
    verb.add_option(
            "--phase", o->phase,
            "Where the output lies, right of source sample 0, in [0, 1); default 0,1/4,1/2,3/4. Weights are\n"
            "normalised to sum 1; \"first\" and \"centroid\" count from source sample 0. Of a radial kernel the\n"
            "output lies on the row of sample 0, and weights have rows")
        .type_name("P,...");
    verb.add_option("--frequency", o->frequency,
                    "Frequencies of responses, in cycles per source sample; default 0,1/8,1/4,3/8,1/2. Responses are\n"
                    "relative to the output's position; those of radial kernels along x")
        .type_name("F,...");
    verb.add_option("--from", o->from, "Print rows of the bank that takes N samples ...")
        .in_range(1, 1 << 24)
        .type_name("N");
    verb.add_option("--to", o->to, "... to M, with renormalized edges").in_range(1, 1 << 24).type_name("M");
    verb.add_option("--rows", o->rows, "Which outputs to print; default all").type_name("I,...");
    verb.add_option("--plot", o->plot,
                    "Draw kernel, responses at the phases and variance over phase, as .svg or .png; of a pattern, its\n"
                    "points, coverage and spectrum")
        .type_name("OUT");
    verb.add_option_function<std::string>(
            "--emit", [o](const std::string& s) { o->emit = parse_dialect(s); },
            "Print shader source instead: functions that read a texture with the kernel, or one of them by its\n"
            "name, such as sample_catmull_rom_5; srgb for the curve; for a taps.json, its first shader")
        .type_name("glsl|hlsl|wgsl|msl|slang|cpp");
    add_json(verb, o->json);
    program.on(
        verb, [o] { check(*o); }, [o, &program](Console& console) { run(*o, console, program.command); });
}

}  // namespace bandlimit::app
