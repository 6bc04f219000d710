#include "bandlimit/job/analyze.h"

#include "bandlimit/job/option_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/design/downsample.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/kernel/radial_weights.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit::job {
namespace {

/// 0, 1/2, 1, ... and the radius.
std::vector<double> default_positions(double radius) {
    std::vector<double> at;
    for (int i = 0; i * 0.5 < radius; ++i) at.push_back(i * 0.5);
    at.push_back(radius);
    return at;
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
    if (!file.fetches.empty()) return weights_of(file.fetches, output_position(file));
    const WeightGrid grid = expanded(file.terms);
    return {double(centred_first(grid.width)), double(centred_first(grid.height)), grid.width, grid.weights};
}

PhaseReport grid_phase(const TapsFile& file, const std::vector<double>& frequencies) {
    const double phase = output_position(file);
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

Bank bank_of(const Kernel& kernel, const BankRows& rows) {
    const Axis src{rows.from, 0, double(rows.from)}, dst{rows.to, 0, double(rows.from)};
    require_memory(bank_bytes(kernel.radius, src, dst),
                   fmt::format("the bank from {} to {} samples", rows.from, rows.to));
    return make_bank(kernel, src, dst, Edge::renormalize);
}

Bank bank_of(const TapsFile& file, const std::string& name, const BankRows& rows) {
    const Taps& taps = taps_of(file, name);
    const int outputs = std::max(1, rows.from / taps.factor);
    if (rows.to != outputs)
        throw Error(fmt::format("{}: taps of factor {} take {} samples to {}, not {}; ask for {}", name, taps.factor,
                                rows.from, outputs, rows.to, outputs));
    return make_bank(taps, rows.from, cancels(taps.weights) ? Edge::reflect : Edge::renormalize);
}

std::vector<RowReport> rows_of(const Bank& bank, const std::vector<int>& outputs) {
    std::vector<RowReport> rows;
    for (const int i : outputs) {
        if (i < 0 || i >= bank.output_count())
            throw Error(
                fmt::format("rows: {} is not a row; pass whole numbers from 0 to {}", i, bank.output_count() - 1));
        const std::span<const float> row = bank.row(i);
        rows.push_back({i, bank.first(i), {row.begin(), row.end()}});
    }
    return rows;
}

}  // namespace

bool is_taps_name(const std::string& name) { return name.ends_with(".json"); }

Subject read_subject(const std::string& name) {
    if (!is_taps_name(name)) return parse_kernel(name);
    TapsFile file = read_taps(name);
    if (is_kernel(file)) return kernel_of(file, name);
    if (file.fetches.empty() && file.terms.empty()) taps_of(file, name);
    constexpr double most = 1 << 22;  // as many as fetches may spread over
    if (!file.taps && file.fetches.empty() && size_of(file.terms).count() > most)
        throw std::runtime_error(
            fmt::format("{}: its terms expand to {} x {} weights, and analyze lists at most {}; use shorter ones", name,
                        size_of(file.terms).width, size_of(file.terms).height, most));
    return file;
}

PhaseReport kernel_phase(const Kernel& kernel, double phase, const std::vector<double>& frequencies) {
    if (is_radial(kernel)) return radial_phase(kernel, phase, frequencies);
    const PhaseWeights at = weights_at(kernel, phase);
    return separable_phase(at.taps, at.sum, phase, frequencies);
}

PhaseReport taps_phase(const TapsFile& file, const std::vector<double>& frequencies) {
    if (!file.taps) return grid_phase(file, frequencies);
    return separable_phase(*file.taps, sum(*file.taps), output_position(file), frequencies);
}

PhaseReport phase_of(const Subject& subject, double phase, const std::vector<double>& frequencies) {
    if (const auto* file = std::get_if<TapsFile>(&subject)) return taps_phase(*file, frequencies);
    return kernel_phase(std::get<Kernel>(subject), phase, frequencies);
}

double output_position(const TapsFile& file) {
    return file.kind == "upsample" ? output_texel({.upsample = true}) : output_offset({0, {}, file.factor});
}

void check_analysis(const AnalyzeOptions& options) {
    constexpr double limit = 1000;  // the cost of a spectrum grows with its frequency
    for (const double p : options.phases)
        if (!(p >= 0 && p < 1))
            throw OptionError("phase", fmt::format("{} is not in [0, 1); use e.g. 0,1/6,1/3,1/2", p));
    for (const double f : options.frequencies)
        if (!(std::abs(f) <= limit))
            throw Error(
                fmt::format("frequency: {} is out of range; pass cycles per source sample, at most {}", f, limit));
}

Analysis analyze_kernel(const Kernel& kernel, const AnalyzeOptions& options) {
    check_analysis(options);
    Analysis analysis{kernel.name, kernel.radius, !is_radial(kernel), {}, {}, {}, {}};
    for (const double x : options.positions.empty() ? default_positions(kernel.radius) : options.positions)
        analysis.values.emplace_back(x, kernel.value(x));
    for (const double f : options.frequencies) analysis.profile.emplace_back(f, relative_spectrum(kernel, f));
    for (const double p : options.phases) analysis.phases.push_back(kernel_phase(kernel, p, options.frequencies));
    if (options.bank) analysis.rows = rows_of(bank_of(kernel, *options.bank), options.bank->outputs);
    return analysis;
}

Analysis analyze_taps(const TapsFile& file, const std::string& name, const AnalyzeOptions& options) {
    check_analysis(options);
    Analysis analysis{name, {}, file.taps.has_value(), {}, {}, {taps_phase(file, options.frequencies)}, {}};
    if (options.bank) analysis.rows = rows_of(bank_of(file, name, *options.bank), options.bank->outputs);
    return analysis;
}

PatternAnalysis analyze_pattern(const SamplePattern& pattern) {
    const std::vector<Point>& points = pattern.points;
    PatternAnalysis analysis{pattern, sweep_edges(points), least_distance(points), {}, {}};
    const bool is_inside = std::all_of(points.begin(), points.end(),
                                       [](const Point& p) { return std::max(std::abs(p.x), std::abs(p.y)) <= 0.5; });
    if (is_inside)
        analysis.star_discrepancy = star_discrepancy(points), analysis.l2_discrepancy = l2_discrepancy(points);
    return analysis;
}

}  // namespace bandlimit::job
