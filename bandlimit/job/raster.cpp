#include "bandlimit/job/raster.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/antialias/raster.h"
#include "bandlimit/color/encoding.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/drawing.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/raster_scene.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {
namespace {

bool is_linear_file(const RasterJob& job, const FormatAbilities& format, Depth depth) {
    return job.space == Space::data || job.space == Space::linear || format.is_linear || !is_integer(depth);
}

ImageTarget target_of(const RasterJob& job, const RasterScene& scene) {
    const FormatAbilities format = abilities_of(job.out);
    ImageTarget target;
    target.width = scene.width;
    target.height = scene.height;
    const int channels = scene.has_alpha ? 4 : 3;
    if (!format.channels.empty() &&
        std::find(format.channels.begin(), format.channels.end(), channels) == format.channels.end())
        fail_file(job.out, format.name, " files do not hold ", scene.has_alpha ? "alpha" : "colour",
                  "; write PNG or EXR");
    target.channel_names = channel_names(channels);
    target.alpha = alpha_among(channels);
    target.depth = job.depth.value_or(nearest_depth(format, format.is_linear ? Depth::f32 : Depth::u8));
    target.transfer = is_linear_file(job, format, target.depth) ? Transfer::linear : Transfer::srgb;
    target.is_data = job.space == Space::data;
    target.tile = job.tile;
    return target;
}

void fill(View<float> rows, const std::array<float, 4>& color) {
    for (int y = 0; y < rows.height; ++y)
        for (int x = 0; x < rows.width; ++x)
            for (int c = 0; c < rows.channels; ++c)
                rows(x, y, c) = color[static_cast<std::size_t>(c)] * (c < 3 ? color[3] : 1);
}

/// Bands of the picture, prefiltered or of samples, and how far they are from the truth.
class Bands {
public:
    Bands(const RasterJob& job, const RasterScene& scene, const Rasterizer& rasterizer, int channels, int rows,
          RasterReport& report)
        : job_(job),
          scene_(scene),
          rasterizer_(rasterizer),
          drawn_(scene.width, rows, channels, Layout::interleaved),
          meter_(scene.width, scene.height, channels),
          report_(report) {
        if (job.compare > 0) truth_ = Image<float>(scene.width, rows, channels, Layout::interleaved);
    }

    /// Draws rows from `y` on, and encodes them into `stored`.
    void draw(int y, const AnyView& stored, const Encoding& encoding, const Parallel& parallel) {
        const int rows = shape_of(stored).height;
        const View<float> band = cropped(drawn_.view(), 0, 0, scene_.width, rows);
        fill_and_draw(band, y, job_.truth, parallel);
        if (job_.compare > 0) {
            const View<float> truth = cropped(truth_.view(), 0, 0, scene_.width, rows);
            fill_and_draw(truth, y, job_.compare, parallel);
            meter_.add_rows(band, truth);
        }
        const auto row_samples = static_cast<std::size_t>(scene_.width) * static_cast<std::size_t>(band.channels);
        parallel_for(rows, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (int row = static_cast<int>(begin); row < end; ++row)
                encode_row(std::span<const float>(&band(0, row), row_samples), true, stored, row, encoding);
        });
    }

    void take_errors() const {
        std::vector<Measures> measures(static_cast<std::size_t>(drawn_.channels()));
        meter_.fill(measures);
        double sum = 0, largest = 0;
        for (const Measures& m : measures) sum += m.mse, largest = std::max(largest, m.max_abs);
        report_.rms = std::sqrt(sum / drawn_.channels());
        report_.max_abs = largest;
    }

private:
    /// Prefiltered, or by so many samples.
    void fill_and_draw(View<float> band, int y, int samples, const Parallel& parallel) {
        Stopwatch watch;
        fill(band, scene_.background);
        if (samples == 0) watch.time(report_.seconds_drawing, [&] { rasterizer_.draw(band, y, parallel); });
        else watch.time(report_.seconds_truth, [&] { rasterizer_.draw_supersampled(band, samples, y, parallel); });
    }

    const RasterJob& job_;
    const RasterScene& scene_;
    const Rasterizer& rasterizer_;
    Image<float> drawn_, truth_;
    ErrorMeter meter_;
    RasterReport& report_;
};

void draw_scene(const RasterJob& job, const RasterScene& scene, const Rasterizer& rasterizer, const ImageTarget& target,
                const Context& context, RasterReport& report) {
    Drawing drawing{.out = job.out, .target = target};
    const int channels = static_cast<int>(target.channel_names.size());
    // Samples take long: smaller bands show progress.
    drawing.band_pixels = job.truth + job.compare > 0 ? 1 << 16 : 1 << 20;
    const int rows = band_rows(drawing);
    drawing.bytes = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(scene.width * channels) *
                    sizeof(float) * (job.compare > 0 ? 2 : 1);
    std::optional<Bands> bands;  // made when the memory was found to be there
    drawing.draw = [&](int y, const AnyView& stored, const Encoding& encoding, Parallel parallel) {
        if (!bands) bands.emplace(job, scene, rasterizer, channels, rows, report);
        bands->draw(y, stored, encoding, parallel);
    };
    report.seconds_writing = draw_picture(drawing, context).writing;
    if (job.compare > 0) bands->take_errors();
}

/// Throws OptionError if so few or many samples do not go with the filter, before anything is drawn.
void check_samples(const RasterJob& job, const Rasterizer& rasterizer) {
    const int samples = std::max(job.truth, job.compare);
    if (samples == 0) return;
    Image<float> nothing(0, 0, 3);
    try {
        rasterizer.draw_supersampled(nothing.view(), samples);
    } catch (const Error& e) {
        throw OptionError(job.truth > 0 ? "truth" : "compare", e.what());
    }
}

}  // namespace

void check(const RasterJob& job) {
    if (!(job.truth >= 0 && job.truth <= 64))
        throw OptionError("truth", fmt::format("{} is out of range; pass 1 to 64 samples per axis", job.truth));
    if (!(job.compare >= 0 && job.compare <= 64))
        throw OptionError("compare", fmt::format("{} is out of range; pass 1 to 64 samples per axis", job.compare));
    if (job.truth > 0 && job.compare > 0)
        throw OptionError("truth", "cannot be compared with itself; pass truth or compare, not both");
    if (job.filter.empty()) return;
    try {
        raster_filter(job.filter);
    } catch (const Error& e) {
        throw OptionError("filter", e.what());
    }
}

RasterReport raster(const RasterJob& job, const Context& context) {
    check(job);
    check_output_path(job.out);
    RasterReport report;
    Stopwatch watch;
    RasterScene scene;
    watch.time(report.seconds_reading, [&] { scene = read_raster_scene(job.scene); });
    report.filter = job.filter.empty() ? scene.filter : job.filter;
    const ImageTarget target = target_of(job, scene);
    report.width = scene.width, report.height = scene.height, report.shapes = scene.shapes.size();
    report.channels = static_cast<int>(target.channel_names.size());
    report.depth = target.depth, report.transfer = target.transfer;
    std::optional<Rasterizer> rasterizer;
    watch.time(report.seconds_preparing, [&] { rasterizer.emplace(scene.shapes, raster_filter(report.filter)); });
    check_samples(job, *rasterizer);
    draw_scene(job, scene, *rasterizer, target, context, report);
    return report;
}

}  // namespace bandlimit::job
