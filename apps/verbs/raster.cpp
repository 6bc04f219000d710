// bandlimit raster: points, lines and polygons, band-limited before they are sampled.
#include <nlohmann/json.hpp>

#include "apps/console/common.h"
#include "bandlimit/job/raster.h"

namespace bandlimit::app {
namespace {

struct Options {
    job::RasterJob job;
    Parallel parallel;
    bool json = false;
};

void check(const Options& o) {
    check_output_format(o.job.out, o.job.depth, o.job.tile);
    job::check(o.job);
}

nlohmann::ordered_json json_of(const Options& o, const job::RasterReport& report) {
    nlohmann::ordered_json json{{"scene", o.job.scene},
                                {"file", o.job.out},
                                {"width", report.width},
                                {"height", report.height},
                                {"channels", report.channels},
                                {"shapes", report.shapes},
                                {"filter", report.filter},
                                {"truth", o.job.truth},
                                {"depth", name_of(report.depth)},
                                {"transfer", name_of(report.transfer)},
                                {"threads", o.parallel.count()},
                                {"seconds",
                                 {{"read", report.seconds_reading},
                                  {"prepare", report.seconds_preparing},
                                  {"draw", report.seconds_drawing},
                                  {"truth", report.seconds_truth},
                                  {"write", report.seconds_writing}}}};
    if (report.rms) json["difference"] = {{"samples", o.job.compare}, {"rms", *report.rms}, {"max", *report.max_abs}};
    return json;
}

void run(const Options& o, Console& console) {
    const job::RasterReport report = job::raster(o.job, context_of(console, o.parallel));
    if (o.json) return console.print_json(json_of(o, report));
    if (report.rms)
        console.print("from the truth of {0} x {0} samples: RMS {1:.5f}, at most {2:.4f}, in linear light\n",
                      o.job.compare, *report.rms, *report.max_abs);
}

}  // namespace

void add_raster(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("raster", "Draw points, discs, lines and polygons without aliasing, by prefiltering",
                                 "bandlimit raster examples/wheel.json wheel.png\n"
                                 "  bandlimit raster examples/wheel.json wheel.exr --filter gaussian:0.5 --compare 16");
    verb.add_option("SCENE", o->job.scene,
                    "JSON: {width, height, filter, background: [r,g,b], shapes: [...]}; see docs/raster.md")
        .required();
    verb.add_option("OUT", o->job.out, "Image to write; the extension names the format").required();
    verb.add_option("--filter", o->job.filter,
                    "Instead of the scene's: cone:R, gaussian:SIGMA, or a kernel, as bspline or jinc3")
        .type_name("FILTER");
    Option truth = verb.add_option("--truth", o->job.truth,
                                   "Draw the truth instead: N x N samples per pixel, inside or outside, through the\n"
                                   "same filter")
                       .in_range(1, 64)
                       .type_name("N");
    verb.add_option("--compare", o->job.compare, "Also draw the truth of N x N samples, and print how far it is")
        .in_range(1, 64)
        .excludes(truth)
        .type_name("N");
    add_depth(verb, o->job.depth).description("Depth of the output; default: f32 for EXR, HDR and PFM, else u8");
    add_space(verb, o->job.space)
        .description(
            "What codes shall mean: auto (sRGB for 8 and 16 bit, else linear), srgb, or linear and data\n"
            "(codes are the values)");
    add_tiles(verb, o->job.tile);
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
