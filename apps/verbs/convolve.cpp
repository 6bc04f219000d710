// bandlimit convolve: designed filters, and any weights, on pictures.
#include <fmt/core.h>

#include "apps/verbs/picture_options.h"
#include "bandlimit/job/convolve.h"
#include "bandlimit/job/weights.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    WeightChoice weights;
    std::string taps, image, axis = "both";
    double radius = 0;

    job::TapsAxis taps_axis() const {
        return axis == "x" ? job::TapsAxis::x : axis == "y" ? job::TapsAxis::y : job::TapsAxis::both;
    }
};

void check(const Options& o) {
    if (o.taps.empty() == o.image.empty())
        throw UsageError(
            "convolve: the weights must come from exactly one place; pass either --taps FILE or --image KERNEL");
    if (o.axis != "x" && o.axis != "y" && o.axis != "both")
        throw UsageError(fmt::format("--axis: \"{}\" is unknown; choose x, y or both", o.axis));
    if (o.axis != "both" && o.taps.empty()) throw UsageError("--axis: an image has both axes; use it with --taps");
    check_pictures(o.pictures);
}

void run(const Options& o, Console& console) {
    job::ConvolveJob job{o.pictures.files, {}, o.taps.empty() ? o.image : o.taps, o.weights.options()};
    int components = 0;
    if (o.taps.empty()) {
        job.weights = centred(job::read_weights(o.image));
    } else {
        const TapsFile file = read_taps(o.taps);
        job.weights = job::weights_of(file, o.taps, o.taps_axis(), o.radius);
        components = static_cast<int>(file.components.size());
    }
    print_report(console, "convolve", o.pictures, job::convolve(job, context_of(console, o.pictures.parallel)),
                 components);
}

}  // namespace

void add_convolve(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("convolve", "Run designed filters, or any weights, on an image",
                                 "bandlimit convolve examples/coffee.png soft.png --taps examples/binomial.json");
    add_pictures(verb, o->pictures);
    verb.add_option("--taps", o->taps,
                    "Weights of a taps.json, as bandlimit design writes it: along both axes for taps")
        .type_name("FILE");
    verb.add_option("--image", o->image,
                    "Weights of an image, centred: the mean of its colours times alpha, as codes have it.\n"
                    "Each output is the sum of what the weights lie over (correlation, as taps have it): a spot\n"
                    "becomes the image turned by half a turn")
        .type_name("KERNEL");
    verb.add_option("--axis", o->axis, "Axis for taps of one axis (default both)").type_name("x|y|both");
    verb.add_option("--radius", o->radius, "Radius in pixels, for components of a taps.json")
        .in_range(0.5, 1000.0)
        .type_name("PX");
    add_weight_options(verb, o->weights);
    add_edge(verb, o->weights.given.edge);
    add_colour(verb, o->pictures);
    add_output(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
