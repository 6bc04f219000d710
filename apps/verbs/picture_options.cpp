#include "apps/verbs/picture_options.h"

#include <fmt/core.h>

#include <algorithm>

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

std::string line_of(const MethodCost& cost, WeightSize size) {
    const std::string terms =
        cost.method == Method::low_rank ? fmt::format(" of {} products", cost.rank) : std::string();
    return fmt::format("{} x {} weights, {}{}, {:.0f} multiply-adds per sample", size.width, size.height,
                       name_of(cost.method), terms, cost.multiply_adds);
}

}  // namespace

void add_pictures(Verb verb, PictureOptions& o) {
    verb.add_option("IN", o.files.in, "Image to read").required();
    verb.add_option("OUT", o.files.out, "Image to write; the extension names the format").required();
}

void add_colour(Verb verb, PictureOptions& o) {
    add_space(verb, o.files.space);
    verb.add_option_function<std::string>(
            "--alpha",
            [&premultiply = o.files.premultiply](const std::string& s) {
                if (s != "premultiply" && s != "straight")
                    throw UsageError("--alpha: \"" + s + "\" is unknown; choose premultiply or straight");
                premultiply = s == "premultiply";
            },
            "premultiply (default): transparent texels do not bleed, and come out with colour 0;\n"
            "straight: every channel by itself (default for --space data)")
        .type_name("premultiply|straight");
}

void add_output(Program& program, Verb verb, PictureOptions& o) {
    add_depth(verb, o.files.depth);
    add_tiles(verb, o.files.tile);
    add_threads(verb, o.parallel);
    add_json(verb, o.json);
    program.add_quiet(verb);
}

ordered_json file_json(const std::string& file, const job::PictureSummary& picture) {
    return {{"file", file},
            {"width", picture.width},
            {"height", picture.height},
            {"channels", picture.channels},
            {"depth", name_of(picture.depth)}};
}

void check_pictures(const PictureOptions& o) { check_output_format(o.files.out, o.files.depth, o.files.tile); }

void add_weight_options(Verb verb, WeightChoice& weights) {
    Option const rank =
        verb.add_option("--rank", weights.given.rank, "Run the nearest sum of N products instead: an approximation")
            .in_range(1, 4096)
            .type_name("N");
    Option const exact = verb.add_flag("--exact", weights.is_exact, "Run every weight by itself").excludes(rank);
    verb.add_flag("--fft", weights.is_fft, "Run by Fourier transforms").excludes(rank).excludes(exact);
    verb.add_flag("--keep-sum", weights.given.keeps_sum,
                  "Run weights as they are; without, they are divided by their sum");
}

void print_report(Console& console, const std::string& verb, const PictureOptions& o, const job::ConvolveReport& r,
                  int components, double gamma) {
    const job::PictureReport::Seconds& seconds = r.seconds;
    const double rate = double(r.input.width) * r.input.height / 1e6 / std::max(seconds.filter, 1e-9);
    if (!o.json) {
        console.print("{}: {}, {:.3g} Mpixel/s\n", verb, line_of(r.chosen, r.size), rate);
        return;
    }
    ordered_json report{
        {"input", file_json(o.files.in, r.input)},
        {"output", {{"file", o.files.out}, {"channels", r.output.channels}, {"depth", name_of(r.output.depth)}}},
        {"weights", {{"of", r.name}, {"width", r.size.width}, {"height", r.size.height}}},
        {"sum", r.sum},
        {"method", name_of(r.chosen.method)},
        {"rank", r.rank > 0 ? ordered_json(r.rank) : ordered_json()},
        {"multiply_adds", r.chosen.multiply_adds}};
    if (components > 0) report["components"] = components;
    if (gamma != 1) report["hdr"] = gamma;
    report["edge"] = name_of(r.edge);
    for (const MethodCost& c : r.candidates)
        report["candidates"].push_back({{"method", name_of(c.method)},
                                        {"multiply_adds", c.multiply_adds},
                                        {"relative_time", c.time / r.chosen.time}});
    report["megapixels_per_second"] = rate;
    report["space"] = name_of(o.files.space);
    report["alpha"] = o.files.premultiplies() ? "premultiply" : "straight";
    report["threads"] = o.parallel.count();
    report["seconds"] = {{"plan", seconds.plan},
                         {"read", seconds.read},
                         {"filter", seconds.filter},
                         {"write", seconds.write},
                         {"total", seconds.total}};
    console.print_json(report);
}

}  // namespace bandlimit::app
