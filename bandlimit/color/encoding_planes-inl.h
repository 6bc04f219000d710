// The vectors of encoding_simd.cpp, once per instruction set: stored samples and rows as planes, codes as floats.
// Stability: inner.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

#include "bandlimit/color/half.h"
#include "bandlimit/color/srgb_codes.h"
#include "bandlimit/core/dispatch.h"
#include "bandlimit/core/transpose4-inl.h"

#if defined(BANDLIMIT_COLOR_ENCODING_PLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BANDLIMIT_COLOR_ENCODING_PLANES_INL_H
#undef BANDLIMIT_COLOR_ENCODING_PLANES_INL_H
#else
#define BANDLIMIT_COLOR_ENCODING_PLANES_INL_H
#endif

#if !BANDLIMIT_NO_VECTORS

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether the conversions of half are instructions; elsewhere half is left to the scalar form.
constexpr bool kHalf =
    HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3_DL || (HWY_TARGET == HWY_NEON && HWY_ARCH_ARM_A64);

/// Whether MulAdd rounds once.
constexpr bool kFused = HWY_NATIVE_FMA;

constexpr hn::ScalableTag<float> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
constexpr std::size_t kLanes = hn::MaxLanes(df);

// ---- Stored samples of type T, and the 32-bit lanes that hold them: codes in int32, or floats.

/// A vector of kLanes stored samples.
template <class T>
using Raw = std::conditional_t<std::is_same_v<T, Half>, std::uint16_t, T>;
template <class T>
using RawTag = hn::Rebind<Raw<T>, decltype(df)>;
template <class T>
using Lanes = std::conditional_t<std::is_integral_v<T>, VI, VF>;

template <class T>
const Raw<T>* RawPointer(const T* p) {
    if constexpr (std::is_same_v<T, Half>) return &p->bits;
    else return p;
}
template <class T>
Raw<T>* RawPointer(T* p) {
    if constexpr (std::is_same_v<T, Half>) return &p->bits;
    else return p;
}

template <class T>
HWY_INLINE Lanes<T> Widen(hn::Vec<RawTag<T>> raw) {
    if constexpr (std::is_same_v<T, float>) return raw;
    else if constexpr (std::is_same_v<T, Half>)
        return hn::PromoteTo(df, hn::BitCast(hn::Rebind<hwy::float16_t, decltype(df)>(), raw));
    else return hn::PromoteTo(di, raw);
}

template <class T>
HWY_INLINE hn::Vec<RawTag<T>> Narrow(Lanes<T> lanes) {
    const RawTag<T> d;
    if constexpr (std::is_same_v<T, float>) return lanes;
    else if constexpr (std::is_same_v<T, Half>)
        return hn::BitCast(d, hn::DemoteTo(hn::Rebind<hwy::float16_t, decltype(df)>(), lanes));
#if HWY_TARGET == HWY_AVX3_DL
    // Highway 1.0.3 truncates to bytes by the wrong permutation where it has AVX3_DL.
    else if constexpr (sizeof(T) == 1) return hn::Vec<RawTag<T>>{_mm512_cvtepi32_epi8(lanes.raw)};
#endif
    else return hn::TruncateTo(d, hn::BitCast(du, lanes));
}

// ---- Four channels: a 4 x 4 transposition within each 128-bit block turns four vectors of pixels into four planes,
// and back. It leaves pixel k * kLanes / 4 + j in lane 4 j + k; whatever holds pixels in their order is permuted alike.

/// From the order of pixels to that of the lanes of planes, and back.
struct Order {
    Order() {
        HWY_ALIGN std::int32_t to[kLanes], from[kLanes];
        const std::size_t n = hn::Lanes(df);
        for (std::size_t lane = 0; lane < n; ++lane) {
            const std::size_t pixel = lane % 4 * (n / 4) + lane / 4;
            to[lane] = static_cast<std::int32_t>(pixel);
            from[pixel] = static_cast<std::int32_t>(lane);
        }
        to_lanes = hn::SetTableIndices(df, to);
        to_pixels = hn::SetTableIndices(df, from);
    }
    template <class V>
    HWY_INLINE V ToLanes(V v) const {
        return hn::BitCast(hn::DFromV<V>(), hn::TableLookupLanes(hn::BitCast(df, v), to_lanes));
    }
    template <class V>
    HWY_INLINE V ToPixels(V v) const {
        return hn::BitCast(hn::DFromV<V>(), hn::TableLookupLanes(hn::BitCast(df, v), to_pixels));
    }
    decltype(hn::SetTableIndices(df, static_cast<const std::int32_t*>(nullptr))) to_lanes, to_pixels;
};

template <int C>
HWY_INLINE void LoadRow(const float* HWY_RESTRICT row, VF (&p)[C]) {
    if constexpr (C == 1) p[0] = hn::LoadU(df, row);
    if constexpr (C == 2) hn::LoadInterleaved2(df, row, p[0], p[1]);
    if constexpr (C == 3) hn::LoadInterleaved3(df, row, p[0], p[1], p[2]);
    if constexpr (C == 4) {
        for (std::size_t i = 0; i < 4; ++i) p[i] = hn::LoadU(df, row + i * hn::Lanes(df));
        Transpose4(p);
    }
}

template <int C>
HWY_INLINE void StoreRow(VF (&p)[C], float* HWY_RESTRICT row) {
    if constexpr (C == 1) hn::StoreU(p[0], df, row);
    if constexpr (C == 2) hn::StoreInterleaved2(p[0], p[1], df, row);
    if constexpr (C == 3) hn::StoreInterleaved3(p[0], p[1], p[2], df, row);
    if constexpr (C == 4) {
        Transpose4(p);
        for (std::size_t i = 0; i < 4; ++i) hn::StoreU(p[i], df, row + i * hn::Lanes(df));
    }
}

/// The stored samples of a row: channel c of pixel x is data[x * dx + c * dc].
template <class T>
struct Samples {
    T* data;
    std::ptrdiff_t dx, dc;

    template <int C>
    bool Tight() const {
        return dx == C && (dc == 1 || C == 1);
    }
    bool Planar() const { return dx == 1; }
    Samples From(std::size_t x) const { return {data + static_cast<std::ptrdiff_t>(x) * dx, dx, dc}; }
    T& operator()(std::size_t x, int c) const { return data[static_cast<std::ptrdiff_t>(x) * dx + c * dc]; }
};

/// Copies the first `count` pixels to where they are tight, and back.
template <int C, class T>
void Pack(Samples<const T> from, std::size_t count, T* HWY_RESTRICT tight) {
    for (std::size_t x = 0; x < count; ++x)
        for (int c = 0; c < C; ++c) *tight++ = from(x, c);
}
template <int C, class T>
void Unpack(const T* HWY_RESTRICT tight, std::size_t count, Samples<T> to) {
    for (std::size_t x = 0; x < count; ++x)
        for (int c = 0; c < C; ++c) to(x, c) = *tight++;
}

/// The first kLanes pixels of samples that are tight or planar.
template <int C, class T>
HWY_INLINE void LoadStored(Samples<const T> s, const Order& order, Lanes<T> (&p)[C]) {
    const RawTag<T> d;
    const Raw<T>* HWY_RESTRICT from = RawPointer(s.data);
    if constexpr (C == 1) {
        p[0] = Widen<T>(hn::LoadU(d, from));
    } else if (!s.template Tight<C>()) {
        for (int c = 0; c < C; ++c) {
            p[c] = Widen<T>(hn::LoadU(d, from + c * s.dc));
            if constexpr (C == 4) p[c] = order.ToLanes(p[c]);
        }
    } else if constexpr (C == 4 && sizeof(T) == 1) {
        const hn::Repartition<std::uint8_t, decltype(du)> d8;
        const VI pixels = order.ToLanes(hn::BitCast(di, hn::LoadU(d8, from)));
        const VI byte = hn::Set(di, 255);
        p[0] = hn::And(pixels, byte);
        p[1] = hn::And(hn::ShiftRight<8>(pixels), byte);
        p[2] = hn::And(hn::ShiftRight<16>(pixels), byte);
        p[3] = hn::BitCast(di, hn::ShiftRight<24>(hn::BitCast(du, pixels)));
    } else if constexpr (C == 4) {
        for (std::size_t i = 0; i < 4; ++i) p[i] = Widen<T>(hn::LoadU(d, from + i * hn::Lanes(df)));
        Transpose4(p);
    } else {
        hn::Vec<RawTag<T>> raw[C];
        if constexpr (C == 2) hn::LoadInterleaved2(d, from, raw[0], raw[1]);
        if constexpr (C == 3) hn::LoadInterleaved3(d, from, raw[0], raw[1], raw[2]);
        for (int c = 0; c < C; ++c) p[c] = Widen<T>(raw[c]);
    }
}

template <int C, class T>
HWY_INLINE void StoreStored(Lanes<T> (&p)[C], const Order& order, Samples<T> s) {
    const RawTag<T> d;
    Raw<T>* HWY_RESTRICT to = RawPointer(s.data);
    if constexpr (C == 1) {
        hn::StoreU(Narrow<T>(p[0]), d, to);
    } else if (!s.template Tight<C>()) {
        for (int c = 0; c < C; ++c) {
            if constexpr (C == 4) p[c] = order.ToPixels(p[c]);
            hn::StoreU(Narrow<T>(p[c]), d, to + c * s.dc);
        }
    } else if constexpr (C == 4 && sizeof(T) == 1) {
        const hn::Repartition<std::uint8_t, decltype(du)> d8;
        const VI low = hn::Or(p[0], hn::ShiftLeft<8>(p[1]));
        const VI high = hn::Or(hn::ShiftLeft<16>(p[2]), hn::ShiftLeft<24>(p[3]));
        hn::StoreU(hn::BitCast(d8, order.ToPixels(hn::Or(low, high))), d8, to);
    } else if constexpr (C == 4) {
        Transpose4(p);
        for (std::size_t i = 0; i < 4; ++i) hn::StoreU(Narrow<T>(p[i]), d, to + i * hn::Lanes(df));
    } else {
        hn::Vec<RawTag<T>> raw[C];
        for (int c = 0; c < C; ++c) raw[c] = Narrow<T>(p[c]);
        if constexpr (C == 2) hn::StoreInterleaved2(raw[0], raw[1], d, to);
        if constexpr (C == 3) hn::StoreInterleaved3(raw[0], raw[1], raw[2], d, to);
    }
}

// ---- Codes to floats and back.

/// base[index].
///
/// The instruction of AVX-512 keeps lanes of its destination, and compilers let that be any register where the mask is
/// known to be full: it would wait for the gather of the pixels before. A mask that they cannot know, and zeros, do
/// not.
HWY_INLINE VF Gather(const float* base, VI index) {
#if HWY_TARGET == HWY_AVX3_DL
    __mmask16 all = 0xffff;
    asm("" : "+Yk"(all));
    return VF{_mm512_mask_i32gather_ps(_mm512_setzero_ps(), all, index.raw, base, sizeof(float))};
#else
    return hn::GatherIndex(df, base, index);
#endif
}

/// from_code(). 1 / 255 is 2^-8 and a small rest, 1 / 65535 is 2^-16 and a smaller one: the first product is exact, and
/// the sum is correctly rounded for every code, fused or not, which the tests show.
template <class Code>
HWY_INLINE VF FromCode(VI code) {
    constexpr double largest = std::numeric_limits<Code>::max(), high = 1 / (largest + 1);
    const VF x = hn::ConvertTo(df, code);
    const VF low = hn::Set(df, static_cast<float>(1 / largest - high));
    return hn::MulAdd(x, hn::Set(df, static_cast<float>(high)), hn::Mul(x, low));
}

/// to_code() for finite values.
///
/// Floats of 2^23 and a little more are the integers, so that adding 2^23 rounds. A tie would go to the even code; the
/// only float with one is 1/2, whose even code is the upper one. Fused, the sum is that of the exact product. Otherwise
/// 255 x = 256 x - x is `product` + `rest` exactly; their sum with 1/2 can only be rounded up to an integer that the
/// exact one does not reach, and what is left then, exact up to a rounding that keeps its sign, is negative.
template <class Code>
HWY_INLINE VI ToCode(VF value) {
    constexpr float largest = std::numeric_limits<Code>::max();
    const VF x = hn::Min(hn::Max(value, hn::Zero(df)), hn::Set(df, 1.0f));
    if constexpr (kFused) {
        const VF rounded = hn::MulAdd(x, hn::Set(df, largest), hn::Set(df, 0x1p23f));
        return hn::And(hn::BitCast(di, rounded), hn::Set(di, 0xffff));
    }
    const VF above = hn::Mul(x, hn::Set(df, largest + 1)), half = hn::Set(df, 0.5f);
    const VF product = hn::Sub(above, x), rest = hn::Sub(hn::Sub(above, product), x);
    const VI code = hn::ConvertTo(di, hn::Add(product, half));
    const VF left = hn::Add(hn::Sub(product, hn::Sub(hn::ConvertTo(df, code), half)), rest);
    return hn::Add(code, hn::ShiftRight<31>(hn::BitCast(di, left)));
}

/// srgb_code() for finite values.
HWY_INLINE VI SrgbCode(const SrgbCarryTable& table, VF light) {
    const VF x = hn::Min(hn::Max(light, hn::Set(df, table.lowest)), hn::Set(df, 1.0f));
    const VI bits = hn::BitCast(di, x), low = hn::And(bits, hn::Set(di, 0xffff));
    const VI entry = hn::BitCast(di, Gather(table.entries.data(), hn::ShiftRight<16>(bits)));
    return hn::ShiftRight<16>(hn::Add(entry, low));
}
HWY_INLINE VI SrgbCode(const SrgbChordTable& table, VF light) {
    const VF x = hn::Min(hn::Max(light, hn::Set(df, table.lowest)), hn::Set(df, 1.0f));
    const VI bits = hn::BitCast(di, x), bucket = hn::ShiftRight<16>(bits);
    const VF along = hn::ConvertTo(df, hn::And(bits, hn::Set(di, 0xffff)));
    const VF position = hn::MulAdd(Gather(table.slope.data(), bucket), along, Gather(table.start.data(), bucket));
    const VI code = hn::ConvertTo(di, position);
    const VF threshold = Gather(table.threshold.data(), code);
    return hn::Add(code, hn::VecFromMask(di, hn::RebindMask(di, hn::Lt(x, threshold))));
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#endif  // !BANDLIMIT_NO_VECTORS

#endif  // BANDLIMIT_COLOR_ENCODING_PLANES_INL_H
