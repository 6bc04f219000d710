#include "bandlimit/job/row_stream.h"

#include <algorithm>
#include <array>

#include "bandlimit/core/pipeline.h"
#include "bandlimit/job/source_bands.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {
namespace {

// Of the larger of source and target rows. Where a row of output takes many of the source, bands may be larger, since
// each of them filters anew what its first row shares with the last band.
constexpr std::uint64_t band_bytes = 32u << 20, largest_band_bytes = 192u << 20;
constexpr int wanted_bands = 8;  // for stages to overlap

std::uint64_t row_bytes(int width, std::size_t channels, Depth depth) {
    return static_cast<std::uint64_t>(width) * channels * size_of(depth);
}

/// Output rows per band: so few that stages overlap, and neither side exceeds the bytes of a band by much.
int rows_per_band(const PictureFilter& filter, std::uint64_t source_row, std::uint64_t target_row, int target_height) {
    const int least_rows = filter.least_rows;
    int rows = std::min(target_height, std::max(least_rows, target_height / wanted_bands + 1));
    const auto exceeds = [&](std::uint64_t limit) {
        const IndexRange needed = filter.rows.rows_needed(0, rows);
        return std::max(static_cast<std::uint64_t>(needed.end - needed.begin) * source_row,
                        static_cast<std::uint64_t>(rows) * target_row) > limit;
    };
    while (rows > least_rows && exceeds(band_bytes)) rows = std::max(least_rows, rows / 2);
    while (rows > 1 && exceeds(largest_band_bytes)) rows /= 2;
    return rows;
}

/// Rows [first, last) of the output.
IndexRange band(int i, int rows, int target_height) {
    const int first = i * rows;
    return {first, rows < target_height - first ? first + rows : target_height};
}

int largest_band(const PictureFilter& filter, int rows, int bands, int target_height) {
    int largest = 0;
    for (int i = 0; i < bands; ++i) {
        const IndexRange out = band(i, rows, target_height);
        const IndexRange needed = filter.rows.rows_needed(out.begin, out.end);
        largest = std::max(largest, needed.end - needed.begin);
    }
    return largest;
}

}  // namespace

void stream_rows(const PictureFilter& filter, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                 const Encoding& to, const ImageTarget& target, const Parallel& stages, const Context& context,
                 StreamReport& report) {
    const ImageInfo& in = reader.info();
    const std::uint64_t source_row = row_bytes(in.width, in.channel_names.size(), in.depth);
    const std::uint64_t target_row = row_bytes(target.width, target.channel_names.size(), target.depth);
    const int rows = rows_per_band(filter, source_row, target_row, target.height);
    const int bands = (target.height - 1) / rows + 1;
    const int source_rows = largest_band(filter, rows, bands, target.height);
    require_memory(SourceBands::bytes(in, source_rows) + 2 * static_cast<std::uint64_t>(rows) * target_row,
                   filter.doing + ' ' + std::to_string(in.width) + " x " + std::to_string(in.height) + " pixels");
    SourceBands source(reader, source_rows);
    std::array<AnyImage, 2> out;
    for (AnyImage& image : out)
        image = make_image(target.depth, target.width, rows, static_cast<int>(target.channel_names.size()));
    const auto out_rows = [&](int i) {
        const IndexRange r = band(i, rows, target.height);
        return rows_of(view_of(out[static_cast<std::size_t>(i % 2)]), 0, r.end - r.begin);
    };
    Stopwatch watch;
    const auto read = [&](int i, Parallel) {
        const IndexRange r = band(i, rows, target.height);
        watch.time(report.read, [&] { source.load(i, filter.rows.rows_needed(r.begin, r.end)); });
    };
    const auto run = [&](int i, Parallel threads) {
        const TargetRows to_rows{out_rows(i), band(i, rows, target.height).begin, to, filter.background};
        watch.time(report.filter, [&] {
            if (filter.rows.run(source.rows(i, from), to_rows, threads).lost_non_finite) report.lost_non_finite = true;
        });
    };
    const auto write = [&](int i, Parallel) {
        watch.time(report.write, [&] { writer.write_rows(const_view(out_rows(i))); });
        context.report({filter.doing, double(band(i, rows, target.height).end), double(target.height)});
    };
    run_pipeline(bands, {{read}, {run, true}, {write}}, stages);
}

}  // namespace bandlimit::job
