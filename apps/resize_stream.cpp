#include "apps/resize_stream.h"

#include <algorithm>

#include "apps/common.h"

namespace bandlimit::app {
namespace {

constexpr std::uint64_t band_bytes = 32u << 20;  // of the larger of source and target rows
constexpr int least_rows = 64;

std::uint64_t row_bytes(int width, std::size_t channels, Depth depth) {
    return static_cast<std::uint64_t>(width) * channels * size_of(depth);
}

/// The rows of a file that are needed now, of which those known already are kept when the band moves on.
class SourceBand {
public:
    SourceBand(ImageReader& reader, int capacity)
        : reader_(reader),
          image_(make_image(reader.info().depth, reader.info().width, capacity, reader.info().channels())) {}

    /// Makes rows [range) the content of the band.
    void hold(IndexRange range) {
        const int kept = std::clamp(end_ - range.begin, 0, range.begin >= begin_ ? range.end - range.begin : 0);
        if (kept > 0 && range.begin != begin_) move_rows(range.begin - begin_, kept);
        const int fresh = range.end - range.begin - kept;
        if (fresh > 0) reader_.read_rows(range.begin + kept, rows_of(view_of(image_), kept, fresh));
        begin_ = range.begin, end_ = range.end;
    }

    SourceRows rows(const Encoding& encoding) {
        return {const_view(rows_of(view_of(image_), 0, end_ - begin_)), begin_, encoding};
    }

private:
    void move_rows(int from, int count) {
        std::visit(
            [&](auto& image) {
                const auto v = image.view();
                std::copy(&v(0, from), &v(0, from) + count * v.dy, &v(0, 0));
            },
            image_);
    }

    ImageReader& reader_;
    AnyImage image_;
    int begin_ = 0, end_ = 0;
};

/// Output rows per band, so that neither side exceeds the bytes of a band by much.
int rows_per_band(const Resizer& resizer, std::uint64_t source_row, std::uint64_t target_row, int target_height) {
    int rows = target_height;
    while (rows > least_rows) {
        const IndexRange needed = resizer.rows_needed(0, rows);
        const std::uint64_t bytes = std::max(static_cast<std::uint64_t>(needed.end - needed.begin) * source_row,
                                             static_cast<std::uint64_t>(rows) * target_row);
        if (bytes <= band_bytes) break;
        rows = std::max(least_rows, rows / 2);
    }
    return rows;
}

int largest_band(const Resizer& resizer, int rows, int target_height) {
    int largest = 0;
    for (int y = 0; y < target_height; y += rows) {
        const IndexRange needed = resizer.rows_needed(y, std::min(y + rows, target_height));
        largest = std::max(largest, needed.end - needed.begin);
    }
    return largest;
}

}  // namespace

void stream_resize(const Resizer& resizer, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                   const Encoding& to, const ImageTarget& target, const std::vector<float>& background,
                   Parallel parallel, StreamReport& report) {
    const ImageInfo& in = reader.info();
    const std::uint64_t source_row = row_bytes(in.width, in.channel_names.size(), in.depth);
    const std::uint64_t target_row = row_bytes(target.width, target.channel_names.size(), target.depth);
    const int rows = rows_per_band(resizer, source_row, target_row, target.height);
    const int source_rows = largest_band(resizer, rows, target.height);
    require_memory(static_cast<std::uint64_t>(source_rows) * source_row + static_cast<std::uint64_t>(rows) * target_row,
                   "resizing " + std::to_string(in.width) + " x " + std::to_string(in.height) + " pixels");
    Stopwatch watch;
    SourceBand band(reader, source_rows);
    AnyImage out = make_image(target.depth, target.width, rows, static_cast<int>(target.channel_names.size()));
    Progress progress("resize", target.height);
    for (int y = 0; y < target.height; y += rows) {
        const int count = std::min(rows, target.height - y);
        const AnyView out_rows = rows_of(view_of(out), 0, count);
        watch.time(report.read, [&] { band.hold(resizer.rows_needed(y, y + count)); });
        watch.time(report.filter, [&] {
            if (resizer.run(band.rows(from), {out_rows, y, to, background}, parallel)) report.lost_non_finite = true;
        });
        watch.time(report.write, [&] { writer.write_rows(const_view(out_rows)); });
        progress.advance_to(y + count);
    }
}

}  // namespace bandlimit::app
