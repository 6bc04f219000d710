#include "bandlimit/resample/apply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/lines.h"

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

constexpr int tile_lanes = 32;  // two vectors of 512 bits; 4096 of them are 512 KiB

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

/// Some lanes of an image at every x, side by side: the transposition that lets a horizontal filter run the vertical
/// loop.
class Tile {
public:
    explicit Tile(int lanes) : lanes_(lanes) {}
    /// `scratch` keeps its memory from call to call.
    void resize(int width, std::vector<float>& scratch) {
        const std::size_t needed = static_cast<std::size_t>(width) * static_cast<std::size_t>(lanes_);
        if (scratch.size() < needed) scratch.resize(needed);
        samples_ = scratch.data();
    }
    float* at(int x) const { return samples_ + x * lanes_; }

    void load(View<const float> v, std::ptrdiff_t lane, int count) const {
        for_each_run(v, lane, count, [&](const float* from, int k, auto run) {
            float* to = samples_ + k;
            for (int x = 0; x < v.width; ++x, from += v.dx, to += lanes_) std::copy_n(from, int{run}, to);
        });
    }
    void store(View<float> v, std::ptrdiff_t lane, int count) const {
        for_each_run(v, lane, count, [&](float* to, int k, auto run) {
            const float* from = samples_ + k;
            for (int x = 0; x < v.width; ++x, to += v.dx, from += lanes_) std::copy_n(from, int{run}, to);
        });
    }

private:
    std::ptrdiff_t lanes_;
    float* samples_ = nullptr;
};

/// Runs lanes [begin, end) through the bank, by way of tiles where a view is not contiguous.
void apply_lanes(const Bank& bank, IndexRange read, View<const float> src, View<float> dst, float antiring,
                 std::ptrdiff_t begin, std::ptrdiff_t end) {
    const bool direct_src = has_contiguous_lanes(src), direct_dst = has_contiguous_lanes(dst);
    const int step = direct_src && direct_dst ? std::numeric_limits<int>::max() : tile_lanes;
    const int lanes = static_cast<int>(std::min<std::ptrdiff_t>(step, end - begin));
    thread_local std::vector<float> in_scratch, out_scratch;  // 32 lanes of a row each: not worth new pages per call
    Tile in(tile_lanes), out(tile_lanes);
    if (!direct_src) in.resize(src.width, in_scratch);
    if (!direct_dst) out.resize(dst.width, out_scratch);
    std::vector<float*> to(static_cast<std::size_t>(dst.width));
    for (std::ptrdiff_t lane = begin; lane < end; lane += lanes) {
        const int count = static_cast<int>(std::min<std::ptrdiff_t>(lanes, end - lane));
        if (!direct_src) in.load(src, lane, count);
        const LineTable from(bank, read, [&](int i) { return direct_src ? &src(i, 0) + lane : in.at(i); });
        for (int i = 0; i < dst.width; ++i)
            to[static_cast<std::size_t>(i)] = direct_dst ? &dst(i, 0) + lane : out.at(i);
        combine(bank, 0, dst.width, antiring, from.at_zero(), to.data(), static_cast<std::size_t>(count));
        if (!direct_dst) out.store(dst, lane, count);
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
    const IndexRange read = indices_read(bank, 0, bank.output_count());
    parallel_for(lanes, tile_lanes * 4, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        apply_lanes(bank, read, src, dst, static_cast<float>(antiring), begin, end);
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
