#include "bandlimit/job/scene_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "bandlimit/job/channels.h"
#include "bandlimit/job/drawing.h"
#include "bandlimit/job/option_error.h"

namespace bandlimit::job {
namespace {

bool holds_all_channels(const FormatAbilities& format) { return format.name == "openexr"; }

ImageTarget target_of(const ScenePictureJob& job) {
    const FormatAbilities format = abilities_of(job.out);
    ImageTarget target;
    target.width = job.size.width;
    target.height = job.size.height;
    target.tile = job.tile;
    if (holds_all_channels(format)) {
        if (job.depth.value_or(Depth::f32) != Depth::f32)
            throw OptionError("depth", fmt::format("{} cannot hold the depth of the sky, {:g}; use f32",
                                                   name_of(*job.depth), sky_depth));
        target.channel_names.assign(scene_channel_names.begin(), scene_channel_names.end());
        target.alpha = scene_channel::alpha;
        target.depth = Depth::f32;
        target.transfer = Transfer::linear;
        return target;
    }
    if (!format.channels.empty() && std::count(format.channels.begin(), format.channels.end(), 3) == 0)
        throw OptionError(fmt::format("\"{}\" cannot hold colour; choose PNG, or EXR for all channels", job.out));
    target.channel_names = channel_names(3);
    target.depth = job.depth.value_or(nearest_depth(format, format.is_linear ? Depth::f32 : Depth::u8));
    target.transfer = format.is_linear || !is_integer(target.depth) ? Transfer::linear : Transfer::srgb;
    return target;
}

Drawing drawing_of(const ScenePictureJob& job, const ImageTarget& target) {
    const auto scene =
        std::make_shared<const Scene>(make_scene(job.scene, job.size.width, job.size.height, job.options));
    Drawing drawing{.out = job.out, .target = target};
    // Pixels that take long make smaller bands, so that progress is seen.
    drawing.band_pixels = std::max<std::uint64_t>(1, (1 << 18) / static_cast<std::uint64_t>(job.sampling.samples));
    const int rows = band_rows(drawing), width = target.width;
    const auto frame_rows = std::make_shared<Image<float>>();
    drawing.bytes =
        static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(width) * scene_channel::count * sizeof(float);
    const int channels = static_cast<int>(target.channel_names.size());
    drawing.draw = [=](int y, const AnyView& stored, const Encoding& encoding, Parallel parallel) {
        if (frame_rows->width() == 0)
            *frame_rows = Image<float>(width, rows, scene_channel::count, Layout::interleaved);
        const View<float> drawn = cropped(frame_rows->view(), 0, 0, width, std::min(rows, target.height - y));
        render_scene(*scene, job.frame, job.sampling, y, drawn, parallel);
        parallel_for(drawn.height, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            std::vector<float> row;
            for (int j = static_cast<int>(begin); j < end; ++j) {
                row.clear();
                for (int i = 0; i < width; ++i)
                    for (int c = 0; c < channels; ++c) row.push_back(drawn(i, j, c));
                encode_row(row, true, stored, j, encoding);  // alpha is 1 everywhere
            }
        });
    };
    return drawing;
}

}  // namespace

void check(const ScenePictureJob& job) {
    make_scene(job.scene, job.size.width, job.size.height, job.options);
    check_sampling(job.sampling);
    target_of(job);
}

ScenePictureReport scene_picture(const ScenePictureJob& job, const Context& context) {
    check_output_path(job.out);
    check(job);
    const ImageTarget target = target_of(job);
    const DrawingSeconds seconds = draw_picture(drawing_of(job, target), context);
    return {static_cast<int>(target.channel_names.size()), target.depth, target.transfer, seconds.rendering,
            seconds.writing};
}

}  // namespace bandlimit::job
