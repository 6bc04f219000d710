#include "bandlimit/job/audit_findings.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace bandlimit::job {
namespace {

constexpr double visible_bias = 0.2;  // codes
constexpr double poor_alias = -12;    // dB: what even a box does better than

/// Values of both sides of 1, each text once with the scales it holds for, if they differ.
template <class F>
std::string by_scale(const AuditReport& report, F text_of_scale) {
    std::vector<std::pair<std::string, std::string>> texts;  // and their scales
    for (const ScaleReport& s : report.scales) {
        const std::string text = text_of_scale(s);
        const auto known = std::find_if(texts.begin(), texts.end(), [&](const auto& t) { return t.first == text; });
        if (known == texts.end()) texts.emplace_back(text, ratio_text(s.ratio));
        else known->second += ", " + ratio_text(s.ratio);
    }
    if (texts.size() == 1) return texts[0].first;
    std::string all;
    for (const auto& [text, scales] : texts) all += fmt::format("{}{} at {}", all.empty() ? "" : "; ", text, scales);
    return all;
}

Finding kernel_finding(const AuditReport& report) {
    const auto text = [](const ScaleReport& s) {
        const std::string x = kernel_text(s.x.kernel, s.ratio), y = kernel_text(s.y.kernel, s.ratio);
        return x == y ? x : fmt::format("{} along x, {} along y", x, y);
    };
    return {"kernel", false, "kernel: " + by_scale(report, text)};
}

std::optional<Finding> antialias_finding(const AuditReport& report) {
    bool shrinks = false, all_widened = true;
    double alias = -200;
    for (const ScaleReport& s : report.scales) {
        if (!s.ratio.shrinks()) continue;
        shrinks = true;
        all_widened = all_widened && s.x.kernel.is_widened(s.ratio) && s.y.kernel.is_widened(s.ratio);
        if (!s.x.kernel.is_known) all_widened = all_widened && s.alias < poor_alias;
        alias = std::max(alias, s.alias);
    }
    if (!shrinks) return {};
    if (all_widened)
        return Finding{
            "antialias", false,
            fmt::format("widens its kernel while shrinking; alias of the zone plate at most {:.0f} dB", alias)};
    return Finding{"antialias", true,
                   fmt::format("does not antialias: its kernel keeps the width of source pixels while shrinking; alias "
                               "of the zone plate up to {:.0f} dB",
                               alias)};
}

Finding placement_finding(const AuditReport& report) {
    bool is_wrong = false;
    for (const ScaleReport& s : report.scales)
        for (const AxisReport& a : {std::cref(s.x), std::cref(s.y)}) is_wrong = is_wrong || a.alignment != "corners";
    if (!is_wrong) return {"placement", false, "no shift: images share their corners (half-pixel centres)"};
    return {"placement", true, by_scale(report, [](const ScaleReport& s) -> std::string {
                const AxisReport& a = larger_shift(s);
                if (s.x.alignment == "corners" && s.y.alignment == "corners") return "no shift";
                if (s.x.alignment == "centers" || s.y.alignment == "centers")
                    return "puts the centres of the corner samples together (align_corners)";
                return fmt::format("shifts by {:+.2f} px{}", a.shift,
                                   a.alignment == "top-left" ? " (top-left samples together)" : "");
            })};
}

Finding light_finding(const AuditReport& report, const AuditSubject& subject) {
    const double checker = report.light.front().checker * 255;
    switch (report.filtered_in) {
        case Light::srgb:
            return {"light", false, fmt::format("averages linear light: black and white become {:.0f}", checker)};
        case Light::gamma22:
            return {"light", true,
                    fmt::format("averages light by a power of 2.2 instead of the sRGB curve: black and white become "
                                "{:.0f}, not 188",
                                checker)};
        case Light::bt709:
            return {
                "light", true,
                fmt::format("averages light by the curve of BT.709 instead of sRGB's: black and white become {:.0f}, "
                            "not 188",
                            checker)};
        case Light::codes:
            if (subject.depth == "f32") return {"light", false, "averages floats as they are"};
            return {"light", true, fmt::format("averages sRGB codes: black and white become {:.0f}, not 188", checker)};
        case Light::unknown: break;
    }
    if (report.light.front().error > 0)
        return {"light", true, fmt::format("averages by an unknown curve: black and white become {:.0f}", checker)};
    return {"light", false, "averages nothing, so its light cannot be told"};
}

Finding alpha_finding(const AlphaReport& a) {
    const std::string at = fmt::format("alpha at {}: ", ratio_text(a.ratio));
    const std::string hidden = a.hidden == "kept"   ? "; the colour under alpha 0 is kept"
                               : a.hidden == "zero" ? "; the colour under alpha 0 becomes 0"
                                                    : "; the colour under alpha 0 changes";
    switch (a.mode) {
        case AlphaMode::untested: break;
        case AlphaMode::failed: return {"alpha", true, at + "the command failed: " + a.failure};
        case AlphaMode::dropped: return {"alpha", true, at + "dropped" + hidden};
        case AlphaMode::bleeds:
            return {"alpha", true,
                    fmt::format("{}colour of transparent pixels bleeds into others, by up to {:.0f} of 255{}", at,
                                a.leak * 255, hidden)};
        case AlphaMode::weighted:
            if (std::abs(a.coverage - 0.5) > 0.05 || a.flat_error > 0.05)
                return {"alpha", true,
                        fmt::format("{}colour is weighted, but half coverage becomes {:.2f} and a constant changes by "
                                    "{:.0f} of 255",
                                    at, a.coverage, a.flat_error * 255)};
            return {"alpha", false, at + "colour is weighted by it, nothing bleeds" + hidden};
    }
    return {"alpha", false, "alpha was not tested"};
}

Finding edge_finding(const AuditReport& report) {
    if (report.edges.empty()) {
        const bool is_seen = report.edge_errors.energy > 0;
        return {
            "edges", false,
            is_seen ? "borders: by an unknown rule" : "borders: no kernel reached outside, or the kernel is unknown"};
    }
    const bool is_wrong = report.edges.size() == 1 && report.edges[0] == "zero";
    return {"edges", is_wrong,
            fmt::format("borders: {}{}", fmt::join(report.edges, " or "),
                        is_wrong                  ? ", which darkens them"
                        : report.edges.size() > 1 ? " (the same here)"
                                                  : "")};
}

std::optional<Finding> overshoot_finding(const AuditReport& report, const AuditSubject& subject) {
    double found = 0, expected = 0, range = 0;
    for (const ScaleReport& s : report.scales) {
        if (s.expected_overshoot < expected) continue;
        expected = s.expected_overshoot, found = s.overshoot, range = s.overrange;
    }
    if (expected < 0.02) return {};
    if (found < expected / 4)
        return Finding{
            "overshoot", false,
            fmt::format("removes overshoot: {:.1f} % of an edge instead of {:.1f} %", found * 100, expected * 100)};
    const std::string clipped = subject.depth != "f32" ? "codes clip it at black and white"
                                : range < expected / 4 ? "but floats are clipped at 0 and 1"
                                                       : "also beyond 0 and 1";
    return Finding{"overshoot", subject.depth == "f32" && range < expected / 4,
                   fmt::format("keeps overshoot, {:.1f} % of an edge; {}", found * 100, clipped)};
}

std::optional<Finding> rounding_finding(const AuditReport& report) {
    const auto bias = bias_of(report);
    if (!bias || report.filtered_in == Light::unknown) return {};
    if (report.code == 0)
        return Finding{"rounding", std::abs(*bias) > 1e-3, fmt::format("mean error of values {:+.1e}", *bias)};
    if (std::abs(*bias) < visible_bias)
        return Finding{"rounding", false, fmt::format("rounds to the nearest code (bias {:+.2f})", *bias)};
    const bool truncates = *bias < -0.35 && *bias > -0.65;
    return Finding{"rounding", true,
                   fmt::format("{}codes are {:.2f} too {} on average", truncates ? "truncates: " : "", std::abs(*bias),
                               *bias < 0 ? "low" : "high")};
}

std::optional<Finding> phases_finding(const AuditReport& report) {
    std::optional<int> count;
    int finest = 0;
    for (const ScaleReport& s : report.scales)
        for (const AxisReport& a : {std::cref(s.x), std::cref(s.y)}) {
            if (a.phases.count) count = std::max(count.value_or(0), *a.phases.count);
            finest = std::max(finest, a.phases.finest);
        }
    if (count) return Finding{"phases", true, fmt::format("uses weights from a table of {} phases per pixel", *count)};
    if (finest == 0) return {};
    return Finding{"phases", false, fmt::format("no table of {} phases or fewer", finest)};
}

std::optional<Finding> form_finding(const AuditReport& report) {
    bool radial = false;
    double difference = 0;
    for (const ScaleReport& s : report.scales) {
        radial = radial || s.separable == false;
        difference = std::max(difference, s.axis_difference);
    }
    if (radial)
        return Finding{"form", false, "is not separable: its kernel depends on the distance, or on more than position"};
    if (difference > 0.03)
        return Finding{"form", true, fmt::format("differs along x and y by {:.0f} %", difference * 100)};
    return Finding{"form", false, "the same along x and y, one after the other"};
}

std::optional<Finding> flat_finding(const AuditReport& report, const AuditSubject& subject) {
    double error = 0;
    for (const LightReport& l : report.light) error = std::max(error, l.flat_error);
    const double unit = report.code > 0 ? report.code : 1, bound = report.code > 0 ? 0.6 : 1e-4;
    const std::string word = report.code > 0 ? "codes" : "of 1";
    if (error / unit > bound)
        return Finding{"constants", true, fmt::format("constant greys change by up to {:.3g} {}", error / unit, word)};
    if (subject.channel_spread / unit > bound)
        return Finding{"constants", true,
                       fmt::format("grey becomes coloured by up to {:.3g} {}", subject.channel_spread / unit, word)};
    return Finding{"constants", false, "constant greys stay as they are"};
}

}  // namespace

const AxisReport& larger_shift(const ScaleReport& s) { return std::abs(s.x.shift) >= std::abs(s.y.shift) ? s.x : s.y; }

std::optional<double> bias_of(const AuditReport& report) {
    double sum = 0, count = 0;
    for (const bool whole : {false, true}) {
        if (count > 0) break;
        for (const ScaleReport& s : report.scales)
            if (s.ratio.is_whole() == whole && s.x.kernel.candidate.kernel.form != Kernel::Form::nearest)
                sum += s.x.bias + s.y.bias, count += 2;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::string ratio_text(const Ratio& ratio) { return fmt::format("{}/{}", ratio.to, ratio.from); }

std::string kernel_text(const KernelFinding& kernel, const Ratio& ratio) {
    const Candidate& c = kernel.candidate;
    std::string text = kernel.name;
    if (c.is_sampled) text += " by equal weights";
    if (c.ties_down) text += " (of two the left)";
    const bool is_nearest = c.kernel.form == Kernel::Form::nearest;
    if (!kernel.is_widened(ratio) && !is_nearest) text += ", not widened";
    else if (std::abs(c.widening - 1) > 0.02) text += fmt::format(", {:.2f} times as wide", c.widening);
    if (!kernel.is_known)
        return kernel.residual > 0.2 ? "unknown"
                                     : fmt::format("unknown (nearest: {}, {:.0f} % off)", text, kernel.residual * 100);
    // Known kernels of float or of rounded codes leave less.
    return kernel.residual > std::max(0.015, 2 * kernel.noise) ? "about " + text : text;
}

std::vector<Finding> findings_of(const AuditReport& report, const AuditSubject& subject) {
    std::vector<Finding> all{kernel_finding(report)};
    const auto add = [&](std::optional<Finding> f) {
        if (f) all.push_back(std::move(*f));
    };
    add(antialias_finding(report));
    add(placement_finding(report));
    add(light_finding(report, subject));
    for (const AlphaReport& a : report.alpha) add(alpha_finding(a));
    add(edge_finding(report));
    add(overshoot_finding(report, subject));
    add(rounding_finding(report));
    add(phases_finding(report));
    add(form_finding(report));
    add(flat_finding(report, subject));
    return all;
}

}  // namespace bandlimit::job
