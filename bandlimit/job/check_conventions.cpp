#include "bandlimit/job/check_conventions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "bandlimit/antialias/history_weights.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/bank.h"

namespace bandlimit::job {
namespace {

using Units = MotionConvention::Units;
using JitterSign = MotionConvention::JitterSign;
using Verdict = ConventionReport::Verdict;

constexpr int most_frames = 6, most_sites = 32768, parts_x = 16, parts_y = 9;
constexpr double most_excess = 3;        // standard errors by which a reading that is likely may be worse
constexpr double close_excess = 1;       // and one that is as good as the best
constexpr int least_parts = 4;           // to tell anything by
constexpr double error_of_depth = 0.2;   // where the frame before has another depth; a colour's is 0.02 to 0.1
constexpr float depth_tolerance = 0.1f;  // relative: other depths are of something else
constexpr double least_motion = 0.05;    // pixels; less is rounding
constexpr double most_unsteady = 0.02;   // pixels, of motion that may as well be steady

Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }

/// The lightness (R + 2 G + B) / 4 of colours v / (1 + v), so that a highlight weighs no more than anything else, and 0
/// for what is not finite; smoothed by 1/4 1/2 1/4 along x and y, since what aliases is not found again.
Image<float> prepared(View<const float> color) {
    const auto compressed = [](float v) { return std::isfinite(v) && v > 0 ? v / (1 + v) : 0; };
    Image<float> picture(color.width, color.height), rows(color.width, color.height);
    for (int y = 0; y < color.height; ++y)
        for (int x = 0; x < color.width; ++x)
            picture.view()(x, y) =
                (compressed(color(x, y, 0)) + 2 * compressed(color(x, y, 1)) + compressed(color(x, y, 2))) / 4;
    const Taps taps{-1, {0.25, 0.5, 0.25}};
    apply(make_bank(taps, color.width, Edge::clamp), picture.view(), rows.view());
    apply(make_bank(taps, color.height, Edge::clamp), transposed(View<const float>(rows.view())),
          transposed(picture.view()));
    return picture;
}

/// The weights of samples -1, 0, 1 and 2 at t in [0, 1) from sample 0.
std::array<float, 4> bspline_weights(float t) {
    const CubicPart& powers = history_weights(HistoryKernel::bspline).front();
    std::array<float, 4> weights{};
    for (std::size_t i = 0; i < 4; ++i)
        weights[i] = powers[0][i] + t * (powers[1][i] + t * (powers[2][i] + t * powers[3][i]));
    return weights;
}

/// What `picture` shows at (x, y), where samples are at whole numbers, through a B-spline: it smooths as much between
/// samples as at them, so that no way is at an advantage.
float shown_at(View<const float> picture, float x, float y) {
    x = std::clamp(x, 0.0f, static_cast<float>(picture.width - 1));
    y = std::clamp(y, 0.0f, static_cast<float>(picture.height - 1));
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const std::array<float, 4> weights_x = bspline_weights(x - static_cast<float>(left));
    const std::array<float, 4> weights_y = bspline_weights(y - static_cast<float>(top));
    std::ptrdiff_t columns[4];
    for (int i = 0; i < 4; ++i) columns[i] = picture.dx * std::clamp(left + i - 1, 0, picture.width - 1);
    float sum = 0;
    for (int j = 0; j < 4; ++j) {
        const float* const row = &picture(0, std::clamp(top + j - 1, 0, picture.height - 1));
        const float across = weights_x[0] * row[columns[0]] + weights_x[1] * row[columns[1]] +
                             weights_x[2] * row[columns[2]] + weights_x[3] * row[columns[3]];
        sum += weights_y[static_cast<std::size_t>(j)] * across;
    }
    return sum;
}

/// A pixel that is looked for in the frame before.
struct Site {
    int x = 0, y = 0, part = 0;
    float shown = 0, depth = 0;
    Point stored;
};

/// A frame and the one before it.
struct Pair {
    View<const float> previous, previous_depth;  ///< prepared() colour; an empty view where there is no depth
    std::vector<Site> sites;
    Point jitter_step;  ///< stored jitter of the frame minus that of the one before
};

std::vector<Site> sites_of(const SequenceFrame& frame, View<const float> color) {
    const int width = color.width, height = color.height;
    const int step = static_cast<int>(std::ceil(std::sqrt(double(width) * height / most_sites)));
    const bool has_depth = frame.depth.width() > 0;
    std::vector<Site> sites;
    for (int y = step / 2; y < height; y += step)
        for (int x = step / 2; x < width; x += step) {
            Site site{x, y, y * parts_y / height * parts_x + x * parts_x / width, 0, 0, {}};
            site.stored = {double(frame.motion.view()(x, y, 0)), double(frame.motion.view()(x, y, 1))};
            if (has_depth) site.depth = frame.depth.view()(x, y);
            if (is_sky(site.depth) || !std::isfinite(site.stored.x + site.stored.y)) continue;
            site.shown = shown_at(color, static_cast<float>(x), static_cast<float>(y));
            sites.push_back(site);
        }
    return sites;
}

bool is_of_other_depth(const Pair& pair, const Site& site, float x, float y) {
    const View<const float>& depth = pair.previous_depth;
    if (depth.width == 0) return false;
    const int u = std::clamp(static_cast<int>(std::lround(x)), 0, depth.width - 1);
    const int v = std::clamp(static_cast<int>(std::lround(y)), 0, depth.height - 1);
    return !(std::abs(depth(u, v) - site.depth) <= depth_tolerance * site.depth);
}

/// How far a site is from what the frame before shows where it is moved by (dx, dy).
double error_of(const Pair& pair, const Site& site, Point moved) {
    const float x = static_cast<float>(site.x + moved.x), y = static_cast<float>(site.y + moved.y);
    if (is_of_other_depth(pair, site, x, y)) return error_of_depth;
    return std::abs(double(shown_at(pair.previous, x, y)) - double(site.shown));
}

std::vector<MotionConvention> motion_readings() {
    std::vector<MotionConvention> all;
    for (const Units units : {Units::pixels, Units::uv, Units::ndc})
        for (int bits = 0; bits < 8; ++bits)
            all.push_back({.units = units,
                           .is_previous_minus_current = (bits & 1) == 0,
                           .is_y_up = (bits & 2) != 0,
                           .are_axes_swapped = (bits & 4) != 0});
    return all;
}

/// All readings; where there is no jitter, that of the jitter stays the current one.
std::vector<MotionConvention> readings(const MotionConvention& current, bool has_jitter) {
    std::vector<MotionConvention> all;
    for (MotionConvention c : motion_readings()) {
        const auto add = [&](JitterSign sign, bool is_up, bool includes) {
            c.jitter_sign = sign, c.is_jitter_y_up = is_up, c.includes_jitter = includes;
            all.push_back(c);
        };
        add(has_jitter ? JitterSign::none : current.jitter_sign, current.is_jitter_y_up, current.includes_jitter);
        if (!has_jitter) continue;
        if (current.jitter_sign != JitterSign::none) all.back().includes_jitter = false;  // of what is not there
        for (const bool includes : {false, true})
            for (const JitterSign sign : {JitterSign::plus, JitterSign::minus})
                for (const bool is_up : {false, true}) add(sign, is_up, includes);
    }
    return all;
}

/// One way to get from pixels to those of the frame before.
struct Way {
    MotionConvention convention;    ///< the simplest reading that goes it
    bool is_still = false;          ///< all vectors count as 0
    std::vector<double> sums = {};  ///< of the errors in each part of each pair

    double error_over(double sites) const { return std::accumulate(sums.begin(), sums.end(), 0.0) / sites; }
};

/// The simplest reading that leads to the same pixels: where vectors include the jitter, they alone lead there.
MotionConvention simplest(MotionConvention c) {
    if (c.includes_jitter || c.jitter_sign == JitterSign::none)
        c.includes_jitter = false, c.jitter_sign = JitterSign::none, c.is_jitter_y_up = false;
    return c;
}

/// The ways of all readings, each once, and those of standing still.
std::vector<Way> ways_of(const std::vector<MotionConvention>& readings) {
    std::vector<Way> ways;
    for (const MotionConvention& reading : readings) {
        const MotionConvention c = simplest(reading);
        if (std::ranges::find(ways, c, &Way::convention) == ways.end()) ways.push_back({c});
    }
    for (std::size_t i = 0, count = ways.size(); i < count; ++i)
        if (ways[i].convention == MotionConvention{.jitter_sign = ways[i].convention.jitter_sign,
                                                   .is_jitter_y_up = ways[i].convention.is_jitter_y_up})
            ways.push_back({ways[i].convention, true});
    return ways;
}

/// By how many standard errors the errors of `way` are larger than those of `other`, over the parts where they differ.
double excess(const Way& way, const Way& other) {
    double n = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < way.sums.size(); ++i) {
        const double d = way.sums[i] - other.sums[i];
        n += d != 0, sum += d, squares += d * d;
    }
    if (n < least_parts) return 0;
    const double mean = sum / n;
    return mean / std::sqrt(std::max(squares / n - mean * mean, 1e-30) / (n - 1));
}

/// What all frames together show.
struct Comparison {
    std::vector<Way> ways;
    int width = 0, height = 0, pairs = 0;
    double sites = 0;
    double largest_motion = 0;               ///< pixels, in the units that make the most of it
    std::vector<Point> turns, jitter_turns;  ///< by how much the middle stored vector changes, and the jitter's step
};

void add_errors(std::vector<Way>& ways, const Pair& pair, const Context& context) {
    const int width = pair.previous.width, height = pair.previous.height;
    parallel_for(std::ssize(ways), 1, context.parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t w = begin; w < end; ++w) {
            Way& way = ways[static_cast<std::size_t>(w)];
            const Point jitter = way.convention.jitter_of(pair.jitter_step);
            std::vector<double> sums(static_cast<std::size_t>(parts_x * parts_y));
            for (const Site& site : pair.sites) {
                const Point motion = way.is_still ? Point{} : way.convention.motion_of(site.stored, width, height);
                sums[static_cast<std::size_t>(site.part)] += error_of(pair, site, motion + jitter);
            }
            way.sums.insert(way.sums.end(), sums.begin(), sums.end());
        }
    });
}

double middle_of(std::vector<double>& values) {
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// By how much the stored vector of the middle pixel changes between two frames.
Point turn_between(View<const float> before, const std::vector<Site>& sites) {
    std::vector<double> x, y;
    for (const Site& site : sites) {
        const Point d = site.stored - Point{double(before(site.x, site.y, 0)), double(before(site.x, site.y, 1))};
        if (std::isfinite(d.x + d.y)) x.push_back(d.x), y.push_back(d.y);
    }
    return x.empty() ? Point{} : Point{middle_of(x), middle_of(y)};
}

Comparison compared(const StoredFrames& frames, const std::vector<MotionConvention>& all, const Context& context) {
    Comparison result;
    result.ways = ways_of(all);
    const int count = std::min(frames.count, most_frames), first = (frames.count - count) / 2;
    SequenceFrame before = frames.read(first);
    if (before.motion.width() == 0) throw std::runtime_error("the frames have no motion; pass vectors to check");
    result.width = before.color.width(), result.height = before.color.height();
    Image<float> color_before = prepared(before.color.view());
    Point step_before;
    for (int i = 1; i < count; ++i) {
        SequenceFrame frame = frames.read(first + i);
        Image<float> color = prepared(frame.color.view());
        const Pair pair{color_before.view(), before.depth.view(), sites_of(frame, color.view()),
                        frame.jitter - before.jitter};
        for (const Site& site : pair.sites)
            result.largest_motion = std::max({result.largest_motion, std::abs(site.stored.x) * color.width(),
                                              std::abs(site.stored.y) * color.height()});
        add_errors(result.ways, pair, context);
        if (i > 1) {
            result.turns.push_back(turn_between(before.motion.view(), pair.sites));
            result.jitter_turns.push_back(pair.jitter_step - step_before);
        }
        result.sites += double(pair.sites.size()), ++result.pairs;
        step_before = pair.jitter_step;
        before = std::move(frame), color_before = std::move(color);
        context.report({"comparing", double(i), double(count - 1), "frames"});
    }
    return result;
}

/// The mean change of the middle vector between frames, in pixels, without the jitter that the reading takes away.
double unsteadiness(const Comparison& c, const MotionConvention& reading) {
    double sum = 0;
    for (std::size_t i = 0; i < c.turns.size(); ++i) {
        Point turn = reading.motion_of(c.turns[i], c.width, c.height);
        if (reading.includes_jitter) turn = turn - reading.jitter_of(c.jitter_turns[i]);
        sum += std::hypot(turn.x, turn.y);
    }
    return c.turns.empty() ? 0 : sum / double(c.turns.size());
}

/// Lowest error first; of the same ones the steadiest.
bool is_nearer(const ConventionCandidate& a, const ConventionCandidate& b) {
    return a.error != b.error ? a.error < b.error : a.unsteadiness < b.unsteadiness;
}

/// Marks the candidates that the pictures leave open.
void mark_likely(std::vector<ConventionCandidate>& candidates, const Comparison& comparison, const Way& best) {
    const auto way_of = [&](const ConventionCandidate& c) -> const Way& {
        return *std::ranges::find(comparison.ways, simplest(c.convention), &Way::convention);
    };
    for (ConventionCandidate& c : candidates) {
        double steadiest = c.unsteadiness;
        for (const ConventionCandidate& other : candidates)
            if (simplest(other.convention) == simplest(c.convention))
                steadiest = std::min(steadiest, other.unsteadiness);
        c.excess = excess(way_of(c), best);
        c.is_likely = c.excess <= most_excess && c.unsteadiness <= 1.5 * steadiest + most_unsteady;
    }
}

/// The current reading, if it is likely; else of those that are about as near to the pictures as the nearest the one that
/// needs the fewest flags.
const ConventionCandidate& best_of(const std::vector<ConventionCandidate>& candidates,
                                   const ConventionCandidate& current) {
    const ConventionCandidate* best = &current;
    if (current.is_likely) return *best;
    const auto flags = [&](const ConventionCandidate& c) {
        return flags_between(current.convention, c.convention).size();
    };
    for (const ConventionCandidate& c : candidates)
        if (c.is_likely && c.excess <= close_excess && (best == &current || flags(c) < flags(*best))) best = &c;
    return *best;
}

/// The options by which single changes of the best reading are as likely.
std::vector<std::string> open_options(const ConventionReport& report) {
    std::vector<std::string> open;
    for (const ConventionCandidate& c : report.candidates) {
        const std::vector<std::string> flags = flags_between(report.best.convention, c.convention);
        if (!c.is_likely || flags.size() != 1) continue;
        const std::string option = flags[0].substr(0, flags[0].find(' '));
        if (std::ranges::find(open, option) == open.end()) open.push_back(option);
    }
    return open;
}

}  // namespace

ConventionReport check_conventions(const StoredFrames& frames, const Context& context) {
    if (frames.count < 2)
        throw std::runtime_error("the sequence has one frame; vectors are checked between frames, so render two");
    const std::vector<MotionConvention> all = readings(frames.convention, frames.has_jitter);
    const Comparison comparison = compared(frames, all, context);
    const double sites = std::max(comparison.sites, 1.0);
    const auto error = [&](const Way& way) { return way.error_over(sites); };
    const auto first_still = std::ranges::find(comparison.ways, true, &Way::is_still);
    const Way& nearest = *std::ranges::min_element(comparison.ways.begin(), first_still, {}, error);
    const Way& still = *std::ranges::min_element(first_still, comparison.ways.end(), {}, error);
    ConventionReport report;
    report.pairs = comparison.pairs;
    report.still_error = error(still);
    for (const MotionConvention& c : all) {
        const Way& way = *std::ranges::find(comparison.ways, simplest(c), &Way::convention);
        report.candidates.push_back({c, error(way), unsteadiness(comparison, c)});
    }
    std::ranges::stable_sort(report.candidates, is_nearer);
    mark_likely(report.candidates, comparison, nearest);
    if (comparison.largest_motion < least_motion) report.reason = "nothing moves";
    else if (excess(still, nearest) <= most_excess)
        report.reason = "vectors explain the pictures no better than standing still";
    return judged(std::move(report), frames.convention);
}

ConventionReport judged(ConventionReport report, const MotionConvention& current) {
    const auto found = std::ranges::find(report.candidates, current, &ConventionCandidate::convention);
    if (found == report.candidates.end())
        throw Error("check_conventions: no such reading was compared; check the frames once more");
    report.current = *found;
    report.best = report.reason.empty() ? best_of(report.candidates, *found) : *found;
    report.flags = flags_between(current, report.best.convention);
    report.verdict = !report.reason.empty() ? Verdict::cannot_tell
                     : report.flags.empty() ? Verdict::right
                                            : Verdict::wrong;
    report.open = report.reason.empty() ? open_options(report) : std::vector<std::string>();
    return report;
}

ConventionReport check_conventions(const FrameSequence& sequence, const Context& context) {
    if (!sequence.has_motion())
        throw std::runtime_error(message(sequence.name(0), ": has no channel ",
                                         convention_called(sequence.conventions()).motion_channel,
                                         ".X; name the channels of the motion by --motion"));
    return check_conventions({.count = sequence.count(),
                              .read = [&](int i) { return sequence.read_stored(i, context.parallel.threads); },
                              .convention = sequence.convention(),
                              .has_jitter = sequence.jitter_length() > 0},
                             context);
}

}  // namespace bandlimit::job
