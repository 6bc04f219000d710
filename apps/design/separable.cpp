// bandlimit design separable: two-dimensional kernels as sums of few separable ones.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "apps/design/design.h"
#include "bandlimit/design/slanted.h"
#include "bandlimit/job/designs.h"
#include "bandlimit/job/weights.h"
#include "bandlimit/kernel/shapes.h"

namespace bandlimit::app {
namespace {

constexpr int largest_side = 512;   // decomposed in about three seconds
constexpr int largest_slant = 128;  // of fit_slanted()

struct Options {
    std::string kernel;
    Space space = Space::data;
    std::optional<int> rank;
    SeparableLoss loss;
    bool optimise = false;
};

void check(const Options& o) {
    int most = job::most_terms;
    if (job::is_shape_name(o.kernel)) most = std::min(most, job::shape_or_image(o.kernel, o.space, largest_side).width);
    if (o.rank && (*o.rank < 1 || *o.rank > most))
        throw UsageError(fmt::format("--rank: {}; pass 1 to {}", *o.rank, most));
    for (const auto& [option, factor] :
         {std::pair{"--non-negative", o.loss.non_negative}, {"--keep-zeros", o.loss.keep_zeros}})
        if (!(factor >= 0 && std::isfinite(factor)))
            throw UsageError(fmt::format("{}: {}; pass a number that is 0 or more", option, factor));
}

int count(const job::SeparableReport& r) { return static_cast<int>(r.svd.values.size()); }

// ---- Lines

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

std::vector<std::string> value_lines(const job::SeparableReport& r) {
    std::vector<std::string> lines{"rank  singular value    energy    sum of values"};
    const int last = std::min(count(r), std::max({r.rank(), std::min(r.nearly, 16), 4}));
    for (int n = 1; n <= last; ++n) {
        const auto i = static_cast<std::size_t>(n) - 1;
        lines.push_back(
            fmt::format("{:>4}  {:>14.6g} {:>9} {:>16}", n, r.svd.values[i], percent(r.energy[i]), percent(r.sum[i])));
    }
    return lines;
}

std::string kernel_line(const Options& o, const WeightGrid& kernel, const job::SeparableReport& r) {
    const double sum = std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
    std::string line = fmt::format("kernel        {}: {} x {}, sum {:.6g}, rank {}", o.kernel, kernel.width,
                                   kernel.height, sum, r.exact);
    if (!job::is_shape_name(o.kernel)) line += fmt::format("; codes read as {}, the largest as 1", name_of(o.space));
    return line;
}

std::string rank_line(const Options& o, const job::SeparableReport& r) {
    std::string line = fmt::format("rank          {} holds 99.9 % of the energy", r.nearly);
    if (!job::is_shape_name(o.kernel))
        line += fmt::format("; {} suggested: the rank above the noise of a measured kernel", r.above_noise);
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
std::vector<std::string> oriented_lines(const WeightGrid& kernel, const job::SeparableReport& r) {
    const PrincipalAxes axes = principal_axes(kernel);
    std::vector<std::string> lines;
    if (axes.along <= 1.01 * axes.across) return lines;
    lines.push_back(
        fmt::format("axes          {:.2f} samples along {:.1f} degrees, {:.2f} across: {:.2f} times as long",
                    axes.along, axes.degrees, axes.across, axes.along / std::max(axes.across, 1e-9)));
    if (std::max(kernel.width, kernel.height) > largest_slant) return lines;
    const auto [passes, along_steps, error] = fit_slanted(kernel);
    const double missing = std::max(0.0, 1 - r.energy[static_cast<std::size_t>(r.rank()) - 1]);
    if (follows_grid(passes.first.step) && follows_grid(passes.second.step)) return lines;
    const auto as_near =
        std::find_if(r.energy.begin(), r.energy.end(), [&, limit = 1 - error](double held) { return held >= limit; });
    const int terms = std::min(count(r), 1 + static_cast<int>(as_near - r.energy.begin()));
    const auto cost = static_cast<double>(passes.first.taps.weights.size() + passes.second.taps.weights.size());
    if (cost >= job::multiply_adds(kernel, terms) || error > std::max(0.01, missing)) return lines;
    lines.push_back(
        fmt::format("two passes    at a slant come to the error {:.3g} in {} linear reads; rows and columns need {} "
                    "terms for it, {} multiply-adds",
                    error, cost, terms, job::multiply_adds(kernel, terms)));
    lines.push_back("              " + pass_text(passes.first));
    lines.push_back("              " + pass_text(passes.second));
    lines.push_back(
        fmt::format("              along these steps 99.9 % of the energy have rank {}, along rows and columns {}",
                    along_steps, r.nearly));
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

std::vector<Panel> panels_of(const WeightGrid& kernel, const job::SeparableReport& r) {
    const int last = std::min(count(r), std::max({r.rank() + 2, r.nearly + 2, 8}));
    const auto series = [&](const char* label, Series::Style style, auto value) {
        Series s{label, {}, {}, style};
        for (int n = 1; n <= last; ++n) {
            s.x.push_back(n);
            s.y.push_back(value(static_cast<std::size_t>(n) - 1));
        }
        return s;
    };
    Panel values{"Singular values", "rank", "share", {}, Range{0.5, last + 0.5}, Range{0, 1.05}};
    values.series = {
        series("value / first", Series::Style::stems, [&](std::size_t i) { return r.svd.values[i] / r.svd.values[0]; }),
        series("energy", Series::Style::line, [&](std::size_t i) { return r.energy[i]; }),
        series("sum", Series::Style::line, [&](std::size_t i) { return r.sum[i]; })};
    WeightGrid difference = r.weights;
    for (std::size_t i = 0; i < difference.weights.size(); ++i) difference.weights[i] -= kernel.weights[i];
    const auto peak_of = [](const WeightGrid& g) {
        double peak = 0;
        for (const double w : g.weights) peak = std::max(peak, std::abs(w));
        return peak;
    };
    const double peak = peak_of(kernel);
    return {values, map_panel("Kernel", kernel, peak),
            map_panel(fmt::format("Sum of {} separable", r.rank()), r.weights, peak),
            map_panel("Difference", difference, std::max(peak_of(difference), 1e-12 * peak))};
}

// ---- Making it

Design make(const Options& o, Console& console) {
    job::SeparableJob job{.kernel = job::shape_or_image(o.kernel, o.space, largest_side),
                          .name = o.kernel,
                          .is_measured = !job::is_shape_name(o.kernel),
                          .rank = o.rank,
                          .loss = o.loss,
                          .optimise = o.optimise};
    const job::SeparableReport report = job::design_separable(job, context_of(console, {}));
    const WeightGrid& kernel = job.kernel;
    Design design;
    design.file = report.file;
    design.lines = {kernel_line(o, kernel, report), rank_line(o, report)};
    const auto add = [&](const std::vector<std::string>& more) {
        design.lines.insert(design.lines.end(), more.begin(), more.end());
    };
    add(value_lines(report));
    if (report.optimised)
        design.lines.push_back(fmt::format(
            "optimised     from a loss of {:.6f} in {} iterations, with non-negative {:g}, keep-zeros {:g}",
            report.optimised->start_loss, report.optimised->iterations, o.loss.non_negative, o.loss.keep_zeros));
    design.lines.push_back(
        fmt::format("terms         {}: relative error {:.6g}, loss {:.6f}", report.rank(), report.error, report.loss));
    design.lines.push_back(artefact_line(report.weights, kernel));
    add(oriented_lines(kernel, report));
    if (kernel.width % 2 == 0 || kernel.height % 2 == 0)
        design.lines.push_back("placement     an even size has no middle sample: pictures shift by half a sample");
    design.intermediates = report.rank();
    design.panels = panels_of(kernel, report);
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
