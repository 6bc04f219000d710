#include "bandlimit/resample/tiles.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "bandlimit/core/allocator.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

constexpr std::ptrdiff_t tile_bytes = 16 << 10;  // of inputs: stays in the first cache beside the outputs
constexpr int run_multiple = 4;                 // pixels that fill a cache line

/// Calls copy(from pixel x to tile row x) for runs of lanes that are side by side in memory: whole pixels where
/// channels are interleaved and the run starts a pixel, else single samples.
template <class T, class Copy>
void for_each_run(View<T> v, std::ptrdiff_t lane, int count, Copy copy) {
    for (int k = 0; k < count;) {
        const int y = static_cast<int>((lane + k) / v.channels), c = static_cast<int>((lane + k) % v.channels);
        const int run = v.dc == 1 && c == 0 && k + v.channels <= count ? v.channels : 1;
        T* const first = &v(0, y, c);
        switch (run) {  // a constant length turns each copy into one or two moves
            case 2: copy(first, k, std::integral_constant<std::size_t, 2>()); break;
            case 3: copy(first, k, std::integral_constant<std::size_t, 3>()); break;
            case 4: copy(first, k, std::integral_constant<std::size_t, 4>()); break;
            default: copy(first, k, static_cast<std::size_t>(run));
        }
        k += run;
    }
}

/// Some lanes of an image for a run of x.
class Tile {
public:
    /// Room for rows [-slack, width) of `lanes` samples; `scratch` keeps its memory from call to call.
    Tile(int slack, int width, int lanes, std::vector<float, SampleAllocator<float>>& scratch)
        : stride_((lanes + 15) & ~15) {
        const std::size_t needed = static_cast<std::size_t>(slack + width) * static_cast<std::size_t>(stride_);
        if (scratch.size() < needed) scratch.resize(needed);
        samples_ = scratch.data() + slack * stride_;
    }
    float* at(int x) const { return samples_ + x * stride_; }

    /// Pixels [begin, begin + width) of the view to tile rows from x on.
    void load(View<const float> v, std::ptrdiff_t lane, int count, int begin, int width, int x) const {
        if (rows_are_lanes(v))
            return rows_to_lanes(&v(begin, static_cast<int>(lane)), v.dy, count, width, at(x), stride_);
        if (pixels_are_blocks(v))
            return pixels_to_lanes(&v(begin, static_cast<int>(lane / 4)), v.dy, count / 4, width, at(x), stride_);
        for_each_run(v, lane, count, [&](const float* from, int k, auto run) {
            from += begin * v.dx;
            float* to = at(x) + k;
            for (int i = 0; i < width; ++i, from += v.dx, to += stride_) std::memcpy(to, from, sizeof(float) * run);
        });
    }
    /// Tile rows [0, width) to pixels of the view from `begin` on.
    void store(View<float> v, std::ptrdiff_t lane, int count, int begin, int width) const {
        if (rows_are_lanes(v))
            return lanes_to_rows(samples_, stride_, count, width, &v(begin, static_cast<int>(lane)), v.dy);
        if (pixels_are_blocks(v))
            return lanes_to_pixels(samples_, stride_, count / 4, width, &v(begin, static_cast<int>(lane / 4)), v.dy);
        for_each_run(v, lane, count, [&](float* to, int k, auto run) {
            to += begin * v.dx;
            const float* from = samples_ + k;
            for (int i = 0; i < width; ++i, to += v.dx, from += stride_) std::memcpy(to, from, sizeof(float) * run);
        });
    }

private:
    template <class T>
    static bool rows_are_lanes(const View<T>& v) {
        return v.channels == 1 && v.dx == 1;
    }
    /// Tiles begin and end with whole pixels then: their lanes are a multiple of 4.
    template <class T>
    static bool pixels_are_blocks(const View<T>& v) {
        return v.channels == 4 && v.dx == 4 && v.dc == 1;
    }

    float* samples_ = nullptr;
    std::ptrdiff_t stride_;
};

/// Loads what a run of outputs reads; the edge resolves what lies outside of src, which begins at input `first`.
void load_inputs(const Tile& tile, const Bank& bank, IndexRange read, View<const float> src, int first,
                 std::ptrdiff_t lane, int count) {
    const int begin = std::clamp(first, read.begin, read.end), end = std::clamp(first + src.width, begin, read.end);
    // A few inputs more, so that blocks begin where cache lines do.
    const int more = (begin - first) % run_multiple;
    if (begin < end) tile.load(src, lane, count, begin - first - more, end - begin + more, begin - read.begin - more);
    const auto load_outside = [&](int v) {
        const int x = resolve(v, bank.inputs, bank.edge);
        if (x >= 0) tile.load(src, lane, count, x - first, 1, v - read.begin);
        else std::fill_n(tile.at(v - read.begin), count, 0.0f);
    };
    for (int v = read.begin; v < begin; ++v) load_outside(v);
    for (int v = end; v < read.end; ++v) load_outside(v);
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
                    View<float> dst, int first_output, float antiring, std::ptrdiff_t begin, std::ptrdiff_t end) {
    thread_local std::vector<float, SampleAllocator<float>> in_scratch, out_scratch;
    thread_local std::vector<const float*> from;
    thread_local std::vector<float*> to;
    const int widest = static_cast<int>(std::min<std::ptrdiff_t>(tile_lanes, end - begin));
    for (const TileRun& run : runs) {
        const int inputs = run.read.end - run.read.begin, outputs = run.last - run.first;
        const Tile in(run_multiple, inputs, widest, in_scratch), out(0, outputs, widest, out_scratch);
        from.clear();
        for (int i = 0; i < inputs; ++i) from.push_back(in.at(i));
        to.clear();
        for (int i = 0; i < outputs; ++i) to.push_back(out.at(i));
        for (std::ptrdiff_t lane = begin; lane < end; lane += tile_lanes) {
            const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile_lanes, end - lane));
            load_inputs(in, bank, run.read, src, first_input, lane, count);
            combine(bank, run.first, run.last, antiring, from.data() - run.read.begin, to.data(),
                    static_cast<std::size_t>(count));
            out.store(dst, lane, count, run.first - first_output, outputs);
        }
    }
}

}  // namespace bandlimit
