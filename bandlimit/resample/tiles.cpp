#include "bandlimit/resample/tiles.h"

#include <algorithm>

#include "bandlimit/core/allocator.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

constexpr std::ptrdiff_t tile_bytes = 16 << 10;  // of inputs: stays in the first cache beside the outputs
constexpr int run_multiple = 4;                  // pixels that fill a cache line

/// How the samples of some rows lie side by side in a tile, at each x.
enum class Lanes {
    by_channel,  ///< (channel, row), where rows are contiguous: samples of a row become rows of the tile
    by_pixel,    ///< (row, channel), where rows are contiguous and pixels of four fill a block of a vector
    scattered    ///< (row, channel), from anywhere
};

template <class T>
bool is_interleaved(const View<T>& v) {
    return v.dx == v.channels && (v.channels == 1 || v.dc == 1);
}

template <class A, class B>
Lanes lanes_of(const View<A>& src, const View<B>& dst) {
    if (!is_interleaved(src) || !is_interleaved(dst)) return Lanes::scattered;
    return src.channels == 4 ? Lanes::by_pixel : Lanes::by_channel;
}

/// Some rows of an image for a run of x.
class Tile {
public:
    /// Room for pixels [-slack, width) of so many rows; `scratch` keeps its memory from call to call.
    Tile(Lanes lanes, int rows, int channels, int slack, int width, std::vector<float, SampleAllocator<float>>& scratch)
        : lanes_(lanes), rows_(rows), stride_(std::ptrdiff_t{rows} * channels) {
        const std::size_t needed = static_cast<std::size_t>(slack + width) * static_cast<std::size_t>(stride_);
        if (scratch.size() < needed) scratch.resize(needed);
        samples_ = scratch.data() + slack * stride_;
    }
    float* at(int x) const { return samples_ + x * stride_; }

    /// Pixels [begin, begin + width) of the view, which has the tile's rows, to the tile from x on.
    void load(View<const float> v, int begin, int width, int x) const {
        const float* const from = &v(begin, 0);
        switch (lanes_) {
            case Lanes::by_channel: return rows_to_lanes(from, v.dy, rows_, width * v.channels, at(x), rows_);
            case Lanes::by_pixel: return pixels_to_lanes(from, v.dy, rows_, width, at(x), stride_);
            case Lanes::scattered:
                return for_each_row(v, begin, [&](const float* row, int lane) {
                    float* to = at(x) + lane;
                    for (int i = 0; i < width; ++i, row += v.dx, to += stride_) *to = *row;
                });
        }
    }
    /// Pixels [0, width) of the tile to the view from `begin` on.
    void store(View<float> v, int begin, int width) const {
        float* const to = &v(begin, 0);
        switch (lanes_) {
            case Lanes::by_channel: return lanes_to_rows(samples_, rows_, rows_, width * v.channels, to, v.dy);
            case Lanes::by_pixel: return lanes_to_pixels(samples_, stride_, rows_, width, to, v.dy);
            case Lanes::scattered:
                return for_each_row(v, begin, [&](float* row, int lane) {
                    const float* from = samples_ + lane;
                    for (int i = 0; i < width; ++i, row += v.dx, from += stride_) *row = *from;
                });
        }
    }

private:
    /// Calls visit(pixel `begin` of one channel of a row, its lane).
    template <class T, class Visit>
    void for_each_row(View<T> v, int begin, Visit visit) const {
        for (int y = 0; y < rows_; ++y)
            for (int c = 0; c < v.channels; ++c) visit(&v(begin, y, c), y * v.channels + c);
    }

    Lanes lanes_;
    int rows_;
    std::ptrdiff_t stride_;
    float* samples_ = nullptr;
};

/// Loads what a run of outputs reads; the edge resolves what lies outside of src, which begins at input `first`.
void load_inputs(const Tile& tile, const Bank& bank, IndexRange read, View<const float> src, int first,
                 std::size_t lanes) {
    const int begin = std::clamp(first, read.begin, read.end), end = std::clamp(first + src.width, begin, read.end);
    // A few inputs more, so that blocks begin where cache lines do.
    const int more = (begin - first) % run_multiple;
    if (begin < end) tile.load(src, begin - first - more, end - begin + more, begin - read.begin - more);
    const auto load_outside = [&](int v) {
        const int x = resolve(v, bank.inputs, bank.edge);
        if (x >= 0) tile.load(src, x - first, 1, v - read.begin);
        else std::fill_n(tile.at(v - read.begin), lanes, 0.0f);
    };
    for (int v = read.begin; v < begin; ++v) load_outside(v);
    for (int v = end; v < read.end; ++v) load_outside(v);
}

/// As many rows as fill a tile, in whole vectors where their samples are side by side.
int rows_of_tile(int channels) {
    return std::max(1, tile_lanes / channels < 16 ? tile_lanes / channels : tile_lanes / channels / 16 * 16);
}

}  // namespace

std::vector<TileRun> tile_runs(const Bank& bank) {
    const int fitting = static_cast<int>(tile_bytes / (tile_lanes * std::ptrdiff_t{sizeof(float)}));
    std::vector<TileRun> runs;
    for (int i = 0; i < bank.output_count(); ++i) {
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
    thread_local std::vector<float, SampleAllocator<float>> in_scratch, out_scratch;
    thread_local std::vector<const float*> from;
    thread_local std::vector<float*> to;
    const Lanes lanes = lanes_of(src, dst);
    const int most = rows_of_tile(src.channels);
    for (int y = 0; y < src.height; y += most) {
        const int rows = std::min(most, src.height - y);
        const auto length = static_cast<std::size_t>(rows) * static_cast<std::size_t>(src.channels);
        const View<const float> src_rows = cropped(src, 0, y, src.width, rows);
        const View<float> dst_rows = cropped(dst, 0, y, dst.width, rows);
        for (const TileRun& run : runs) {
            const int inputs = run.read.end - run.read.begin, outputs = run.last - run.first;
            const Tile in(lanes, rows, src.channels, run_multiple, inputs, in_scratch);
            const Tile out(lanes, rows, src.channels, 0, outputs, out_scratch);
            from.clear();
            for (int i = 0; i < inputs; ++i) from.push_back(in.at(i));
            to.clear();
            for (int i = 0; i < outputs; ++i) to.push_back(out.at(i));
            load_inputs(in, bank, run.read, src_rows, first_input, length);
            combine(bank, run.first, run.last, antiring, from.data() - run.read.begin, to.data(), length);
            out.store(dst_rows, run.first - first_output, outputs);
        }
    }
}

}  // namespace bandlimit
