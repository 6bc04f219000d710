// Four floats at a time: a pixel, or what belongs to four taps. Once per instruction set; see
// core/dispatch.h.
// Stability: inner.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"

#if defined(BANDLIMIT_ANTIALIAS_FOUR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BANDLIMIT_ANTIALIAS_FOUR_INL_H
#undef BANDLIMIT_ANTIALIAS_FOUR_INL_H
#else
#define BANDLIMIT_ANTIALIAS_FOUR_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS

/// The definition: what vectors do, a float at a time.
struct Four {
    float v[4];
};

template <class F>
Four each(Four a, Four b, F f) {
    return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
}

inline Four load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
inline void store(Four a, float* p) { std::copy_n(a.v, 4, p); }
/// To an address that 16 bytes divide, which will not be read soon. flush_stores() makes it known to other threads.
inline void store_past_caches(Four a, float* p) { store(a, p); }
inline void flush_stores() {}
inline Four all(float v) { return {{v, v, v, v}}; }
inline Four four(float a, float b, float c, float d) { return {{a, b, c, d}}; }
inline Four operator+(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x + y; });
}
inline Four operator-(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x - y; });
}
inline Four operator*(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x * y; });
}
inline Four operator/(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x / y; });
}
/// a b + c, rounded once.
inline Four fma(Four a, Four b, Four c) {
    Four r;
    for (int i = 0; i < 4; ++i) r.v[i] = std::fma(a.v[i], b.v[i], c.v[i]);
    return r;
}
inline Four least(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline Four most(Four a, Four b) {
    return each(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline Four magnitude(Four a) {
    return each(a, a, [](float x, float) { return std::abs(x); });
}
inline Four with_sign(Four a, Four sign) {
    return each(a, sign, [](float x, float y) { return std::copysign(x, y); });
}
inline Four root(Four a) {
    return each(a, a, [](float x, float) { return std::sqrt(x); });
}
/// where_more[i]: a > b ? x : y
inline Four where_more(Four a, Four b, Four x, Four y) {
    Four r;
    for (int i = 0; i < 4; ++i) r.v[i] = a.v[i] > b.v[i] ? x.v[i] : y.v[i];
    return r;
}
/// Lane i in all.
template <int i>
Four spread(Four a) {
    return all(a.v[i]);
}
/// The last lane of each.
inline Four lasts_of(Four a, Four b, Four c, Four d) { return {{a.v[3], b.v[3], c.v[3], d.v[3]}}; }
inline Four with_last(Four a, float last) { return {{a.v[0], a.v[1], a.v[2], last}}; }
inline float first_of(Four a) { return a.v[0]; }
inline float least_of(Four a) { return first_of(least(all(std::min(a.v[0], a.v[1])), all(std::min(a.v[2], a.v[3])))); }
inline float most_of(Four a) { return first_of(most(all(std::max(a.v[0], a.v[1])), all(std::max(a.v[2], a.v[3])))); }
inline bool is_finite(Four a) {
    return std::isfinite(a.v[0]) && std::isfinite(a.v[1]) && std::isfinite(a.v[2]) && std::isfinite(a.v[3]);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::FixedTag<float, 4> d4;

struct Four {
    hn::Vec<hn::FixedTag<float, 4>> v;
};

HWY_INLINE Four load(const float* p) { return {hn::LoadU(d4, p)}; }
HWY_INLINE void store(Four a, float* p) { hn::StoreU(a.v, d4, p); }
HWY_INLINE void store_past_caches(Four a, float* p) { hn::Stream(a.v, d4, p); }
HWY_INLINE void flush_stores() { hwy::FlushStream(); }
HWY_INLINE Four all(float v) { return {hn::Set(d4, v)}; }
HWY_INLINE Four four(float a, float b, float c, float d) {
    return {hn::ConcatLowerLower(d4, hn::InterleaveLower(d4, hn::Set(d4, c), hn::Set(d4, d)),
                                 hn::InterleaveLower(d4, hn::Set(d4, a), hn::Set(d4, b)))};
}
HWY_INLINE Four lasts_of(Four a, Four b, Four c, Four d) {
    return {hn::ConcatUpperUpper(d4, hn::InterleaveUpper(d4, c.v, d.v), hn::InterleaveUpper(d4, a.v, b.v))};
}
HWY_INLINE Four operator+(Four a, Four b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Four operator-(Four a, Four b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Four operator*(Four a, Four b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Four operator/(Four a, Four b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE Four fma(Four a, Four b, Four c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Four least(Four a, Four b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE Four most(Four a, Four b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE Four magnitude(Four a) { return {hn::Abs(a.v)}; }
HWY_INLINE Four with_sign(Four a, Four sign) { return {hn::CopySign(a.v, sign.v)}; }
HWY_INLINE Four root(Four a) { return {hn::Sqrt(a.v)}; }
HWY_INLINE Four where_more(Four a, Four b, Four x, Four y) { return {hn::IfThenElse(hn::Gt(a.v, b.v), x.v, y.v)}; }
template <int i>
HWY_INLINE Four spread(Four a) {
    return {hn::Broadcast<i>(a.v)};
}
HWY_INLINE Four with_last(Four a, float last) {
    alignas(16) static constexpr std::uint32_t lanes[4] = {0, 0, 0, ~0u};
    const auto mask = hn::MaskFromVec(hn::BitCast(d4, hn::Load(hn::FixedTag<std::uint32_t, 4>(), lanes)));
    return {hn::IfThenElse(mask, hn::Set(d4, last), a.v)};
}
HWY_INLINE float first_of(Four a) { return hn::GetLane(a.v); }
HWY_INLINE float least_of(Four a) {
    const auto pairs = hn::Min(a.v, hn::Shuffle2301(a.v));
    return hn::GetLane(hn::Min(pairs, hn::Shuffle1032(pairs)));
}
HWY_INLINE float most_of(Four a) {
    const auto pairs = hn::Max(a.v, hn::Shuffle2301(a.v));
    return hn::GetLane(hn::Max(pairs, hn::Shuffle1032(pairs)));
}
HWY_INLINE bool is_finite(Four a) {
    const auto zero = hn::Mul(a.v, hn::Zero(d4));  // 0 times anything else is NaN
    return hn::AllTrue(d4, hn::Eq(zero, zero));
}

#endif

HWY_INLINE float last_of(Four a) { return first_of(spread<3>(a)); }
HWY_INLINE Four between(Four low, Four v, Four high) { return least(most(v, low), high); }

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#endif
