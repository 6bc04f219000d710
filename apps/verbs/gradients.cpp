// bandlimit gradients: derivatives, structure tensors and normal maps of a picture.
#include <fmt/core.h>

#include <algorithm>

#include "apps/verbs/picture_options.h"
#include "bandlimit/job/gradients.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

struct Options {
    PictureOptions pictures;
    job::GradientJob job;
    std::optional<Edge> edge;
    std::optional<double> sigma, height;
    std::optional<int> box;
    std::string coherence, convention, measure;

    bool has_window() const {
        return job.options.result == GradientResult::tensor || job.options.result == GradientResult::coherence;
    }
    bool has_normals() const { return job.options.result == GradientResult::normals; }
};

/// Refuses what the result has no use for.
void expect(bool is_given, bool is_used, const char* option, const Options& o, const char* with) {
    if (is_given && !is_used)
        throw UsageError(fmt::format("{}: {} has no use for it; leave it out, or use it with --result {}", option,
                                     name_of(o.job.options.result), with));
}

/// The second of two words, or the first.
template <class T>
T choice(const char* option, const std::string& word, const char* first, const char* second, T a, T b) {
    if (word.empty() || word == first) return a;
    if (word == second) return b;
    throw UsageError(fmt::format("{}: \"{}\" is unknown; choose {} or {}", option, word, first, second));
}

job::GradientJob job_of(const Options& o) {
    job::GradientJob job = o.job;
    job.files = o.pictures.files;
    if (o.has_normals() && job.files.space == Space::automatic) job.files.space = Space::data;
    job.options.edge = o.edge.value_or(Edge::reflect);
    job.options.window = o.box ? box_taps(*o.box) : gaussian_taps(o.sigma.value_or(1.5));
    job.options.coherence =
        choice("--coherence", o.coherence, "difference", "sqrt", Coherence::difference, Coherence::sqrt);
    job.options.height = o.height.value_or(1);
    job.options.convention =
        choice("--convention", o.convention, "opengl", "directx", NormalConvention::opengl, NormalConvention::directx);
    job.of_corners.measure = choice("--measure", o.measure, "shi-tomasi", "harris", CornerOptions::Measure::shi_tomasi,
                                    CornerOptions::Measure::harris);
    return job;
}

void check(const Options& o) {
    expect(o.sigma.has_value(), o.has_window(), "--sigma", o, "tensor or coherence");
    expect(o.box.has_value(), o.has_window(), "--box", o, "tensor or coherence");
    expect(!o.coherence.empty(), o.has_window(), "--coherence", o, "tensor or coherence");
    expect(o.height.has_value(), o.has_normals(), "--scale", o, "normals");
    expect(!o.convention.empty(), o.has_normals(), "--convention", o, "normals");
    check_pictures(o.pictures);
    job::check(job_of(o));
}

ordered_json json_of(const GradientPosition& p) { return ordered_json::array({p.x, p.y}); }

ordered_json json_of(const Options& o, const job::GradientJob& job, const job::GradientReport& r) {
    ordered_json report{{"input", file_json(job.files.in, r.input)},
                        {"output", file_json(job.files.out, r.output)},
                        {"operator", job.derivative},
                        {"result", name_of(job.options.result)},
                        {"edge", name_of(job.options.edge)}};
    if (const auto* gradient = std::get_if<Gradient>(&r.derivative)) {
        report["position"] = {{"dx", json_of(position_of_dx(*gradient))}, {"dy", json_of(position_of_dy(*gradient))}};
        report["ramp_gain"] = ramp_gain(*gradient);
    }
    if (o.has_window()) {
        report["window"] = o.box ? ordered_json{{"box", *o.box}} : ordered_json{{"sigma", o.sigma.value_or(1.5)}};
        report["coherence"] = job.options.coherence == Coherence::sqrt ? "sqrt" : "difference";
    }
    if (o.has_normals()) {
        report["scale"] = job.options.height;
        report["convention"] = job.options.convention == NormalConvention::opengl ? "opengl" : "directx";
    }
    if (r.corners) report["corners"] = {{"file", job.corners}, {"found", *r.corners}};
    report["space"] = name_of(job.files.space);
    report["alpha"] = job.files.premultiplies() ? "premultiply" : "straight";
    report["threads"] = o.pictures.parallel.count();
    report["seconds"] = {
        {"read", r.seconds.read}, {"filter", r.seconds.filter}, {"write", r.seconds.write}, {"total", r.seconds.total}};
    return report;
}

void run(const Options& o, Console& console) {
    const job::GradientJob job = job_of(o);
    const job::GradientReport r = job::gradients(job, context_of(console, o.pictures.parallel));
    if (o.pictures.json) return console.print_json(json_of(o, job, r));
    console.print("gradients: {} by {}, {:.3g} Mpixel/s\n", name_of(job.options.result), job.derivative,
                  double(r.input.width) * r.input.height / 1e6 / std::max(r.seconds.filter, 1e-9));
    if (r.corners) console.print("{}: {} corners\n", job.corners, *r.corners);
}

void add_result_options(Verb verb, const std::shared_ptr<Options>& o) {
    Option const sigma =
        verb.add_option("--sigma", o->sigma, "Sigma of the tensor's Gaussian window, in pixels (default 1.5)")
            .in_range(0.1, 50.0)
            .type_name("S");
    verb.add_option("--box", o->box, "A window of (2 R + 1) x (2 R + 1) equal weights instead")
        .in_range(0, 200)
        .excludes(sigma)
        .type_name("R");
    verb.add_option("--coherence", o->coherence,
                    "Of the eigenvalues a >= b: (a - b) / (a + b) (default), or the same of their square roots")
        .type_name("difference|sqrt");
    verb.add_option("--scale", o->height, "Height of the value 1, in pixels, for normals (default 1)")
        .in_range(-1e6, 1e6)
        .type_name("S");
    verb.add_option("--convention", o->convention,
                    "Green of normals: opengl (default) grows where the surface looks up, directx down")
        .type_name("opengl|directx");
}

void add_corner_options(Verb verb, Options& o) {
    Option const corners =
        verb.add_option("--corners", o.job.corners,
                        "Write the input's corners too, to a fraction of a pixel, the strongest first: .csv or .json.\n"
                        "The first pixel has its middle at 0.5, 0.5")
            .type_name("FILE");
    verb.add_option("--measure", o.measure, "Of corners: shi-tomasi (default), the smaller eigenvalue, or harris")
        .needs(corners)
        .type_name("shi-tomasi|harris");
    verb.add_option("--least", o.job.of_corners.least,
                    "Share of the strongest corner that others must have (default 0.05)")
        .in_range(0.0, 1.0)
        .needs(corners)
        .type_name("S");
}

}  // namespace

void add_gradients(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb =
        program.add_verb("gradients", "Differentiate an image: gradients, structure tensors, normal maps",
                         "bandlimit gradients examples/coffee.png edges.png\n"
                         "  bandlimit gradients examples/gravel.png normals.png --result normals --scale 4\n"
                         "  bandlimit gradients examples/coffee.png tensor.exr --operator diagonal3 --result tensor");
    add_pictures(verb, o->pictures);
    verb.add_option("--operator", o->job.derivative,
                    "scharr (default), forward, central, sobel, prewitt, diagonal, diagonal3, laplacian4,\n"
                    "laplacian8, log:S, gaussian:S (S in pixels), or taps:FILE, a taps.json as bandlimit design\n"
                    "derivative writes it. A ramp of slope 1 has gradient 1. dx of forward lies half a pixel to the\n"
                    "right and dy half a pixel below, diagonal both; all others lie on the pixel")
        .type_name("O");
    verb.add_option_function<std::string>(
            "--result", [o](const std::string& s) { o->job.options.result = parse_gradient_result(s); },
            "magnitude (default), dx (above 0 where values grow to the right) and dy (downward) of each\n"
            "channel; direction: hue = angle, saturation = magnitude; tensor: channels xx, xy, yy,\n"
            "strength, angle, coherence; coherence; normals of a height, which implies --space data;\n"
            "value: a Laplacian with its sign")
        .type_name("R");
    add_result_options(verb, o);
    add_corner_options(verb, *o);
    add_edge(verb, o->edge)
        .description("What lies outside the image; reflect (the default) repeats the border sample")
        .type_name("clamp|reflect|wrap|zero");
    add_colour(verb, o->pictures);
    add_output(program, verb, o->pictures);
    verb.option("--alpha").description(
        "premultiply (default): colours are multiplied by alpha before they are differentiated;\n"
        "straight: every channel by itself (default for --space data). Alpha is a channel like others");
    verb.option("--depth").description(
        "Depth of the output; default: f32 if the format holds it, else that of the "
        "input, or the\nnearest. Integers hold no values below 0 and above 1");
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
