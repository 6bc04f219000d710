#include "bandlimit/job/resize.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bandlimit/io/taps_json.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/kernel/kernel.h"

namespace bandlimit::job {
namespace {

bool is_taps_file(const std::string& kernel) { return kernel.ends_with(".json"); }

int rounded_length(double length) {
    const double rounded = std::max(1.0, std::floor(length + 0.5));
    if (!(rounded <= 2147483647))
        throw OptionError(fmt::format("the new size would be {:.6g} pixels long; the limit is 2147483647", length));
    return static_cast<int>(rounded);
}

struct Size {
    int width, height;
};

Size target_size(const ResizeJob& job, const Region& region) {
    const bool has_sides = job.width > 0 || job.height > 0;
    if (has_sides == (job.scale != 0) || job.width < 0 || job.height < 0 || !(job.scale >= 0))
        throw OptionError(
            fmt::format("resize: scale {:g}, width {}, height {}; pass a scale above 0, or one side or "
                        "both in pixels",
                        job.scale, job.width, job.height));
    if (!has_sides) return {rounded_length(region.width * job.scale), rounded_length(region.height * job.scale)};
    return {job.width > 0 ? job.width : rounded_length(region.width * job.height / region.height),
            job.height > 0 ? job.height : rounded_length(region.height * job.width / region.width)};
}

Region source_region(const ResizeJob& job, const ImageInfo& in) {
    if (!job.region) return {0, 0, double(in.width), double(in.height)};
    const Region& r = *job.region;
    if (!(r.width > 0 && r.height > 0))
        throw OptionError("region",
                          fmt::format("{:g} x {:g} pixels are not an area; pass sides above 0", r.width, r.height));
    if (!(r.x >= 0 && r.y >= 0 && r.x + r.width <= in.width && r.y + r.height <= in.height))
        throw std::runtime_error(
            fmt::format("region: {:g},{:g},{:g},{:g} reaches outside {}, which is {} x {}; stay inside", r.x, r.y,
                        r.width, r.height, job.files.in, in.width, in.height));
    return r;
}

/// The axis of `count` samples over `length` source pixels from `begin`.
Axis target_axis(double begin, double length, int count, Align align) {
    if (align == Align::corners) return {count, begin, begin + length};
    // Pixels have a pitch of 1: as many cells as the length holds, at least one.
    return center_aligned({std::max(1, static_cast<int>(std::lround(length))), begin, begin + length}, count);
}

Grid target_grid(const ResizeJob& job, const ImageInfo& in) {
    const Region region = source_region(job, in);
    const Size size = target_size(job, region);
    return {target_axis(region.x, region.width, size.width, job.align),
            target_axis(region.y, region.height, size.height, job.align)};
}

Reconstruction reconstruction_of(const std::string& kernel) {
    if (kernel == "auto") return Auto{};
    if (!is_taps_file(kernel)) return parse_kernel(kernel);
    const TapsFile file = read_taps(kernel);
    if (is_kernel(file)) return kernel_of(file, kernel);
    return taps_of(file, kernel);
}

bool sums_to_zero(const Reconstruction& reconstruction) {
    const Taps* taps = std::get_if<Taps>(&reconstruction);
    return taps && cancels(taps->weights);
}

ResizeOptions resize_options(const ResizeJob& job) {
    ResizeOptions options;
    options.reconstruction = reconstruction_of(job.kernel);
    if (sums_to_zero(options.reconstruction)) options.edge = Edge::reflect;  // nothing to renormalize to
    if (job.edge) options.edge = *job.edge;
    options.antiring = job.antiring;
    options.premultiply = job.files.premultiplies();
    return options;
}

/// The background in linear light, for a picture with alpha.
std::vector<float> background_of(const ResizeJob& job, const ImageInfo& in) {
    const auto& codes = *job.background;
    const int colours = in.channels() - 1;
    const bool is_grey = codes[0] == codes[1] && codes[1] == codes[2];
    if (colours != 3 && !(colours == 1 && is_grey))
        throw std::runtime_error(
            fmt::format("a background of this colour does not fit {} colour channels of {}; use a grey for grey "
                        "pictures",
                        colours, job.files.in));
    const Space space = job.files.space == Space::data ? Space::linear : job.files.space;
    const Transfer transfer = in.encoding(space).transfer;
    std::vector<float> linear;
    for (int c = 0; c < colours; ++c)
        linear.push_back(static_cast<float>(decode(transfer, codes[static_cast<std::size_t>(c)])));
    return linear;
}

Resizer make_resizer(const ResizeJob& job, const Grid& src, const Grid& dst, int channels, const ResizeOptions& options,
                     const Parallel& parallel) {
    try {
        require_memory(Resizer::bytes(src, dst, channels, options, parallel),
                       fmt::format("resizing to {} x {} pixels", dst.x.count, dst.y.count));
        return Resizer(src, dst, channels, options);
    } catch (const Error& e) {
        if (is_taps_file(job.kernel)) throw OptionError(fmt::format("{}: {}", job.kernel, e.what()));
        throw;
    }
}

}  // namespace

ResizeReport resize(const ResizeJob& job, const Context& context) {
    ResizeReport report;
    static_cast<PictureReport&>(report) =
        filter_picture(job.files, job.background.has_value(), context, [&](const ImageInfo& in) {
            const Grid src{{in.width, 0, double(in.width)}, {in.height, 0, double(in.height)}};
            const Grid dst = target_grid(job, in);
            const ResizeOptions options = resize_options(job);
            const std::vector<float> background =
                in.alpha >= 0 && job.background ? background_of(job, in) : std::vector<float>();
            const Resizer resizer = make_resizer(job, src, dst, in.channels(), options, context.parallel);
            report.kernel_x = resizer.kernel_x(), report.kernel_y = resizer.kernel_y();
            report.edge = options.edge;
            return PictureFilter{resizer.rows(), "resizing", background};
        });
    return report;
}

}  // namespace bandlimit::job
