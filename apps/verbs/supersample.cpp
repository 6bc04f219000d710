// bandlimit supersample: scenes with many samples per pixel, and what patterns and kernels do to them.
#include <fmt/core.h>

#include <cmath>

#include <nlohmann/json.hpp>
#include "apps/console/common.h"
#include "bandlimit/job/supersample.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

struct Options {
    job::SupersampleJob job;
    std::string size, pattern = "sobol:16:1", kernel = "blackman-harris", reconstruction, tone = "none", mixed;
    std::optional<int> seed;
    Parallel parallel;
    bool json = false;
};

job::SupersampleJob job_of(const Options& o) {
    job::SupersampleJob job = o.job;
    const Size size = parse_size("--size", o.size);
    job.width = size.width, job.height = size.height;
    job.options = {parse_pattern(o.pattern), parse_kernel(o.kernel), {}, parse_tone_weight(o.tone), {}};
    if (!o.reconstruction.empty()) job.options.reconstruction = parse_kernel(o.reconstruction);
    if (o.seed) job.options.pixel_seed = static_cast<std::uint64_t>(*o.seed);
    if (!o.mixed.empty()) job.mixed = parse_mixed(o.mixed);
    return job;
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    if (!o.mixed.empty() && (!o.reconstruction.empty() || o.tone != "none" || o.seed))
        throw UsageError(
            "supersample: --mixed takes its samples as they are; leave out --reconstruct, --tone and --vary");
    const job::SupersampleJob job = job_of(o);
    check_output_format(job.out, job.depth, 0);
    job::check(job);
}

// ---- Printing

ordered_json to_json(const job::ResolveReport& r) {
    ordered_json edges = ordered_json::array(), counts = edges, mixed = edges, shading = edges;
    for (const EdgeSweep& e : r.edges)
        edges.push_back({{"degrees", e.degrees}, {"levels", e.levels}, {"max_gap", e.max_gap}, {"rms", e.rms}});
    for (const job::PsnrOfCount& c : r.counts)
        counts.push_back({{"samples", c.samples}, {"psnr", std::isfinite(c.psnr) ? ordered_json(c.psnr) : nullptr}});
    for (const job::MixedError& m : r.mixed)
        mixed.push_back({{"mode", name_of(m.mode)}, {"kernel", m.kernel}, {"rmse", m.rmse}});
    for (const job::ShadingError& s : r.shading)
        shading.push_back({{"shading", s.shading}, {"filtered", s.is_filtered}, {"rmse", s.rmse}});
    return {{"edges", edges},
            {"alias_energy", r.alias_energy},
            {"psnr", counts},
            {"tone_bias", r.tone_bias ? ordered_json(*r.tone_bias) : ordered_json()},
            {"mixed_resolution", mixed},
            {"outline", shading}};
}

void run(const Options& o, Console& console) {
    const job::SupersampleJob job = job_of(o);
    const job::Context context = context_of(console, o.parallel);
    const job::SupersampleSummary summary = job::supersample(job, context);
    if (!o.json) return;
    ordered_json out{{"scene", job.scene},
                     {"file", job.out},
                     {"width", job.width},
                     {"height", job.height},
                     {"frame", job.frame},
                     {"pattern", job.mixed ? ordered_json() : ordered_json(job.options.pattern.name)},
                     {"mixed", job.mixed ? ordered_json(name_of(*job.mixed)) : ordered_json()},
                     {"kernel", job.options.kernel.name},
                     {"reconstruction",
                      job.options.reconstruction ? ordered_json(job.options.reconstruction->name) : ordered_json()},
                     {"tone", name_of(job.options.tone)},
                     {"samples_per_pixel", summary.samples_per_pixel},
                     {"mean_luma", summary.mean_luma},
                     {"threads", o.parallel.count()},
                     {"seconds", summary.seconds}};
    out.update(to_json(job::report_on(job, context)));
    console.print_json(out);
}

}  // namespace

void add_supersample(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb =
        program.add_verb("supersample", "Draw a scene with many samples per pixel",
                         "bandlimit supersample plane plane.png --size 160x90 --pattern sobol:16:1 --kernel mitchell");
    std::string scenes;
    for (const std::string& name : scene_names()) scenes += (scenes.empty() ? "" : ", ") + name;
    verb.add_option("SCENE", o->job.scene, "One of " + scenes).required();
    verb.add_option("OUT", o->job.out, "Image to write; the extension names the format").required();
    verb.add_option("--size", o->size, "Size in pixels, e.g. 480x270").required().type_name("WxH");
    verb.add_option("--pattern", o->pattern,
                    "Where the samples of a pixel lie (analyze --list-patterns shows them); default sobol:16:1")
        .type_name("NAME[:N]");
    verb.add_option("--kernel", o->kernel,
                    "What makes a pixel of the samples around it (analyze --list shows the kernels), in pixels of the\n"
                    "output; default blackman-harris")
        .type_name("KERNEL");
    verb.add_option("--frame", o->job.frame, "Which frame of a scene that moves; default 0")
        .in_range(-1000000, 1000000)
        .type_name("F");
    verb.add_option(
            "--reconstruct", o->reconstruction,
            "Make a continuous picture of the samples first, by a kernel as wide as they are apart, and filter\n"
            "that: both steps are one table of weights. Default: the samples are filtered themselves")
        .type_name("KERNEL");
    verb.add_option("--tone", o->tone,
                    "How samples far brighter than white weigh less, so that their edges look smooth: none (default),\n"
                    "karis or lottes. An edge of light L on black becomes L / (2 + L) where it should be L / 2")
        .type_name("none|karis|lottes");
    verb.add_option("--vary", o->seed,
                    "Another pattern in each pixel, chosen by this seed: errors become noise. The same in all frames")
        .in_range(0, 2147483647)
        .type_name("SEED");
    const Option pattern = verb.option("--pattern");
    verb.add_option(
            "--mixed", o->mixed,
            "Instead of --pattern: one sample per pixel (full), or half of that, as a smaller picture (uniform),\n"
            "every other row (interlaced) or a checkerboard; the kernel fills in the rest")
        .type_name("full|uniform|interlaced|checkerboard")
        .excludes(pattern);
    add_depth(verb, o->job.depth).description("Depth of the output; default: f32 for EXR, HDR and PFM, else u8");
    add_threads(verb, o->parallel);
    add_json(verb, o->json)
        .description(
            "Print a report as JSON on stdout: the levels and errors of edges, what aliases on a zone plate, PSNR per\n"
            "number of samples, half resolutions, and multisampling, which take a few seconds more");
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
