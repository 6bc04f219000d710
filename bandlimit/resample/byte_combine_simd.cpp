// The loops of byte_combine.h by vectors of x86: dot products of 8-bit rows by 8-bit weights, then of 16-bit pairs of
// pixels by 16-bit weights. Sums are exact, so every instruction set gives the same codes.
#include "bandlimit/resample/byte_combine.h"

#include <algorithm>
#include <cstring>

#if defined(BANDLIMIT_SCALAR) || !(defined(__x86_64__) || defined(_M_X64))

namespace bandlimit {
bool has_byte_vectors() { return false; }
void interleave_bytes(const std::uint8_t* const*, std::size_t, std::uint8_t*) {}
void combine_byte_rows(const ByteColumnTaps&, int, const std::uint8_t* const*, std::size_t, std::size_t, Pixel,
                       std::int16_t*) {}
void combine_byte_pairs(const BytePairs&, int, int, const std::int16_t*, int, Pixel, std::uint8_t* const*) {}
}  // namespace bandlimit

#else

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/resample/byte_combine_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

// Highway's list of instructions for AVX3_DL, which it chooses only where they are there, does not name this one.
#if HWY_TARGET == HWY_AVX3_DL
HWY_PUSH_ATTRIBUTES(HWY_TARGET_STR ",avx512vnni")
#else
HWY_BEFORE_NAMESPACE();
#endif
namespace bandlimit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

bool HasByteVectors() { return false; }
void InterleaveBytes(const std::uint8_t* const*, std::size_t, std::uint8_t*) {}
void CombineByteRows(const ByteColumnTaps&, int, const std::uint8_t* const*, std::size_t, std::size_t, Pixel,
                     std::int16_t*) {}
void CombineBytePairs(const BytePairs&, int, int, const std::int16_t*, int, Pixel, std::uint8_t* const*) {}

#else

bool HasByteVectors() { return true; }

using D8 = hn::ScalableTag<std::uint8_t>;
using D16 = hn::ScalableTag<std::int16_t>;
using D32 = hn::ScalableTag<std::int32_t>;
using V8 = hn::Vec<D8>;
using V16 = hn::Vec<D16>;
using V32 = hn::Vec<D32>;
constexpr D8 d8;
constexpr D16 d16;
constexpr D32 d32;
constexpr std::size_t kBytes = HWY_LANES(std::uint8_t);

/// sum + the four products of unsigned bytes by signed ones, per lane. Two adjacent products must fit 16 bits.
HWY_INLINE V32 DotBytes(V32 sum, V8 codes, V32 weights) {
#if HWY_TARGET == HWY_AVX3_DL
    return V32{_mm512_dpbusd_epi32(sum.raw, codes.raw, weights.raw)};
#elif HWY_TARGET == HWY_AVX3
    const __m512i products = _mm512_maddubs_epi16(codes.raw, weights.raw);
    return V32{_mm512_add_epi32(sum.raw, _mm512_madd_epi16(products, _mm512_set1_epi16(1)))};
#elif HWY_TARGET == HWY_AVX2
    const __m256i products = _mm256_maddubs_epi16(codes.raw, weights.raw);
    return V32{_mm256_add_epi32(sum.raw, _mm256_madd_epi16(products, _mm256_set1_epi16(1)))};
#else
    const __m128i products = _mm_maddubs_epi16(codes.raw, weights.raw);
    return V32{_mm_add_epi32(sum.raw, _mm_madd_epi16(products, _mm_set1_epi16(1)))};
#endif
}

/// sum + the two products of 16-bit samples, per lane.
HWY_INLINE V32 DotPairs(V32 sum, V16 samples, V32 weights) {
#if HWY_TARGET == HWY_AVX3_DL
    return V32{_mm512_dpwssd_epi32(sum.raw, samples.raw, weights.raw)};
#elif HWY_TARGET == HWY_AVX3
    return V32{_mm512_add_epi32(sum.raw, _mm512_madd_epi16(samples.raw, weights.raw))};
#elif HWY_TARGET == HWY_AVX2
    return V32{_mm256_add_epi32(sum.raw, _mm256_madd_epi16(samples.raw, weights.raw))};
#else
    return V32{_mm_add_epi32(sum.raw, _mm_madd_epi16(samples.raw, weights.raw))};
#endif
}

/// Per block of 128 bits: the lanes of a, then those of b.
HWY_INLINE V16 Pack(V32 a, V32 b) {
#if HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_AVX3
    return V16{_mm512_packs_epi32(a.raw, b.raw)};
#elif HWY_TARGET == HWY_AVX2
    return V16{_mm256_packs_epi32(a.raw, b.raw)};
#else
    return V16{_mm_packs_epi32(a.raw, b.raw)};
#endif
}
HWY_INLINE V8 PackCodes(V16 a, V16 b) {
#if HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_AVX3
    return V8{_mm512_packus_epi16(a.raw, b.raw)};
#elif HWY_TARGET == HWY_AVX2
    return V8{_mm256_packus_epi16(a.raw, b.raw)};
#else
    return V8{_mm_packus_epi16(a.raw, b.raw)};
#endif
}

/// Stores block b of 128 bits at rows[b] + offset, of which `bytes` are wanted.
template <std::size_t kBlocks = kBytes / 16>
HWY_INLINE void StoreBlocks(V8 v, std::uint8_t* const* rows, std::size_t row_step, std::size_t offset,
                            std::size_t bytes) {
    alignas(64) std::uint8_t blocks[kBytes];
    hn::Store(v, d8, blocks);
    for (std::size_t b = 0; b < kBlocks; ++b)
        if (std::uint8_t* const row = rows[b * row_step]) {
            if (bytes >= 16) std::memcpy(row + offset, blocks + 16 * b, 16);
            else std::memcpy(row + offset, blocks + 16 * b, bytes);
        }
}

/// The order of units of 8 bytes from which unpacking and packing, which work in blocks of 16, come out in sequence:
/// block b holds units b and b + (number of blocks).
HWY_INLINE auto BlockOrder() {
    constexpr std::size_t lanes = kBytes / 4;
    alignas(64) std::int32_t order[lanes];
    for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t block = l / 4, place = l % 4;
        order[l] = static_cast<std::int32_t>(place < 2 ? 2 * block + place : lanes / 2 + 2 * block + place - 2);
    }
    return hn::SetTableIndices(d32, order);
}

template <class Order>
HWY_INLINE V8 LoadOrdered(const std::uint8_t* from, Order order) {
    return hn::BitCast(d8, hn::TableLookupLanes(hn::BitCast(d32, hn::LoadU(d8, from)), order));
}

template <class Order>
HWY_INLINE void InterleaveColumn(const std::uint8_t* const (&rows)[4], Order order, std::uint8_t* out) {
    const V8 r0 = LoadOrdered(rows[0], order), r1 = LoadOrdered(rows[1], order);
    const V8 r2 = LoadOrdered(rows[2], order), r3 = LoadOrdered(rows[3], order);
    const V16 low01 = hn::BitCast(d16, hn::InterleaveLower(d8, r0, r1));
    const V16 low23 = hn::BitCast(d16, hn::InterleaveLower(d8, r2, r3));
    const V16 high01 = hn::BitCast(d16, hn::InterleaveUpper(d8, r0, r1));
    const V16 high23 = hn::BitCast(d16, hn::InterleaveUpper(d8, r2, r3));
    hn::Store(hn::BitCast(d8, hn::InterleaveLower(d16, low01, low23)), d8, out);
    hn::Store(hn::BitCast(d8, hn::InterleaveUpper(d16, low01, low23)), d8, out + kBytes);
    hn::Store(hn::BitCast(d8, hn::InterleaveLower(d16, high01, high23)), d8, out + 2 * kBytes);
    hn::Store(hn::BitCast(d8, hn::InterleaveUpper(d16, high01, high23)), d8, out + 3 * kBytes);
}

void InterleaveBytes(const std::uint8_t* const* rows, std::size_t bytes, std::uint8_t* out) {
    const auto order = BlockOrder();
    const std::size_t whole = bytes / kBytes * kBytes, padded = whole_columns(bytes);
    for (std::size_t k = 0; k < whole; k += kBytes)
        InterleaveColumn({rows[0] + k, rows[1] + k, rows[2] + k, rows[3] + k}, order, out + 4 * k);
    for (std::size_t k = whole; k < padded; k += kBytes) {
        alignas(64) std::uint8_t last[4][kBytes] = {};
        for (int r = 0; k < bytes && r < 4; ++r) std::memcpy(last[r], rows[r] + k, bytes - k);
        InterleaveColumn({last[0], last[1], last[2], last[3]}, order, out + 4 * k);
    }
}

/// (128 * high + low) >> bits - 6, but for that shift.
HWY_INLINE V32 Whole(V32 high, V32 low) { return hn::Add(low, hn::ShiftLeft<7>(high)); }

/// Stores the sums of one column; vector k holds bytes 4k..4k+3 of each block.
template <Pixel kPixel, int kShift>
HWY_INLINE void StoreSums(const V32* high, const V32* low, std::int16_t* out) {
    for (int half = 0; half < 2; ++half) {
        const V32 a = Whole(high[2 * half], low[2 * half]), b = Whole(high[2 * half + 1], low[2 * half + 1]);
        V16 result;
        if constexpr (kPixel == Pixel::four) {
            const V16 first = hn::BitCast(d16, hn::ShiftRight<kShift>(a));
            const V16 second = hn::BitCast(d16, hn::ShiftLeft<16 - kShift>(b));
            result = hn::OddEven(second, first);
        } else {
            result = Pack(hn::ShiftRight<kShift>(a), hn::ShiftRight<kShift>(b));
        }
        hn::Store(result, d16, out + static_cast<std::size_t>(half) * kBytes / 2);
    }
}

/// kColumns columns side by side share the weights.
template <Pixel kPixel, int kShift, int kColumns>
HWY_INLINE void CombineColumns(const ByteColumnTaps& taps, const std::uint8_t* const* groups, std::size_t k,
                               std::int16_t* out) {
    V32 high[4 * kColumns], low[4 * kColumns];
    for (int v = 0; v < 4 * kColumns; ++v) high[v] = hn::Zero(d32), low[v] = hn::Set(d32, 1 << (kShift - 1));
    const std::size_t count = taps.high.size();
    for (std::size_t g = 0; g < count; ++g) {
        const V32 high_weights = hn::Set(d32, taps.high[g]), low_weights = hn::Set(d32, taps.low[g]);
        const std::uint8_t* const codes = groups[g] + 4 * k;
        for (int v = 0; v < 4 * kColumns; ++v) {
            const V8 four_rows = hn::Load(d8, codes + static_cast<std::size_t>(v) * kBytes);
            high[v] = DotBytes(high[v], four_rows, high_weights);
            low[v] = DotBytes(low[v], four_rows, low_weights);
        }
    }
    for (int c = 0; c < kColumns; ++c)
        StoreSums<kPixel, kShift>(high + 4 * c, low + 4 * c, out + k + static_cast<std::size_t>(c) * kBytes);
}

template <Pixel kPixel, int kShift>
void CombineRow(const ByteColumnTaps& taps, const std::uint8_t* const* groups, std::size_t begin, std::size_t end,
                std::int16_t* out) {
    constexpr int columns = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL ? 2 : 1;  // 32 registers, or 16
    std::size_t k = begin;
    for (; k + columns * kBytes <= end; k += columns * kBytes)
        CombineColumns<kPixel, kShift, columns>(taps, groups, k, out);
    for (; k < end; k += kBytes) CombineColumns<kPixel, kShift, 1>(taps, groups, k, out);
}

void CombineByteRows(const ByteColumnTaps& taps, int bits, const std::uint8_t* const* groups, std::size_t begin,
                     std::size_t end, Pixel pixel, std::int16_t* out) {
    const auto run = pixel == Pixel::four ? (bits == 14 ? CombineRow<Pixel::four, 8> : CombineRow<Pixel::four, 7>)
                                          : (bits == 14 ? CombineRow<Pixel::one, 8> : CombineRow<Pixel::one, 7>);
    run(taps, groups, begin, end, out);
}

constexpr int kPairShift = 20;  // 14 bits of weights, 6 of samples
constexpr std::size_t kTileVectors = 2 * tile_pair / kBytes;

/// Sums of one output for kVectors vectors of rows.
template <int kVectors>
HWY_INLINE void SumPairs(const BytePairs& pairs, int output, const std::int16_t* tile, int first_pair, V32* sums) {
    const BytePairs::Output& at = pairs.outputs[static_cast<std::size_t>(output)];
    const std::int32_t* const weights = pairs.weights.data() + at.offset;
    const std::int16_t* samples = tile + (at.first_pair - first_pair) * static_cast<std::ptrdiff_t>(tile_pair);
    for (int u = 0; u < kVectors; ++u) sums[u] = hn::Set(d32, 1 << (kPairShift - 1));
    for (int p = 0; p < at.count; ++p, samples += tile_pair) {
        const V32 w = hn::Set(d32, weights[p]);
        for (int u = 0; u < kVectors; ++u)
            sums[u] = DotPairs(sums[u], hn::Load(d16, samples + static_cast<std::size_t>(u) * kBytes / 2), w);
    }
    for (int u = 0; u < kVectors; ++u) sums[u] = hn::ShiftRight<kPairShift>(sums[u]);
}

/// Four outputs of kVectors vectors of rows: per lane of 32 bits of sums, the codes in four bytes, outputs apart.
template <int kVectors>
HWY_INLINE void FourOutputs(const BytePairs& pairs, int i, int end, const std::int16_t* tile, int first_pair,
                            V8* codes) {
    V32 sums[4][kVectors];
    for (int o = 0; o < 4; ++o) SumPairs<kVectors>(pairs, std::min(i + o, end - 1), tile, first_pair, sums[o]);
    for (int u = 0; u < kVectors; ++u) codes[u] = PackCodes(Pack(sums[0][u], sums[1][u]), Pack(sums[2][u], sums[3][u]));
}

template <int kVectors>
void PixelsOfFour(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, int first_pair,
                  std::uint8_t* const* rows) {
    constexpr std::size_t blocks = kBytes / 16;  // a row each
    for (int i = begin; i < end; i += 4) {
        V8 codes[kVectors];
        FourOutputs<kVectors>(pairs, i, end, tile, first_pair, codes);
        const std::size_t wanted = static_cast<std::size_t>(std::min(4, end - i)) * 4;
        for (std::size_t u = 0; u < kVectors; ++u)
            StoreBlocks(codes[u], rows + u * blocks, 1, static_cast<std::size_t>(i - begin) * 4, wanted);
    }
}

/// Swaps rows and columns of the 4 x 4 lanes of each block.
HWY_INLINE void TransposeBlocks(V32* v) {
    const hn::ScalableTag<std::int64_t> d64;
    const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d32, v[0], v[1]));
    const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d32, v[2], v[3]));
    const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d32, v[0], v[1]));
    const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d32, v[2], v[3]));
    v[0] = hn::BitCast(d32, hn::InterleaveLower(d64, low01, low23));
    v[1] = hn::BitCast(d32, hn::InterleaveUpper(d64, low01, low23));
    v[2] = hn::BitCast(d32, hn::InterleaveLower(d64, high01, high23));
    v[3] = hn::BitCast(d32, hn::InterleaveUpper(d64, high01, high23));
}

template <int kVectors>
void PixelsOfOne(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, int first_pair,
                 std::uint8_t* const* rows) {
    // Within a block, from outputs apart to rows apart.
    alignas(16) static constexpr std::uint8_t kByRow[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
    const V8 by_row = hn::LoadDup128(d8, kByRow);
    for (int i = begin; i < end; i += 16) {
        V32 lanes[kVectors][4];  // lane = row, its bytes = four outputs
        for (int m = 0; m < 4; ++m) {
            V8 codes[kVectors];
            FourOutputs<kVectors>(pairs, std::min(i + 4 * m, end - 1), end, tile, first_pair, codes);
            for (int u = 0; u < kVectors; ++u) lanes[u][m] = hn::BitCast(d32, hn::TableLookupBytes(codes[u], by_row));
        }
        const std::size_t wanted = static_cast<std::size_t>(std::min(16, end - i));
        for (std::size_t u = 0; u < kVectors; ++u) {
            TransposeBlocks(lanes[u]);
            for (std::size_t r = 0; r < 4; ++r)
                StoreBlocks(hn::BitCast(d8, lanes[u][r]), rows + u * kBytes / 4 + r, 4,
                            static_cast<std::size_t>(i - begin), wanted);
        }
    }
}

void CombineBytePairs(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, int first_pair, Pixel pixel,
                      std::uint8_t* const* rows) {
    for (std::size_t u = 0; u < kTileVectors; u += 2) {
        const std::int16_t* const part = tile + u * kBytes / 2;
        if (pixel == Pixel::four) PixelsOfFour<2>(pairs, begin, end, part, first_pair, rows + u * kBytes / 16);
        else PixelsOfOne<2>(pairs, begin, end, part, first_pair, rows + u * kBytes / 4);
    }
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
HWY_EXPORT(HasByteVectors);
HWY_EXPORT(InterleaveBytes);
HWY_EXPORT(CombineByteRows);
HWY_EXPORT(CombineBytePairs);
bool has_byte_vectors() { return HWY_DYNAMIC_DISPATCH(HasByteVectors)(); }
void interleave_bytes(const std::uint8_t* const* rows, std::size_t bytes, std::uint8_t* out) {
    HWY_DYNAMIC_DISPATCH(InterleaveBytes)(rows, bytes, out);
}
void combine_byte_rows(const ByteColumnTaps& taps, int bits, const std::uint8_t* const* groups, std::size_t begin,
                       std::size_t end, Pixel pixel, std::int16_t* out) {
    HWY_DYNAMIC_DISPATCH(CombineByteRows)(taps, bits, groups, begin, end, pixel, out);
}
void combine_byte_pairs(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, int first_pair,
                        Pixel pixel, std::uint8_t* const* rows) {
    HWY_DYNAMIC_DISPATCH(CombineBytePairs)(pairs, begin, end, tile, first_pair, pixel, rows);
}
}  // namespace bandlimit
#endif

#endif
