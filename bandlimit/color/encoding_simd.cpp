// The vector forms of the loops over a row. A vector holds one channel of several pixels (a plane), so that alpha meets
// colour lane by lane and everything between loading and storing is the same for all layouts.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "bandlimit/color/encoding_rows.h"
#include "bandlimit/color/srgb_codes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/color/encoding_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/color/encoding_planes-inl.h"
#include "bandlimit/core/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS

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

namespace hn = hwy::HWY_NAMESPACE;

/// Exchanges the plane of alpha, if any, with the last one, where the loops below expect it.
template <class V, int C>
HWY_INLINE void ExchangeAlpha(int alpha, V (&p)[C]) {
    if (alpha < 0 || alpha == C - 1) return;
    for (int c = 0; c < C - 1; ++c)
        if (c == alpha) std::swap(p[c], p[C - 1]);
}

/// Changes the planes of colour by alpha, the last one.
template <int C>
HWY_INLINE void WithAlpha(ByAlpha step, VF (&p)[C]) {
    const VF alpha = p[C - 1], zero = hn::Zero(df);
    if (step == ByAlpha::multiply)
        for (int c = 0; c < C - 1; ++c) p[c] = hn::IfThenZeroElse(hn::Eq(alpha, zero), hn::Mul(p[c], alpha));
    if (step == ByAlpha::divide)
        for (int c = 0; c < C - 1; ++c) p[c] = hn::IfThenElseZero(hn::Gt(alpha, zero), hn::Div(p[c], alpha));
}

/// Whether all lanes are finite: 0 times anything else is NaN.
template <int C>
HWY_INLINE bool AllFinite(const VF (&p)[C]) {
    VF zero = hn::Mul(p[0], hn::Zero(df));
    for (int c = 1; c < C; ++c) zero = hn::MulAdd(p[c], hn::Zero(df), zero);
    return hn::AllTrue(df, hn::Eq(zero, zero));
}

/// How the samples of a row are converted.
struct Conversion {
    Conversion(const Encoding& stored, ByAlpha by_alpha)
        : step(by_alpha), alpha(stored.alpha), srgb(stored.transfer == Transfer::srgb) {}

    /// Whether all channels are treated alike.
    bool Uniform() const { return step == ByAlpha::none && (alpha < 0 || !srgb); }

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
            ExchangeAlpha(alpha, codes);
            for (int c = 0; c < C - 1; ++c) p[c] = srgb ? Gather(light, codes[c]) : FromCode<T>(codes[c]);
            p[C - 1] = srgb && alpha < 0 ? Gather(light, codes[C - 1]) : FromCode<T>(codes[C - 1]);
        } else {
            LoadStored<C>(from, order, p);
            ExchangeAlpha(alpha, p);
        }
        WithAlpha<C>(step, p);
        ExchangeAlpha(alpha, p);
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

    /// Returns whether something not finite became a code.
    template <int C>
    HWY_INLINE bool Group(const float* HWY_RESTRICT row, Samples<T> to) const {
        VF p[C];
        LoadRow<C>(row, p);
        ExchangeAlpha(alpha, p);
        WithAlpha<C>(step, p);
        if constexpr (std::is_integral_v<T>) {
            const bool finite = AllFinite(p);
            if (HWY_UNLIKELY(!finite))
                for (int c = 0; c < C; ++c) p[c] = hn::IfThenElseZero(hn::IsFinite(p[c]), p[c]);
            VI codes[C];
            for (int c = 0; c < C - 1; ++c) codes[c] = srgb ? SrgbCode(*table, p[c]) : ToCode<T>(p[c]);
            codes[C - 1] = srgb && alpha < 0 ? SrgbCode(*table, p[C - 1]) : ToCode<T>(p[C - 1]);
            ExchangeAlpha(alpha, codes);
            StoreStored<C>(codes, order, to);
            return !finite;
        } else {
            ExchangeAlpha(alpha, p);
            StoreStored<C>(p, order, to);
            return false;
        }
    }

    template <int C>
    bool Span(const float* HWY_RESTRICT row, Samples<T> to, std::size_t width) const {
        const std::size_t n = hn::Lanes(df);
        bool lost = false;
        std::size_t x = 0;
        for (; x + n <= width; x += n) lost |= Group<C>(row + x * C, to.From(x));
        if (x == width) return lost;
        float last[kLanes * C] = {};
        T stored[kLanes * C];
        std::copy_n(row + x * C, (width - x) * C, last);
        lost |= Group<C>(last, {stored, C, 1});
        Unpack<C>(stored, width - x, to.From(x));
        return lost;
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
    const Samples<T> row{view.data + y * view.dy, view.dx, view.dc};
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
    for (int c = alpha; c < C - 1; ++c) std::swap(p[c], p[c + 1]);  // alpha last, colours in their order
    WithAlpha<C>(step, p);
    const VF uncovered = hn::Sub(hn::Set(df, 1.0f), p[C - 1]);
    for (int c = 0; c < C - 1; ++c) over[c] = hn::Add(p[c], hn::Mul(uncovered, hn::Set(df, background[c])));
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

#endif  // BANDLIMIT_NO_VECTORS

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
BANDLIMIT_EXPORT(DecodeRow);
BANDLIMIT_EXPORT(EncodeRow);
BANDLIMIT_EXPORT(CompositeRow);

void decode_row_simd(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                     std::span<float> row) {
    BANDLIMIT_DISPATCH(DecodeRow)(image, y, stored, premultiplied, row);
}
bool encode_row_simd(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                     const Encoding& stored) {
    return BANDLIMIT_DISPATCH(EncodeRow)(row, premultiplied, image, y, stored);
}
void composite_row_simd(std::span<const float> row, bool premultiplied, int channels, int alpha,
                        std::span<const float> background, std::span<float> out) {
    BANDLIMIT_DISPATCH(CompositeRow)(row, premultiplied, channels, alpha, background, out);
}
}  // namespace bandlimit
#endif
