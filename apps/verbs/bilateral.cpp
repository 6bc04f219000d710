// bandlimit bilateral: means that leave out what is unlike, by the picture itself or a guide.
#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "apps/verbs/picture_options.h"
#include "bandlimit/job/bilateral.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    job::BilateralJob job;
    std::optional<int> radius;
    std::optional<Edge> edge;
    bool is_bilinear = false;

    /// The job, once all options are known.
    job::BilateralJob made() const {
        job::BilateralJob made = job;
        made.files = pictures.files;
        made.options.radius = radius;
        made.options.edge_x = made.options.edge_y = edge.value_or(Edge::renormalize);
        if (is_bilinear) made.window = UpsampleWindow::bilinear;
        return made;
    }
};

/// A number of 0 or more, or inf.
double parse_sigma(const std::string& option, std::string_view text) {
    double value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size() || !(value >= 0))
        throw UsageError(fmt::format("{}: \"{}\" is not a sigma; pass 0 or more, or inf", option, text));
    return value;
}

std::vector<double> parse_sigmas(const std::string& option, std::string_view text) {
    std::vector<double> sigmas;
    for (std::size_t comma = text.find(','); comma != std::string_view::npos; comma = text.find(',')) {
        sigmas.push_back(parse_sigma(option, text.substr(0, comma)));
        text.remove_prefix(comma + 1);
    }
    sigmas.push_back(parse_sigma(option, text));
    return sigmas;
}

void print_report(Console& console, const Options& o, const job::BilateralJob& job, const job::BilateralReport& r) {
    const job::PictureReport::Seconds& seconds = r.seconds;
    const double rate = double(r.output.width) * r.output.height / 1e6 / std::max(seconds.filter, 1e-9);
    if (!o.pictures.json) {
        console.print("bilateral: {:.0f} weights per sample{}, a guide of {} channel{}, {:.3g} Mpixel/s\n", r.weights,
                      job.options.separable ? ", separable" : "", r.guide_channels, r.guide_channels == 1 ? "" : "s",
                      rate);
        return;
    }
    using nlohmann::ordered_json;
    const auto number = [](double sigma) { return std::isinf(sigma) ? ordered_json("inf") : ordered_json(sigma); };
    ordered_json report{{"input",
                         {{"file", job.files.in},
                          {"width", r.input.width},
                          {"height", r.input.height},
                          {"channels", r.input.channels},
                          {"depth", name_of(r.input.depth)}}},
                        {"output",
                         {{"file", job.files.out},
                          {"width", r.output.width},
                          {"height", r.output.height},
                          {"channels", r.output.channels},
                          {"depth", name_of(r.output.depth)}}},
                        {"guide", job.guide.empty() ? job.files.in : job.guide},
                        {"guide_channels", r.guide_channels}};
    if (!job.full_guide.empty()) {
        report["guide_full"] = job.full_guide;
        report["window"] = o.is_bilinear ? "bilinear" : "gaussian";
    }
    report["sigma_space"] = number(job.options.sigma_space);
    report["sigma_range"] = ordered_json::array();
    for (const double sigma : job.options.sigma_range) report["sigma_range"].push_back(number(sigma));
    report["radius"] = r.radius;
    report["weights"] = r.weights;
    report["separable"] = job.options.separable;
    report["edge"] = name_of(job.options.edge_x);
    report["megapixels_per_second"] = rate;
    report["space"] = name_of(job.files.space);
    report["alpha"] = job.files.premultiplies() ? "premultiply" : "straight";
    report["threads"] = o.pictures.parallel.count();
    report["seconds"] = {{"plan", seconds.plan},
                         {"read", seconds.read},
                         {"filter", seconds.filter},
                         {"write", seconds.write},
                         {"total", seconds.total}};
    console.print_json(report);
}

void check(const Options& o) {
    if (o.is_bilinear && o.job.full_guide.empty())
        throw UsageError("--bilinear: only upsampling has this window; pass --guide-full too");
    job::check(o.made());
    check_pictures(o.pictures);
}

void run(const Options& o, Console& console) {
    const job::BilateralJob job = o.made();
    print_report(console, o, job, job::bilateral(job, context_of(console, o.pictures.parallel)));
}

}  // namespace

void add_bilateral(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb(
        "bilateral", "Smooth an image, but not across the edges of itself or of a guide; upsample by a guide",
        "bandlimit bilateral examples/coffee.png smooth.png --sigma-space 2 --sigma-range 0.1");
    add_pictures(verb, o->pictures);
    verb.add_option_function<std::string>(
            "--sigma-space",
            [o](const std::string& s) { o->job.options.sigma_space = parse_sigma("--sigma-space", s); },
            "Sigma in space, in pixels of IN: each weight is exp(-d^2 / (2 sigma^2)) of the distance. 0 to inf")
        .required()
        .type_name("S");
    verb.add_option_function<std::string>(
            "--sigma-range",
            [o](const std::string& s) { o->job.options.sigma_range = parse_sigmas("--sigma-range", s); },
            "Sigma in range, in the values that --space gives: the same of the (Euclidean) difference of the\n"
            "guide's channels. 0 (only what is equal counts) to inf; or one for each channel, as 0.1,0.1,inf")
        .required()
        .type_name("R[,R...]");
    verb.add_option("--radius", o->radius, "The window is a square of (2 N + 1)^2 pixels; default: 3 S, rounded up")
        .in_range(0, most_bilateral_radius)
        .type_name("N");
    verb.add_option("--guide", o->job.guide, "Compare pixels of this image, of the size of IN, instead of IN's own")
        .type_name("G");
    Option const separable =
        verb.add_flag("--separable", o->job.options.separable,
                      "Filter along x, then along y: fast, but another filter, which leaves streaks");
    verb.add_option("--guide-full", o->job.full_guide,
                    "Upsample IN to the size of this image, with whose pixels those of the guide "
                    "(or of IN)\n"
                    "are compared. The window lies about the nearest pixel of IN; where nothing in "
                    "it is alike,\n"
                    "the pixel that is most alike is taken")
        .excludes(separable)
        .type_name("G2");
    verb.add_flag("--bilinear", o->is_bilinear,
                  "With --guide-full: the 2 x 2 pixels about, weighted as in bilinear interpolation, instead of S\n"
                  "and N");
    add_edge(verb, o->edge);
    add_colour(verb, o->pictures);
    add_output(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
