#include "bandlimit/job/picture_filter.h"

#include <fmt/core.h>

#include <stdexcept>

#include "bandlimit/job/shares.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {
namespace {

/// The transfer function of a file to be written.
Transfer output_transfer(Space space, const ImageInfo& in, const FormatAbilities& format, Depth depth) {
    if (space == Space::data || space == Space::linear || format.is_linear || !is_integer(depth))
        return Transfer::linear;
    if (space == Space::automatic && is_integer(in.depth)) return in.transfer;
    return Transfer::srgb;
}

void check_alpha(const PictureFiles& files, const ImageInfo& in) {
    const FormatAbilities format = abilities_of(files.out);
    if (in.alpha >= 0 && !format.alpha)
        throw std::runtime_error(
            fmt::format("{} has an alpha channel, which {} files cannot hold; write .png, or lay it over a background "
                        "colour, as resize can, by a scale of 1 if need be",
                        files.in, format.name));
}

ImageTarget target_of(const PictureFiles& files, const ImageReader& reader, const PictureFilter& filter) {
    const ImageInfo& in = reader.info();
    const FormatAbilities format = abilities_of(files.out);
    const Depth depth = files.depth.value_or(nearest_depth(format, in.depth));
    ImageTarget target{filter.rows.protocol().width,
                       filter.rows.protocol().height,
                       in.channel_names,
                       depth,
                       in.alpha,
                       output_transfer(files.space, in, format, depth),
                       files.space == Space::data,
                       &reader.metadata(),
                       files.tile};
    if (filter.makes_data) target.transfer = Transfer::linear, target.is_data = true;
    if (!filter.channel_names.empty()) target.channel_names = filter.channel_names, target.alpha = -1;
    if (!filter.background.empty()) {
        target.channel_names.erase(target.channel_names.begin() + in.alpha);
        target.alpha = -1;
    }
    return target;
}

/// For data, alpha is a channel like the others unless it was asked for.
void treat_alpha_as_asked(const PictureFiles& files, const ImageInfo& in, int target_alpha, Encoding& from,
                          Encoding& to) {
    if (files.space != Space::data) return;
    from.alpha = files.premultiplies() ? in.alpha : -1;
    from.associated = in.associated;
    to.alpha = files.premultiplies() ? target_alpha : -1;
}

PictureSummary summary_of(const ImageInfo& in) { return {in.width, in.height, in.channels(), in.depth}; }
PictureSummary summary_of(const ImageTarget& out) {
    return {out.width, out.height, static_cast<int>(out.channel_names.size()), out.depth};
}

}  // namespace

PictureReport filter_picture(const PictureFiles& files, bool lies_over, const Context& context,
                             const std::function<PictureFilter(const ImageInfo& in)>& make) {
    check_output_path(files.out);
    Stopwatch watch;
    StreamReport stream;
    PictureReport report;
    const Shares shares = shares_of(context.parallel);
    ImageReader reader = watch.time(stream.read, [&] { return ImageReader(files.in, shares.codecs.threads); });
    const ImageInfo& in = reader.info();
    if (!lies_over) check_alpha(files, in);
    const PictureFilter filter = watch.time(report.seconds.plan, [&] { return make(in); });
    const ImageTarget target = target_of(files, reader, filter);
    if (in.has_foreign_profile && files.space == Space::automatic)
        context.say(
            fmt::format("{} has an ICC profile that is not sRGB: it is kept, its curve is treated as sRGB", files.in));

    ImageWriter writer(files.out, target, shares.codecs.threads);
    Encoding from = in.encoding(files.space), to = writer.encoding();
    treat_alpha_as_asked(files, in, target.alpha, from, to);
    stream_rows(filter, reader, from, writer, to, target, shares.stages, context, stream);
    watch.time(stream.write, [&] { writer.finish(); });
    if (stream.lost_non_finite) context.say(fmt::format("{} holds NaN or infinite values; they became 0", files.in));

    report.input = summary_of(in), report.output = summary_of(target);
    report.lost_non_finite = stream.lost_non_finite;
    report.seconds = {report.seconds.plan, stream.read, stream.filter, stream.write, watch.total()};
    return report;
}

}  // namespace bandlimit::job
