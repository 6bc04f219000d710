// bandlimit resize: the command line of the resampler.
#include <fmt/core.h>

#include "apps/verbs/picture_options.h"
#include "bandlimit/job/resize.h"
#include "bandlimit/kernel/kernel.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    job::ResizeJob job;
    std::string size, scale, region, background;
};

job::Region parse_region(const std::string& text) {
    const std::vector<double> n = parse_numbers("--region", text);
    if (n.size() != 4 || n[2] <= 0 || n[3] <= 0)
        throw UsageError(fmt::format(
            "--region: \"{}\" is not a region; write X,Y,WIDTH,HEIGHT in source pixels, e.g. 10,20,300,200", text));
    return {n[0], n[1], n[2], n[3]};
}

/// "ff8000" or "#ff8000" as three codes.
std::array<double, 3> parse_background(const std::string& text) {
    const std::string digits = text.starts_with('#') ? text.substr(1) : text;
    if (digits.size() != 6 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw UsageError(fmt::format("--background: \"{}\" is not a colour; write RRGGBB, as ffffff for white", text));
    const auto code = [&](std::size_t i) { return std::stoi(digits.substr(2 * i, 2), nullptr, 16) / 255.0; };
    return {code(0), code(1), code(2)};
}

/// What the command line alone shows to be wrong.
void check(const Options& o) {
    const int sizes = !o.size.empty() + !o.scale.empty() + (o.job.width > 0 || o.job.height > 0);
    if (sizes != 1)
        throw UsageError(
            "resize: the new size must be given exactly once; pass --size WxH, or --scale S, or --width W and/or "
            "--height H");
    if (!o.size.empty()) parse_size("--size", o.size);
    if (!o.scale.empty() && !(parse_number("--scale", o.scale) > 0))
        throw UsageError("--scale: a size cannot be 0 or less; pass a number above 0, e.g. 0.5 or 2");
    if (!(o.job.antiring >= 0 && o.job.antiring <= 1))  // a range check of the parser lets NaN pass
        throw UsageError(fmt::format("--antiring: {} is out of range; pass 0 to 1", o.job.antiring));
    if (!o.region.empty()) parse_region(o.region);
    if (!o.background.empty()) parse_background(o.background);
    if (o.job.kernel != "auto" && !o.job.kernel.ends_with(".json")) parse_kernel(o.job.kernel);
    check_pictures(o.pictures);
}

job::ResizeJob job_of(const Options& o) {
    job::ResizeJob job = o.job;
    job.files = o.pictures.files;
    if (!o.size.empty()) {
        const Size size = parse_size("--size", o.size);
        job.width = size.width, job.height = size.height;
    }
    if (!o.scale.empty()) job.scale = parse_number("--scale", o.scale);
    if (!o.region.empty()) job.region = parse_region(o.region);
    if (!o.background.empty()) job.background = parse_background(o.background);
    return job;
}

nlohmann::ordered_json json_of(const Options& o, const job::ResizeReport& r) {
    const job::PictureFiles& files = o.pictures.files;
    return {{"input", file_json(files.in, r.input)},
            {"output", file_json(files.out, r.output)},
            {"kernel", {{"x", r.kernel_x}, {"y", r.kernel_y}}},
            {"edge", name_of(r.edge)},
            {"align", o.job.align == job::Align::centers ? "centers" : "corners"},
            {"antiring", o.job.antiring},
            {"space", name_of(files.space)},
            {"alpha", files.premultiplies() ? "premultiply" : "straight"},
            {"threads", o.pictures.parallel.count()},
            {"seconds",
             {{"read", r.seconds.read},
              {"filter", r.seconds.filter},
              {"write", r.seconds.write},
              {"total", r.seconds.total}}}};
}

void run(const Options& o, Console& console) {
    const job::ResizeReport report = job::resize(job_of(o), context_of(console, o.pictures.parallel));
    if (o.pictures.json) console.print_json(json_of(o, report));
}

}  // namespace

void add_resize(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("resize", "Resample an image: in linear light, without bleeding, shift or aliasing",
                                 "bandlimit resize examples/coffee.png half.png --scale 0.5");
    add_pictures(verb, o->pictures);
    verb.add_option("--size", o->size, "New size").type_name("WxH");
    verb.add_option("--width", o->job.width, "New width; the height follows unless given")
        .in_range(1, 2147483647)
        .type_name("W");
    verb.add_option("--height", o->job.height, "New height; the width follows unless given")
        .in_range(1, 2147483647)
        .type_name("H");
    verb.add_option("--scale", o->scale, "New size as a multiple of the old, e.g. 0.5 or 1/3").type_name("S");
    verb.add_option("--kernel", o->job.kernel,
                    "Kernel (bandlimit analyze --list), or a taps.json; auto: shrink3 along an axis that shrinks,\n"
                    "grow3 along one that grows or keeps its size")
        .type_name("K|auto");
    add_edge(verb, o->job.edge);
    verb.add_option_function<std::string>(
            "--align",
            [o](const std::string& s) {
                if (s != "corners" && s != "centers")
                    throw UsageError("--align: \"" + s + "\" is unknown; choose corners or centers");
                o->job.align = s == "centers" ? job::Align::centers : job::Align::corners;
            },
            "What both images share: their corners (default), or the centres of their first and last\n"
            "samples, which other libraries call align_corners")
        .type_name("corners|centers");
    verb.add_option("--region", o->region,
                    "Part of the source to resample, in source pixels, fractions allowed;\n"
                    "what lies around it contributes at its borders")
        .type_name("X,Y,W,H");
    verb.add_option("--antiring", o->job.antiring, "Share of the overshoot to remove, 0 (default) to 1").type_name("A");
    add_colour(verb, o->pictures);
    verb.add_option("--background", o->background, "Opaque colour to lay the picture over; drops alpha")
        .type_name("RRGGBB");
    add_output(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
