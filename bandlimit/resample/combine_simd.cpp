// The vector form of combine_scalar(): vectors run along a line, never across taps, so each sample sees the same
// operations in the same order as in the scalar form. With fused multiply-add the bits are the same too.
#include "bandlimit/resample/combine.h"

#include <algorithm>
#include <type_traits>

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

/// kCount vectors side by side, which hide the latency of the multiply-add. Members, not an array with loops over it:
/// that keeps them in registers.
template <int kCount, class D>
struct Vectors {
    using V = hn::Vec<D>;
    V first;
    Vectors<kCount - 1, D> rest;

    HWY_INLINE void Load(const float* from) {
        first = hn::LoadU(D(), from);
        rest.Load(from + hn::Lanes(D()));
    }
    HWY_INLINE void Multiply(V weight, const Vectors& samples) {
        first = hn::Mul(weight, samples.first);
        rest.Multiply(weight, samples.rest);
    }
    HWY_INLINE void MultiplyAdd(V weight, const Vectors& samples) {
        first = hn::MulAdd(weight, samples.first, first);
        rest.MultiplyAdd(weight, samples.rest);
    }
    HWY_INLINE void Store(const Row& row, float* HWY_RESTRICT out, std::size_t k) const {
        const bool limits = row.antiring > 0;
        hn::StoreU(limits ? Limited(D(), first, row.taps + row.near_begin, row.near_count, k, row.antiring) : first, D(),
                   out + k);
        rest.Store(row, out, k + hn::Lanes(D()));
    }
};
template <class D>
struct Vectors<0, D> {
    HWY_INLINE void Load(const float*) {}
    HWY_INLINE void Multiply(hn::Vec<D>, const Vectors&) {}
    HWY_INLINE void MultiplyAdd(hn::Vec<D>, const Vectors&) {}
    HWY_INLINE void Store(const Row&, float*, std::size_t) const {}
};

template <int kCount, class D>
HWY_INLINE void CombineAt(D d, const Row& row, float* HWY_RESTRICT out, std::size_t k) {
    Vectors<kCount, D> sum, samples;
    samples.Load(row.taps[0] + k);
    sum.Multiply(hn::Set(d, row.weights[0]), samples);
    for (int j = 1; j < row.count; ++j) {
        samples.Load(row.taps[j] + k);
        sum.MultiplyAdd(hn::Set(d, row.weights[j]), samples);
    }
    sum.Store(row, out, k);
}

/// Two outputs at once, of which the second begins `step` lines later, while the first still reads: what both read is
/// loaded once.
template <int kCount, class D>
HWY_INLINE void CombineTwoAt(D d, const Row& a, const Row& b, int step, float* HWY_RESTRICT out_a,
                             float* HWY_RESTRICT out_b, std::size_t k) {
    Vectors<kCount, D> sum_a, sum_b, samples;
    samples.Load(a.taps[0] + k);
    sum_a.Multiply(hn::Set(d, a.weights[0]), samples);
    for (int j = 1; j <= step; ++j) {
        samples.Load(a.taps[j] + k);
        sum_a.MultiplyAdd(hn::Set(d, a.weights[j]), samples);
    }
    sum_b.Multiply(hn::Set(d, b.weights[0]), samples);
    const int shared = a.count - step;
    for (int j = 1; j < shared; ++j) {
        samples.Load(b.taps[j] + k);
        sum_a.MultiplyAdd(hn::Set(d, a.weights[step + j]), samples);
        sum_b.MultiplyAdd(hn::Set(d, b.weights[j]), samples);
    }
    for (int j = shared; j < b.count; ++j) {
        samples.Load(b.taps[j] + k);
        sum_b.MultiplyAdd(hn::Set(d, b.weights[j]), samples);
    }
    sum_a.Store(a, out_a, k);
    sum_b.Store(b, out_b, k);
}

/// Calls at(tag, vectors side by side, sample) over samples [k, end) of lines.
template <class At>
HWY_INLINE void ForEachVector(std::size_t k, std::size_t end, At at) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 1> one;  // the tail, with the same arithmetic as the vectors
    const std::size_t n = hn::Lanes(d);
    for (; k + 4 * n <= end; k += 4 * n) at(d, std::integral_constant<int, 4>(), k);
    for (; k + n <= end; k += n) at(d, std::integral_constant<int, 1>(), k);
    for (; k < end; ++k) at(one, std::integral_constant<int, 1>(), k);
}

void Combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    const auto row_of = [&](int i) {
        const Bank::Row& info = bank.row_info(i);
        return Row{bank.weights.data() + info.offset, lines + bank.first(i), info.count, info.near_begin,
                   info.near_count, antiring};
    };
    // Outputs that lie together read mostly the same lines: a strip of those stays in the first cache meanwhile.
    constexpr std::size_t strip = 1024;
    for (std::size_t k = 0; k < length; k += strip) {
        const std::size_t last = std::min(length, k + strip);
        for (int i = begin; i < end; ++i) {
            const Row a = row_of(i);
            const int step = i + 1 < end ? bank.first(i + 1) - bank.first(i) : -1;
            if (step >= 0 && step < a.count && a.count - step <= bank.row_info(i + 1).count) {
                const Row b = row_of(i + 1);
                ForEachVector(k, last, [&](auto d, auto unroll, std::size_t at) HWY_ATTR {
                    CombineTwoAt<unroll.value>(d, a, b, step, out[i - begin], out[i + 1 - begin], at);
                });
                ++i;
            } else {
                ForEachVector(k, last, [&](auto d, auto unroll, std::size_t at) HWY_ATTR {
                    CombineAt<unroll.value>(d, a, out[i - begin], at);
                });
            }
        }
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
