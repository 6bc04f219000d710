// bandlimit guided: what is clean in a guide makes what is noisy, or small, clean and large.
#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "apps/verbs/picture_options.h"
#include "bandlimit/job/guided.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    job::GuidedJob job;
    std::optional<Edge> edge;

    /// The job, once all options are known.
    job::GuidedJob made() const {
        job::GuidedJob made = job;
        made.files = pictures.files;
        made.options.edge = edge.value_or(Edge::renormalize);
        return made;
    }
};

/// A number of 0 or more, or inf.
double parse_epsilon(const std::string& text) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size() || !(value >= 0))
        throw UsageError(fmt::format("--epsilon: \"{}\" is not a variance; pass 0 or more, or inf", text));
    return value;
}

nlohmann::ordered_json json_of(const Options& o, const job::GuidedJob& job, const job::GuidedReport& r, double rate) {
    const LocalModelOptions& options = job.options;
    nlohmann::ordered_json report{{"input", file_json(job.files.in, r.input)},
                                  {"output", file_json(job.files.out, r.output)},
                                  {"guide", job.guide},
                                  {"guide_channels", r.guide_channels}};
    if (!job.full_guide.empty()) report["guide_full"] = job.full_guide;
    if (!job.save_models.empty()) report["models"] = job.save_models;
    report["radius"] = options.radius;
    if (std::isinf(options.epsilon)) report["epsilon"] = "inf";
    else report["epsilon"] = options.epsilon;
    report["window"] = name_of(options.window);
    if (options.window == WindowShape::gaussian) report["sigma"] = gaussian_sigma(options.radius);
    report["order"] = options.order;
    report["terms"] = r.terms;
    report["coefficients"] = options.averages ? "average" : "centre";
    report["edge"] = name_of(options.edge);
    report["megapixels_per_second"] = rate;
    report["space"] = name_of(job.files.space);
    report["alpha"] = job.files.premultiplies() ? "premultiply" : "straight";
    report["threads"] = o.pictures.parallel.count();
    report["seconds"] = {{"plan", r.seconds.plan},
                         {"read", r.seconds.read},
                         {"filter", r.seconds.filter},
                         {"write", r.seconds.write},
                         {"total", r.seconds.total}};
    return report;
}

void run(const Options& o, Console& console) {
    const job::GuidedJob job = o.made();
    const job::GuidedReport r = job::guided(job, context_of(console, o.pictures.parallel));
    const double rate = double(r.output.width) * r.output.height / 1e6 / std::max(r.seconds.filter, 1e-9);
    if (o.pictures.json) console.print_json(json_of(o, job, r, rate));
    else
        console.print("guided: models of {} term{} from a guide of {} channel{}, {:.3g} Mpixel/s\n", r.terms,
                      r.terms == 1 ? "" : "s", r.guide_channels, r.guide_channels == 1 ? "" : "s", rate);
}

}  // namespace

void add_guided(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb(
        "guided", "Fit an image to a guide, window by window, and apply the fit: smooth, fill holes, upsample",
        "bandlimit guided examples/coffee.png smooth.png --guide examples/coffee.png --radius 8 --epsilon 0.01");
    add_pictures(verb, o->pictures);
    verb.add_option("--guide", o->job.guide,
                    "Image of the size of IN that IN is fitted to: all of its channels but alpha, which guides with\n"
                    "--space data alone. --space says what its codes mean, too")
        .required()
        .type_name("G");
    verb.add_option("--radius", o->job.options.radius, "Radius of the windows in pixels").required().type_name("R");
    verb.add_option_function<std::string>(
            "--epsilon", [o](const std::string& s) { o->job.options.epsilon = parse_epsilon(s); },
            "Variance that counts as noise of the guide, in its squared values: added to the variance of each of its\n"
            "channels. 0 follows all that the guide shows; inf gives means of windows")
        .required()
        .type_name("E");
    verb.add_option_function<std::string>(
            "--window", [o](const std::string& s) { o->job.options.window = parse_window_shape(s); },
            "box (default): (2R+1)^2 pixels alike, at a cost that does not depend on R;\n"
            "gaussian: sigma = sqrt(R(R+1)/3), the box's")
        .type_name("box|gaussian");
    verb.add_option("--order", o->job.options.order,
                    "1 (default): linear in the channels of the guide; 2: with their squares and products")
        .type_name("1|2");
    verb.add_flag("--average", o->job.options.averages,
                  "Use the mean of the models of the windows about a pixel, instead of its own: smoother");
    verb.add_option("--guide-full", o->job.full_guide,
                    "Apply the models to this image, whose size OUT gets: upsampling. IN and --guide are small")
        .type_name("G2");
    verb.add_option("--save-models", o->job.save_models, "Write the models, a channel per coefficient")
        .type_name("EXR");
    add_edge(verb, o->edge);
    add_colour(verb, o->pictures);
    add_output(program, verb, o->pictures);
    program.on(
        verb,
        [o] {
            job::check(o->made());
            check_pictures(o->pictures);
        },
        [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
