#include "bandlimit/resample/apply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/overlap.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/lines.h"
#include "bandlimit/resample/tiles.h"

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

/// Runs lanes [begin, end) through the bank where a column of pixels is contiguous in both views.
void apply_in_place(const Bank& bank, View<const float> src, View<float> dst, float antiring, std::ptrdiff_t begin,
                    std::ptrdiff_t end) {
    const LineTable from(bank, indices_read(bank, 0, bank.output_count()), [&](int i) { return &src(i, 0) + begin; });
    std::vector<float*> to;
    for (int i = 0; i < dst.width; ++i) to.push_back(&dst(i, 0) + begin);
    combine(bank, 0, dst.width, antiring, from.at_zero(), to.data(), static_cast<std::size_t>(end - begin));
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
    check_apart("apply", src, dst);
    check_antiring(antiring);
    const auto strength = static_cast<float>(antiring);
    if (has_contiguous_lanes(src) && has_contiguous_lanes(dst)) {
        const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(src.height) * src.channels;
        return parallel_for(lanes, 2 * tile_lanes, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            apply_in_place(bank, src, dst, strength, begin, end);
        });
    }
    const std::vector<TileRun> runs = tile_runs(bank);
    parallel_for(src.height, tile_lanes, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        const int y = static_cast<int>(begin), rows = static_cast<int>(end - begin);
        apply_by_tiles(bank, runs, cropped(src, 0, y, src.width, rows), 0, cropped(dst, 0, y, dst.width, rows), 0,
                       strength);
    });
}

void apply_scalar(const Bank& bank, View<const float> src, View<float> dst, double antiring) {
    check_shapes("apply_scalar", bank, src.width, dst.width, same_lines(src, dst));
    check_apart("apply_scalar", src, dst);
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
    check_apart("apply_adjoint", src, dst);
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
