// Transposition by blocks of 4 x 4 samples, in vectors of 128 bits.
#include "bandlimit/resample/transpose.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/resample/transpose.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"
#include "bandlimit/core/transpose4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS

void RowsToLanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride) {
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < count; ++y) lanes[x * stride + y] = rows[y * pitch + x];
}
void PixelsToLanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride) {
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < count; ++y) std::copy_n(rows + y * pitch + 4 * x, 4, lanes + x * stride + 4 * y);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlock = 4;
HWY_INLINE void TransposeBlock(const float* rows, std::ptrdiff_t pitch, float* lanes, std::ptrdiff_t stride) {
    const hn::Full128<float> d;
    hn::Vec<decltype(d)> v[4] = {hn::LoadU(d, rows), hn::LoadU(d, rows + pitch), hn::LoadU(d, rows + 2 * pitch),
                                 hn::LoadU(d, rows + 3 * pitch)};
    Transpose4(v);
    for (int i = 0; i < 4; ++i) hn::StoreU(v[i], d, lanes + i * stride);
}

#if HWY_TARGET == HWY_AVX3_DL
/// Block b of row k of a tall block of 16 x 4 samples comes from row 4 * b + k.
constexpr int kTall = 16;
HWY_INLINE auto LoadBlocks(const float* from, std::ptrdiff_t step) {
    __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(from));
    v = _mm512_insertf32x4(v, _mm_loadu_ps(from + step), 1);
    v = _mm512_insertf32x4(v, _mm_loadu_ps(from + 2 * step), 2);
    return hn::Vec<hn::ScalableTag<float>>{_mm512_insertf32x4(v, _mm_loadu_ps(from + 3 * step), 3)};
}
HWY_INLINE void TransposeTallBlock(const float* rows, std::ptrdiff_t pitch, float* lanes, std::ptrdiff_t stride) {
    const hn::ScalableTag<float> d;
    hn::Vec<decltype(d)> v[4] = {LoadBlocks(rows, 4 * pitch), LoadBlocks(rows + pitch, 4 * pitch),
                                 LoadBlocks(rows + 2 * pitch, 4 * pitch), LoadBlocks(rows + 3 * pitch, 4 * pitch)};
    Transpose4(v);
    for (int i = 0; i < 4; ++i) hn::StoreU(v[i], d, lanes + i * stride);
}
#else
constexpr int kTall = kBlock;
HWY_INLINE void TransposeTallBlock(const float* rows, std::ptrdiff_t pitch, float* lanes, std::ptrdiff_t stride) {
    TransposeBlock(rows, pitch, lanes, stride);
}
#endif

void RowsToLanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride) {
    const int whole_width = width & ~3, whole_count = count & ~3;
    for (int x = 0; x < whole_width; x += kBlock) {
        int y = 0;
        for (; y + kTall <= whole_count; y += kTall)
            TransposeTallBlock(rows + y * pitch + x, pitch, lanes + x * stride + y, stride);
        for (; y < whole_count; y += kBlock)
            TransposeBlock(rows + y * pitch + x, pitch, lanes + x * stride + y, stride);
    }
    for (int x = 0; x < width; ++x)
        for (int y = x < whole_width ? whole_count : 0; y < count; ++y) lanes[x * stride + y] = rows[y * pitch + x];
}

#if HWY_TARGET == HWY_AVX3_DL
/// Rows and columns of 4 x 4 pixels.
constexpr int kPixels = 4;
HWY_INLINE void TransposePixels(const float* from, std::ptrdiff_t from_step, float* to, std::ptrdiff_t to_step) {
    const __m512 r0 = _mm512_loadu_ps(from), r1 = _mm512_loadu_ps(from + from_step);
    const __m512 r2 = _mm512_loadu_ps(from + 2 * from_step), r3 = _mm512_loadu_ps(from + 3 * from_step);
    const __m512 low01 = _mm512_shuffle_f32x4(r0, r1, 0x44), high01 = _mm512_shuffle_f32x4(r0, r1, 0xee);
    const __m512 low23 = _mm512_shuffle_f32x4(r2, r3, 0x44), high23 = _mm512_shuffle_f32x4(r2, r3, 0xee);
    _mm512_storeu_ps(to, _mm512_shuffle_f32x4(low01, low23, 0x88));
    _mm512_storeu_ps(to + to_step, _mm512_shuffle_f32x4(low01, low23, 0xdd));
    _mm512_storeu_ps(to + 2 * to_step, _mm512_shuffle_f32x4(high01, high23, 0x88));
    _mm512_storeu_ps(to + 3 * to_step, _mm512_shuffle_f32x4(high01, high23, 0xdd));
}
#else
constexpr int kPixels = 1;
HWY_INLINE void TransposePixels(const float* from, std::ptrdiff_t, float* to, std::ptrdiff_t) {
    std::copy_n(from, 4, to);
}
#endif

/// to[j * to_step + 4 * i ...] = from[i * from_step + 4 * j ...], for pixels of four samples.
HWY_INLINE void TransposeAllPixels(const float* from, std::ptrdiff_t from_step, int rows, int columns, float* to,
                                   std::ptrdiff_t to_step) {
    const int whole_rows = rows / kPixels * kPixels, whole_columns = columns / kPixels * kPixels;
    for (int j = 0; j < whole_columns; j += kPixels)
        for (int i = 0; i < whole_rows; i += kPixels)
            TransposePixels(from + i * from_step + 4 * j, from_step, to + j * to_step + 4 * i, to_step);
    for (int j = 0; j < columns; ++j)
        for (int i = j < whole_columns ? whole_rows : 0; i < rows; ++i)
            std::copy_n(from + i * from_step + 4 * j, 4, to + j * to_step + 4 * i);
}

void PixelsToLanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride) {
    TransposeAllPixels(rows, pitch, count, width, lanes, stride);
}

#endif  // BANDLIMIT_NO_VECTORS

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
BANDLIMIT_EXPORT(RowsToLanes);
BANDLIMIT_EXPORT(PixelsToLanes);
void pixels_to_lanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes,
                     std::ptrdiff_t stride) {
    BANDLIMIT_DISPATCH(PixelsToLanes)(rows, pitch, count, width, lanes, stride);
}
void rows_to_lanes(const float* rows, std::ptrdiff_t pitch, int count, int width, float* lanes, std::ptrdiff_t stride) {
    BANDLIMIT_DISPATCH(RowsToLanes)(rows, pitch, count, width, lanes, stride);
}
}  // namespace bandlimit
#endif
