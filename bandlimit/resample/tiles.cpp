#include "bandlimit/resample/tiles.h"

#include <algorithm>

#include "bandlimit/core/allocator.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

constexpr std::ptrdiff_t tile_bytes = 16 << 10;  // of inputs: stays in the first cache beside the outputs
constexpr int run_multiple = 16;                 // outputs of a run: whole vectors of stored pixels

template <class T>
bool is_interleaved(const View<T>& v) {
    return v.dx == v.channels && (v.channels == 1 || v.dc == 1);
}

/// Calls visit(pixel 0 of one channel of a row, its lane), where lanes are (row, channel).
template <class T, class Visit>
void for_each_row(View<T> v, Visit visit) {
    for (int y = 0; y < v.height; ++y)
        for (int c = 0; c < v.channels; ++c) visit(&v(0, y, c), y * v.channels + c);
}

/// The next index that begins a block of pixels to be transposed.
int aligned(int x) { return (x + 3) / 4 * 4; }

/// Lets columns[i] be column i of samples, of which there are at least so many.
void make_columns(std::vector<float, SampleAllocator<float>>& samples, std::vector<float*>& columns, int count,
                  std::size_t stride) {
    const auto wanted = static_cast<std::size_t>(count);
    if (samples.size() < wanted * stride) samples.resize(wanted * stride);
    columns.resize(samples.size() / stride);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = samples.data() + i * stride;
}

/// Columns of some rows of an image, transposed. It slides along x: columns that several runs read are loaded once.
class ColumnTile {
public:
    /// Begins anew, without columns, for rows laid out like those of `from` whose results go to rows like those of
    /// `to`.
    void start(const View<const float>& from, const View<float>& to);

    /// Lets the columns held begin at x. Where x lies outside of them, none are left.
    void begin_at(int x);
    /// The column behind the last one held.
    int end() const { return end_; }
    /// Appends columns of the rows, which start() has seen the like of.
    void append(View<const float> columns);
    void append_zeros();

    /// Computes a run of outputs, whose inputs are held from run.read.begin on, into `to`, whose column 0 is the first.
    void filter(const Bank& bank, const TileRun& run, float antiring, View<float> to);

private:
    /// How the samples of the rows lie side by side at each x.
    enum class Lanes {
        by_channel,  ///< (channel, row), where rows are contiguous: samples of a row become rows of the tile
        by_pixel,    ///< (row, channel), where rows are contiguous and pixels of four fill a block of a vector
        scattered    ///< (row, channel), from anywhere
    };
    using Samples = std::vector<float, SampleAllocator<float>>;

    std::size_t stride() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(channels_); }
    float* make_room(int columns);
    void load(View<const float> from, float* to) const;
    void store(View<float> to) const;

    Lanes lanes_ = Lanes::scattered;
    int rows_ = 0, channels_ = 1, begin_ = 0, end_ = 0;
    Samples in_, out_;
    std::vector<float*> from_, to_;  ///< the columns of both
};

void ColumnTile::start(const View<const float>& from, const View<float>& to) {
    rows_ = from.height;
    channels_ = from.channels;
    begin_ = end_ = 0;
    if (!is_interleaved(from) || !is_interleaved(to)) lanes_ = Lanes::scattered;
    else lanes_ = channels_ == 4 ? Lanes::by_pixel : Lanes::by_channel;
    from_.clear();
    to_.clear();
}

void ColumnTile::begin_at(int x) {
    if (x < begin_ || x >= end_) {
        begin_ = end_ = x;
        return;
    }
    const auto left = static_cast<std::size_t>(end_ - x), passed = static_cast<std::size_t>(x - begin_);
    std::copy_n(in_.data() + passed * stride(), left * stride(), in_.data());
    begin_ = x;
}

float* ColumnTile::make_room(int columns) {
    const int held = end_ - begin_;
    end_ += columns;
    if (static_cast<std::size_t>(end_ - begin_) > from_.size()) make_columns(in_, from_, end_ - begin_, stride());
    return from_[static_cast<std::size_t>(held)];
}

void ColumnTile::append(View<const float> columns) { load(columns, make_room(columns.width)); }

void ColumnTile::append_zeros() { std::fill_n(make_room(1), stride(), 0.0f); }

void ColumnTile::load(View<const float> v, float* to) const {
    const auto step = static_cast<std::ptrdiff_t>(stride());
    switch (lanes_) {
        case Lanes::by_channel: return rows_to_lanes(v.data, v.dy, rows_, v.width * channels_, to, rows_);
        case Lanes::by_pixel: return pixels_to_lanes(v.data, v.dy, rows_, v.width, to, step);
        case Lanes::scattered:
            return for_each_row(v, [&](const float* row, int lane) {
                float* p = to + lane;
                for (int i = 0; i < v.width; ++i, row += v.dx, p += step) *p = *row;
            });
    }
}

void ColumnTile::store(View<float> v) const {
    const auto step = static_cast<std::ptrdiff_t>(stride());
    switch (lanes_) {
        case Lanes::by_channel: return lanes_to_rows(out_.data(), rows_, rows_, v.width * channels_, v.data, v.dy);
        case Lanes::by_pixel: return lanes_to_pixels(out_.data(), step, rows_, v.width, v.data, v.dy);
        case Lanes::scattered:
            return for_each_row(v, [&](float* row, int lane) {
                const float* p = out_.data() + lane;
                for (int i = 0; i < v.width; ++i, row += v.dx, p += step) *row = *p;
            });
    }
}

void ColumnTile::filter(const Bank& bank, const TileRun& run, float antiring, View<float> to) {
    const int outputs = run.last - run.first;
    if (static_cast<std::size_t>(outputs) > to_.size()) make_columns(out_, to_, outputs, stride());
    combine(bank, run.first, run.last, antiring, from_.data() - run.read.begin, to_.data(), stride());
    store(cropped(to, 0, 0, outputs, rows_));
}

/// As many rows as fill a tile, in whole vectors where their samples are side by side.
int rows_of_tile(int channels) {
    return std::max(1, tile_lanes / channels < 16 ? tile_lanes / channels : tile_lanes / channels / 16 * 16);
}

}  // namespace

std::vector<TileRun> tile_runs(const Bank& bank) { return tile_runs(bank, 0, bank.output_count()); }

std::vector<TileRun> tile_runs(const Bank& bank, int first, int last) {
    const int fitting = static_cast<int>(tile_bytes / (tile_lanes * std::ptrdiff_t{sizeof(float)}));
    std::vector<TileRun> runs;
    for (int i = first; i < last; ++i) {
        const IndexRange next = indices_read(bank, i, i + 1);
        if (!runs.empty()) {
            TileRun& run = runs.back();
            const IndexRange both{std::min(run.read.begin, next.begin), std::max(run.read.end, next.end)};
            // A long row of weights takes a longer tile, or each input would be loaded many times.
            const int inputs = std::max(fitting, 4 * bank.row_info(i).count);
            const bool fits = both.end - both.begin <= inputs && i - run.first < inputs;
            if (fits || (i - run.first) % run_multiple != 0) {
                run = {run.first, i + 1, both};
                continue;
            }
        }
        runs.push_back({i, i + 1, next});
    }
    return runs;
}

void apply_by_tiles(const Bank& bank, std::span<const TileRun> runs, View<const float> src, int first_input,
                    View<float> dst, int first_output, float antiring) {
    thread_local ColumnTile tile;
    const int most = rows_of_tile(src.channels), last_input = first_input + src.width;
    for (int y = 0; y < src.height; y += most) {
        const int rows = std::min(most, src.height - y);
        const View<const float> from = cropped(src, 0, y, src.width, rows);
        const View<float> to = cropped(dst, 0, y, dst.width, rows);
        const auto append = [&](int begin, int width) {
            tile.append(cropped(from, begin - first_input, 0, width, rows));
        };
        tile.start(from, to);
        for (const TileRun& run : runs) {
            tile.begin_at(run.read.begin);
            while (tile.end() < run.read.end) {
                const int begin = tile.end();
                if (begin >= first_input && begin < last_input) {
                    append(begin, std::min(aligned(run.read.end - first_input) + first_input, last_input) - begin);
                } else if (const int x = resolve(begin, bank.inputs, bank.edge); x >= 0) {
                    append(x, 1);
                } else {
                    tile.append_zeros();
                }
            }
            tile.filter(bank, run, antiring, cropped(to, run.first - first_output, 0, run.last - run.first, rows));
        }
    }
}

}  // namespace bandlimit
