#include "bandlimit/resample/apply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/transpose.h"

namespace bandlimit {
namespace {

void check_shapes(const char* function, const Bank& bank, int inputs, int outputs, bool same_lines) {
    if (inputs != bank.inputs || outputs != bank.output_count() || !same_lines)
        fail(function, ": the bank takes ", bank.inputs, " samples to ", bank.output_count(), ", the views ", inputs,
             " to ", outputs, same_lines ? "" : " with different heights or channels",
             "; widths must be those of the bank, heights and channels equal");
}

template <class A, class B>
bool same_lines(const View<A>& a, const View<B>& b) {
    return a.height == b.height && a.channels == b.channels;
}

void check_antiring(double antiring) {
    if (!(antiring >= 0 && antiring <= 1)) fail("apply: antiring = ", antiring, "; pass 0 (off) to 1 (no overshoot)");
}

/// The lanes of an image are its samples at one x, in the order (y, channel): row after row if the channels of a pixel
/// lie together. They are contiguous where a column of pixels is.
template <class T>
bool has_contiguous_lanes(const View<T>& v) {
    if (v.channels == 1) return v.dy == 1 || v.height == 1;
    return v.dc == 1 && (v.dy == v.channels || v.height == 1);
}

constexpr int tile_lanes = 64;                  // four vectors of 512 bits
constexpr std::ptrdiff_t tile_bytes = 1 << 15;  // of inputs: stays in the first cache beside the outputs

/// Calls copy(from pixel x to tile row x) for runs of lanes that are side by side in memory: whole pixels where
/// channels are interleaved and the run starts a pixel, else single samples.
template <class T, class Copy>
void for_each_run(View<T> v, std::ptrdiff_t lane, int count, Copy copy) {
    for (int k = 0; k < count;) {
        const int y = static_cast<int>((lane + k) / v.channels), c = static_cast<int>((lane + k) % v.channels);
        const int run = v.dc == 1 && c == 0 && k + v.channels <= count ? v.channels : 1;
        T* const first = &v(0, y, c);
        switch (run) {  // a constant length turns each copy into one or two moves
            case 2: copy(first, k, std::integral_constant<int, 2>()); break;
            case 3: copy(first, k, std::integral_constant<int, 3>()); break;
            case 4: copy(first, k, std::integral_constant<int, 4>()); break;
            default: copy(first, k, run);
        }
        k += run;
    }
}

/// Some lanes of an image for a run of x, side by side: the transposition that lets a horizontal filter run the
/// vertical loop.
class Tile {
public:
    /// `scratch` keeps its memory from call to call.
    Tile(int width, std::vector<float>& scratch) {
        const std::size_t needed = static_cast<std::size_t>(width) * tile_lanes;
        if (scratch.size() < needed) scratch.resize(needed);
        samples_ = scratch.data();
    }
    float* at(int x) const { return samples_ + static_cast<std::ptrdiff_t>(x) * tile_lanes; }

    /// Pixels [begin, begin + width) of the view to tile rows from x on.
    void load(View<const float> v, std::ptrdiff_t lane, int count, int begin, int width, int x) const {
        if (rows_are_lanes(v))
            return rows_to_lanes(&v(begin, static_cast<int>(lane)), v.dy, count, width, at(x), tile_lanes);
        for_each_run(v, lane, count, [&](const float* from, int k, auto run) {
            from += begin * v.dx;
            float* to = at(x) + k;
            for (int i = 0; i < width; ++i, from += v.dx, to += tile_lanes) std::copy_n(from, int{run}, to);
        });
    }
    /// Tile rows [0, width) to pixels of the view from `begin` on.
    void store(View<float> v, std::ptrdiff_t lane, int count, int begin, int width) const {
        if (rows_are_lanes(v))
            return lanes_to_rows(samples_, tile_lanes, count, width, &v(begin, static_cast<int>(lane)), v.dy);
        for_each_run(v, lane, count, [&](float* to, int k, auto run) {
            to += begin * v.dx;
            const float* from = samples_ + k;
            for (int i = 0; i < width; ++i, to += v.dx, from += tile_lanes) std::copy_n(from, int{run}, to);
        });
    }

private:
    template <class T>
    static bool rows_are_lanes(const View<T>& v) {
        return v.channels == 1 && v.dx == 1;
    }

    float* samples_ = nullptr;
};

/// The outputs from `first` on whose inputs fit a tile, at least one.
int outputs_of_tile(const Bank& bank, int first) {
    const int fitting = static_cast<int>(tile_bytes / (tile_lanes * std::ptrdiff_t{sizeof(float)}));
    // A long row of weights takes a longer tile, or each input would be loaded many times.
    const int inputs = std::max(fitting, 4 * bank.row_info(first).count);
    IndexRange range = indices_read(bank, first, first + 1);
    int last = first + 1;
    for (; last < bank.output_count() && last - first < inputs; ++last) {
        const IndexRange next = indices_read(bank, last, last + 1);
        range = {std::min(range.begin, next.begin), std::max(range.end, next.end)};
        if (range.end - range.begin > inputs) break;
    }
    return last - first;
}

/// Loads what a run of outputs reads, with what lies outside resolved by the edge.
void load_inputs(const Tile& tile, const Bank& bank, IndexRange read, View<const float> src, std::ptrdiff_t lane,
                 int count) {
    const int begin = std::clamp(0, read.begin, read.end), end = std::clamp(bank.inputs, begin, read.end);
    if (begin < end) tile.load(src, lane, count, begin, end - begin, begin - read.begin);
    const auto load_outside = [&](int v) {
        const int x = resolve(v, bank.inputs, bank.edge);
        if (x >= 0) tile.load(src, lane, count, x, 1, v - read.begin);
        else std::fill_n(tile.at(v - read.begin), count, 0.0f);
    };
    for (int v = read.begin; v < begin; ++v) load_outside(v);
    for (int v = end; v < read.end; ++v) load_outside(v);
}

/// Runs lanes [begin, end) through the bank where a column of pixels is contiguous in both views.
void apply_in_place(const Bank& bank, View<const float> src, View<float> dst, float antiring, std::ptrdiff_t begin,
                    std::ptrdiff_t end) {
    const LineTable from(bank, indices_read(bank, 0, bank.output_count()), [&](int i) { return &src(i, 0) + begin; });
    std::vector<float*> to;
    for (int i = 0; i < dst.width; ++i) to.push_back(&dst(i, 0) + begin);
    combine(bank, 0, dst.width, antiring, from.at_zero(), to.data(), static_cast<std::size_t>(end - begin));
}

/// Runs lanes [begin, end) through the bank by way of tiles, a run of outputs at a time.
void apply_by_tiles(const Bank& bank, View<const float> src, View<float> dst, float antiring, std::ptrdiff_t begin,
                    std::ptrdiff_t end) {
    thread_local std::vector<float> in_scratch, out_scratch;
    std::vector<const float*> from;
    std::vector<float*> to;
    for (int first = 0, outputs = 0; first < dst.width; first += outputs) {
        outputs = outputs_of_tile(bank, first);
        const IndexRange read = indices_read(bank, first, first + outputs);
        const Tile in(read.end - read.begin, in_scratch), out(outputs, out_scratch);
        from.resize(static_cast<std::size_t>(read.end - read.begin));
        for (std::size_t i = 0; i < from.size(); ++i) from[i] = in.at(static_cast<int>(i));
        to.resize(static_cast<std::size_t>(outputs));
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = out.at(static_cast<int>(i));
        for (std::ptrdiff_t lane = begin; lane < end; lane += tile_lanes) {
            const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile_lanes, end - lane));
            load_inputs(in, bank, read, src, lane, count);
            combine(bank, first, first + outputs, antiring, from.data() - read.begin, to.data(),
                    static_cast<std::size_t>(count));
            out.store(dst, lane, count, first, outputs);
        }
    }
}

}  // namespace

IndexRange indices_read(const Bank& bank, int first, int last) {
    IndexRange range{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    for (int i = first; i < last; ++i) {
        range.begin = std::min(range.begin, bank.first(i));
        range.end = std::max(range.end, bank.first(i) + bank.row_info(i).count);
    }
    return range;
}

void apply(const Bank& bank, View<const float> src, View<float> dst, Parallel parallel, double antiring) {
    check_shapes("apply", bank, src.width, dst.width, same_lines(src, dst));
    check_antiring(antiring);
    const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(src.height) * src.channels;
    const auto run = has_contiguous_lanes(src) && has_contiguous_lanes(dst) ? apply_in_place : apply_by_tiles;
    parallel_for(lanes, tile_lanes * 2, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        run(bank, src, dst, static_cast<float>(antiring), begin, end);
    });
}

void apply_scalar(const Bank& bank, View<const float> src, View<float> dst, double antiring) {
    check_shapes("apply_scalar", bank, src.width, dst.width, same_lines(src, dst));
    check_antiring(antiring);
    const IndexRange read = indices_read(bank, 0, bank.output_count());
    for (int c = 0; c < src.channels; ++c)
        for (int y = 0; y < src.height; ++y) {
            const LineTable from(bank, read, [&](int i) { return &src(i, y, c); });
            for (int i = 0; i < dst.width; ++i) {
                float* const to = &dst(i, y, c);
                combine_scalar(bank, i, i + 1, static_cast<float>(antiring), from.at_zero(), &to, 1);
            }
        }
}

void apply_adjoint(const Bank& bank, View<const float> src, View<float> dst, Parallel parallel) {
    check_shapes("apply_adjoint", bank, dst.width, src.width, same_lines(src, dst));
    parallel_for(static_cast<std::ptrdiff_t>(src.height) * src.channels, 16, parallel,
                 [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                     for (std::ptrdiff_t lane = begin; lane < end; ++lane) {
                         const int y = static_cast<int>(lane / src.channels), c = static_cast<int>(lane % src.channels);
                         for (int x = 0; x < dst.width; ++x) dst(x, y, c) = 0;
                         for (int i = 0; i < src.width; ++i) {
                             const std::span<const float> row = bank.row(i);
                             for (int j = 0; j < static_cast<int>(row.size()); ++j) {
                                 float& to = dst(resolve(bank.first(i) + j, bank.inputs, bank.edge), y, c);
                                 to = std::fma(row[static_cast<std::size_t>(j)], src(i, y, c), to);
                             }
                         }
                     }
                 });
}

}  // namespace bandlimit
