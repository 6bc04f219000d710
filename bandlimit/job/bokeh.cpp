#include "bandlimit/job/bokeh.h"

#include <fmt/core.h>

#include <cmath>

#include "bandlimit/design/disk.h"
#include "bandlimit/filter/bokeh.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/weights.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::job {
namespace {

std::string shape_of(const BokehJob& job) {
    return job.shape == "disc" || job.shape == "circle" ? "disc:1" : job.shape;
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

ConvolutionWeights weights_of(const BokehJob& job) {
    if (job.components > 0) {
        const Components disk = fit_disk(job.components);
        return centred(separable_terms(disk, job.radius, reach_for(disk, job.radius)));
    }
    const std::string shape = shape_of(job);
    // Lights shall have the shape as it is drawn, not turned.
    return turned(centred(is_shape_name(shape) ? aperture(shape, job.radius) : aperture_of_image(shape, job.radius)));
}

}  // namespace

void check(const BokehJob& job) {
    if (!(job.radius >= 0.5 && job.radius <= 1000))
        throw OptionError("radius", fmt::format("{} is out of range; pass 0.5 to 1000 pixels", job.radius));
    if (!(job.gamma >= 0.1 && job.gamma <= 16))
        throw OptionError("hdr", fmt::format("{} is out of range; pass 0.1 to 16, e.g. 7", job.gamma));
    const std::string shape = shape_of(job);
    if (job.components > 0 && shape != "disc:1")
        throw OptionError("components", fmt::format("{} stand for a disc, not for \"{}\"; use a rank instead",
                                                    job.components, job.shape));
    if (is_shape_name(shape)) parse_shape(shape, 64);
}

ConvolveReport bokeh(const BokehJob& job, const Context& context) {
    check(job);
    return convolve_by([&] { return weights_of(job); }, fmt::format("{} of radius {:g}", job.shape, job.radius),
                       job.files, job.options, job.gamma, "blurring", context);
}

}  // namespace bandlimit::job
