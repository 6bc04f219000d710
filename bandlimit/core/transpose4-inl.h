// A transposition of 4 x 4 lanes, once per instruction set.
// Stability: inner.
#include <hwy/highway.h>

#if defined(BANDLIMIT_CORE_TRANSPOSE4_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BANDLIMIT_CORE_TRANSPOSE4_INL_H
#undef BANDLIMIT_CORE_TRANSPOSE4_INL_H
#else
#define BANDLIMIT_CORE_TRANSPOSE4_INL_H
#endif

#if HWY_TARGET != HWY_SCALAR  // has no blocks

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

/// Within each block of 128 bits: lane j of vector i becomes lane i of vector j. Lanes have 32 bits; 8 shuffles.
template <class V>
HWY_INLINE void Transpose4(V (&v)[4]) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::DFromV<V> d;
    const hn::Repartition<double, decltype(d)> pairs;
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, v[0], v[1]));
    const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, v[0], v[1]));
    const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, v[2], v[3]));
    const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, v[2], v[3]));
    v[0] = hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23));
    v[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23));
    v[2] = hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23));
    v[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23));
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET != HWY_SCALAR

#endif  // BANDLIMIT_CORE_TRANSPOSE4_INL_H
