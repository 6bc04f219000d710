// bandlimit design downsample: filters that shrink by a whole factor, or double, as taps or as bilinear reads.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/design/design.h"
#include "bandlimit/design/fold.h"
#include "bandlimit/job/designs.h"

namespace bandlimit::app {
namespace {

struct Options {
    job::DownsampleJob job;
    bool curve = false;
};

constexpr const char* verb = "design downsample";

FetchLayout parse_layout(const std::string& text) {
    if (text == "free") return FetchLayout::free;
    if (text == "cross") return FetchLayout::cross;
    if (text == "square") return FetchLayout::square;
    throw UsageError("--layout: \"" + text + "\" is unknown; choose free, cross or square");
}

void set_weighting(RateGoal& goal, const std::string& text) {
    const std::vector<double> weights = parse_numbers("--weighting", text);
    if (weights.size() != 2)
        throw UsageError("--weighting: \"" + text +
                         "\" is not two numbers; pass those of pass band and stop band, e.g. 1,4");
    goal.pass_weight = weights[0], goal.stop_weight = weights[1];
}

void check(const Options& o) {
    const job::DownsampleJob job = o.job.completed();
    if (o.curve && (job.is_one_dimensional() || job.is_folded()))
        throw UsageError("--curve: lists numbers of fetches; give the largest with --fetches");
    job::check(job, verb);
}

// ---- Describing
// ------------------------------------------------------------------------------------------------------

/// H along x and along the diagonal.
struct Responses {
    std::function<double(double)> axis, diagonal;
};

Responses responses_of(const PlacedWeights2D& weights) {
    return {[weights](double f) { return response(weights, f, 0).real(); },
            [weights](double f) { return response(weights, f, f).real(); }};
}

std::string title_of(const RateGoal& goal, const std::string& what) {
    std::string title = goal.upsample ? "upsample by 2: " : fmt::format("downsample by {}: ", goal.factor);
    title += what;
    if (goal.pass_weight != goal.stop_weight)
        title += fmt::format(", bands weighted {:g} to {:g}", goal.pass_weight, goal.stop_weight);
    if (goal.max_gain) title += fmt::format(", gain at most {:g}", *goal.max_gain);
    if (goal.non_negative) title += ", no negative weights";
    return title;
}

/// Error and response, for people.
void describe(Design& design, const RateGoal& goal, const PlacedWeights2D& whole) {
    const BandError error = band_error(whole, goal.factor);
    design.lines.push_back(
        fmt::format("error         {:.6f}, the mean of |H - ideal|^2 over the band; pass band {:.5f}, stop band {:.5f}",
                    error.whole, error.pass, error.stop));
    design.lines.push_back(fmt::format("largest gain  {:.5f}", max_gain(whole)));
    const Responses h = responses_of(whole);
    const auto cell = [](double v) { return fmt::format("{:>8.4f}", std::abs(v) < 5e-5 ? 0.0 : v); };
    std::string f = "f            ", axis = "H on an axis ", diagonal = "H at (f, f)  ";
    for (int i = 0; i <= 8; ++i) {
        f += fmt::format("{:>8.4f}", i / 16.0);
        axis += cell(h.axis(i / 16.0));
        diagonal += cell(h.diagonal(i / 16.0));
    }
    f += goal.upsample ? "  cycles per sample of the larger picture" : "  cycles per sample";
    design.lines.insert(design.lines.end(), {f, axis, diagonal});
}

Panel response_panel(const RateGoal& goal, const PlacedWeights2D& whole) {
    const Responses h = responses_of(whole);
    const double edge = 0.5 / goal.factor;
    Panel panel{
        "response",
        goal.upsample ? "frequency (cycles per sample of the larger picture)" : "frequency (cycles per source sample)",
        "H",
        {}};
    panel.series = {curve("axis (f, 0)", 0, 0.5, 200, h.axis),
                    curve("diagonal (f, f)", 0, 0.5, 200, h.diagonal),
                    {"ideal", {0, edge, edge, 0.5}, {1, 1, 0, 0}}};
    return panel;
}

/// What more of them would gain: errors by number, and the one that was chosen.
Panel trade_panel(const std::string& unit, Series all, double chosen, double error) {
    all.style = Series::Style::line;
    Panel panel{"trade-off", unit, "mean of |H - ideal|^2", {}};
    Series marks = all;
    marks.label = "", marks.style = Series::Style::points;
    panel.series = {all, marks, {"this design", {chosen}, {error}, Series::Style::points}};
    panel.y_range = Range{0, 1.1 * *std::max_element(all.y.begin(), all.y.end())};
    return panel;
}

Series errors_of(const std::vector<FetchDesign>& designs) {
    Series series{"least error", {}, {}};
    for (const FetchDesign& d : designs) {
        series.x.push_back(static_cast<double>(d.fetches.size()));
        series.y.push_back(d.error);
    }
    return series;
}

// ---- Making
// ----------------------------------------------------------------------------------------------------------

Design design_of(const job::DownsampleReport& report, const RateGoal& goal, const std::string& what) {
    Design design;
    design.file = report.file;
    design.enlarges = goal.upsample ? 2 : 1;
    design.lines = {title_of(goal, what)};
    describe(design, goal, report.whole);
    return design;
}

constexpr const char* mirrored_line =
    "outputs       for the output 1/4 texel right of and below a texel's centre; mirror it for the other three";

Design make_taps(const job::DownsampleJob& job) {
    const job::DownsampleReport report = job::design_downsample(job);
    const RateGoal& goal = job.goal;
    const Taps& taps = *report.file.taps;
    const PlacedWeights whole = whole_filter(taps, goal);
    Design design = design_of(report, goal, fmt::format("{} taps along one axis, then the other", job.where.taps));
    design.intermediates = 1;
    design.lines.push_back(fmt::format("on one axis   error {:.6f}", band_error(whole, goal.factor).whole));
    if (goal.upsample) design.lines.push_back(mirrored_line);
    else design.lines.push_back(fmt::format("as fetches    {} linear reads per axis", fold(taps).size()));
    design.table = {"", fmt::format("{:>6} {:>10}", "sample", "weight")};
    for (std::size_t j = 0; j < taps.weights.size(); ++j)
        design.table.push_back(fmt::format("{:>6} {:>10.6f}", taps.first + static_cast<int>(j), taps.weights[j]));
    Series errors{"least error", {}, {}};
    const int step = goal.upsample ? 1 : 2, most = std::max(16, job.where.taps);
    for (int count = goal.upsample ? 1 : 2 + goal.factor % 2; count <= most; count += step) {
        const PlacedWeights other = whole_filter(downsample_taps(count, goal), goal);
        errors.x.push_back(count);
        errors.y.push_back(band_error(PlacedWeights2D(other, other), goal.factor).whole);
    }
    design.panels = {Panel{"taps", "distance (samples)", "weight", {stems("", whole.first, whole.weights)}},
                     response_panel(goal, report.whole),
                     trade_panel("taps per axis", errors, job.where.taps, *report.file.error)};
    return design;
}

/// Where fetches read: marks along x and y, by the sign of their weight.
Panel layout_panel(const Fetches& fetches) {
    Series added{"weight > 0", {}, {}, Series::Style::points}, taken{"weight < 0", {}, {}, Series::Style::points};
    for (const Fetch& f : fetches) {
        Series& series = f.weight > 0 ? added : taken;
        series.x.push_back(f.x);
        series.y.push_back(f.y);
    }
    Panel panel{"fetches", "x (texels from the output)", "y (texels from the output)", {added}};
    if (!taken.x.empty()) panel.series.push_back(taken);
    return panel;
}

Design make_of_fetches(const job::DownsampleReport& report, const RateGoal& goal, const std::string& what) {
    const Fetches& fetches = report.file.fetches;
    Design design = design_of(report, goal, what);
    if (goal.upsample) design.lines.push_back(mirrored_line);
    design.table = {"", fmt::format("{:>10} {:>10} {:>11}", "x", "y", "weight")};
    for (const Fetch& f : fetches)
        design.table.push_back(fmt::format("{:>10.6f} {:>10.6f} {:>11.8f}", f.x, f.y, f.weight));
    design.panels = {layout_panel(fetches), response_panel(goal, report.whole)};
    if (!report.curve.empty())
        design.panels.push_back(
            trade_panel("fetches", errors_of(report.curve), static_cast<double>(fetches.size()), *report.file.error));
    return design;
}

Design make_folded(const job::DownsampleJob& job) {
    const job::DownsampleReport report = job::design_downsample(job);
    const SparseWeights weights = downsample_weights(job.where.taps, job.where.threshold, job.goal);
    const auto kept = std::count_if(weights.optimized.weights.begin(), weights.optimized.weights.end(),
                                    [](double w) { return w != 0; });
    Design design = make_of_fetches(report, job.goal,
                                    fmt::format("{} fetches for {} of {} x {} weights", report.file.fetches.size(),
                                                kept, job.where.taps, job.where.taps));
    const auto error = [&](const PlacedWeights2D& w) { return band_error(w, job.goal.factor).whole; };
    design.lines.push_back(fmt::format(
        "weights       all {:.6f}; those of {:g} and more {:.6f}; optimised {:.6f}; as fetches {:.6f}",
        error(weights.all), job.where.threshold, error(weights.dropped), error(weights.optimized), *report.file.error));
    return design;
}

/// Errors of all numbers of fetches, a line each.
std::vector<std::string> curve_table(const std::vector<FetchDesign>& curve, const RateGoal& goal) {
    std::vector<std::string> table{
        "", fmt::format("{:>8} {:>10} {:>10} {:>10} {:>8}", "fetches", "error", "pass", "stop", "gain")};
    for (const FetchDesign& d : curve) {
        const PlacedWeights2D whole = whole_filter(d.fetches, goal);
        const BandError e = band_error(whole, goal.factor);
        table.push_back(fmt::format("{:>8} {:>10.6f} {:>10.6f} {:>10.6f} {:>8.4f}", d.fetches.size(), e.whole, e.pass,
                                    e.stop, max_gain(whole)));
    }
    return table;
}

Design make_fetches(const job::DownsampleJob& job, bool curve) {
    const job::DownsampleReport report = job::design_downsample(job);
    const int count = static_cast<int>(report.file.fetches.size());
    std::string what = fmt::format("{} bilinear fetches", count);
    if (count != job.fetches) what += fmt::format(", as good as {}", job.fetches);
    Design design = make_of_fetches(report, job.goal, what);
    if (curve) design.table = curve_table(report.curve, job.goal);
    return design;
}

Design make(const Options& o) {
    const job::DownsampleJob job = o.job.completed();
    if (job.is_one_dimensional()) return make_taps(job);
    return job.is_folded() ? make_folded(job) : make_fetches(job, o.curve);
}

}  // namespace

void add_design_downsample(const DesignVerb& design) {
    auto o = std::make_shared<Options>();
    Verb app = add_design_kind(
        design, "downsample", "Shrink by a whole factor, or double, with as little aliasing as possible",
        "bandlimit design downsample --fetches 12 --max-gain 1.05 --plot downsample.svg -o downsample.json",
        [o] { check(*o); }, [o](Console&) { return make(*o); });
    app.add_option("--factor", o->job.goal.factor, "How many samples become one, 2 to 16; default 2").type_name("N");
    app.add_flag("--upsample", o->job.goal.upsample, "Double instead: the filter of one of the four outputs per texel");
    app.add_option("--taps", o->job.where.taps,
                   "Alone: this many taps along each axis. With --fetches or --threshold: read within so many\n"
                   "texels a side")
        .in_range(1, 256)
        .type_name("N");
    app.add_option("--fetches", o->job.fetches,
                   "This many bilinear reads, positions and weights optimised together; default 8 (9 for odd\n"
                   "factors, 4 to double, 16 in a square)")
        .in_range(1, 64)
        .type_name("N");
    app.add_option("--threshold", o->job.where.threshold,
                   "With --taps N: drop those of the N x N best weights that are below it, optimise the others, and\n"
                   "fold them into fetches")
        .in_range(0.0, 1.0)
        .type_name("T");
    app.add_option_function<std::string>(
           "--layout", [o](const std::string& s) { o->job.where.layout = parse_layout(s); },
           "Where fetches may be: free (default), cross (around the output and along the axes) or square (rows and\n"
           "columns)")
        .type_name("free|cross|square");
    app.add_option_function<std::string>(
           "--weighting", [o](const std::string& s) { set_weighting(o->job.goal, s); },
           "How squared errors in the pass band and in the stop band count; default 1,1")
        .type_name("PASS,STOP");
    app.add_option("--max-gain", o->job.goal.max_gain, "Largest gain allowed at any frequency, e.g. 1.05")
        .type_name("G");
    app.add_flag("--non-negative", o->job.goal.non_negative, "No weights below 0");
    app.add_flag("--curve", o->curve, "Print the error for each number of fetches instead of the fetches");
}

}  // namespace bandlimit::app
