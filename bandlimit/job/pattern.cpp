#include "bandlimit/job/pattern.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "bandlimit/job/drawing.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

Grid grid_of(PatternSize size) { return {{size.width, 0, double(size.width)}, {size.height, 0, double(size.height)}}; }

int channels_of_file(const PatternJob& job, const FormatAbilities& format) {
    const auto holds = [&](int n) {
        return format.channels.empty() ||
               std::find(format.channels.begin(), format.channels.end(), n) != format.channels.end();
    };
    if (job.channels == 0) return holds(1) ? 1 : 3;
    if (!holds(job.channels))
        throw OptionError("channels", fmt::format("{} files do not hold {}; choose {}, or TIFF", format.name,
                                                  job.channels, holds(1) ? "1" : "3"));
    return job.channels;
}

/// The file to be written.
ImageTarget target_of(const PatternJob& job) {
    const FormatAbilities format = abilities_of(job.out);
    const Depth depth = job.depth.value_or(nearest_depth(format, format.is_linear ? Depth::f32 : Depth::u8));
    const bool is_linear =
        job.space == Space::data || job.space == Space::linear || format.is_linear || !is_integer(depth);
    ImageTarget target;
    target.width = job.size.width;
    target.height = job.size.height;
    const int channels = channels_of_file(job, format);
    target.channel_names = channel_names(channels);
    target.alpha = alpha_among(channels);
    target.depth = depth;
    target.transfer = is_linear ? Transfer::linear : Transfer::srgb;
    target.is_data = job.space == Space::data;
    target.tile = job.tile;
    return target;
}

/// Encodes the rows of `linear`, one channel, to all channels of `stored` but alpha, which is opaque.
void encode_rows(View<const float> linear, const ImageTarget& target, const AnyView& stored, const Encoding& encoding,
                 Parallel parallel) {
    const int channels = static_cast<int>(target.channel_names.size());
    parallel_for(linear.height, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<float> row;
        for (int y = static_cast<int>(begin); y < end; ++y) {
            row.clear();
            for (int x = 0; x < linear.width; ++x)
                for (int c = 0; c < channels; ++c) row.push_back(c == target.alpha ? 1.0f : linear(x, y));
            encode_row(row, false, stored, y, encoding);
        }
    });
}

/// The image of a signal, drawn by bands of rows: 16 MB of floats at a time.
Drawing drawing_of(const PatternJob& job, const Signal& signal, const ImageTarget& target) {
    const Sampling& sampling = job.sampling;
    const Grid grid = grid_of(job.size);
    Drawing drawing{.out = job.out, .target = target, .band_pixels = 1 << 22};
    const int rows = band_rows(drawing), width = target.width;
    const std::uint64_t band = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(width);
    drawing.bytes = rendering_bytes(grid, sampling) + band * sizeof(float);
    const auto linear = std::make_shared<Image<float>>();
    drawing.draw = [=](int y, const AnyView& stored, const Encoding& encoding, Parallel parallel) {
        if (linear->width() == 0) *linear = Image<float>(width, rows);
        const View<float> drawn = cropped(linear->view(), 0, 0, width, std::min(rows, target.height - y));
        render(signal, {grid.x, grid.y.cells(y, y + drawn.height)}, sampling, drawn, parallel);
        encode_rows(drawn, target, stored, encoding, parallel);
    };
    return drawing;
}

Signal signal_of(const PatternJob& job) {
    require_memory(job.signal.bytes(job.size),
                   fmt::format("{} of {} x {} pixels", job.signal.name, job.size.width, job.size.height));
    try {
        Signal signal = with_range(job.signal.make(job.size), job.low, job.high);
        check_sampling(signal, job.sampling);
        return signal;
    } catch (const Error& e) {
        throw OptionError(e.what());  // it is made of nothing but options
    }
}

}  // namespace

void check(const PatternJob& job) {
    rendering_bytes(grid_of(job.size), job.sampling);
    // A small signal of the same kind knows whether it has an exact form; noise needs its memory first.
    if (job.signal.bytes(job.size) == 0)
        check_sampling(with_range(job.signal.make(job.size), job.low, job.high), job.sampling);
    channels_of_file(job, abilities_of(job.out));
}

PatternReport pattern(const PatternJob& job, const Context& context) {
    check_output_path(job.out);
    PatternReport report;
    const ImageTarget target = target_of(job);
    report.channels = static_cast<int>(target.channel_names.size());
    report.depth = target.depth, report.transfer = target.transfer;
    const DrawingSeconds seconds = draw_picture(drawing_of(job, signal_of(job), target), context);
    report.seconds_rendering = seconds.rendering, report.seconds_writing = seconds.writing;
    return report;
}

}  // namespace bandlimit::job
