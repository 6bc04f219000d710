// The vector form of combine_scalar(): vectors run along a line, never across taps, so each sample sees the same
// operations in the same order as in the scalar form. With fused multiply-add the bits are the same too.
#include "bandlimit/resample/combine.h"

#include <algorithm>

#ifdef BANDLIMIT_SCALAR

namespace bandlimit {
void combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    combine_scalar(bank, begin, end, antiring, lines, out, length);
}
}  // namespace bandlimit

#else

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/resample/combine_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Limited(D d, V sum, const float* const* near, int count, std::size_t k, float antiring) {
    V low = hn::LoadU(d, near[0] + k), high = low;
    for (int j = 1; j < count; ++j) {
        const V x = hn::LoadU(d, near[j] + k);
        low = hn::IfThenElse(hn::Lt(x, low), x, low);
        high = hn::IfThenElse(hn::Lt(high, x), x, high);
    }
    const V clamped = hn::IfThenElse(hn::Lt(sum, low), low, hn::IfThenElse(hn::Lt(high, sum), high, sum));
    const V mixed = hn::MulAdd(hn::Set(d, antiring), clamped, hn::Mul(hn::Set(d, 1 - antiring), sum));
    return hn::IfThenElse(hn::Eq(clamped, sum), sum, mixed);
}

struct Row {
    const float* weights;
    const float* const* taps;
    int count, near_begin, near_count;
    float antiring;
};

/// kUnroll vectors side by side hide the latency of the multiply-add.
template <int kUnroll, class D>
HWY_INLINE void CombineAt(D d, const Row& row, float* HWY_RESTRICT out, std::size_t k) {
    using V = hn::Vec<D>;
    const std::size_t n = hn::Lanes(d);
    V sum[kUnroll];
    const V first = hn::Set(d, row.weights[0]);
    for (int u = 0; u < kUnroll; ++u)
        sum[u] = hn::Mul(first, hn::LoadU(d, row.taps[0] + k + static_cast<std::size_t>(u) * n));
    for (int j = 1; j < row.count; ++j) {
        const V w = hn::Set(d, row.weights[j]);
        const float* line = row.taps[j] + k;
        for (int u = 0; u < kUnroll; ++u)
            sum[u] = hn::MulAdd(w, hn::LoadU(d, line + static_cast<std::size_t>(u) * n), sum[u]);
    }
    for (int u = 0; u < kUnroll; ++u) {
        const std::size_t at = k + static_cast<std::size_t>(u) * n;
        if (row.antiring > 0) sum[u] = Limited(d, sum[u], row.taps + row.near_begin, row.near_count, at, row.antiring);
        hn::StoreU(sum[u], d, out + at);
    }
}

/// Samples [k, end) of the line.
HWY_INLINE void CombineRow(const Row& row, float* HWY_RESTRICT out, std::size_t k, std::size_t end) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 1> one;  // the tail, with the same arithmetic as the vectors
    const std::size_t n = hn::Lanes(d);
    for (; k + 4 * n <= end; k += 4 * n) CombineAt<4>(d, row, out, k);
    for (; k + n <= end; k += n) CombineAt<1>(d, row, out, k);
    for (; k < end; ++k) CombineAt<1>(one, row, out, k);
}

void Combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    // Outputs that lie together read mostly the same lines: a strip of those stays in the first cache meanwhile.
    constexpr std::size_t strip = 512;
    for (std::size_t k = 0; k < length; k += strip)
        for (int i = begin; i < end; ++i) {
            const Bank::Row& info = bank.row_info(i);
            const Row row{bank.weights.data() + info.offset,
                          lines + bank.first(i),
                          info.count,
                          info.near_begin,
                          info.near_count,
                          antiring};
            CombineRow(row, out[i - begin], k, std::min(length, k + strip));
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
HWY_EXPORT(Combine);
void combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    HWY_DYNAMIC_DISPATCH(Combine)(bank, begin, end, antiring, lines, out, length);
}
}  // namespace bandlimit
#endif

#endif  // BANDLIMIT_SCALAR
