#include "apps/verbs/scene_request.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace bandlimit::app {
namespace {

job::ScenePictureJob job_of(const SceneRequest& scene, const DrawingOptions& drawing) {
    job::ScenePictureJob job = scene.job;
    const Size size = parse_size("--size", drawing.size);
    job.size = {size.width, size.height};
    job.out = drawing.out, job.depth = drawing.depth, job.tile = drawing.tile;
    return job;
}

Point parse_jitter(const std::string& text) {
    const std::vector<double> numbers = parse_numbers("--jitter", text);
    if (numbers.size() != 2)
        throw UsageError(fmt::format("--jitter: \"{}\" is not X,Y; pass two numbers, e.g. 0.25,-0.125", text));
    return {numbers[0], numbers[1]};
}

}  // namespace

bool SceneRequest::is_asked_for() const {
    return std::any_of(options.begin(), options.end(), [](const Option& o) { return o.is_given(); });
}

void add_scene_options(Verb kind, SceneRequest& scene) {
    job::ScenePictureJob& job = scene.job;
    scene.options = {
        kind.add_option("--frame", job.frame, "Which frame of the scene; default 0").type_name("F"),
        kind.add_option_function<std::string>(
                "--jitter", [&job](const std::string& s) { job.sampling.jitter = parse_jitter(s); },
                "Samples pixel (i, j) around (i + 0.5 + X, j + 0.5 + Y), y down; default 0,0")
            .type_name("X,Y"),
        kind.add_option("--spp", job.sampling.samples,
                        "Samples per pixel whose mean is the colour: a grid if a square, else spread evenly;\n"
                        "default 1. Other channels are those of the middle")
            .in_range(1, 1 << 20)
            .type_name("N"),
        kind.add_option_function<std::string>(
                "--speed", [&job](const std::string& s) { job.options.speed = parse_number("--speed", s); },
                "1: the scene's own; 0: still. Flat scenes move so many pixels a frame to the right;\n"
                "default: 0 for zoneplate, edge, line, fence and glyphs, else 1")
            .type_name("S"),
        kind.add_option("--ao-rays", job.options.occlusion_rays,
                        "Random rays per pixel for the channel AO, as renderers do it; default 0: its truth")
            .in_range(0, 1000000)
            .type_name("N"),
    };
}

void check_scene(const SceneRequest& scene, const DrawingOptions& drawing) {
    check_output_format(drawing.out, drawing.depth, drawing.tile);
    check(job_of(scene, drawing));
}

void run_scene(const SceneRequest& scene, const DrawingOptions& drawing, Console& console) {
    const job::ScenePictureJob job = job_of(scene, drawing);
    const job::ScenePictureReport report = job::scene_picture(job, context_of(console, drawing.parallel));
    if (!drawing.json) return;
    console.print_json({{"kind", job.scene},
                        {"file", job.out},
                        {"width", job.size.width},
                        {"height", job.size.height},
                        {"channels", report.channels},
                        {"frame", job.frame},
                        {"jitter", {job.sampling.jitter.x, job.sampling.jitter.y}},
                        {"samples", job.sampling.samples},
                        {"depth", name_of(report.depth)},
                        {"transfer", name_of(report.transfer)},
                        {"threads", drawing.parallel.count()},
                        {"seconds", {{"render", report.seconds_rendering}, {"write", report.seconds_writing}}}});
}

}  // namespace bandlimit::app
