// bandlimit analyze: kernels and taps, their weights and what they do to frequencies.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include <nlohmann/json.hpp>
#include "apps/common.h"
#include "apps/emit.h"
#include "apps/plot.h"
#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/design/downsample.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/resample/bank.h"
#include "bandlimit/resample/radial.h"
#include "bandlimit/shader/kernels.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

struct Options {
    std::string kernel, at, phase, frequency, rows, plot;
    std::optional<int> from, to;
    std::optional<Dialect> emit;
    bool list = false, json = false;

    bool is_taps_file() const { return kernel.ends_with(".json"); }
};

/// Something to analyze.
using Subject = std::variant<Kernel, TapsFile>;

struct ResponseAt {
    double f;
    std::complex<double> h;
};

/// Weights of one phase. Positions in source samples from sample 0.
struct PhaseReport {
    double phase = 0;
    int first = 0;
    std::optional<int> first_y;                ///< of radial kernels, fetches and terms, whose weights have rows
    std::vector<std::vector<double>> weights;  ///< one row, or all of them
    double sum = 1, variance = 0, centroid = 0;
    std::vector<ResponseAt> responses;  ///< along x
    std::vector<ResponseAt> diagonal;   ///< of fetches and terms: H(f, f)
};

struct RowReport {
    int output = 0, first = 0;
    std::vector<float> weights;
};

struct Report {
    std::string name;
    std::optional<double> radius;  ///< none for taps
    bool separable = true;
    std::vector<std::pair<double, double>> values, profile;
    std::vector<PhaseReport> phases;
    std::vector<RowReport> rows;
};

std::vector<double> numbers_or(const std::string& option, const std::string& text, std::vector<double> otherwise) {
    return text.empty() ? otherwise : parse_numbers(option, text);
}

/// 0, 1/2, 1, ... and the radius.
std::vector<double> default_positions(double radius) {
    std::vector<double> at;
    for (int i = 0; i * 0.5 < radius; ++i) at.push_back(i * 0.5);
    at.push_back(radius);
    return at;
}

std::vector<double> phases_of(const Options& o) {
    const std::vector<double> phases = numbers_or("--phase", o.phase, {0, 0.25, 0.5, 0.75});
    for (const double p : phases)
        if (!(p >= 0 && p < 1))
            throw UsageError(fmt::format("--phase: {} is not in [0, 1); use e.g. 0,1/6,1/3,1/2", p));
    return phases;
}

std::vector<double> frequencies_of(const Options& o) {
    constexpr double limit = 1000;  // the cost of a spectrum grows with its frequency
    const std::vector<double> frequencies = numbers_or("--frequency", o.frequency, {0, 0.125, 0.25, 0.375, 0.5});
    for (const double f : frequencies)
        if (!(std::abs(f) <= limit))
            throw UsageError(
                fmt::format("--frequency: {} is out of range; pass cycles per source sample, at most {}", f, limit));
    return frequencies;
}

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

/// The shaders that --emit prints: all of a kernel, or the one of that name.
std::vector<std::string_view> shaders_for(const std::string& name) {
    const auto known = [](std::string_view n) {
        return std::ranges::any_of(kernel_shaders(), [&](const KernelShader& s) { return s.name == n; });
    };
    if (known(name)) return {std::ranges::find(kernel_shaders(), name, &KernelShader::name)->name};
    std::vector<std::string_view> names;
    const std::string kernel = parse_kernel(name).name;
    for (const KernelShader& s : kernel_shaders())
        if (s.kernel == kernel) names.push_back(s.name);
    if (!names.empty()) return names;
    std::vector<std::string_view> all;
    for (const KernelShader& s : kernel_shaders()) {
        const std::string_view each = s.kernel.empty() ? s.name : s.kernel;
        if (all.empty() || all.back() != each) all.push_back(each);
    }
    throw UsageError(
        fmt::format("--emit: there is no shader of {}; there are shaders of {}", name, fmt::join(all, ", ")));
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    if (o.list) return;
    if (o.kernel.empty())
        throw UsageError("analyze: a kernel is missing; name one (analyze --list shows them) or a taps.json");
    if (o.emit && o.json) throw UsageError("analyze: --emit and --json both print to stdout; leave one out");
    if (o.emit && !o.plot.empty())
        throw UsageError("analyze: --emit prints a shader and draws nothing; leave out --plot");
    if (o.emit && !o.is_taps_file()) {
        shaders_for(o.kernel);
        return;
    }
    if (o.from.has_value() != o.to.has_value())
        throw UsageError("analyze: --from and --to belong together; give both or none");
    if (!o.rows.empty() && !o.to)
        throw UsageError("--rows: there is no bank to show rows of; say which with --from N --to M");
    if (!o.at.empty()) parse_numbers("--at", o.at);
    phases_of(o), frequencies_of(o), rows_of(o);
    if (!o.is_taps_file() && is_radial(parse_kernel(o.kernel)) && o.to) {
        throw UsageError(
            fmt::format("analyze: {} is radial and has no rows along an axis; leave out --from and --to", o.kernel));
    }
    if (!o.plot.empty()) check_plot_format(o.plot);
}

// ---- Measuring
// -------------------------------------------------------------------------------------------------------

/// Where the output of `file` lies, right of input sample i * factor.
double phase_of(const TapsFile& file) {
    return file.kind == "upsample" ? output_texel({.upsample = true}) : output_offset({0, {}, file.factor});
}

PhaseReport separable_phase(const Taps& taps, double sum_before, double phase, const std::vector<double>& frequencies) {
    const PlacedWeights placed(taps, phase);
    PhaseReport report{phase, taps.first, {}, {taps.weights}, sum_before, variance(placed), centroid(placed) + phase,
                       {},    {}};
    for (const double f : frequencies) report.responses.push_back({f, response(placed, f)});
    return report;
}

PhaseReport radial_phase(const Kernel& kernel, double phase, const std::vector<double>& frequencies) {
    const RadialWeights radial = radial_weights_at(kernel, phase, 0);
    const PlacedWeights2D placed(radial, phase, 0);
    PhaseReport report{phase, radial.first_x, radial.first_y, {}, radial.sum, variance(placed), 0, {}, {}};
    for (int y = 0; y < radial.height; ++y) {
        const auto row = radial.weights.begin() + static_cast<std::ptrdiff_t>(y) * radial.width;
        report.weights.emplace_back(row, row + radial.width);
        for (int x = 0; x < radial.width; ++x) report.centroid += (radial.first_x + x) * row[x];
    }
    for (const double f : frequencies) report.responses.push_back({f, response(placed, f, 0)});
    return report;
}

/// The weights of fetches or terms in two dimensions.
PlacedWeights2D placed_weights(const TapsFile& file) {
    if (!file.fetches.empty()) return weights_of(file.fetches, phase_of(file));
    const WeightGrid grid = expanded(file.terms);
    return {double(centred_first(grid.width)), double(centred_first(grid.height)), grid.width, grid.weights};
}

PhaseReport grid_phase(const TapsFile& file, const std::vector<double>& frequencies) {
    const double phase = phase_of(file);
    const PlacedWeights2D placed = placed_weights(file);
    const auto first = [phase](double at) { return static_cast<int>(std::lround(at + phase)); };
    PhaseReport report{phase, first(placed.first_x), first(placed.first_y), {}, 0, variance(placed), 0, {}, {}};
    double moment = 0;
    for (auto at = placed.weights.begin(); at != placed.weights.end(); at += placed.width) {
        report.weights.emplace_back(at, at + placed.width);
        for (int x = 0; x < placed.width; ++x) {
            report.sum += at[x];
            moment += (report.first + x) * at[x];
        }
    }
    report.centroid = moment / report.sum;
    for (const double f : frequencies) {
        report.responses.push_back({f, response(placed, f, 0)});
        report.diagonal.push_back({f, response(placed, f, f)});
    }
    return report;
}

PhaseReport phase_report(const Subject& subject, double phase, const std::vector<double>& frequencies) {
    if (const auto* file = std::get_if<TapsFile>(&subject)) {
        if (!file->taps) return grid_phase(*file, frequencies);
        return separable_phase(*file->taps, sum(*file->taps), phase_of(*file), frequencies);
    }
    const Kernel& kernel = std::get<Kernel>(subject);
    if (is_radial(kernel)) return radial_phase(kernel, phase, frequencies);
    const PhaseWeights at = weights_at(kernel, phase);
    return separable_phase(at.taps, at.sum, phase, frequencies);
}

Bank bank_of(const Options& o, const Subject& subject) {
    const Axis src{*o.from, 0, double(*o.from)}, dst{*o.to, 0, double(*o.from)};
    if (const auto* kernel = std::get_if<Kernel>(&subject)) {
        require_memory(bank_bytes(kernel->radius, src, dst),
                       fmt::format("the bank from {} to {} samples", *o.from, *o.to));
        return make_bank(*kernel, src, dst, Edge::renormalize);
    }
    const Taps& taps = taps_of(std::get<TapsFile>(subject), o.kernel);
    const int outputs = std::max(1, *o.from / taps.factor);
    if (*o.to != outputs)
        throw UsageError(fmt::format("{}: taps of factor {} take {} samples to {}, not {}; pass --to {}", o.kernel,
                                     taps.factor, *o.from, outputs, *o.to, outputs));
    return make_bank(taps, *o.from, std::abs(sum(taps)) < 1e-9 ? Edge::reflect : Edge::renormalize);
}

Report analyze(const Options& o, const Subject& subject) {
    Report report;
    const std::vector<double> frequencies = frequencies_of(o);
    if (const auto* kernel = std::get_if<Kernel>(&subject)) {
        report.name = kernel->name;
        report.radius = kernel->radius;
        report.separable = !is_radial(*kernel);
        for (const double x : numbers_or("--at", o.at, default_positions(kernel->radius)))
            report.values.emplace_back(x, kernel->value(x));
        for (const double f : frequencies) report.profile.emplace_back(f, relative_spectrum(*kernel, f));
        for (const double p : phases_of(o)) report.phases.push_back(phase_report(subject, p, frequencies));
    } else {
        report.name = o.kernel;
        report.separable = std::get<TapsFile>(subject).taps.has_value();
        report.phases.push_back(phase_report(subject, 0, frequencies));
    }
    if (!o.to) return report;
    const Bank bank = bank_of(o, subject);
    for (const int i : rows_of(o)) {
        const std::span<const float> row = bank.row(i);
        report.rows.push_back({i, bank.first(i), {row.begin(), row.end()}});
    }
    return report;
}

// ---- Printing
// --------------------------------------------------------------------------------------------------------

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

ordered_json to_json(const Report& r) {
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

void print_gains(Console& console, const Report& r) {
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

void print(Console& console, const Report& r) {
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

void print_list(Console& console, bool json) {
    if (json) {
        ordered_json list = ordered_json::array();
        for (const KernelInfo& k : kernel_list())
            list.push_back({{"name", k.name}, {"example", k.example}, {"summary", k.summary}});
        return console.print_json({{"kernels", list}});
    }
    for (const KernelInfo& k : kernel_list()) console.print("{:<24}{}\n", k.name, k.summary);
}

// ---- Drawing
// ---------------------------------------------------------------------------------------------------------

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
    const PlacedWeights placed(*file.taps, phase_of(file));
    panel.title = "taps";
    panel.series = {stems("", placed.first, placed.weights)};
    return panel;
}

Panel response_panel(const Report& r, const Subject& subject) {
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
        const PhaseReport fine = phase_report(subject, p.phase, frequencies);
        add(r.phases.size() > 1     ? fmt::format("phase {:.3g}", p.phase)
            : fine.diagonal.empty() ? ""
                                    : "(f, 0)",
            fine.responses);
        if (!fine.diagonal.empty()) add("(f, f)", fine.diagonal);
    }
    return panel;
}

void plot(const Options& o, const Report& r, const Subject& subject) {
    std::vector<Panel> panels{shape_panel(subject), response_panel(r, subject)};
    if (std::holds_alternative<Kernel>(subject)) {
        Panel panel{"variance of white noise", "phase (source samples)", "sum of squared weights", {}};
        panel.series = {curve("", 0, 0.999, 120, [&](double p) { return phase_report(subject, p, {}).variance; })};
        panel.x_range = Range{0, 1};
        panels.push_back(std::move(panel));
    }
    draw(panels, o.plot, 400 * static_cast<int>(panels.size()), 360);
}

Subject read_subject(const Options& o) {
    if (!o.is_taps_file()) return parse_kernel(o.kernel);
    TapsFile file = read_taps(o.kernel);
    if (is_kernel(file)) return kernel_of(file, o.kernel);
    if (file.fetches.empty() && file.terms.empty()) taps_of(file, o.kernel);
    constexpr double most = 1 << 22;  // as many as fetches may spread over
    if (!file.taps && file.fetches.empty() && size_of(file.terms).count() > most)
        throw std::runtime_error(
            fmt::format("{}: its terms stand for {} x {} weights, and analyze lists at most {}; "
                        "name shorter ones",
                        o.kernel, size_of(file.terms).width, size_of(file.terms).height, most));
    if (!o.phase.empty() || !o.at.empty())
        throw UsageError("analyze: --phase and --at are for kernels; taps have one phase, and no values in between");
    return file;
}

void emit(const Options& o, Console& console, const std::string& command) {
    if (o.is_taps_file()) {
        const TapsFile file = read_taps(o.kernel);
        const std::vector<ShaderFile> files = shaders_of(file, {file.kind, command, {}}, *o.emit);
        return console.write(files.front().text);
    }
    for (const std::string_view name : shaders_for(o.kernel)) console.write(kernel_shader(name, command, *o.emit));
}

void run(const Options& o, Console& console, const std::string& command) {
    if (o.list) return print_list(console, o.json);
    if (o.emit) return emit(o, console, command);
    if (!o.plot.empty()) check_output_path(o.plot);
    const Subject subject = read_subject(o);
    const Report report = analyze(o, subject);
    if (!o.plot.empty()) plot(o, report, subject);
    if (o.json) console.print_json(to_json(report));
    else print(console, report);
}

}  // namespace

void add_analyze(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("analyze", "See what a kernel or taps do: weights, responses, variance, spectrum",
                                 "bandlimit analyze bspline --phase 0,1/6,1/3,1/2 --plot bspline.svg");
    verb.add_option("KERNEL", o->kernel, "A kernel (analyze --list shows them), or a file that ends in .json");
    verb.add_flag("--list", o->list, "List the kernels with a line each");
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
    verb.add_option("--rows", o->rows, "Which outputs; default all").type_name("I,...");
    verb.add_option("--plot", o->plot, "Draw kernel, responses at the phases and variance over phase, as .svg or .png")
        .type_name("OUT");
    verb.add_option_function<std::string>(
            "--emit", [o](const std::string& s) { o->emit = parse_dialect(s); },
            "Print shader source instead: functions that read a texture with the kernel, or one of them by its\n"
            "name, as sample_catmull_rom_5; srgb for the curve; of a taps.json its first shader")
        .type_name("glsl|hlsl|wgsl|msl|slang|cpp");
    add_json(verb, o->json);
    program.on(
        verb, [o] { check(*o); }, [o, &program](Console& console) { run(*o, console, program.command); });
}

}  // namespace bandlimit::app
