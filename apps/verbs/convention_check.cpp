#include "apps/verbs/convention_check.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include "bandlimit/job/check_conventions.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;
using Verdict = job::ConventionReport::Verdict;

constexpr std::size_t most_rows = 8;

std::string words(const job::MotionConvention& c) {
    std::string text;
    for (const job::ConventionSetting& setting : job::settings_of(c))
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", setting.option, setting.value);
    return text;
}

ordered_json json_of(const job::MotionConvention& c) {
    ordered_json json;
    for (const job::ConventionSetting& s : job::settings_of(c)) json[std::string(s.option)] = s.value;
    return json;
}

ordered_json json_of(const job::ConventionCandidate& c, const job::ConventionReport& r) {
    return {{"reading", json_of(c.convention)},
            {"flags", job::flags_between(r.current.convention, c.convention)},
            {"error", c.error},
            {"excess", c.excess},
            {"unsteadiness", c.unsteadiness},
            {"likely", c.is_likely}};
}

std::string name_of(Verdict verdict) {
    return verdict == Verdict::right ? "right" : verdict == Verdict::wrong ? "wrong" : "cannot tell";
}

ordered_json json_of(const std::string& folder, const std::string& conventions, const job::ConventionReport& r) {
    ordered_json candidates = ordered_json::array();
    for (const job::ConventionCandidate& c : r.candidates) candidates.push_back(json_of(c, r));
    return {{"input", folder},
            {"conventions", conventions},
            {"verdict", name_of(r.verdict)},
            {"reason", r.reason},
            {"pairs", r.pairs},
            {"reading", json_of(r.current.convention)},
            {"error", r.current.error},
            {"still_error", r.still_error},
            {"best", json_of(r.best, r)},
            {"flags", r.flags},
            {"open", r.open},
            {"candidates", candidates}};
}

void print(const std::string& folder, const std::string& conventions, const job::ConventionReport& r,
           Console& console) {
    console.print("temporal: {}, {} conventions, {} pairs of frames\n", folder, conventions, r.pairs);
    const auto row = [&](const std::string& name, double error, const std::string& what) {
        console.print("  {:<10}{:.5f}  {}\n", name, error, what);
    };
    row("current", r.current.error, words(r.current.convention));
    if (r.verdict == Verdict::right) row("best", r.best.error, "the same");
    if (r.verdict == Verdict::wrong) row("best", r.best.error, words(r.best.convention));
    row("still", r.still_error, "if nothing moved");
    if (r.verdict == Verdict::cannot_tell) return;
    console.print("  readings by their errors in lightness, 0 to 1, and what they change:\n");
    for (std::size_t i = 0; i < std::min(most_rows, r.candidates.size()); ++i) {
        const job::ConventionCandidate& c = r.candidates[i];
        const std::vector<std::string> flags = job::flags_between(r.current.convention, c.convention);
        row(c.is_likely ? "likely" : "", c.error,
            flags.empty() ? std::string("nothing") : fmt::format("{}", fmt::join(flags, " ")));
    }
    if (r.candidates.size() > most_rows) console.print("  and {} more\n", r.candidates.size() - most_rows);
    if (!r.open.empty()) console.print("  open: {}; either value explains the pictures\n", fmt::join(r.open, ", "));
}

}  // namespace

void check_conventions(const std::string& folder, job::SequenceJob sequence, const Parallel& parallel, bool json,
                       Console& console) {
    sequence.folder = folder;
    const job::FrameSequence frames = job::open_sequence(sequence);
    const job::ConventionReport report = job::check_conventions(frames, context_of(console, parallel));
    if (json) console.print_json(json_of(folder, frames.conventions(), report));
    else print(folder, frames.conventions(), report, console);
    if (report.verdict == Verdict::right) return;
    console.finish();
    if (report.verdict == Verdict::wrong)
        throw std::runtime_error(fmt::format("{}: is read wrongly; pass {}", folder, fmt::join(report.flags, " ")));
    throw std::runtime_error(fmt::format("{}: {}: cannot tell; check frames in which the camera or more things move",
                                         folder, report.reason));
}

}  // namespace bandlimit::app
