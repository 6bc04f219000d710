#include "bandlimit/job/drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "bandlimit/core/pipeline.h"
#include "bandlimit/job/shares.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {

int band_rows(const Drawing& drawing) {
    const std::uint64_t rows = drawing.band_pixels / static_cast<std::uint64_t>(drawing.target.width);
    return static_cast<int>(std::clamp<std::uint64_t>(rows, 1, static_cast<std::uint64_t>(drawing.target.height)));
}

DrawingSeconds draw_picture(const Drawing& drawing, const Context& context) {
    const ImageTarget& target = drawing.target;
    const int rows = band_rows(drawing), channels = static_cast<int>(target.channel_names.size());
    const std::uint64_t band = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(target.width);
    require_memory(drawing.bytes + 2 * band * static_cast<std::uint64_t>(channels) * size_of(target.depth),
                   fmt::format("drawing {} x {} pixels", target.width, target.height));
    const Shares shares = shares_of(context.parallel);
    ImageWriter writer(drawing.out, target, shares.codecs.threads);
    std::array<AnyImage, 2> stored;
    for (AnyImage& image : stored) image = make_image(target.depth, target.width, rows, channels);
    const auto rows_of_band = [&](int i) { return std::min(rows, target.height - i * rows); };
    const auto encoded = [&](int i) {
        return rows_of(view_of(stored[static_cast<std::size_t>(i % 2)]), 0, rows_of_band(i));
    };
    DrawingSeconds seconds;
    Stopwatch watch;
    const auto render_band = [&](int i, Parallel parallel) {
        watch.time(seconds.rendering, [&] { drawing.draw(i * rows, encoded(i), writer.encoding(), parallel); });
    };
    const auto write_band = [&](int i, Parallel) {
        watch.time(seconds.writing, [&] { writer.write_rows(const_view(encoded(i))); });
        context.report({"drawing", double(i * rows + rows_of_band(i)), double(target.height)});
    };
    run_pipeline((target.height - 1) / rows + 1, {{render_band, true}, {write_band}}, shares.stages);
    watch.time(seconds.writing, [&] { writer.finish(); });
    return seconds;
}

}  // namespace bandlimit::job
