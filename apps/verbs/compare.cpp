// bandlimit compare: how far two images are apart, and by how much they are shifted.
#include <fmt/core.h>

#include <cmath>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "bandlimit/job/compare.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

struct Options {
    job::CompareJob job;
    Parallel parallel;
    bool json = false;
};

const char* name_of(job::Measure measure) { return measure == job::Measure::encoded ? "encoded" : "linear"; }

ordered_json decibels(double psnr) { return std::isinf(psnr) ? ordered_json("inf") : ordered_json(psnr); }
ordered_json or_null(const std::optional<double>& v) { return v ? ordered_json(*v) : ordered_json(); }

ordered_json json_of(const job::CompareJob& job, const job::CompareReport& r) {
    const ImageInfo& info = r.info;
    ordered_json channels = ordered_json::array();
    for (std::size_t c = 0; c < r.metrics.per_channel.size(); ++c) {
        const Measures& m = r.metrics.per_channel[c];
        channels.push_back({{"channel", info.channel_names[c]},
                            {"mse", m.mse},
                            {"psnr", decibels(m.psnr())},
                            {"max_abs", m.max_abs},
                            {"ssim", m.ssim}});
    }
    return {{"mse", r.metrics.mse},          {"psnr", decibels(r.metrics.psnr())},
            {"max_abs", r.metrics.max_abs},  {"ssim", r.metrics.ssim},
            {"shift_x", or_null(r.shift.x)}, {"shift_y", or_null(r.shift.y)},
            {"width", info.width},           {"height", info.height},
            {"channels", info.channels()},   {"measure", name_of(r.measure)},
            {"border", job.border},          {"per_channel", channels}};
}

std::string psnr_text(double psnr) { return std::isinf(psnr) ? "inf" : fmt::format("{:.3f}", psnr); }

/// "+0.500  (B lies right of A)"
std::string shift_text(const std::optional<double>& shift, const char* below, const char* above) {
    if (!shift) return "undefined";
    const double rounded = std::round(*shift * 1000) / 1000 + 0.0;  // + 0: no minus zero
    const std::string text = fmt::format("{:+.3f} px", rounded);
    return std::abs(rounded) < 0.005 ? text : fmt::format("{}  (B lies {} A)", text, rounded < 0 ? below : above);
}

void print(Console& console, const job::CompareJob& job, const job::CompareReport& r) {
    const ImageInfo& info = r.info;
    console.print("A  {}\nB  {}\n", job.a, job.b);
    console.print("{} x {}, {} channel{}, {} values, white is 1", info.width, info.height, info.channels(),
                  info.channels() == 1 ? "" : "s", name_of(r.measure));
    if (job.border > 0) console.print(", without a border of {}", job.border);
    console.print("\n\n");
    console.print("{:<10}{:>12}{:>10}{:>12}{:>10}\n", "", "MSE", "PSNR/dB", "max |A-B|", "SSIM");
    const auto line = [&](const std::string& name, const Measures& m) {
        console.print("{:<10}{:>12.5g}{:>10}{:>12.6f}{:>10.6f}\n", name, m.mse, psnr_text(m.psnr()), m.max_abs, m.ssim);
    };
    line("all", r.metrics);
    for (std::size_t c = 0; info.channels() > 1 && c < r.metrics.per_channel.size(); ++c)
        line(info.channel_names[c], r.metrics.per_channel[c]);
    console.print("\nshift x   {}\nshift y   {}\n", shift_text(r.shift.x, "left of", "right of"),
                  shift_text(r.shift.y, "above", "below"));
}

void run(const Options& o, Console& console) {
    const job::CompareReport report = job::compare(o.job, context_of(console, o.parallel));
    if (o.json) console.print_json(json_of(o.job, report));
    else print(console, o.job, report);
}

}  // namespace

void add_compare(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("compare", "Measure how far two images are apart: MSE, PSNR, SSIM, shift",
                                 "bandlimit compare examples/coffee.png examples/coffee.png");
    verb.add_option("A", o->job.a, "The first image").required();
    verb.add_option("B", o->job.b,
                    "The second image; a shift above 0 means that its content lies right of or below A's")
        .required();
    verb.add_option("--border", o->job.border, "Pixels to leave out on every side; default 0")
        .in_range(0, 1 << 30)
        .type_name("N");
    add_space(verb, o->job.space);
    verb.add_option_function<std::string>(
            "--measure",
            [o](const std::string& s) {
                if (s != "encoded" && s != "linear")
                    throw UsageError("--measure: \"" + s + "\" is unknown; choose encoded or linear");
                o->job.measure = s == "encoded" ? job::Measure::encoded : job::Measure::linear;
            },
            "What to compare: codes, divided by the largest (default where both files hold integers;\n"
            "linear floats are sRGB-encoded for it), or linear light (default for float files)")
        .type_name("encoded|linear");
    verb.add_option("--diff", o->job.diff,
                    "Write |A - B| of the measured values, without alpha, to an image of linear codes,\n"
                    "to be read with --space data")
        .type_name("OUT");
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb,
        [o] {
            if (!o->job.diff.empty()) check_output_format(o->job.diff, {});
        },
        [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
