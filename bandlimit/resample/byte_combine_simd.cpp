// The loops of byte_combine.h by vectors of x86: dot products of 8-bit rows by 8-bit weights, then of 16-bit pairs of
// pixels by 16-bit weights. Sums are exact, so every instruction set gives the same codes.
#include "bandlimit/resample/byte_combine.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/resample/byte_combine_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"
#include "bandlimit/core/transpose4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS || !HWY_ARCH_X86

const ByteLoops* Loops() { return nullptr; }

#else

namespace hn = hwy::HWY_NAMESPACE;

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
    // As the compilers' function has it, but GCC 12 then copies each sum twice per product.
    __asm__("vpdpbusd %2, %1, %0" : "+v"(sum.raw) : "v"(codes.raw), "v"(weights.raw));
    return sum;
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
    __asm__("vpdpwssd %2, %1, %0" : "+v"(sum.raw) : "v"(samples.raw), "v"(weights.raw));
    return sum;
#elif HWY_TARGET == HWY_AVX2
    return V32{_mm256_add_epi32(sum.raw, _mm256_madd_epi16(samples.raw, weights.raw))};
#else
    return V32{_mm_add_epi32(sum.raw, _mm_madd_epi16(samples.raw, weights.raw))};
#endif
}

/// The sums of adjacent bytes.
HWY_INLINE V16 PairSums(V8 codes) {
#if HWY_TARGET == HWY_AVX3_DL
    return V16{_mm512_maddubs_epi16(codes.raw, _mm512_set1_epi8(1))};
#elif HWY_TARGET == HWY_AVX2
    return V16{_mm256_maddubs_epi16(codes.raw, _mm256_set1_epi8(1))};
#else
    return V16{_mm_maddubs_epi16(codes.raw, _mm_set1_epi8(1))};
#endif
}

/// Per block of 128 bits: the lanes of a, then those of b.
HWY_INLINE V16 Pack(V32 a, V32 b) {
#if HWY_TARGET == HWY_AVX3_DL
    return V16{_mm512_packs_epi32(a.raw, b.raw)};
#elif HWY_TARGET == HWY_AVX2
    return V16{_mm256_packs_epi32(a.raw, b.raw)};
#else
    return V16{_mm_packs_epi32(a.raw, b.raw)};
#endif
}
HWY_INLINE V8 PackCodes(V16 a, V16 b) {
#if HWY_TARGET == HWY_AVX3_DL
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

/// Moves pixels of `from` bytes to pixels of `to`, four at a time by one shuffle of 16 bytes, of which some may belong
/// to the next: they are written over.
HWY_INLINE void MovePixels(const std::uint8_t* in, std::size_t from, std::uint8_t* out, std::size_t to,
                           std::size_t pixels) {
    const hn::Full128<std::uint8_t> d;
    alignas(16) std::uint8_t places[16];
    for (std::size_t i = 0; i < 16; ++i) {
        const std::size_t pixel = i / to, sample = i % to;
        places[i] = static_cast<std::uint8_t>(pixel < 4 && sample < from ? pixel * from + sample : 0x80);  // 0x80: 0
    }
    const auto shuffle = hn::Load(d, places);
    std::size_t x = 0;
    for (; x + 8 <= pixels; x += 4)
        hn::StoreU(hn::TableLookupBytesOr0(hn::LoadU(d, in + x * from), shuffle), d, out + x * to);
    for (; x < pixels; ++x)
        for (std::size_t c = 0; c < to; ++c) out[x * to + c] = c < from ? in[x * from + c] : std::uint8_t{0};
}

void SpreadPixels(const std::uint8_t* narrow, int channels, std::size_t pixels, std::uint8_t* wide) {
    if (channels == 3) MovePixels(narrow, 3, wide, 4, pixels);
    else MovePixels(narrow, 2, wide, 4, pixels);
}

void NarrowPixels(const std::uint8_t* wide, int channels, std::size_t pixels, std::uint8_t* narrow) {
    if (channels == 3) MovePixels(wide, 4, narrow, 3, pixels);
    else MovePixels(wide, 4, narrow, 2, pixels);
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

/// Stores block b of 128 bits at to + b * step.
HWY_INLINE void ScatterBlocks(V16 v, std::int16_t* to, std::size_t step) {
    const hn::Full128<std::int16_t> block;
#if HWY_TARGET == HWY_AVX3_DL
    _mm_store_si128(reinterpret_cast<__m128i*>(to), _mm512_castsi512_si128(v.raw));
    _mm_store_si128(reinterpret_cast<__m128i*>(to + step), _mm512_extracti32x4_epi32(v.raw, 1));
    _mm_store_si128(reinterpret_cast<__m128i*>(to + 2 * step), _mm512_extracti32x4_epi32(v.raw, 2));
    _mm_store_si128(reinterpret_cast<__m128i*>(to + 3 * step), _mm512_extracti32x4_epi32(v.raw, 3));
#elif HWY_TARGET == HWY_AVX2
    _mm_store_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(v.raw));
    _mm_store_si128(reinterpret_cast<__m128i*>(to + step), _mm256_extracti128_si256(v.raw, 1));
#else
    static_cast<void>(step);
    hn::Store(v, block, to);
#endif
    static_cast<void>(block);
}

/// The sums of one column: vector k holds bytes 4k..4k+3 of each block. Members, not arrays with loops over them: that
/// keeps them in registers.
template <Pixel kPixel, int kShift>
struct ColumnSums {
    V32 high0, high1, high2, high3, low0, low1, low2, low3;

    HWY_INLINE void Start() {
        high0 = high1 = high2 = high3 = hn::Zero(d32);
        low0 = low1 = low2 = low3 = hn::Set(d32, 1 << (kShift - 1));
    }

    HWY_INLINE void Add(const std::uint8_t* codes, V32 high, V32 low) {
        AddVector(codes, high, low, high0, low0);
        AddVector(codes + kBytes, high, low, high1, low1);
        AddVector(codes + 2 * kBytes, high, low, high2, low2);
        AddVector(codes + 3 * kBytes, high, low, high3, low3);
    }

    HWY_INLINE void Store(std::size_t k, std::int16_t* out) const {
        StoreHalf(Whole(high0, low0), Whole(high1, low1), k, out);
        StoreHalf(Whole(high2, low2), Whole(high3, low3), k + kBytes / 2, out);
    }

private:
    static HWY_INLINE void AddVector(const std::uint8_t* codes, V32 high, V32 low, V32& high_sum, V32& low_sum) {
        const V8 four_rows = hn::Load(d8, codes);
        high_sum = DotBytes(high_sum, four_rows, high);
        low_sum = DotBytes(low_sum, four_rows, low);
    }
    static HWY_INLINE V32 Whole(V32 high, V32 low) { return hn::Add(low, hn::ShiftLeft<7>(high)); }

    static HWY_INLINE void StoreHalf(V32 a, V32 b, std::size_t k, std::int16_t* out) {
        if constexpr (kPixel == Pixel::four) {
            const V16 first = hn::BitCast(d16, hn::ShiftRight<kShift>(a));
            const V16 second = hn::BitCast(d16, hn::ShiftLeft<16 - kShift>(b));
            constexpr std::size_t pair_bytes = 8;
            ScatterBlocks(hn::OddEven(second, first), out + k / pair_bytes * tile_pair, tile_pair);
        } else {
            hn::StoreU(Pack(hn::ShiftRight<kShift>(a), hn::ShiftRight<kShift>(b)), d16, out + k);
        }
    }
};

constexpr std::size_t cache_line = 64;

/// Into the second cache.
HWY_INLINE void Prefetch(const std::uint8_t* p) { _mm_prefetch(reinterpret_cast<const char*>(p), _MM_HINT_T1); }

template <Pixel kPixel, int kShift>
void CombineRow(const ByteColumnTaps& taps, const std::uint8_t* const* groups, std::size_t begin, std::size_t end,
                std::span<const std::uint8_t* const> ahead, std::int16_t* out) {
    const std::int32_t *const high = taps.high.data(), *const low = taps.low.data();
    const std::size_t count = taps.high.size();
    std::size_t k = begin;
#if HWY_TARGET == HWY_AVX3_DL  // has registers for two columns, which share the weights
    for (; k + 2 * kBytes <= end; k += 2 * kBytes) {
        for (const std::uint8_t* const row : ahead) Prefetch(row + k), Prefetch(row + k + kBytes);
        ColumnSums<kPixel, kShift> sums, next;
        sums.Start();
        next.Start();
        for (std::size_t g = 0; g < count; ++g) {
            const V32 high_weights = hn::Set(d32, high[g]), low_weights = hn::Set(d32, low[g]);
            sums.Add(groups[g] + 4 * k, high_weights, low_weights);
            next.Add(groups[g] + 4 * k + 4 * kBytes, high_weights, low_weights);
        }
        sums.Store(k, out);
        next.Store(k + kBytes, out);
    }
#endif
    for (; k < end; k += kBytes) {
        if (k % cache_line == 0)
            for (const std::uint8_t* const row : ahead) Prefetch(row + k);
        ColumnSums<kPixel, kShift> sums;
        sums.Start();
        for (std::size_t g = 0; g < count; ++g)
            sums.Add(groups[g] + 4 * k, hn::Set(d32, high[g]), hn::Set(d32, low[g]));
        sums.Store(k, out);
    }
}

void CombineByteRows(const ByteColumnTaps& taps, int bits, const std::uint8_t* const* groups, std::size_t begin,
                     std::size_t end, std::span<const std::uint8_t* const> ahead, Pixel pixel, std::int16_t* out) {
    const auto run = pixel == Pixel::four ? (bits == 14 ? CombineRow<Pixel::four, 8> : CombineRow<Pixel::four, 7>)
                                          : (bits == 14 ? CombineRow<Pixel::one, 8> : CombineRow<Pixel::one, 7>);
    run(taps, groups, begin, end, ahead, out);
}

constexpr int kPairShift = 20;                                // 14 bits of weights, 6 of samples
constexpr std::size_t kTileVectors = 2 * tile_pair / kBytes;  // of which two run at a time
constexpr std::size_t kPart = kBytes / 2;                     // samples of a vector

/// The sums of one output for two vectors of rows.
struct OutputSums {
    V32 a, b;

    HWY_INLINE void Start() { a = b = hn::Set(d32, 1 << (kPairShift - 1)); }

    HWY_INLINE void Add(V16 samples_a, V16 samples_b, V32 weights) {
        a = DotPairs(a, samples_a, weights);
        b = DotPairs(b, samples_b, weights);
    }
};
struct FourSums {
    OutputSums o0, o1, o2, o3;

    HWY_INLINE void Start() {
        o0.Start();
        o1 = o2 = o3 = o0;
    }
};

/// One output: kPairs pairs, or pairs.count for 0.
template <int kPairs>
HWY_INLINE void SumOne(const BytePairs& pairs, int i, const std::int16_t* tile, OutputSums& sums) {
    const int count = kPairs ? kPairs : pairs.count;
    const BytePairs::Output& at = pairs.outputs[static_cast<std::size_t>(i)];
    const std::int32_t* const weights = pairs.weights.data() + at.offset;
    const std::int16_t* samples = tile + at.first_pair * static_cast<std::ptrdiff_t>(tile_pair);
    for (int p = 0; p < count; ++p, samples += tile_pair)
        sums.Add(hn::Load(d16, samples), hn::Load(d16, samples + kPart), hn::Set(d32, weights[p]));
}

template <int kPairs>
HWY_INLINE void SumFour(const BytePairs& pairs, int i, int end, const std::int16_t* tile, FourSums& sums) {
    SumOne<kPairs>(pairs, i, tile, sums.o0);
    SumOne<kPairs>(pairs, std::min(i + 1, end - 1), tile, sums.o1);
    SumOne<kPairs>(pairs, std::min(i + 2, end - 1), tile, sums.o2);
    SumOne<kPairs>(pairs, std::min(i + 3, end - 1), tile, sums.o3);
}

/// The same for outputs one pair of pixels apart that share their weights, as those of a reduction to half: each pair
/// is loaded once for all.
template <std::size_t kCount>
struct Weights {
    V32 of[kCount];
};
template <int kPairs, int kPair>
HWY_INLINE void StepPair(const Weights<kPairs>& weights, const std::int16_t* samples, FourSums& sums) {
    const V16 a = hn::Load(d16, samples + kPair * tile_pair), b = hn::Load(d16, samples + kPair * tile_pair + kPart);
    if constexpr (kPair < kPairs) sums.o0.Add(a, b, weights.of[kPair]);
    if constexpr (kPair >= 1 && kPair < kPairs + 1) sums.o1.Add(a, b, weights.of[kPair - 1]);
    if constexpr (kPair >= 2 && kPair < kPairs + 2) sums.o2.Add(a, b, weights.of[kPair - 2]);
    if constexpr (kPair >= 3) sums.o3.Add(a, b, weights.of[kPair - 3]);
}
template <int... kPair>
HWY_INLINE auto Broadcast(const std::int32_t* from, std::integer_sequence<int, kPair...>) {
    return Weights<sizeof...(kPair)>{{hn::Set(d32, from[kPair])...}};
}
template <int kPairs, int... kPair>
HWY_INLINE void SumFourInStep(const Weights<kPairs>& weights, const std::int16_t* samples, FourSums& sums,
                              std::integer_sequence<int, kPair...>) {
    (StepPair<kPairs, kPair>(weights, samples, sums), ...);
}

HWY_INLINE bool InStep(const BytePairs& pairs, int i, int end) {
    if (i + 4 > end) return false;
    const BytePairs::Output* const at = pairs.outputs.data() + i;
    return at[3].offset == at[0].offset && at[1].offset == at[0].offset && at[2].offset == at[0].offset &&
           at[3].first_pair == at[0].first_pair + 3;
}

/// Codes of four outputs: byte o of a lane of 32 bits for output o, where lanes of one output were sums.
HWY_INLINE V8 PackFour(V32 o0, V32 o1, V32 o2, V32 o3) {
    return PackCodes(Pack(hn::ShiftRight<kPairShift>(o0), hn::ShiftRight<kPairShift>(o1)),
                     Pack(hn::ShiftRight<kPairShift>(o2), hn::ShiftRight<kPairShift>(o3)));
}

/// Outputs [begin, end) of two vectors of rows.
template <int kPairs>
class PairRun {
public:
    PairRun(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, std::uint8_t* const* rows)
        : pairs_(pairs), begin_(begin), end_(end), tile_(tile), rows_(rows) {}

    void PixelsOfFour() {
        constexpr std::size_t blocks = kBytes / 16;  // a row each
        for (int i = begin_; i < end_; i += 4) {
            V8 a, b;
            FourOutputs(i, a, b);
            const std::size_t at = static_cast<std::size_t>(i - begin_) * 4;
            const std::size_t wanted = static_cast<std::size_t>(std::min(4, end_ - i)) * 4;
            StoreBlocks(a, rows_, 1, at, wanted);
            StoreBlocks(b, rows_ + blocks, 1, at, wanted);
        }
    }

    void PixelsOfOne() {
        // Within a block, from outputs apart to rows apart.
        alignas(16) static constexpr std::uint8_t kByRow[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
        const V8 by_row = hn::LoadDup128(d8, kByRow);
        for (int i = begin_; i < end_; i += 16) {
            V32 lanes[2][4];  // a lane is a row, its bytes four outputs
            for (int m = 0; m < 4; ++m) {
                V8 a, b;
                FourOutputs(std::min(i + 4 * m, end_ - 1), a, b);
                lanes[0][m] = hn::BitCast(d32, hn::TableLookupBytes(a, by_row));
                lanes[1][m] = hn::BitCast(d32, hn::TableLookupBytes(b, by_row));
            }
            const std::size_t wanted = static_cast<std::size_t>(std::min(16, end_ - i));
            for (std::size_t u = 0; u < 2; ++u) {
                Transpose4(lanes[u]);
                for (std::size_t r = 0; r < 4; ++r)
                    StoreBlocks(hn::BitCast(d8, lanes[u][r]), rows_ + u * kBytes / 4 + r, 4,
                                static_cast<std::size_t>(i - begin_), wanted);
            }
        }
    }

private:
    HWY_INLINE void FourOutputs(int i, V8& a, V8& b) {
        FourSums sums;
        sums.Start();
        if constexpr (kPairs != 0) {
            if (InStep(pairs_, i, end_)) {
                const BytePairs::Output& at = pairs_.outputs[static_cast<std::size_t>(i)];
                const auto weights =
                    Broadcast(pairs_.weights.data() + at.offset, std::make_integer_sequence<int, kPairs>());
                SumFourInStep<kPairs>(weights, tile_ + at.first_pair * static_cast<std::ptrdiff_t>(tile_pair), sums,
                                      std::make_integer_sequence<int, kPairs + 3>());
            } else {
                SumFour<kPairs>(pairs_, i, end_, tile_, sums);
            }
        } else {
            SumFour<0>(pairs_, i, end_, tile_, sums);
        }
        a = PackFour(sums.o0.a, sums.o1.a, sums.o2.a, sums.o3.a);
        b = PackFour(sums.o0.b, sums.o1.b, sums.o2.b, sums.o3.b);
    }

    const BytePairs& pairs_;
    int begin_, end_;
    const std::int16_t* tile_;
    std::uint8_t* const* rows_;
};

template <int kPairs>
void CombinePairs(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, Pixel pixel,
                  std::uint8_t* const* rows) {
    for (std::size_t u = 0; u < kTileVectors; u += 2) {
        const std::int16_t* const part = tile + u * kPart;
        if (pixel == Pixel::four) PairRun<kPairs>(pairs, begin, end, part, rows + u * kBytes / 16).PixelsOfFour();
        else PairRun<kPairs>(pairs, begin, end, part, rows + u * kBytes / 4).PixelsOfOne();
    }
}

void CombineBytePairs(const BytePairs& pairs, int begin, int end, const std::int16_t* tile, Pixel pixel,
                      std::uint8_t* const* rows) {
    using Run = void (*)(const BytePairs&, int, int, const std::int16_t*, Pixel, std::uint8_t* const*);
    constexpr Run unrolled[] = {CombinePairs<0>, CombinePairs<1>, CombinePairs<2>, CombinePairs<3>, CombinePairs<4>,
                                CombinePairs<5>, CombinePairs<6>, CombinePairs<7>, CombinePairs<8>};
    const bool is_unrolled = pairs.count < static_cast<int>(std::size(unrolled));
    unrolled[is_unrolled ? pairs.count : 0](pairs, begin, end, tile, pixel, rows);
}

/// One vector of means from two of either row, in the order that undoes what packing by blocks does.
template <Pixel kPixel, class Order>
HWY_INLINE V8 HalveColumn(const std::uint8_t* const* rows, std::size_t k, Order order) {
    alignas(16) static constexpr std::uint8_t kApart[16] = {0, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 10, 14, 11, 15};
    const V8 apart = hn::LoadDup128(d8, kApart);
    const auto sums = [&](const std::uint8_t* from) {
        const V8 codes = hn::LoadU(d8, from);
        return PairSums(kPixel == Pixel::four ? hn::TableLookupBytes(codes, apart) : codes);
    };
    const auto means = [&](std::size_t at) {
        const V16 sum = hn::Add(sums(rows[0] + at), sums(rows[1] + at));
        return hn::ShiftRight<2>(hn::Add(sum, hn::Set(d16, 2)));
    };
    const V8 packed = PackCodes(means(2 * k), means(2 * k + kBytes));
    return hn::BitCast(d8, hn::TableLookupLanes(hn::BitCast(d32, packed), order));
}

/// Block b of a packed vector holds units b and b + (number of blocks): this puts them in sequence.
HWY_INLINE auto SequenceOrder() {
    constexpr std::size_t lanes = kBytes / 4;
    alignas(64) std::int32_t order[lanes];
    for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t unit = l / 2 % (lanes / 4), half = l / (lanes / 2);
        order[l] = static_cast<std::int32_t>(4 * unit + 2 * half + l % 2);
    }
    return hn::SetTableIndices(d32, order);
}

template <Pixel kPixel>
void Halve(const std::uint8_t* const* rows, std::size_t pixels, std::uint8_t* out) {
    constexpr auto lanes = static_cast<std::size_t>(kPixel);
    const auto order = SequenceOrder();
    const std::size_t bytes = pixels * lanes;
    std::size_t k = 0;
    for (; k + kBytes <= bytes; k += kBytes) hn::StoreU(HalveColumn<kPixel>(rows, k, order), d8, out + k);
    for (; k < bytes; ++k) {
        const std::size_t at = k / lanes * 2 * lanes + k % lanes;
        const int sum = rows[0][at] + rows[0][at + lanes] + rows[1][at] + rows[1][at + lanes];
        out[k] = static_cast<std::uint8_t>((sum + 2) >> 2);
    }
}

void HalveBytes(const std::uint8_t* const* rows, std::size_t pixels, Pixel pixel, std::uint8_t* out) {
    if (pixel == Pixel::four) Halve<Pixel::four>(rows, pixels, out);
    else Halve<Pixel::one>(rows, pixels, out);
}

constexpr ByteLoops loops{HalveBytes, SpreadPixels, NarrowPixels, InterleaveBytes, CombineByteRows, CombineBytePairs};

const ByteLoops* Loops() { return &loops; }

#endif  // BANDLIMIT_NO_VECTORS || !HWY_ARCH_X86

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
BANDLIMIT_EXPORT(Loops);
const ByteLoops* byte_loops() { return BANDLIMIT_DISPATCH(Loops)(); }
}  // namespace bandlimit
#endif
