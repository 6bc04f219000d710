#include "apps/verbs/audit_report.h"

#include <fmt/core.h>

#include <cmath>
#include <map>

#include <nlohmann/json.hpp>
#include "apps/console/console.h"

namespace bandlimit::app {

using namespace job;
using nlohmann::ordered_json;

std::string text_of(const CommandAudit& audit) {
    const auto& [report, subject, findings] = audit;
    std::string text =
        fmt::format("{}\n  {} runs on {} {}, {} channels; the slowest took {:.2f} s\n", visible(subject.command),
                    report.runs, subject.format, subject.depth, subject.channels, subject.seconds);
    for (const bool wrong : {true, false}) {
        text += wrong ? "\nWrong\n" : "\nFound\n";
        const auto size = text.size();
        for (const Finding& f : findings)
            if (f.is_wrong == wrong) text += fmt::format("  {}\n", f.text);
        if (text.size() == size) text += "  nothing\n";
    }
    text += fmt::format("\n  {:>7}  {:<34} {:>8}  {:<26} {:>7} {:>8} {:>9} {:>9}\n", "scale", "kernel", "residual",
                        "next best", "support", "shift", "pass", "alias");
    for (const ScaleReport& s : report.scales)
        text += fmt::format("  {:>7}  {:<34} {:>6.2f} %  {:<26} {:>7.2f} {:>+5.2f} px {:>6.1f} dB {:>6.1f} dB\n",
                            ratio_text(s.ratio), kernel_text(s.x.kernel, s.ratio), s.x.kernel.residual * 100,
                            fmt::format("{} {:.1f} %", s.x.kernel.runner_up, s.x.kernel.runner_up_residual * 100),
                            s.x.support_coarser, larger_shift(s).shift, s.pass_error, s.alias);
    return text +
           "  support in pixels of the coarser grid; shift in output pixels, above 0 to the right or down;\n"
           "  pass and alias: error of the zone plate where it must survive, and what remains where it must vanish\n";
}

namespace {

ordered_json json_of(const KernelFinding& k, const Ratio& ratio) {
    return {{"name", k.name},
            {"known", k.is_known},
            {"widened", k.is_widened(ratio)},
            {"widening", k.candidate.widening},
            {"equal_weights", k.candidate.is_sampled},
            {"radial", k.candidate.is_radial},
            {"residual", k.residual},
            {"noise", k.noise},
            {"runner_up", {{"name", k.runner_up}, {"residual", k.runner_up_residual}}},
            {"same_here", k.same}};
}

/// The measured kernel, averaged over steps of 1/16.
ordered_json json_of(const KernelSamples& samples) {
    constexpr int steps = 16;
    std::map<int, std::pair<double, int>> bins;
    for (std::size_t i = 0; i < samples.x.size(); ++i) {
        auto& [sum, count] = bins[static_cast<int>(std::lround(samples.x[i] * steps))];
        sum += samples.y[i], ++count;
    }
    ordered_json x = ordered_json::array(), value = ordered_json::array();
    for (const auto& [bin, total] : bins) x.push_back(double(bin) / steps), value.push_back(total.first / total.second);
    return {{"x", x}, {"value", value}};
}

ordered_json json_of(const AxisReport& a, const Ratio& ratio) {
    return {{"kernel", json_of(a.kernel, ratio)},
            {"alignment", a.alignment},
            {"shift", a.shift},
            {"support", {{"source", a.support_source}, {"coarser", a.support_coarser}}},
            {"phases", a.phases.count ? ordered_json(*a.phases.count) : ordered_json()},
            {"phases_seen_up_to", a.phases.finest},
            {"bias", a.bias},
            {"measured", json_of(a.samples)}};
}

ordered_json json_of(const ScaleReport& s) {
    return {{"scale", ratio_text(s.ratio)},
            {"x", json_of(s.x, s.ratio)},
            {"y", json_of(s.y, s.ratio)},
            {"axis_difference", s.axis_difference},
            {"separable", s.separable ? ordered_json(*s.separable) : ordered_json()},
            {"not_separable", s.not_separable},
            {"zone_plate", {{"pass_error_db", s.pass_error}, {"alias_db", s.alias}}},
            {"overshoot", {{"found", s.overshoot}, {"expected", s.expected_overshoot}, {"beyond_range", s.overrange}}}};
}

}  // namespace

ordered_json json_of(const CommandAudit& audit) {
    const auto& [report, subject, found] = audit;
    ordered_json light = ordered_json::array(), alpha = ordered_json::array(), scales = ordered_json::array(),
                 edges = ordered_json::object(), findings = ordered_json::array();
    for (const LightReport& l : report.light)
        light.push_back({{"filtered_in", name_of(l.light)},
                         {"checkerboard", l.checker},
                         {"error", l.error},
                         {"constants_change", l.flat_error}});
    for (const AlphaReport& a : report.alpha)
        alpha.push_back({{"scale", ratio_text(a.ratio)},
                         {"mode", name_of(a.mode)},
                         {"leak", a.leak},
                         {"hidden_color", a.hidden},
                         {"coverage", a.coverage},
                         {"constant_changes", a.flat_error},
                         {"failure", a.failure}});
    for (const ScaleReport& s : report.scales) scales.push_back(json_of(s));
    for (std::size_t r = 0; r < edge_rules.size(); ++r)
        edges[std::string(edge_rules[r])] = report.edge_errors.residual(r);
    for (const Finding& f : found) findings.push_back({{"key", f.key}, {"wrong", f.is_wrong}, {"text", f.text}});
    const auto bias = bias_of(report);
    return {{"command", subject.command},
            {"files", {{"format", subject.format}, {"depth", subject.depth}, {"channels", subject.channels}}},
            {"runs", report.runs},
            {"slowest_run_seconds", subject.seconds},
            {"findings", findings},
            {"filtered_in", name_of(report.filtered_in)},
            {"edges", report.edges},
            {"bias", bias ? ordered_json(*bias) : ordered_json()},
            {"channel_spread", subject.channel_spread},
            {"edge_residuals", edges},
            {"light", light},
            {"alpha", alpha},
            {"scales", scales}};
}

}  // namespace bandlimit::app
