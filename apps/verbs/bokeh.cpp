// bandlimit bokeh: blur by the shape of an aperture.
#include <fmt/core.h>

#include "apps/verbs/picture_options.h"
#include "bandlimit/design/disk.h"
#include "bandlimit/job/bokeh.h"
#include "bandlimit/kernel/shapes.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    job::BokehJob job;
    WeightChoice weights;
};

void check(const Options& o) {
    job::check(o.job);
    check_pictures(o.pictures);
}

void run(const Options& o, Console& console) {
    job::BokehJob job = o.job;
    job.files = o.pictures.files;
    job.options = o.weights.options();
    print_report(console, "bokeh", o.pictures, job::bokeh(job, context_of(console, o.pictures.parallel)),
                 job.components, job.gamma);
}

/// All shapes, in lines of about 90 letters.
std::string shapes() {
    std::string names;
    for (const ShapeInfo& shape : shape_list()) {
        std::string name(shape.name);
        name.erase(name.find(":SIZE"), 5);
        const std::size_t in_line = names.size() - (names.rfind('\n') + 1);  // npos + 1 is 0
        names += names.empty() ? "" : in_line + name.size() > 90 ? ",\n" : ", ";
        names += name;
    }
    return names;
}

}  // namespace

void add_bokeh(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb =
        program.add_verb("bokeh", "Blur an image as a lens does: every light becomes a picture of the aperture",
                         "bandlimit bokeh examples/coffee.png bokeh.png --shape polygon:6:0.9:15 --radius 12 --hdr 7");
    add_pictures(verb, o->pictures);
    verb.add_option("--shape", o->job.shape,
                    "Aperture: disc (default), an image file, or a shape where 1 is the radius:\n" + shapes())
        .type_name("SHAPE|FILE");
    verb.add_option("--radius", o->job.radius, "Radius in pixels, fractions allowed").required().type_name("PX");
    verb.add_option("--hdr", o->job.gamma,
                    "Raise linear light to this power before, and undo it after: lights that the picture has at\n"
                    "white become as bright as they were, as with 7")
        .type_name("GAMMA");
    add_weight_options(verb, o->weights);
    verb.add_option("--components", o->job.components,
                    "Run this many complex phasors fitted to the disc instead: an approximation")
        .in_range(1, most_disk_components)
        .excludes(verb.option("--rank"))
        .excludes(verb.option("--exact"))
        .excludes(verb.option("--fft"))
        .type_name("N");
    add_edge(verb, o->weights.given.edge);
    add_colour(verb, o->pictures);
    add_output(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
