#include "bandlimit/job/guided.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "bandlimit/job/local_models_file.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

std::uint64_t float_bytes(int width, int height, int channels) {
    return std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) * sizeof(float);
}

/// All channels but alpha, unless that is data.
Image<float> read_guide(const std::string& path, Space space, const Parallel& parallel) {
    const ImageInfo info = ImageReader(path, parallel.threads).info();
    require_memory(2 * float_bytes(info.width, info.height, info.channels()),
                   fmt::format("the guide {}, of {} x {} pixels,", path, info.width, info.height));
    Image<float> all = read_picture(path, space, parallel);
    if (space == Space::data || info.alpha < 0 || info.channels() == 1) return all;
    Image<float> guide(info.width, info.height, info.channels() - 1);
    for (int c = 0, to = 0; c < info.channels(); ++c) {
        if (c == info.alpha) continue;
        for (int y = 0; y < info.height; ++y)
            for (int x = 0; x < info.width; ++x) guide.view()(x, y, to) = all.view()(x, y, c);
        ++to;
    }
    return guide;
}

void check_guides(const GuidedJob& job, const ImageInfo& in, const Image<float>& guide, const Image<float>& full) {
    if (guide.width() != in.width || guide.height() != in.height)
        throw std::runtime_error(fmt::format(
            "{} is {} x {} and {} is {} x {}; pass a guide of the size of the input, and another one as the "
            "full guide",
            job.guide, guide.width(), guide.height(), job.files.in, in.width, in.height));
    if (!job.full_guide.empty() && full.channels() != guide.channels())
        throw std::runtime_error(
            fmt::format("{} has {} channels that guide and {} has {}; pass guides of the same channels", job.guide,
                        guide.channels(), job.full_guide, full.channels()));
    const int most = job.options.order == 1 ? LocalModels::most_terms : 8;
    if (guide.channels() > most)
        throw OptionError("order", fmt::format("{} has {} channels that guide; pass a guide of up to {} for order {}",
                                               job.guide, guide.channels(), most, job.options.order));
}

/// Makes a picture of another; both have all channels, in planes or not.
using Work = std::function<Image<float>(View<const float> picture, const Parallel& parallel)>;

/// A filter that needs the whole picture before it has its first row. What the work makes is kept for all bands.
RowFilter whole_picture_filter(const ImageInfo& in, int width, int height, bool premultiply, const Work& work,
                               double bytes) {
    struct Made {
        std::mutex mutex;
        Image<float> image;
    };
    const auto made = std::make_shared<Made>();
    const auto decoded = [in, premultiply](const SourceRows& source) {
        Image<float> picture(in.width, in.height, in.channels(), Layout::interleaved);
        const auto length = static_cast<std::size_t>(in.width) * static_cast<std::size_t>(in.channels());
        for (int y = 0; y < in.height; ++y)
            decode_row(source.samples, y - source.first_row, source.encoding, premultiply,
                       {&picture.view()(0, y), length});
        return picture;
    };
    RowProtocol protocol;
    protocol.name = "guided";
    protocol.sources = {{in.width, in.height, Edge::clamp}};
    protocol.width = width, protocol.height = height, protocol.channels = in.channels();
    protocol.rows_read = [rows = in.height](std::size_t, int, int) { return IndexRange{0, rows}; };
    protocol.bytes = [bytes](int, const Parallel&) { return bytes; };
    protocol.start = [=](const RowRun& run) {
        const SourceRows& source = run.sources[0];
        {
            const std::lock_guard lock(made->mutex);
            if (made->image.width() == 0) made->image = work(decoded(source).view(), run.parallel);
        }
        const bool is_premultiplied = source.encoding.alpha >= 0 && (premultiply || source.encoding.associated);
        return RowWork{1, [&run, made, is_premultiplied](int) {
                           const View<const float> image = made->image.view();
                           bool is_lost = false;
                           std::vector<float> row;
                           for (int y = run.rows().begin; y < run.rows().end; ++y) {
                               row.clear();
                               for (int x = 0; x < image.width; ++x)
                                   for (int c = 0; c < image.channels; ++c) row.push_back(image(x, y, c));
                               is_lost |= encode_row(row, is_premultiplied, run.target.samples,
                                                     y - run.target.first_row, run.target.encoding);
                               run.monitor.made(image.width);
                           }
                           return is_lost;
                       }};
    };
    return RowFilter(std::move(protocol));
}

}  // namespace

void check(const GuidedJob& job) {
    const LocalModelOptions& o = job.options;
    const int most = o.window == WindowShape::box ? 32767 : 255;
    if (o.radius < 0 || o.radius > most)
        throw OptionError("radius", fmt::format("{} is out of range; pass 0 to {} for a {} window", o.radius, most,
                                                name_of(o.window)));
    if (!(o.epsilon >= 0)) throw OptionError("epsilon", fmt::format("{} is out of range; pass 0 or more", o.epsilon));
    if (o.order != 1 && o.order != 2) throw OptionError("order", fmt::format("{} is unknown; pass 1 or 2", o.order));
    if (!job.save_models.empty() && abilities_of(job.save_models).name != "openexr")
        throw OptionError("save-models", fmt::format("{} is not an EXR file; use the extension .exr", job.save_models));
}

GuidedReport guided(const GuidedJob& job, const Context& context) {
    check(job);
    check_output_path(job.files.out);
    if (!job.save_models.empty()) check_output_path(job.save_models);
    GuidedReport report;
    const Image<float> guide = read_guide(job.guide, job.files.space, context.parallel);
    const Image<float> full =
        job.full_guide.empty() ? Image<float>() : read_guide(job.full_guide, job.files.space, context.parallel);
    const View<const float> target = job.full_guide.empty() ? guide.view() : full.view();
    const bool keeps_models = !job.full_guide.empty() || job.options.averages || !job.save_models.empty();
    const Work work = [&](View<const float> picture, const Parallel& parallel) {
        if (!keeps_models) return guided_filter(picture, guide.view(), job.options, parallel);
        const LocalModels models = fit_local_models(picture, guide.view(), job.options, parallel);
        if (!job.save_models.empty()) write_local_models(job.save_models, models);
        return apply_local_models(models, target, parallel);
    };
    const auto make = [&](const ImageInfo& in) {
        check_guides(job, in, guide, full);
        report.guide_channels = guide.channels();
        LocalModels shape;
        shape.guides = guide.channels(), shape.order = job.options.order;
        report.terms = shape.terms();
        std::uint64_t bytes =
            float_bytes(in.width, in.height, in.channels()) + float_bytes(target.width, target.height, in.channels());
        const int coefficients = in.channels() * (1 + report.terms);
        if (keeps_models)
            bytes += 2 * float_bytes(in.width, in.height, coefficients) +
                     2 * float_bytes(target.width, target.height, coefficients);
        require_memory(bytes, fmt::format("filtering {} x {} pixels", in.width, in.height));
        return PictureFilter{whole_picture_filter(in, target.width, target.height, job.files.premultiplies(), work,
                                                  static_cast<double>(bytes)),
                             "filtering"};
    };
    static_cast<PictureReport&>(report) = filter_picture(job.files, false, context, make);
    return report;
}

}  // namespace bandlimit::job
