// bandlimit pattern: test signals and scenes as image files.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/console/common.h"
#include "apps/verbs/scene_request.h"
#include "bandlimit/job/pattern.h"

namespace bandlimit::app {
namespace {

struct Options {
    job::PatternJob job;
    std::string antialias = "none";
    int samples = 8;
    SceneRequest scene;  ///< where the signal is a scene too
    DrawingOptions drawing;
};

Sampling sampling_of(const Options& o) {
    if (o.antialias == "none") return Sampling::point();
    if (o.antialias == "exact") return Sampling::exact();
    return Sampling::supersampled(parse_kernel(o.antialias), o.samples);
}

job::PatternJob job_of(const Options& o) {
    job::PatternJob job = o.job;
    const Size size = parse_size("--size", o.drawing.size);
    job.size = {size.width, size.height};
    job.out = o.drawing.out, job.depth = o.drawing.depth, job.tile = o.drawing.tile;
    job.sampling = sampling_of(o);
    return job;
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    if (o.scene.is_asked_for()) return check_scene(o.scene, o.drawing);
    const job::PatternJob job = job_of(o);
    check_output_format(job.out, job.depth, job.tile);
    job::check(job);
}

void run(const Options& o, Console& console) {
    if (o.scene.is_asked_for()) return run_scene(o.scene, o.drawing, console);
    const job::PatternJob job = job_of(o);
    const job::PatternReport report = job::pattern(job, context_of(console, o.drawing.parallel));
    if (!o.drawing.json) return;
    console.print_json({{"kind", job.signal.name},
                        {"file", job.out},
                        {"width", job.size.width},
                        {"height", job.size.height},
                        {"channels", report.channels},
                        {"antialias", o.antialias},
                        {"samples", job.sampling.mode == Sampling::Mode::supersampled ? o.samples : 1},
                        {"depth", name_of(report.depth)},
                        {"transfer", name_of(report.transfer)},
                        {"threads", o.drawing.parallel.count()},
                        {"seconds", {{"render", report.seconds_rendering}, {"write", report.seconds_writing}}}});
}

void add_number(Verb kind, const std::string& name, double& target, const std::string& help, const std::string& type) {
    kind.add_option_function<std::string>(
            name, [&target, name](const std::string& s) { target = parse_number(name, s); }, help)
        .type_name(type);
}

/// An option for a parameter, by where that is kept.
struct ParameterOption {
    Verb kind;
    const job::SignalParameter& p;
    std::string name = "--" + p.name;

    void operator()(double* to) const { add_number(kind, name, *to, p.help, p.type); }
    void operator()(int* to) const { kind.add_option(name, *to, p.help).type_name(p.type); }
    void operator()(std::uint64_t* to) const {
        kind.add_option(name, *to, p.help)
            .type_name(p.type)
            .in_range(0.0, 18446744073709551615.0);  // the parser would wrap it
    }
    void operator()(bool* to) const { kind.add_flag(name, *to, p.help); }
    void operator()(std::optional<double>* to) const {
        numbers(1, [to](const std::vector<double>& n) { *to = n[0]; });
    }
    void operator()(std::optional<Point>* to) const {
        numbers(2, [to](const std::vector<double>& n) { *to = Point{n[0], n[1]}; });
    }
    void operator()(std::optional<Cell>* to) const {
        numbers(4, [to](const std::vector<double>& n) { *to = Cell{n[0], n[1], n[0] + n[2], n[1] + n[3]}; });
    }

private:
    void numbers(std::size_t count, const std::function<void(const std::vector<double>&)>& set) const {
        const auto parse = [count, set, name = name, type = p.type](const std::string& s) {
            if (count == 1) return set({parse_number(name, s)});
            const std::vector<double> values = parse_numbers(name, s);
            if (values.size() != count)
                throw UsageError(
                    fmt::format("{}: \"{}\" is not {}; write {} numbers with commas", name, s, type, count));
            set(values);
        };
        kind.add_option_function<std::string>(name, parse, p.help).type_name(p.type);
    }
};

void add_drawing(Program& program, Verb kind, DrawingOptions& drawing) {
    kind.add_option("OUT", drawing.out, "Image to write; the extension names the format").required();
    kind.add_option("--size", drawing.size, "Size in pixels, e.g. 512x512").required().type_name("WxH");
    add_depth(kind, drawing.depth).description("Depth of the output; default: f32 for EXR, HDR and PFM, else u8");
    add_tiles(kind, drawing.tile);
    add_threads(kind, drawing.parallel);
    add_json(kind, drawing.json);
    program.add_quiet(kind);
}

/// What signals have beside their parameters.
void add_sampling(Verb kind, const std::shared_ptr<Options>& o) {
    kind.add_option("--antialias", o->antialias,
                    "none (default): the value at the centre of each pixel; exact: the mean over each pixel,\n"
                    "where a closed form is known (all but siemens and noise); or a kernel, supersampled")
        .type_name("none|exact|KERNEL");
    kind.add_option("--samples", o->samples, "Samples per pixel and axis for --antialias KERNEL; default 8")
        .in_range(1, 1024)
        .type_name("N");
    add_number(kind, "--low", o->job.low, "Linear light where the signal is 0; default 0", "L");
    add_number(kind, "--high", o->job.high, "Linear light where the signal is 1; default 1", "L");
    add_space(kind, o->job.space)
        .description(
            "What codes shall mean: auto (sRGB for 8 and 16 bit, else linear), srgb, or linear and data\n"
            "(codes are the values)");
    kind.add_option("--channels", o->job.channels,
                    "1 grey, 2 grey and alpha, 3 RGB, 4 RGBA, all colours alike, alpha opaque; default: 1, or 3 where\n"
                    "the format has no grey")
        .in_range(1, 4)
        .type_name("N");
}

/// Lets a signal be the scene of the same name: any option of scenes makes it that, and excludes those of signals.
void add_scene_of(Verb kind, const job::NamedSignal& signal, SceneRequest& scene) {
    scene.job.scene = signal.name;
    add_scene_options(kind, scene);
    std::vector<std::string> names{"antialias", "samples", "low", "high", "space", "channels"};
    for (const job::SignalParameter& p : signal.parameters) names.push_back(p.name);
    for (const Option& option : scene.options)
        for (const std::string& name : names) option.excludes(kind.option("--" + name));
}

void add_kind(Program& program, Verb verb, const job::NamedSignal& signal) {
    auto o = std::make_shared<Options>();
    o->job.signal = signal;
    const bool has_scene = is_scene(signal.name);
    Verb kind =
        verb.add_subcommand(signal.name, has_scene ? signal.summary + "; with --frame, a scene" : signal.summary);
    kind.example(fmt::format("bandlimit pattern {} {}", signal.name, signal.example) +
                 (has_scene ? fmt::format("\n  bandlimit pattern {} frame_003.exr --size 160x90 --frame 3 --speed 1.5",
                                          signal.name)
                            : ""));
    for (const job::SignalParameter& p : signal.parameters) std::visit(ParameterOption{kind, p}, p.value);
    add_sampling(kind, o);
    add_drawing(program, kind, o->drawing);
    if (has_scene) add_scene_of(kind, signal, o->scene);
    program.on(
        kind, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

void add_scene(Program& program, Verb verb, const std::string& name) {
    struct Both {
        SceneRequest scene;
        DrawingOptions drawing;
    };
    auto o = std::make_shared<Both>();
    o->scene.job.scene = name;
    Verb kind = verb.add_subcommand(name, "Scene: " + scene_summary(name));
    kind.example(
        fmt::format("bandlimit pattern {} frame_003.exr --size 160x90 --frame 3 --jitter 0.25,-0.125\n"
                    "  bandlimit pattern {} {}.png --size 160x90 --spp 16\n"
                    "EXR files hold R, G, B, A, Depth.Z, Vector.X, Vector.Y, Normal.X, Normal.Y, Normal.Z,\n"
                    "Albedo.R, Albedo.G, Albedo.B and AO: Vector is the position in the frame before minus\n"
                    "the one here, in pixels, y down. Other files hold the colour alone.",
                    name, name, name));
    add_scene_options(kind, o->scene);
    add_drawing(program, kind, o->drawing);
    program.on(
        kind, [o] { check_scene(o->scene, o->drawing); },
        [o](Console& console) { run_scene(o->scene, o->drawing, console); });
}

}  // namespace

void add_pattern(Program& program) {
    Verb verb =
        program.add_verb("pattern", "Draw a test signal or scene whose right answer is known",
                         "bandlimit pattern zoneplate zoneplate.png --size 512x512 --antialias exact\n"
                         "  bandlimit pattern plane frame_003.exr --size 160x90 --frame 3 --jitter 0.25,-0.125");
    std::vector<std::string> signals;
    for (const job::NamedSignal& signal : job::named_signals()) {
        add_kind(program, verb, signal);
        signals.push_back(signal.name);
    }
    for (const std::string& name : scene_names())
        if (std::find(signals.begin(), signals.end(), name) == signals.end()) add_scene(program, verb, name);
    verb.require_one_subcommand("kind of signal or scene");
}

}  // namespace bandlimit::app
