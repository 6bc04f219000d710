// The vector forms of the loops over a row. A vector holds one channel of several pixels (a plane), so that alpha meets
// colour lane by lane and everything between loading and storing is the same for all layouts.
#include "bandlimit/color/encoding_rows.h"
#include "bandlimit/color/srgb_codes.h"

#ifdef BANDLIMIT_SCALAR

namespace bandlimit {
void decode_row_simd(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                     std::span<float> row) {
    decode_row_scalar(image, y, stored, premultiplied, row);
}
bool encode_row_simd(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                     const Encoding& stored) {
    return encode_row_scalar(row, premultiplied, image, y, stored);
}
void composite_row_simd(std::span<const float> row, bool premultiplied, int channels, int alpha,
                        std::span<const float> background, std::span<float> out) {
    composite_row_scalar(row, premultiplied, channels, alpha, background, out);
}
}  // namespace bandlimit

#else

#include <algorithm>
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/color/encoding_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

void DecodeRow(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row) {
    decode_row_scalar(image, y, stored, premultiplied, row);
}
bool EncodeRow(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored) {
    return encode_row_scalar(row, premultiplied, image, y, stored);
}
void CompositeRow(std::span<const float> row, bool premultiplied, int channels, int alpha,
                  std::span<const float> background, std::span<float> out) {
    composite_row_scalar(row, premultiplied, channels, alpha, background, out);
}

#else

/// Whether the conversions of half are instructions; elsewhere half is left to the scalar form.
constexpr bool kHalf = HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL ||
                       (HWY_TARGET == HWY_NEON && HWY_ARCH_ARM_A64);

constexpr hn::ScalableTag<float> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;
using VU = hn::Vec<decltype(du)>;
using Mask = hn::Mask<decltype(df)>;
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
    else return hn::DemoteTo(d, lanes);
}

// ---- Four channels: a 4 x 4 transposition within each 128-bit block turns four vectors of pixels into four planes,
// and back. It leaves pixel k * kLanes / 4 + j in lane 4 j + k; whatever holds pixels in their order is permuted alike.

template <class V>
HWY_INLINE void Transpose4(V (&v)[4]) {
    const hn::DFromV<V> d;
    const hn::Repartition<double, decltype(d)> d64;
    const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, v[0], v[1]));
    const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, v[0], v[1]));
    const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, v[2], v[3]));
    const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, v[2], v[3]));
    v[0] = hn::BitCast(d, hn::InterleaveLower(d64, low01, low23));
    v[1] = hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23));
    v[2] = hn::BitCast(d, hn::InterleaveLower(d64, high01, high23));
    v[3] = hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23));
}

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

/// base[index]. The instruction of AVX-512 keeps lanes of its destination, and compilers let it keep those of any
/// register at hand: it would wait for the gather of the pixels before. Clearing the destination sets it free.
HWY_INLINE VF Gather(const float* base, VI index) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return VF{_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, index.raw, base, sizeof(float))};
#else
    return hn::GatherIndex(df, base, index);
#endif
}
HWY_INLINE VU Gather(const std::uint32_t* base, VI index) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return VU{_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, index.raw, base, sizeof(*base))};
#else
    return hn::GatherIndex(du, base, index);
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
/// 255 x = 256 x - x is `product` + `rest` exactly. The sum with 1/2 can only be rounded up to an integer that the
/// exact one does not reach; what is left then, exact up to a rounding that keeps its sign, is negative.
template <class Code>
HWY_INLINE VI ToCode(VF value) {
    const VF half = hn::Set(df, 0.5f);
    const VF x = hn::Min(hn::Max(value, hn::Zero(df)), hn::Set(df, 1.0f));
    const VF above = hn::Mul(x, hn::Set(df, std::numeric_limits<Code>::max() + 1.0f));
    const VF product = hn::Sub(above, x), rest = hn::Sub(hn::Sub(above, product), x);
    const VI code = hn::ConvertTo(di, hn::Add(product, half));
    const VF left = hn::Add(hn::Sub(product, hn::Sub(hn::ConvertTo(df, code), half)), rest);
    return hn::Add(code, hn::ShiftRight<31>(hn::BitCast(di, left)));
}

template <class Table>
HWY_INLINE VF ClampTo(const Table& table, VF light) {
    return hn::Min(hn::Max(light, hn::Set(df, table.lowest)), hn::Set(df, 1.0f));
}
template <class Table>
HWY_INLINE VI BucketOf(const Table& table, VI bits) {
    return hn::Sub(hn::ShiftRight<16>(bits), hn::Set(di, static_cast<std::int32_t>(table.first)));
}

/// srgb_code() for finite values.
HWY_INLINE VI SrgbCode(const SrgbCarryTable& table, VF light) {
    const VI bits = hn::BitCast(di, ClampTo(table, light)), low = hn::And(bits, hn::Set(di, 0xffff));
    const VU entry = Gather(table.entries.data(), BucketOf(table, bits));
    return hn::BitCast(di, hn::ShiftRight<16>(hn::Add(entry, hn::BitCast(du, low))));
}
HWY_INLINE VI SrgbCode(const SrgbChordTable& table, VF light) {
    const VF x = ClampTo(table, light);
    const VI bits = hn::BitCast(di, x), bucket = BucketOf(table, bits);
    const VF along = hn::ConvertTo(df, hn::And(bits, hn::Set(di, 0xffff)));
    const VF start = Gather(table.start.data(), bucket);
    const VF slope = Gather(table.slope.data(), bucket);
    const VI code = hn::ConvertTo(di, hn::MulAdd(slope, along, start));
    const VF threshold = Gather(table.threshold.data(), code);
    return hn::Add(code, hn::VecFromMask(di, hn::RebindMask(di, hn::Lt(x, threshold))));
}

// ---- Rows.

template <int C>
HWY_INLINE void WithAlpha(ByAlpha step, int alpha, VF (&p)[C]) {
    if (step == ByAlpha::none) return;
    VF a = p[0];
    for (int c = 1; c < C; ++c)
        if (c == alpha) a = p[c];
    for (int c = 0; c < C; ++c) {
        if (c == alpha) continue;
        if (step == ByAlpha::multiply) p[c] = hn::IfThenZeroElse(hn::Eq(a, hn::Zero(df)), hn::Mul(p[c], a));
        else p[c] = hn::IfThenElseZero(hn::Gt(a, hn::Zero(df)), hn::Div(p[c], a));
    }
}

/// How the samples of a row are converted.
struct Conversion {
    Conversion(const Encoding& stored, ByAlpha by_alpha)
        : step(by_alpha), alpha(stored.alpha), srgb(stored.transfer == Transfer::srgb) {}

    /// Whether all channels are treated alike.
    bool Uniform() const { return step == ByAlpha::none && (alpha < 0 || !srgb); }
    bool Curved(int c) const { return srgb && c != alpha; }

    ByAlpha step;
    int alpha;
    bool srgb;
    Order order;
};

template <class T>
struct Decoder : Conversion {
    Decoder(const Encoding& stored, ByAlpha by_alpha) : Conversion(stored, by_alpha) {
        if constexpr (std::is_integral_v<T>)
            if (srgb) light = srgb_light<T>().data();
    }

    template <int C>
    HWY_INLINE void Group(Samples<const T> from, float* HWY_RESTRICT row) const {
        VF p[C];
        if constexpr (std::is_integral_v<T>) {
            VI codes[C];
            LoadStored<C>(from, order, codes);
            for (int c = 0; c < C; ++c) p[c] = Curved(c) ? Gather(light, codes[c]) : FromCode<T>(codes[c]);
        } else {
            LoadStored<C>(from, order, p);
        }
        WithAlpha<C>(step, alpha, p);
        StoreRow<C>(p, row);
    }

    template <int C>
    void Span(Samples<const T> from, std::size_t width, float* HWY_RESTRICT row) const {
        const std::size_t n = hn::Lanes(df);
        std::size_t x = 0;
        for (; x + n <= width; x += n) Group<C>(from.From(x), row + x * C);
        if (x == width) return;
        T stored[kLanes * C] = {};
        float last[kLanes * C];
        Pack<C>(from.From(x), width - x, stored);
        Group<C>({stored, C, 1}, last);
        std::copy_n(last, (width - x) * C, row + x * C);
    }

    const float* light = nullptr;
};

template <class T>
struct Encoder : Conversion {
    Encoder(const Encoding& stored, ByAlpha by_alpha) : Conversion(stored, by_alpha) {
        if constexpr (std::is_same_v<T, std::uint8_t>)
            if (srgb) table = &srgb_carry_table();
        if constexpr (std::is_same_v<T, std::uint16_t>)
            if (srgb) table = &srgb_chord_table();
    }

    /// Clears the lanes of `finite` where something else became a code.
    template <int C>
    HWY_INLINE void Group(const float* HWY_RESTRICT row, Samples<T> to, Mask& finite) const {
        VF p[C];
        LoadRow<C>(row, p);
        WithAlpha<C>(step, alpha, p);
        if constexpr (std::is_integral_v<T>) {
            VI codes[C];
            for (int c = 0; c < C; ++c) {
                const Mask good = hn::IsFinite(p[c]);
                const VF v = hn::IfThenElseZero(good, p[c]);
                finite = hn::And(finite, good);
                codes[c] = Curved(c) ? SrgbCode(*table, v) : ToCode<T>(v);
            }
            StoreStored<C>(codes, order, to);
        } else {
            StoreStored<C>(p, order, to);
        }
    }

    /// Returns whether something not finite became a code.
    template <int C>
    bool Span(const float* HWY_RESTRICT row, Samples<T> to, std::size_t width) const {
        const std::size_t n = hn::Lanes(df);
        Mask finite = hn::FirstN(df, n);
        std::size_t x = 0;
        for (; x + n <= width; x += n) Group<C>(row + x * C, to.From(x), finite);
        if (x < width) {
            float last[kLanes * C] = {};
            T stored[kLanes * C];
            std::copy_n(row + x * C, (width - x) * C, last);
            Group<C>(last, {stored, C, 1}, finite);
            Unpack<C>(stored, width - x, to.From(x));
        }
        return !hn::AllTrue(df, finite);
    }

    const std::conditional_t<std::is_same_v<T, std::uint8_t>, SrgbCarryTable, SrgbChordTable>* table = nullptr;
};

constexpr std::size_t kBlock = 256;  // pixels that are packed at a time, on the stack

template <int C, class T>
void DecodeSamples(Samples<const T> from, std::size_t width, const Decoder<T>& decoder, float* row) {
    if (from.template Tight<C>() || from.Planar()) return decoder.template Span<C>(from, width, row);
    T packed[kBlock * C];
    for (std::size_t x = 0; x < width; x += kBlock) {
        const std::size_t some = std::min(kBlock, width - x);
        Pack<C>(from.From(x), some, packed);
        decoder.template Span<C>({packed, C, 1}, some, row + x * C);
    }
}

template <int C, class T>
bool EncodeSamples(const float* row, const Encoder<T>& encoder, Samples<T> to, std::size_t width) {
    if (to.template Tight<C>() || to.Planar()) return encoder.template Span<C>(row, to, width);
    T packed[kBlock * C];
    bool lost = false;
    for (std::size_t x = 0; x < width; x += kBlock) {
        const std::size_t some = std::min(kBlock, width - x);
        lost |= encoder.template Span<C>(row + x * C, {packed, C, 1}, some);
        Unpack<C>(packed, some, to.From(x));
    }
    return lost;
}

/// Calls run(number of channels as a type, samples of row y, their pixels) and returns true; false where the scalar
/// form has to do the work. A row whose channels are tight and treated alike is one channel.
template <class T, class Run>
bool WithSamples(View<T> view, int y, const Conversion& conversion, Run run) {
    using Stored = std::remove_const_t<T>;
    if ((!std::is_integral_v<Stored> && conversion.srgb) || (std::is_same_v<Stored, Half> && !kHalf)) return false;
    const auto width = static_cast<std::size_t>(view.width);
    const Samples<T> row{&view(0, y), view.dx, view.dc};
    if (conversion.Uniform() && view.dx == view.channels && view.dc == 1) {
        run(std::integral_constant<int, 1>(), Samples<T>{row.data, 1, 1},
            width * static_cast<std::size_t>(view.channels));
        return true;
    }
    switch (view.channels) {
        case 1: run(std::integral_constant<int, 1>(), row, width); return true;
        case 2: run(std::integral_constant<int, 2>(), row, width); return true;
        case 3: run(std::integral_constant<int, 3>(), row, width); return true;
        case 4: run(std::integral_constant<int, 4>(), row, width); return true;
        default: return false;
    }
}

template <class T>
bool Decode(View<const T> view, int y, const Encoding& stored, ByAlpha step, float* row) {
    const Decoder<T> decoder(stored, step);
    return WithSamples(view, y, decoder, [&](auto channels, Samples<const T> from, std::size_t width) {
        DecodeSamples<channels()>(from, width, decoder, row);
    });
}

/// Returns whether it has done the work.
template <class T>
bool Encode(const float* row, ByAlpha step, View<T> view, int y, const Encoding& stored, bool& lost) {
    const Encoder<T> encoder(stored, step);
    return WithSamples(view, y, encoder, [&](auto channels, Samples<T> to, std::size_t width) {
        lost = EncodeSamples<channels()>(row, encoder, to, width);
    });
}

/// C planes and the alpha among them; the others, laid over the background, become out.
template <int C>
HWY_INLINE void CompositeGroup(const float* HWY_RESTRICT row, ByAlpha step, int alpha, const float* background,
                               float* HWY_RESTRICT out) {
    VF p[C], over[C - 1];
    if constexpr (C == 4) hn::LoadInterleaved4(df, row, p[0], p[1], p[2], p[3]);  // three are stored: in their order
    else LoadRow<C>(row, p);
    WithAlpha<C>(step, alpha, p);
    VF a = p[0];
    for (int c = 1; c < C; ++c)
        if (c == alpha) a = p[c];
    const VF uncovered = hn::Sub(hn::Set(df, 1.0f), a);
    for (int c = 0; c < C - 1; ++c) {
        const VF colour = c < alpha ? p[c] : p[c + 1];
        over[c] = hn::Add(colour, hn::Mul(uncovered, hn::Set(df, background[c])));
    }
    StoreRow<C - 1>(over, out);
}

template <int C>
void CompositeSpan(const float* HWY_RESTRICT row, std::size_t width, ByAlpha step, int alpha, const float* background,
                   float* HWY_RESTRICT out) {
    const std::size_t n = hn::Lanes(df);
    std::size_t x = 0;
    for (; x + n <= width; x += n) CompositeGroup<C>(row + x * C, step, alpha, background, out + x * (C - 1));
    if (x == width) return;
    float last[kLanes * C] = {}, over[kLanes * C];
    std::copy_n(row + x * C, (width - x) * C, last);
    CompositeGroup<C>(last, step, alpha, background, over);
    std::copy_n(over, (width - x) * (C - 1), out + x * (C - 1));
}

void DecodeRow(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row) {
    const bool done = std::visit(
        [&](auto view) { return Decode(view, y, stored, decoding_step(stored, premultiplied), row.data()); }, image);
    if (!done) decode_row_scalar(image, y, stored, premultiplied, row);
}

bool EncodeRow(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored) {
    const ByAlpha step = encoding_step(stored, premultiplied);
    bool lost = false;
    const bool done = std::visit([&](auto view) { return Encode(row.data(), step, view, y, stored, lost); }, image);
    return done ? lost : encode_row_scalar(row, premultiplied, image, y, stored);
}

void CompositeRow(std::span<const float> row, bool premultiplied, int channels, int alpha,
                  std::span<const float> background, std::span<float> out) {
    const ByAlpha step = premultiplied ? ByAlpha::none : ByAlpha::multiply;
    const std::size_t width = row.size() / static_cast<std::size_t>(channels);
    switch (channels) {
        case 2: return CompositeSpan<2>(row.data(), width, step, alpha, background.data(), out.data());
        case 3: return CompositeSpan<3>(row.data(), width, step, alpha, background.data(), out.data());
        case 4: return CompositeSpan<4>(row.data(), width, step, alpha, background.data(), out.data());
        default: return composite_row_scalar(row, premultiplied, channels, alpha, background, out);
    }
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
HWY_EXPORT(DecodeRow);
HWY_EXPORT(EncodeRow);
HWY_EXPORT(CompositeRow);

void decode_row_simd(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                     std::span<float> row) {
    HWY_DYNAMIC_DISPATCH(DecodeRow)(image, y, stored, premultiplied, row);
}
bool encode_row_simd(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                     const Encoding& stored) {
    return HWY_DYNAMIC_DISPATCH(EncodeRow)(row, premultiplied, image, y, stored);
}
void composite_row_simd(std::span<const float> row, bool premultiplied, int channels, int alpha,
                        std::span<const float> background, std::span<float> out) {
    HWY_DYNAMIC_DISPATCH(CompositeRow)(row, premultiplied, channels, alpha, background, out);
}
}  // namespace bandlimit
#endif

#endif  // BANDLIMIT_SCALAR
