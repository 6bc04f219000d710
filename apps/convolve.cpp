// bandlimit convolve: designed filters, and any weights, on pictures.
#include <fmt/core.h>

#include <cmath>

#include "apps/run_convolution.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit::app {
namespace {

struct Options {
    PictureOptions pictures;
    ConvolutionChoice choice;
    std::string taps, image, axis = "both";
    double radius = 0;
};

void check(const Options& o) {
    if (o.taps.empty() == o.image.empty())
        throw UsageError("convolve: weights are given no times or twice; give one of --taps FILE and --image KERNEL");
    if (o.axis != "x" && o.axis != "y" && o.axis != "both")
        throw UsageError(fmt::format("--axis: \"{}\" is unknown; choose x, y or both", o.axis));
    if (o.axis != "both" && o.taps.empty()) throw UsageError("--axis: an image has both axes; use it with --taps");
    check_pictures(o.pictures);
}

ConvolutionWeights weights_of(const Taps& taps, const std::string& axis) {
    const Taps one{0, {1}};
    const Taps &x = axis == "y" ? one : taps, &y = axis == "x" ? one : taps;
    return {Terms{{y.weights, x.weights}}, x.first, y.first};
}

/// Bilinear reads as the weights of the four samples about each.
ConvolutionWeights weights_of(const Fetches& fetches, const std::string& path) {
    constexpr double most = 2048;
    double left = 0, right = 0, top = 0, bottom = 0;
    for (const Fetch& f : fetches) {
        left = std::min(left, std::floor(f.x)), right = std::max(right, std::floor(f.x) + 1);
        top = std::min(top, std::floor(f.y)), bottom = std::max(bottom, std::floor(f.y) + 1);
    }
    if (!(right - left <= most && bottom - top <= most))
        throw std::runtime_error(fmt::format("{}: fetches lie {} x {} texels apart; the limit is {}", path,
                                             right - left, bottom - top, most));
    WeightGrid grid(static_cast<int>(right - left) + 1, static_cast<int>(bottom - top) + 1);
    for (const Fetch& f : fetches) {
        const int x = static_cast<int>(std::floor(f.x) - left), y = static_cast<int>(std::floor(f.y) - top);
        const double u = f.x - std::floor(f.x), v = f.y - std::floor(f.y);
        grid.at(x, y) += f.weight * (1 - u) * (1 - v);
        grid.at(x + 1, y) += f.weight * u * (1 - v);
        grid.at(x, y + 1) += f.weight * (1 - u) * v;
        grid.at(x + 1, y + 1) += f.weight * u * v;
    }
    return {grid, static_cast<int>(left), static_cast<int>(top)};
}

ChosenWeights weights_of_file(const Options& o) {
    const TapsFile file = read_taps(o.taps);
    ChosenWeights chosen;
    chosen.name = o.taps;
    if (file.factor != 1)
        throw UsageError(
            fmt::format("{}: made for a factor of {}, and convolve keeps the size; use bandlimit resize "
                        "--kernel, or weights of factor 1",
                        o.taps, file.factor));
    if (o.axis != "both" && !file.taps)
        throw UsageError(fmt::format("--axis {}: {} has no taps of one axis; leave the option out", o.axis, o.taps));
    if (o.radius > 0 && (file.components.empty() || !file.terms.empty()))
        throw UsageError(fmt::format("--radius: {} has its size; only components without terms need one", o.taps));
    if (file.taps) {
        chosen.weights = weights_of(*file.taps, o.axis);
    } else if (!file.terms.empty()) {
        chosen.weights = centred(file.terms);
    } else if (!file.fetches.empty()) {
        chosen.weights = weights_of(file.fetches, o.taps);
    } else if (o.radius > 0) {
        chosen.weights = centred(separable_terms(file.components, o.radius, reach_for(file.components, o.radius)));
    } else if (is_kernel(file)) {
        throw UsageError(
            fmt::format("{}: holds a kernel, whose weights depend on a scale; use bandlimit resize --kernel", o.taps));
    } else if (file.components.empty()) {
        throw UsageError(fmt::format("{}: holds no weights; pass taps, fetches, terms or components", o.taps));
    } else {
        throw UsageError(fmt::format("{}: has components, which fit any radius; say which, with --radius PX", o.taps));
    }
    chosen.components = static_cast<int>(file.components.size());
    return chosen;
}

void run(const Options& o, Console& console) {
    ChosenWeights chosen;
    if (o.taps.empty()) chosen = {centred(read_weights(o.image)), 0, 1, o.image};
    else chosen = weights_of_file(o);
    filter_picture(o.pictures, console, [&](const ImageInfo& in) {
        return convolution_filter("convolve", std::move(chosen), o.choice, o.pictures, in, console);
    });
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
    add_choice(verb, o->choice);
    add_picture_options(program, verb, o->pictures);
    program.on(
        verb, [o] { check(*o); }, [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
