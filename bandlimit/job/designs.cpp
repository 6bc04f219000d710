#include "bandlimit/job/designs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bandlimit/analysis/response.h"
#include "bandlimit/design/fold.h"
#include "bandlimit/design/noise_rank.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/shaders.h"

namespace bandlimit::job {
namespace {

constexpr double nearly_all = 0.999;

/// What a filter costs that reads and multiplies so often per output.
TapsFile with_cost(TapsFile file, double reads) {
    file.cost = reads;
    file.multiply_adds = reads;
    return file;
}

}  // namespace

TapsFile taps_file(const DerivativeDesign& d) {
    return with_cost({.kind = "derivative", .error = d.error, .taps = d.taps},
                     static_cast<double>(fold(d.taps).size()));
}

TapsFile taps_file(const GaussianDesign& d) {
    TapsFile file{.kind = "gaussian", .error = d.error, .taps = d.taps};
    for (const LinearRead& read : d.reads) file.fetches.push_back({read.offset, 0, read.weight});
    return with_cost(std::move(file), 2.0 * static_cast<double>(d.reads.size()));
}

TapsFile taps_file(const SharpenDesign& d) {
    return with_cost({.kind = "sharpen", .error = d.error, .taps = d.taps},
                     2.0 * static_cast<double>(fold(d.taps).size()));
}

TapsFile taps_file(const KernelFit& fit) {
    // Of an output at a phase of its own: all weights under the kernel, along both axes in turn.
    const double radius = piecewise_kernel(fit.pieces, "kernel").radius;
    return with_cost({.kind = "kernel", .error = fit.error, .pieces = fit.pieces, .loss = fit.loss},
                     2 * std::ceil(2 * radius));
}

// ---- Discs

void check(const DiskJob& job) {
    if (job.components < 1 || job.components > most_disk_components)
        throw OptionError("components",
                          fmt::format("{} phasors; choose 1 to {}", job.components, most_disk_components));
    if (job.is_published && job.components > 2)
        throw OptionError("components", fmt::format("the published sets have 1 and 2 phasors, not {}; choose one of "
                                                    "them, or the preset fit",
                                                    job.components));
    if (job.reach >= 0 && job.radius == 0)
        throw OptionError("reach", "how far weights extend depends on a radius; add --radius PX");
}

DiskReport design_disk(const DiskJob& job) {
    check(job);
    DiskReport report;
    double reach = -1;  // in radii; below 0: to be found
    if (job.is_published) {
        const PublishedDisk published = published_disk(job.components);
        report.components = fitted_to_disk(published.components, published.radius);
        report.published_radius = published.radius;
        report.published_scale = report.components[0].A / published.components[0].A;
        reach = published.reach / published.radius;
    } else {
        report.components = fit_disk(job.components);
    }
    report.radius = job.radius > 0 ? job.radius : usual_disk_radius;
    report.reach = job.reach >= 0 ? job.reach
                   : reach >= 0   ? static_cast<int>(std::lround(reach * report.radius))
                                  : reach_for(report.components, report.radius);
    TapsFile& file = report.file;
    file.kind = "disk";
    file.components = report.components;
    file.error = disk_error(report.components);
    file.radius = job.radius > 0 ? job.radius : 1;  // without weights it is the unit of components
    // The first pass reads the picture and writes two for each component, of which the second reads all.
    const double taps = 2.0 * report.reach + 1, between = 2.0 * static_cast<double>(report.components.size());
    file.cost = taps * (1 + between);
    file.multiply_adds = taps * 2 * between;
    if (job.radius > 0) file.terms = separable_terms(report.components, report.radius, report.reach);
    return report;
}

// ---- Filters that shrink by a whole factor, or double

namespace {

TapsFile rate_file(const RateGoal& goal, double error, double reads) {
    return with_cost(
        {.kind = goal.upsample ? "upsample" : "downsample", .factor = goal.upsample ? 1 : goal.factor, .error = error},
        reads);
}

DownsampleReport report_of(const Fetches& fetches, const RateGoal& goal) {
    DownsampleReport report{.whole = whole_filter(fetches, goal), .file = {}};
    report.file = rate_file(goal, band_error(report.whole, goal.factor).whole, static_cast<double>(fetches.size()));
    report.file.fetches = fetches;
    return report;
}

}  // namespace

DownsampleJob DownsampleJob::completed() const {
    DownsampleJob job = *this;
    if (fetches != 0 || where.taps != 0) return job;
    if (where.layout == FetchLayout::square) job.fetches = goal.upsample ? 4 : 16;
    else if (goal.upsample) job.fetches = 4;
    else job.fetches = goal.factor % 2 == 0 ? 8 : 9;
    return job;
}

void check(const DownsampleJob& given, const char* function) {
    const DownsampleJob job = given.completed();
    if (job.is_one_dimensional()) return check_taps(function, job.where.taps, job.goal);
    if (job.is_folded() && job.where.layout != FetchLayout::free)
        throw OptionError("layout", "folded weights have a layout of their own; leave it out, or give --fetches too");
    check_fetches(function, job.is_folded() ? 1 : job.fetches, job.goal, job.where);
}

DownsampleReport design_downsample(const DownsampleJob& given) {
    const DownsampleJob job = given.completed();
    check(job, "design_downsample");
    if (job.is_one_dimensional()) {
        const Taps taps = downsample_taps(job.where.taps, job.goal);
        const PlacedWeights whole = whole_filter(taps, job.goal);
        DownsampleReport report{.whole = PlacedWeights2D(whole, whole), .file = {}};
        report.file = rate_file(job.goal, band_error(report.whole, job.goal.factor).whole, job.where.taps);
        report.file.taps = taps;
        return report;
    }
    if (job.is_folded())
        return report_of(downsample_folded(job.where.taps, job.where.threshold, job.goal).fetches, job.goal);
    // The curve goes on to where more fetches gain little.
    const int most = std::max(job.fetches, job.goal.upsample ? 9 : 20);
    std::vector<FetchDesign> curve = downsample_curve(most, job.goal, job.where);
    const auto more = std::find_if(curve.begin(), curve.end(), [&](const FetchDesign& d) {
        return static_cast<int>(d.fetches.size()) > job.fetches;
    });
    if (more == curve.begin())
        throw std::runtime_error(fmt::format("design downsample: no filter of {} fetches; pass more", job.fetches));
    DownsampleReport report = report_of(std::prev(more)->fetches, job.goal);
    report.curve = std::move(curve);
    return report;
}

// ---- Sums of products

namespace {

/// Sum of squared differences over the sum of squares.
double relative_error(const WeightGrid& weights, const WeightGrid& kernel) {
    double missing = 0, all = 0;
    for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
        missing += std::pow(weights.weights[i] - kernel.weights[i], 2);
        all += kernel.weights[i] * kernel.weights[i];
    }
    return missing / all;
}

}  // namespace

double multiply_adds(const WeightGrid& kernel, int rank) {
    return static_cast<double>(rank) * (kernel.width + kernel.height);
}

SeparableReport design_separable(const SeparableJob& job, const Context& context) {
    const WeightGrid& kernel = job.kernel;
    if (std::all_of(kernel.weights.begin(), kernel.weights.end(), [](double w) { return w == 0; }))
        throw std::runtime_error(job.name + ": all samples are 0; a kernel needs at least one that is not");
    SeparableReport report;
    report.svd = svd_of(kernel);
    const std::vector<double>& values = report.svd.values;
    report.energy = cumulative_energy(values), report.sum = cumulative_sum(values);
    report.exact = numerical_rank(values, kernel.height, kernel.width);
    report.nearly = rank_for_energy(values, nearly_all);
    report.above_noise = rank_above_noise(values, kernel.height, kernel.width);
    const int wanted = job.rank.value_or(std::min(most_terms, job.is_measured ? report.above_noise : report.nearly));
    if (wanted > static_cast<int>(values.size()))
        throw std::runtime_error(fmt::format("{}: rank {} of {} x {} samples; pass at most {}", job.name, wanted,
                                             kernel.width, kernel.height, values.size()));
    Terms terms = low_rank(report.svd, wanted);
    report.loss = separable_loss(kernel, expanded(terms), job.loss);
    if (job.optimise) {
        report.optimised = optimise_separable(kernel, terms, job.loss, [&](double done) {
            context.report({"optimise", done, 1});
        });
        terms = report.optimised->terms, report.loss = report.optimised->loss;
    }
    report.weights = expanded(terms);
    report.error = relative_error(report.weights, kernel);
    const int rank = static_cast<int>(terms.size());
    report.file = {.kind = "separable", .error = report.error};
    report.file.loss = report.loss;
    report.file.singular_values = values;
    report.file.terms = std::move(terms);
    // The first pass reads along rows once for all terms; the second reads what it made of each.
    report.file.cost = kernel.width + static_cast<double>(rank) * kernel.height;
    report.file.multiply_adds = multiply_adds(kernel, rank);
    return report;
}

}  // namespace bandlimit::job
