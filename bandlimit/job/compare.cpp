#include "bandlimit/job/compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bandlimit/color/encoding.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

constexpr int block_rows = 16;

/// A file, and its samples as they are measured.
class Source {
public:
    Source(const std::string& path, const Parallel& parallel) : reader_(path, parallel.threads), parallel_(parallel) {}

    const ImageInfo& info() const { return reader_.info(); }
    Encoding encoding(Space space) const { return info().encoding(space); }

    void measure_as(Measure measure, Space space) {
        const bool is_linear = measure == Measure::linear;
        rows_.emplace(reader_, is_linear ? encoding(space) : Encoding{}, false, block_rows);
        encodes_ = !is_linear && space != Space::data && !is_integer(info().depth) &&
                   encoding(space).transfer == Transfer::linear;
        alpha_ = encoding(space).alpha;
        values_ =
            Image<float>(info().width, std::min(block_rows, info().height), info().channels(), Layout::interleaved);
    }

    /// Reads the next rows; the view is valid until the next call.
    View<const float> read(int y, int rows) {
        const View<float> values = cropped(values_.view(), 0, 0, info().width, rows);
        rows_->read(y, values, parallel_);
        if (encodes_) convert(values, alpha_, linear_to_srgb, parallel_);
        return values;
    }

    /// Applies a transfer function to every channel but alpha.
    static void convert(View<float> v, int alpha, double (*transfer)(double), const Parallel& parallel) {
        parallel_for(v.height, 4, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (int y = static_cast<int>(begin); y < end; ++y)
                for (int x = 0; x < v.width; ++x)
                    for (int c = 0; c < v.channels; ++c)
                        if (c != alpha) v(x, y, c) = static_cast<float>(transfer(double(v(x, y, c))));
        });
    }

private:
    ImageReader reader_;
    Parallel parallel_;
    std::optional<PictureRows> rows_;
    bool encodes_ = false;
    int alpha_ = -1;
    Image<float> values_;
};

/// Copies what lies in a window out of rows that pass by.
class WindowCollector {
public:
    explicit WindowCollector(const ShiftWindow& window, int channels)
        : window_(window), image_(window.width, window.height, channels, Layout::interleaved) {}

    void add_rows(int y, View<const float> rows) {
        for (int row = std::max(0, window_.y - y); row < std::min(rows.height, window_.y + window_.height - y); ++row)
            for (int x = 0; x < window_.width; ++x)
                for (int c = 0; c < rows.channels; ++c)
                    image_.view()(x, y + row - window_.y, c) = rows(window_.x + x, row, c);
    }
    View<float> view() { return image_.view(); }

private:
    ShiftWindow window_;
    Image<float> image_;
};

/// Writes |a - b| of the colour channels, row by row.
class DiffWriter {
public:
    DiffWriter(const std::string& path, const ImageInfo& a, int threads) {
        ImageTarget target;
        target.width = a.width;
        target.height = a.height;
        for (int c = 0; c < a.channels(); ++c)
            if (c != a.alpha || a.channels() == 1) channels_.push_back(c);
        for (const int c : channels_) target.channel_names.push_back(a.channel_names[static_cast<std::size_t>(c)]);
        target.depth = nearest_depth(abilities_of(path), a.depth);
        target.transfer = Transfer::linear;
        target.is_data = true;
        row_ = Image<float>(a.width, 1, static_cast<int>(channels_.size()), Layout::interleaved);
        writer_.emplace(path, target, true, threads);
    }

    void add_rows(View<const float> a, View<const float> b) {
        for (int y = 0; y < a.height; ++y) {
            for (int x = 0; x < a.width; ++x)
                for (std::size_t i = 0; i < channels_.size(); ++i)
                    row_.view()(x, 0, static_cast<int>(i)) = std::abs(a(x, y, channels_[i]) - b(x, y, channels_[i]));
            writer_->write(row_.view());
        }
    }
    void finish() { writer_->finish(); }

private:
    std::vector<int> channels_;
    Image<float> row_;
    std::optional<PictureWriter> writer_;
};

ShiftWindow window_within(int width, int height, int border) {
    ShiftWindow window = shift_window(width - 2 * border, height - 2 * border);
    window.x += border;
    window.y += border;
    return window;
}

/// From codes and from linear light, of which the one counts that leaves less unexplained.
Shift shift_of(const CompareJob& job, const Source& a, const Source& b, Measure as, View<float> va, View<float> vb,
               const Parallel& parallel) {
    const Shift measured = estimate_shift(va, vb, parallel);
    const bool has_curve =
        a.encoding(job.space).transfer == Transfer::srgb && b.encoding(job.space).transfer == Transfer::srgb;
    if (!has_curve) return measured;
    const auto transfer = as == Measure::encoded ? srgb_to_linear : linear_to_srgb;
    Source::convert(va, a.info().alpha, transfer, parallel);
    Source::convert(vb, b.info().alpha, transfer, parallel);
    const Shift other = estimate_shift(va, vb, parallel);
    return other.residual < measured.residual ? other : measured;
}

/// Takes all rows of both files through the meters and the windows.
Metrics pass_rows(const CompareJob& job, const Context& context, Source& a, Source& b, WindowCollector& window_a,
                  WindowCollector& window_b) {
    const int width = a.info().width, height = a.info().height, channels = a.info().channels();
    ErrorMeter errors(width, height, channels, job.border, context.parallel);
    SsimMeter similarity(width, height, channels, job.border, context.parallel);
    std::optional<DiffWriter> diff;
    if (!job.diff.empty()) diff.emplace(job.diff, a.info(), context.parallel.threads);
    for (int y = 0, rows = 0; y < height; y += rows) {
        context.parallel.check_stop();
        rows = std::min(block_rows, height - y);
        const View<const float> va = a.read(y, rows), vb = b.read(y, rows);
        errors.add_rows(va, vb);
        similarity.add_rows(va, vb);
        window_a.add_rows(y, va);
        window_b.add_rows(y, vb);
        if (diff) diff->add_rows(va, vb);
        context.report({"comparing", double(y + rows), double(height)});
    }
    if (diff) diff->finish();
    std::vector<Measures> per_channel;
    errors.fill(per_channel);
    similarity.fill(per_channel);
    return summarize(std::move(per_channel));
}

void check_same_shape(const CompareJob& job, const ImageInfo& a, const ImageInfo& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::runtime_error(fmt::format("{} is {} x {}, {} is {} x {}; resize one of them first", job.a, a.width,
                                             a.height, job.b, b.width, b.height));
    if (a.channels() != b.channels())
        throw std::runtime_error(
            fmt::format("{} has {} channels, {} has {}; give both the same", job.a, a.channels(), job.b, b.channels()));
    if (job.border > (std::min(a.width, a.height) - 1) / 2)
        throw std::runtime_error(fmt::format("a border of {} leaves nothing of {}, which is {} x {}; use {} or less",
                                             job.border, job.a, a.width, a.height,
                                             (std::min(a.width, a.height) - 1) / 2));
}

}  // namespace

CompareReport compare(const CompareJob& job, const Context& context) {
    if (!job.diff.empty()) check_output_path(job.diff);
    Source a(job.a, context.parallel), b(job.b, context.parallel);
    check_same_shape(job, a.info(), b.info());
    const bool codes = is_integer(a.info().depth) && is_integer(b.info().depth);
    CompareReport report;
    report.info = a.info();
    report.measure = job.measure.value_or(codes ? Measure::encoded : Measure::linear);
    a.measure_as(report.measure, job.space);
    b.measure_as(report.measure, job.space);
    const ShiftWindow window = window_within(report.info.width, report.info.height, job.border);
    WindowCollector window_a(window, report.info.channels()), window_b(window, report.info.channels());
    report.metrics = pass_rows(job, context, a, b, window_a, window_b);
    report.shift = shift_of(job, a, b, report.measure, window_a.view(), window_b.view(), context.parallel);
    return report;
}

}  // namespace bandlimit::job
