// bandlimit bokeh: blur by the shape of an aperture.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "apps/run_convolution.h"
#include "bandlimit/design/disk.h"
#include "bandlimit/filter/bokeh.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    ConvolutionChoice choice;
    std::string shape = "disc";
    double radius = 0, gamma = 1;
    int components = 0;

    /// Names of shapes have no dots but in parameters.
    bool is_image() const { return std::filesystem::path(shape.substr(0, shape.find(':'))).has_extension(); }
    std::string shape_text() const { return shape == "disc" || shape == "circle" ? "disc:1" : shape; }
};

void check(const Options& o) {
    if (!(o.radius >= 0.5 && o.radius <= 1000))
        throw UsageError(fmt::format("--radius: {} is out of range; pass 0.5 to 1000 pixels", o.radius));
    if (!(o.gamma >= 0.1 && o.gamma <= 16))
        throw UsageError(fmt::format("--hdr: {} is out of range; pass 0.1 to 16, e.g. 7", o.gamma));
    if (o.components > 0 && o.shape_text() != "disc:1")
        throw UsageError(fmt::format("--components: stand for a disc, not for \"{}\"; use --rank", o.shape));
    if (!o.is_image()) parse_shape(o.shape_text(), 64);
    check_pictures(o.pictures);
}

/// An image of an aperture, so large that its longer side is twice the radius.
WeightGrid aperture_of_image(const std::string& path, double radius) {
    const WeightGrid whole = read_weights(path);
    const double longer = std::max(whole.width, whole.height), pixel = longer / (2 * radius);
    Image<float> from(whole.width, whole.height), to;
    for (int y = 0; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x) from.view()(x, y) = static_cast<float>(whole.at(x, y));
    const auto axis = [&](int count) {
        const int reach = static_cast<int>(std::ceil(count / pixel / 2 - 0.5));
        const double half = (reach + 0.5) * pixel;
        return Axis{2 * reach + 1, count / 2.0 - half, count / 2.0 + half};
    };
    const Grid src{{whole.width, 0, double(whole.width)}, {whole.height, 0, double(whole.height)}};
    const Grid dst{axis(whole.width), axis(whole.height)};
    to = Image<float>(dst.x.count, dst.y.count);
    // Where pixels are larger than those of the image, a tent; else means of what lies under them.
    const ResizeOptions options{.reconstruction = pixel >= 1 ? box() : tent(), .edge = Edge::zero};
    Resizer(src, dst, 1, options).run({std::as_const(from).view(), 0, {}}, {to.view(), 0, {}, {}});
    WeightGrid grid(dst.x.count, dst.y.count);
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) grid.at(x, y) = static_cast<double>(to.view()(x, y));
    return grid;
}

ChosenWeights weights_of(const Options& o) {
    ChosenWeights chosen{{}, o.components, o.gamma, fmt::format("{} of radius {:g}", o.shape, o.radius)};
    if (o.components > 0) {
        const Components disk = fit_disk(o.components);
        chosen.weights = centred(separable_terms(disk, o.radius, reach_for(disk, o.radius)));
        return chosen;
    }
    // Lights shall have the shape as it is drawn, not turned.
    chosen.weights =
        turned(centred(o.is_image() ? aperture_of_image(o.shape, o.radius) : aperture(o.shape_text(), o.radius)));
    return chosen;
}

void run(const Options& o, Console& console) {
    filter_picture(o.pictures, console, [&](const ImageInfo& in) {
        return convolution_filter("bokeh", weights_of(o), o.choice, o.pictures, in, console);
    });
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
    verb.add_option("--shape", o->shape,
                    "Aperture: disc (default), an image file, or a shape where 1 is the radius:\n" + shapes())
        .type_name("SHAPE|FILE");
    verb.add_option("--radius", o->radius, "Radius in pixels, fractions allowed").required().type_name("PX");
    verb.add_option("--hdr", o->gamma,
                    "Raise linear light to this power before, and undo it after: lights that the picture has at\n"
                    "white become as bright as they were, as with 7")
        .type_name("GAMMA");
    add_choice(verb, o->choice);
    verb.add_option("--components", o->components,
                    "Run this many complex phasors fitted to the disc instead: an approximation")
        .in_range(1, most_disk_components)
        .excludes(verb.option("--rank"))
        .excludes(verb.option("--exact"))
        .excludes(verb.option("--fft"))
        .type_name("N");
    add_picture_options(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
