// bandlimit temporal: antialiasing and upscaling over time.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "apps/page/page.h"
#include "apps/verbs/convention_check.h"
#include "apps/verbs/temporal_page.h"
#include "bandlimit/antialias/temporal_options.h"
#include "bandlimit/antialias/temporal_shader.h"
#include "bandlimit/job/command.h"
#include "bandlimit/job/temporal.h"
#include "bandlimit/scene/scene.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

struct Options {
    job::TemporalJob job;
    std::string size, report, units, direction, y_axis, jitter = "halton";
    std::string axes, motion_jitter, jitter_sign, jitter_y;
    std::vector<std::string> set;  ///< NAME=VALUE
    std::optional<Dialect> emit;   ///< a shader in place of frames
    Parallel parallel;
    bool json = false, checks_conventions = false;
};

template <class Value>
Value one_of(const std::string& option, const std::string& text,
             const std::vector<std::pair<std::string, Value>>& all) {
    std::string list;
    for (const auto& [name, value] : all) {
        if (name == text) return value;
        list += (list.empty() ? "" : ", ") + name;
    }
    throw UsageError(fmt::format("{}: \"{}\" is unknown; choose one of: {}", option, text, list));
}

/// The options of a preset, changed by what --set says.
TemporalOptions options_of(const Options& o) {
    TemporalOptions options = temporal_preset(o.job.preset);
    for (const std::string& item : o.set) {
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos)
            throw UsageError(fmt::format("--set: \"{}\" has no value; pass e.g. still-frames=32", item));
        set_option(options, item.substr(0, equals), item.substr(equals + 1));
    }
    return options;
}

/// The lines of --help that say what --set takes.
std::string help_of_set() {
    std::string text = "Change one option of the preset; may be repeated. NAME is one of";
    for (const TemporalOptionInfo& info : temporal_option_infos())
        text += fmt::format("\n  {:<20} {}: {}", info.name, info.meaning, info.values);
    return text;
}

job::TemporalJob job_of(const Options& o) {
    using Units = job::MotionConvention::Units;
    job::TemporalJob job = o.job;
    job.options = options_of(o);
    job.jitter = parse_jitter(o.jitter);
    job.measures = !o.report.empty();
    if (!o.size.empty()) {
        const Size size = parse_size("--size", o.size);
        job.width = size.width, job.height = size.height;
    }
    if (!o.units.empty())
        job.sequence.motion_units = one_of<Units>("--motion-units", o.units,
                                                  {{"pixels", Units::pixels}, {"uv", Units::uv}, {"ndc", Units::ndc}});
    if (!o.direction.empty())
        job.sequence.is_previous_minus_current =
            one_of<bool>("--motion-direction", o.direction, {{"previous-current", true}, {"current-previous", false}});
    if (!o.y_axis.empty()) job.sequence.is_y_up = one_of<bool>("--motion-y", o.y_axis, {{"up", true}, {"down", false}});
    if (!o.axes.empty())
        job.sequence.are_axes_swapped = one_of<bool>("--motion-axes", o.axes, {{"xy", false}, {"yx", true}});
    if (!o.motion_jitter.empty())
        job.sequence.includes_jitter =
            one_of<bool>("--motion-jitter", o.motion_jitter, {{"excluded", false}, {"included", true}});
    using Sign = job::MotionConvention::JitterSign;
    if (!o.jitter_sign.empty())
        job.sequence.jitter_sign = one_of<Sign>("--jitter-sign", o.jitter_sign,
                                                {{"plus", Sign::plus}, {"minus", Sign::minus}, {"none", Sign::none}});
    if (!o.jitter_y.empty())
        job.sequence.is_jitter_y_up = one_of<bool>("--jitter-y", o.jitter_y, {{"up", true}, {"down", false}});
    return job;
}

/// The pass of a frame as shader source, by the same options.
std::string shader_of(const Options& o, const std::string& command) {
    return temporal_shader(options_of(o), {.name = "temporal", .command = command}, *o.emit);
}

void check_emit(const Options& o) {
    if (!o.job.input.empty())
        throw UsageError("--emit prints a shader and reads no frames; leave out INPUT and OUTDIR");
    if (o.json || !o.report.empty()) throw UsageError("--emit prints a shader only; leave out --json and --report");
    if (const Accumulation rule = options_of(o).rule; rule != Accumulation::weighted)
        throw UsageError(fmt::format("--emit: the rule {} has no shader; choose another --preset", name_of(rule)));
    shader_of(o, "");
}

void check(const Options& o) {
    if (o.emit) return check_emit(o);
    if (o.job.input.empty()) throw UsageError("INPUT is missing; see bandlimit temporal --help");
    if (o.job.out.empty() && !o.checks_conventions)
        throw UsageError("OUTDIR is missing; see bandlimit temporal --help");
    const job::TemporalJob job = job_of(o);
    const std::vector<std::string_view> conventions = job::convention_names();
    if (std::find(conventions.begin(), conventions.end(), job.sequence.conventions) == conventions.end())
        throw UsageError(fmt::format("--conventions: \"{}\" is unknown; choose one of: {}", job.sequence.conventions,
                                     fmt::join(conventions, ", ")));
    if (job.width > 0 && !is_scene(job.input))
        throw UsageError("--size: a folder of frames has a size of its own; leave it out, or name a scene");
    job::check(job);
    if (o.checks_conventions && is_scene(job.input))
        throw UsageError("--check-conventions: scenes have ours; name a folder of frames");
    if (o.report.empty()) return;
    // The report may lie in the folder of the frames, which is made once these are known to be readable.
    namespace fs = std::filesystem;
    const auto full = [](const std::string& path) { return fs::weakly_canonical(fs::absolute(path)); };
    const fs::path parent = full(o.report).parent_path();
    if (!fs::is_directory(parent) && parent != full(job.out))
        throw UsageError(fmt::format("--report: {} is not a folder; make it first", parent.string()));
}

ordered_json number_or_null(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json();
}

ordered_json json_of(const Options& o, const job::TemporalJob& job, const job::TemporalReport& r) {
    ordered_json frames = ordered_json::array();
    const auto first_made = static_cast<std::size_t>(r.continued_at);
    for (const job::TemporalFrameReport& f : r.frames)
        frames.push_back({{"frame", f.number},
                          {"file", f.file},
                          {"psnr", number_or_null(f.psnr)},
                          {"ssim", number_or_null(f.ssim)},
                          {"ms", f.ms}});
    return {{"input", job.input},
            {"output", job.out},
            {"preset", job.preset},
            {"scale", job.scale},
            {"width", r.width},
            {"height", r.height},
            {"conventions", r.conventions},
            {"jitter_length", r.jitter_length},
            {"mip_bias", r.mip_bias},
            {"threads", o.parallel.count()},
            {"seconds", r.seconds},
            {"continued_at", r.continued_at > 0 ? ordered_json(r.frames[first_made].number) : ordered_json()},
            {"ms_per_frame", mean_milliseconds(r)},
            {"measured_frames", r.measured_frames},
            {"flicker", number_or_null(r.measured.flicker)},
            {"warped_difference", number_or_null(r.measured.warped_difference)},
            {"ghosting",
             {{"disoccluded", number_or_null(r.measured.error_disoccluded)},
              {"elsewhere", number_or_null(r.measured.error_elsewhere)}}},
            {"sharpness", number_or_null(sharpness(r))},
            {"high_frequencies",
             {{"output", number_or_null(r.high_frequencies)}, {"truth", number_or_null(r.high_frequencies_of_truth)}}},
            {"frames", frames}};
}

/// What is known, a line each.
void print_measures(Console& console, const job::TemporalReport& r) {
    const TemporalMeasures& m = r.measured;
    if (m.flicker)
        console.print("  flicker   {:.2f} codes of 255, of what stands still, over the last {} frames\n",
                      *m.flicker * 255, r.measured_frames);
    if (m.error_disoccluded && m.error_elsewhere)
        console.print("  ghosting  error {:.4f} in what came into view, {:.4f} elsewhere\n", *m.error_disoccluded,
                      *m.error_elsewhere);
    if (const std::optional<double> s = sharpness(r))
        console.print("  sharpness {:.2f}: energy above half of Nyquist, against the truth's\n", *s);
}

void run(const Options& o, Console& console, const std::string& command) {
    if (o.emit) return console.write(shader_of(o, command));
    const job::TemporalJob job = job_of(o);
    if (o.checks_conventions) return check_conventions(job.input, job.sequence, o.parallel, o.json, console);
    const job::TemporalReport report = job::temporal(job, context_of(console, o.parallel));
    const std::string folder = o.report.empty() ? "" : job::made_folder(o.report);
    const ordered_json json = json_of(o, job, report);
    if (!folder.empty()) {
        write_text(folder + "/report.json", json.dump(2) + "\n");
        write_temporal_page(folder, job, report, command);
    }
    if (o.json) return console.print_json(json);
    console.print("temporal: {} frames, {} x {} to {} x {}, {} conventions, preset {}\n", report.frames.size(),
                  report.in_width, report.in_height, report.width, report.height, report.conventions, job.preset);
    if (report.continued_at > 0)
        console.print("  continued at frame {}: the frames before it were there\n",
                      report.frames[static_cast<std::size_t>(report.continued_at)].number);
    console.print("  mip bias  {:.2f}: what textures should be sampled with\n", report.mip_bias);
    const job::TemporalFrameReport& last = report.frames.back();
    if (last.psnr) console.print("  truth     PSNR {:.2f} dB, SSIM {:.4f} at {}\n", *last.psnr, *last.ssim, last.file);
    print_measures(console, report);
    console.print("  time      {:.1f} ms a frame\n", mean_milliseconds(report));
    if (!folder.empty()) console.print("  report    {}/index.html\n", folder);
}

}  // namespace

void add_temporal(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb(
        "temporal", "Antialias and upscale over time: accumulate jittered frames, with the sum of their weights",
        "bandlimit temporal glyphs smooth --size 48x32 --scale 2 --report smooth/report\n"
        "Others:\n"
        "  bandlimit temporal render smooth --meta render/meta.json --reference truth --report report\n"
        "  bandlimit temporal render --meta render/meta.json --check-conventions\n"
        "  bandlimit temporal --preset fast --emit wgsl");
    verb.add_option("INPUT", o->job.input,
                    "A folder of EXR files, one a frame, or a scene (bandlimit pattern --help lists them)");
    verb.add_option(
        "OUTDIR", o->job.out,
        "Folder for the frames, which are named like the input's. A run that was stopped goes on where it was");
    verb.add_option("--size", o->size, "Size of the input, for scenes").type_name("WxH");
    verb.add_option_function<std::string>(
            "--scale", [o](const std::string& s) { o->job.scale = parse_number("--scale", s); },
            "Size of the output as a multiple of the input's, 1 (default) to 4")
        .type_name("S");
    verb.add_option("--preset", o->job.preset,
                    "balanced (default), fast, sharp; reference: supersampling over time, without rejection;\n"
                    "per-frame and input-sized: the plain rules, to compare with")
        .type_name("P");
    verb.add_option("--set", o->set, help_of_set()).type_name("NAME=VALUE").one_at_a_time();
    verb.add_option_function<std::string>(
            "--emit", [o](const std::string& s) { o->emit = parse_dialect(s); },
            "Print shader source instead, by --preset and --set: functions that take a frame into the history and\n"
            "show it. Needs no INPUT and OUTDIR")
        .type_name("glsl|hlsl|wgsl|msl|slang|cpp");
    verb.add_option("--frames", o->job.frames, "How many frames; default all, of scenes a period of the jitter")
        .type_name("N");
    verb.add_option("--jitter", o->jitter, "Jitter of scenes: halton (default), r2, rotated or sobol").type_name("J");
    verb.add_option("--meta", o->job.sequence.meta,
                    "JSON file with the jitter of each frame and, for the motion of the sky, the cameras")
        .type_name("FILE");
    verb.add_option("--conventions", o->job.sequence.conventions,
                    "What motion vectors mean: blender, unreal, unity or bandlimit; auto (default): by channel names")
        .type_name("C");
    verb.add_flag("--check-conventions", o->checks_conventions,
                  "Find out, instead, which signs, axes and units explain the pictures, and say which of the options\n"
                  "below to change: exit 0 if none, 1 otherwise");
    verb.add_option("--color", o->job.sequence.color,
                    "Channels of the colour, as Beauty for Beauty.R and so on; or, as for the next two, files of its\n"
                    "own, as beauty_####.exr or beauty_####.exr:Beauty, where #### is the number of the frame")
        .type_name("NAME|FILES");
    verb.add_option("--depth", o->job.sequence.depth, "Channel of the linear depth, or its files")
        .type_name("NAME|FILES");
    verb.add_option("--motion", o->job.sequence.motion,
                    "Channels of the motion, as Vector for Vector.X and Vector.Y, or its files")
        .type_name("NAME|FILES");
    verb.add_option("--motion-units", o->units, "Overrides the conventions").type_name("pixels|uv|ndc");
    verb.add_option("--motion-direction", o->direction, "Overrides the conventions")
        .type_name("previous-current|current-previous");
    verb.add_option("--motion-y", o->y_axis, "Overrides the conventions").type_name("up|down");
    verb.add_option("--motion-axes", o->axes, "yx: the first channel is the motion along y").type_name("xy|yx");
    verb.add_option("--motion-jitter", o->motion_jitter, "included: vectors include the difference of the jitter")
        .type_name("excluded|included");
    verb.add_option("--jitter-sign", o->jitter_sign,
                    "minus: pixels show the scene at their middle minus the jitter; none: the pictures have no jitter")
        .type_name("plus|minus|none");
    verb.add_option("--jitter-y", o->jitter_y, "Which way the jitter's y points; default down").type_name("up|down");
    verb.add_option("--reference", o->job.reference,
                    "Folder with the truth for each frame, of the output's size, paired by the number in its name")
        .type_name("DIR");
    verb.add_option(
            "--report", o->report,
            "Write report.json and a page to this folder: PSNR and SSIM over time, flicker, ghosting, sharpness,\n"
            "an animation beside input and truth, and the weights, motion and rejection of the last frame")
        .type_name("DIR");
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o, &program](Console& console) { run(*o, console, program.command); });
}

}  // namespace bandlimit::app
