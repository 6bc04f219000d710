// bandlimit design separable: two-dimensional kernels as sums of few separable ones.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "apps/design/design.h"
#include "bandlimit/core/error.h"
#include "bandlimit/design/noise_rank.h"
#include "bandlimit/design/separable.h"
#include "bandlimit/design/slanted.h"
#include "bandlimit/job/weights.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/shapes.h"

namespace bandlimit::app {
namespace {

constexpr int largest_side = 512;   // decomposed in about three seconds
constexpr int largest_rank = 64;    // that a taps.json holds
constexpr int largest_slant = 128;  // of fit_slanted()
constexpr double nearly_all = 0.999;

struct Options {
    std::string kernel;
    Space space = Space::data;
    std::optional<int> rank;
    SeparableLoss loss;
    bool optimise = false;
};

void check(const Options& o) {
    int most = largest_rank;
    if (job::is_shape_name(o.kernel)) most = std::min(most, job::shape_or_image(o.kernel, o.space, largest_side).width);
    if (o.rank && (*o.rank < 1 || *o.rank > most))
        throw UsageError(fmt::format("--rank: {}; pass 1 to {}", *o.rank, most));
    for (const auto& [option, factor] :
         {std::pair{"--non-negative", o.loss.non_negative}, {"--keep-zeros", o.loss.keep_zeros}})
        if (!(factor >= 0 && std::isfinite(factor)))
            throw UsageError(fmt::format("{}: {}; pass a number that is 0 or more", option, factor));
}

/// What is known before a rank is chosen.
struct Analysis {
    WeightGrid kernel;
    Svd svd = {};
    std::vector<double> energy = {}, sum = {};
    int exact = 0, nearly = 0, above_noise = 0;

    int count() const { return static_cast<int>(svd.values.size()); }
    double missing(int rank) const { return std::max(0.0, 1 - energy[static_cast<std::size_t>(rank) - 1]); }
};

Analysis analyse(const Options& o) {
    Analysis a{job::shape_or_image(o.kernel, o.space, largest_side)};
    const bool is_dark = std::all_of(a.kernel.weights.begin(), a.kernel.weights.end(), [](double w) { return w == 0; });
    if (is_dark) throw std::runtime_error(o.kernel + ": all samples are 0; a kernel needs at least one that is not");
    a.svd = svd_of(a.kernel);
    a.energy = cumulative_energy(a.svd.values);
    a.sum = cumulative_sum(a.svd.values);
    a.exact = numerical_rank(a.svd.values, a.kernel.height, a.kernel.width);
    a.nearly = rank_for_energy(a.svd.values, nearly_all);
    a.above_noise = rank_above_noise(a.svd.values, a.kernel.height, a.kernel.width);
    return a;
}

/// Sum of squared differences over the sum of squares.
double relative_error(const WeightGrid& weights, const WeightGrid& kernel) {
    double missing = 0, all = 0;
    for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
        missing += std::pow(weights.weights[i] - kernel.weights[i], 2);
        all += kernel.weights[i] * kernel.weights[i];
    }
    return missing / all;
}

double multiply_adds(const Analysis& a, int rank) {
    return static_cast<double>(rank) * (a.kernel.width + a.kernel.height);
}

// ---- Lines

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

std::vector<std::string> value_lines(const Analysis& a, int rank) {
    std::vector<std::string> lines{"rank  singular value    energy    sum of values"};
    const int last = std::min(a.count(), std::max({rank, std::min(a.nearly, 16), 4}));
    for (int r = 1; r <= last; ++r) {
        const auto i = static_cast<std::size_t>(r) - 1;
        lines.push_back(
            fmt::format("{:>4}  {:>14.6g} {:>9} {:>16}", r, a.svd.values[i], percent(a.energy[i]), percent(a.sum[i])));
    }
    return lines;
}

std::string kernel_line(const Options& o, const Analysis& a) {
    const double sum = std::accumulate(a.kernel.weights.begin(), a.kernel.weights.end(), 0.0);
    std::string line = fmt::format("kernel        {}: {} x {}, sum {:.6g}, rank {}", o.kernel, a.kernel.width,
                                   a.kernel.height, sum, a.exact);
    if (!job::is_shape_name(o.kernel)) line += fmt::format("; codes read as {}, the largest as 1", name_of(o.space));
    return line;
}

std::string rank_line(const Options& o, const Analysis& a) {
    std::string line = fmt::format("rank          {} holds 99.9 % of the energy", a.nearly);
    if (!job::is_shape_name(o.kernel))
        line += fmt::format("; {} suggested: the rank above the noise of a measured kernel", a.above_noise);
    return line;
}

/// What the two parts of the loss beside squares count, as shares of all magnitudes.
std::string artefact_line(const WeightGrid& weights, const WeightGrid& kernel) {
    double lowest = 0, negative = 0, leaked = 0, all = 0;
    for (std::size_t i = 0; i < weights.weights.size(); ++i) {
        const double w = weights.weights[i];
        lowest = std::min(lowest, w);
        all += std::abs(w);
        negative += std::max(0.0, -w);
        if (kernel.weights[i] == 0) leaked += std::abs(w);
    }
    return fmt::format(
        "artefacts     {} of the weights is negative (rings; the lowest {:.4f}), {} where the kernel is 0 (leaks)",
        percent(negative / all), lowest, percent(leaked / all));
}

std::string pass_text(const SlantedPass& pass) {
    return fmt::format("step ({:.4f}, {:.4f}), from {}: {:.4g}", pass.step.x, pass.step.y, pass.taps.first,
                       fmt::join(pass.taps.weights, " "));
}

bool follows_grid(const Step& step) { return std::abs(step.x * step.y) < 1e-6; }

/// The axes of a long kernel, and two passes along others than rows and columns where those are cheaper than as many
/// terms as come as near.
std::vector<std::string> oriented_lines(const Analysis& a, int rank) {
    const PrincipalAxes axes = principal_axes(a.kernel);
    std::vector<std::string> lines;
    if (axes.along <= 1.01 * axes.across) return lines;
    lines.push_back(
        fmt::format("axes          {:.2f} samples along {:.1f} degrees, {:.2f} across: {:.2f} times as long",
                    axes.along, axes.degrees, axes.across, axes.along / std::max(axes.across, 1e-9)));
    if (std::max(a.kernel.width, a.kernel.height) > largest_slant) return lines;
    const auto [passes, along_steps, error] = fit_slanted(a.kernel);
    if (follows_grid(passes.first.step) && follows_grid(passes.second.step)) return lines;
    const auto as_near =
        std::find_if(a.energy.begin(), a.energy.end(), [&, limit = 1 - error](double held) { return held >= limit; });
    const int terms = std::min(a.count(), 1 + static_cast<int>(as_near - a.energy.begin()));
    const auto cost = static_cast<double>(passes.first.taps.weights.size() + passes.second.taps.weights.size());
    if (cost >= multiply_adds(a, terms) || error > std::max(0.01, a.missing(rank))) return lines;
    lines.push_back(
        fmt::format("two passes    at a slant come to the error {:.3g} in {} linear reads; rows and columns need {} "
                    "terms for it, {} multiply-adds",
                    error, cost, terms, multiply_adds(a, terms)));
    lines.push_back("              " + pass_text(passes.first));
    lines.push_back("              " + pass_text(passes.second));
    lines.push_back(
        fmt::format("              along these steps 99.9 % of the energy have rank {}, along rows and columns {}",
                    along_steps, a.nearly));
    return lines;
}

// ---- Plots

Panel map_panel(const std::string& title, const WeightGrid& grid, double peak) {
    constexpr int side = 256;  // more cannot be told apart in a panel
    const int step = (std::max(grid.width, grid.height) + side - 1) / side;
    HeatMap map{(grid.width + step - 1) / step, (grid.height + step - 1) / step, {}, peak};
    for (int y = 0; y < grid.height; y += step)
        for (int x = 0; x < grid.width; x += step) map.values.push_back(grid.at(x, y));
    const std::string unit = step == 1 ? "" : fmt::format(" / {}", step);
    return {title, "column" + unit, "row" + unit, {}, {}, {}, map};
}

std::vector<Panel> panels_of(const Analysis& a, const WeightGrid& weights, int rank) {
    const int last = std::min(a.count(), std::max({rank + 2, a.nearly + 2, 8}));
    const auto series = [&](const char* label, Series::Style style, auto value) {
        Series s{label, {}, {}, style};
        for (int r = 1; r <= last; ++r) {
            s.x.push_back(r);
            s.y.push_back(value(static_cast<std::size_t>(r) - 1));
        }
        return s;
    };
    Panel values{"Singular values", "rank", "share", {}, Range{0.5, last + 0.5}, Range{0, 1.05}};
    values.series = {
        series("value / first", Series::Style::stems, [&](std::size_t i) { return a.svd.values[i] / a.svd.values[0]; }),
        series("energy", Series::Style::line, [&](std::size_t i) { return a.energy[i]; }),
        series("sum", Series::Style::line, [&](std::size_t i) { return a.sum[i]; })};
    WeightGrid difference = weights;
    for (std::size_t i = 0; i < difference.weights.size(); ++i) difference.weights[i] -= a.kernel.weights[i];
    const auto peak_of = [](const WeightGrid& g) {
        double peak = 0;
        for (const double w : g.weights) peak = std::max(peak, std::abs(w));
        return peak;
    };
    const double peak = peak_of(a.kernel);
    return {values, map_panel("Kernel", a.kernel, peak),
            map_panel(fmt::format("Sum of {} separable", rank), weights, peak),
            map_panel("Difference", difference, std::max(peak_of(difference), 1e-12 * peak))};
}

// ---- Making it

Design make(const Options& o, Console& console) {
    const Analysis a = analyse(o);
    const int wanted = o.rank.value_or(std::min(largest_rank, job::is_shape_name(o.kernel) ? a.nearly : a.above_noise));
    if (wanted > a.count())
        throw std::runtime_error(fmt::format("{}: rank {} of {} x {} samples; pass at most {}", o.kernel, wanted,
                                             a.kernel.width, a.kernel.height, a.count()));
    Terms terms = low_rank(a.svd, wanted);
    const int rank = static_cast<int>(terms.size());

    Design design;
    design.lines = {kernel_line(o, a), rank_line(o, a)};
    const auto add = [&](const std::vector<std::string>& more) {
        design.lines.insert(design.lines.end(), more.begin(), more.end());
    };
    add(value_lines(a, rank));
    double loss = separable_loss(a.kernel, expanded(terms), o.loss);
    if (o.optimise) {
        Progress progress(console, "optimise", 1);
        const SeparableFit fit =
            optimise_separable(a.kernel, terms, o.loss, [&](double done) { progress.advance_to(done); });
        design.lines.push_back(
            fmt::format("optimised     from a loss of {:.6f} in {} iterations, with non-negative {:g}, keep-zeros {:g}",
                        fit.start_loss, fit.iterations, o.loss.non_negative, o.loss.keep_zeros));
        terms = fit.terms;
        loss = fit.loss;
    }
    const WeightGrid weights = expanded(terms);
    const double error = relative_error(weights, a.kernel);
    design.lines.push_back(fmt::format("terms         {}: relative error {:.6g}, loss {:.6f}", rank, error, loss));
    design.lines.push_back(artefact_line(weights, a.kernel));
    add(oriented_lines(a, rank));
    if (a.kernel.width % 2 == 0 || a.kernel.height % 2 == 0)
        design.lines.push_back("placement     an even size has no middle sample: pictures shift by half a sample");

    design.file.kind = "separable";
    design.file.error = error;
    design.file.loss = loss;
    design.file.singular_values = a.svd.values;
    design.file.terms = terms;
    // The first pass reads along rows once for all terms; the second reads what it made of each.
    design.file.cost = a.kernel.width + static_cast<double>(rank) * a.kernel.height;
    design.file.multiply_adds = multiply_adds(a, rank);
    design.intermediates = rank;
    design.panels = panels_of(a, weights, rank);
    return design;
}

/// All shapes with what they are, a line each.
std::string shape_lines() {
    std::string lines;
    for (const ShapeInfo& info : shape_list())
        lines += fmt::format("{}{}: {}", lines.empty() ? "" : "\n", info.name, info.summary);
    return lines;
}

}  // namespace

void add_design_separable(const DesignVerb& verb) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        verb, "separable", "Any kernel as a sum of a few separable ones: columns times rows",
        "bandlimit design separable disc:50:0.8 --rank 4 --optimise --keep-zeros 0.3 --non-negative 0.5 --plot "
        "disc.png",
        [o] { check(*o); }, [o](Console& console) { return make(*o, console); });
    app.add_option("kernel", o->kernel,
                   "An image of a kernel, or a shape on SIZE x SIZE points from -1 to 1:\n" + shape_lines())
        .required()
        .type_name("KERNEL|IMAGE");
    app.add_option("--rank", o->rank,
                   "Terms; default: enough for 99.9 % of a shape's energy, or those above the noise of an image")
        .type_name("N");
    app.add_option("--non-negative", o->loss.non_negative,
                   "Penalty for negative weights, added to the squared error, e.g. 0.5; default 0")
        .type_name("W");
    app.add_option("--keep-zeros", o->loss.keep_zeros, "Penalty for weights where the kernel is 0, e.g. 0.3; default 0")
        .type_name("W");
    app.add_flag("--optimise,--optimize", o->optimise,
                 "Minimise the loss: the mean squared error plus these two penalties");
    add_space(app, o->space).description("What an image's codes mean; default: data, the codes are the weights");
}

}  // namespace bandlimit::app
