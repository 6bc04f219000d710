#include "bandlimit/job/bilateral.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

/// A guide in memory, or none where there is no path.
Image<float> read_guide(const std::string& path, Space space, const Parallel& parallel) {
    if (path.empty()) return {};
    const ImageInfo info = ImageReader(path, parallel.threads).info();
    require_memory(
        std::uint64_t(info.width) * std::uint64_t(info.height) * std::uint64_t(info.channels()) * sizeof(float),
        fmt::format("the guide {}, of {} x {} pixels,", path, info.width, info.height));
    return read_picture(path, space, parallel);
}

/// An empty view for an empty image.
View<const float> view_of_any(const Image<float>& image) {
    return image.width() > 0 ? image.view() : View<const float>{};
}

/// Where the input, or the guide beside it, is to be compared with a guide of the output.
void check_channels(const BilateralJob& job, int channels, const Image<float>& full) {
    if (full.width() == 0 || channels == full.channels()) return;
    const bool has_guide = !job.guide.empty();
    throw std::runtime_error(fmt::format("{} has {} channels and {} has {}; pass {} of the same channels",
                                         has_guide ? job.guide : job.files.in, channels, job.full_guide,
                                         full.channels(), has_guide ? "guides" : "a guide of the input's size, and"));
}

void check_guides(const BilateralJob& job, const ImageInfo& in, const Image<float>& guide, const Image<float>& full) {
    if (guide.width() > 0 && (guide.width() != in.width || guide.height() != in.height))
        throw std::runtime_error(fmt::format("{} is {} x {} and {} is {} x {}; pass a guide of the size of the input",
                                             job.guide, guide.width(), guide.height(), job.files.in, in.width,
                                             in.height));
    const int channels = guide.width() > 0 ? guide.channels() : in.channels();
    check_channels(job, channels, full);
    const std::size_t sigmas = job.options.sigma_range.size();
    if (sigmas != 1 && sigmas != static_cast<std::size_t>(channels))
        throw OptionError("sigma-range", fmt::format("{} values for a guide of {} channels; pass one for all, or one "
                                                     "for each",
                                                     sigmas, channels));
}

}  // namespace

void check(const BilateralJob& job) {
    try {
        check_bilateral(job.options);
    } catch (const Error& e) {
        // "sigma-space: ...": names of options, as they are here
        const std::string text = e.what();
        const std::size_t colon = text.find(": ");
        throw OptionError(text.substr(0, colon), text.substr(colon + 2));
    }
    if (job.options.separable && !job.full_guide.empty())
        throw OptionError("separable", "upsampling has no separable form; leave it out");
}

BilateralReport bilateral(const BilateralJob& job, const Context& context) {
    check(job);
    check_output_path(job.files.out);
    BilateralOptions options = job.options;
    options.premultiply = job.files.premultiplies();
    BilateralReport report;
    const Image<float> guide = read_guide(job.guide, job.files.space, context.parallel);
    const Image<float> full = read_guide(job.full_guide, job.files.space, context.parallel);
    const auto make = [&](const ImageInfo& in) {
        check_guides(job, in, guide, full);
        const bool upsamples = full.width() > 0, is_bilinear = upsamples && job.window == UpsampleWindow::bilinear;
        const int radius = bilateral_radius(options), side = is_bilinear ? 2 : 2 * radius + 1;
        report.radius = is_bilinear ? 0 : radius;
        report.guide_channels = guide.width() > 0 ? guide.channels() : in.channels();
        report.weights = options.separable ? 2.0 * side : double(side) * side;
        RowFilter rows =
            upsamples ? bilateral_upsampler(in.width, in.height, options, full.view(), view_of_any(guide), job.window)
                      : bilateral_filter(in.width, in.height, options, view_of_any(guide));
        const std::string doing = upsamples ? "upsampling" : "filtering";
        require_memory(rows.bytes(in.channels(), context.parallel),
                       fmt::format("{} {} x {} pixels", doing, in.width, in.height));
        return PictureFilter{std::move(rows), doing, {}, std::max(64, 2 * radius)};
    };
    static_cast<PictureReport&>(report) = filter_picture(job.files, false, context, make);
    return report;
}

}  // namespace bandlimit::job
