// The vector form of combine_scalar(): vectors run along a line, never across taps, so each sample sees the same
// operations in the same order as in the scalar form. With fused multiply-add the bits are the same too.
#include "bandlimit/resample/combine.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/resample/combine_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS

void Combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    combine_scalar(bank, begin, end, antiring, lines, out, length);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

// Without loops all of four sums is one function, which compilers with sanitizers take minutes for: there it is many.
#undef BANDLIMIT_UNROLLED
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || HWY_HAS_FEATURE(address_sanitizer)
#define BANDLIMIT_UNROLLED HWY_NOINLINE
#else
#define BANDLIMIT_UNROLLED HWY_INLINE
#endif

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
    BANDLIMIT_UNROLLED void Store(const Row& row, float* HWY_RESTRICT out, std::size_t k) const {
        const bool limits = row.antiring > 0;
        hn::StoreU(limits ? Limited(D(), first, row.taps + row.near_begin, row.near_count, k, row.antiring) : first,
                   D(), out + k);
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

/// Four outputs, each of which begins and ends no earlier than the one before, and begins while the first still reads.
struct FourRows {
    Row row[4];
    int first[4], end[4];  ///< lines read, from the first line of the first output on
    float* out[4];

    bool is_in_step(int taps, int step) const {
        for (int o = 0; o < 4; ++o)
            if (row[o].count != taps || first[o] != o * step) return false;
        return true;
    }
};

/// Four sums at once: what several read is loaded once.
template <int kCount, class D>
class FourSums {
public:
    HWY_INLINE FourSums(const FourRows& rows, std::size_t k) : rows_(rows), k_(k) {}

    /// The same for rows of kTaps weights each, kStep lines apart, without loops.
    template <int kTaps, int kStep>
    HWY_INLINE void RunInStep() {
        AddLines<kTaps, kStep>(std::make_integer_sequence<int, kTaps + 3 * kStep>());
        Store();
    }

    HWY_INLINE void Run() {
        Start(0, s0_);
        Start(1, s1_);
        Start(2, s2_);
        Start(3, s3_);
        const int* const first = rows_.first;
        const int* const end = rows_.end;
        Add<0, 1>(first[0] + 1, first[1] + 1);
        Add<0, 2>(first[1] + 1, first[2] + 1);
        Add<0, 3>(first[2] + 1, first[3] + 1);
        Add<0, 4>(first[3] + 1, end[0]);
        Add<1, 4>(end[0], end[1]);
        Add<2, 4>(end[1], end[2]);
        Add<3, 4>(end[2], end[3]);
        Store();
    }

private:
    HWY_INLINE void Store() const {
        s0_.Store(rows_.row[0], rows_.out[0], k_);
        s1_.Store(rows_.row[1], rows_.out[1], k_);
        s2_.Store(rows_.row[2], rows_.out[2], k_);
        s3_.Store(rows_.row[3], rows_.out[3], k_);
    }

    template <int kTaps, int kStep, int... kLine>
    HWY_INLINE void AddLines(std::integer_sequence<int, kLine...>) {
        (AddLine<kTaps, kStep, kLine>(), ...);
    }
    template <int kTaps, int kStep, int kLine>
    BANDLIMIT_UNROLLED void AddLine() {
        Vectors<kCount, D> samples;
        samples.Load(rows_.row[0].taps[kLine] + k_);
        AddTap<kTaps, kLine>(0, s0_, samples);
        AddTap<kTaps, kLine - kStep>(1, s1_, samples);
        AddTap<kTaps, kLine - 2 * kStep>(2, s2_, samples);
        AddTap<kTaps, kLine - 3 * kStep>(3, s3_, samples);
    }
    template <int kTaps, int kTap>
    HWY_INLINE void AddTap(int output, Vectors<kCount, D>& sum, const Vectors<kCount, D>& samples) {
        if constexpr (kTap == 0) sum.Multiply(hn::Set(D(), rows_.row[output].weights[0]), samples);
        if constexpr (kTap > 0 && kTap < kTaps) sum.MultiplyAdd(hn::Set(D(), rows_.row[output].weights[kTap]), samples);
    }

    BANDLIMIT_UNROLLED void Start(int output, Vectors<kCount, D>& sum) {
        Vectors<kCount, D> samples;
        samples.Load(rows_.row[output].taps[0] + k_);
        sum.Multiply(hn::Set(D(), rows_.row[output].weights[0]), samples);
    }

    /// Adds lines [begin, end) to the sums [kFirst, kLast).
    template <int kFirst, int kLast>
    BANDLIMIT_UNROLLED void Add(int begin, int end) {
        const float* const* const lines = rows_.row[0].taps;
        for (int v = begin; v < end; ++v) {
            Vectors<kCount, D> samples;
            samples.Load(lines[v] + k_);
            if constexpr (kFirst <= 0 && kLast > 0) s0_.MultiplyAdd(Weight(0, v), samples);
            if constexpr (kFirst <= 1 && kLast > 1) s1_.MultiplyAdd(Weight(1, v), samples);
            if constexpr (kFirst <= 2 && kLast > 2) s2_.MultiplyAdd(Weight(2, v), samples);
            if constexpr (kFirst <= 3 && kLast > 3) s3_.MultiplyAdd(Weight(3, v), samples);
        }
    }
    HWY_INLINE hn::Vec<D> Weight(int output, int v) const {
        return hn::Set(D(), rows_.row[output].weights[v - rows_.first[output]]);
    }

    const FourRows& rows_;
    std::size_t k_;
    Vectors<kCount, D> s0_, s1_, s2_, s3_;
};

/// Calls at(tag, vectors side by side, sample) over the samples [k, end) of lines that fill vectors; returns where they
/// end.
template <int kCount, class At>
HWY_INLINE std::size_t ForEachWholeVector(std::size_t k, std::size_t end, At at) {
    const hn::ScalableTag<float> d;
    const std::size_t n = hn::Lanes(d);
    for (; k + kCount * n <= end; k += kCount * n) at(d, std::integral_constant<int, kCount>(), k);
    for (; k + n <= end; k += n) at(d, std::integral_constant<int, 1>(), k);
    return k;
}

/// The same over all of them; the last ones one by one, with the same arithmetic.
template <int kCount, class At>
HWY_INLINE void ForEachVector(std::size_t k, std::size_t end, At at) {
    const hn::CappedTag<float, 1> one;
    for (k = ForEachWholeVector<kCount>(k, end, at); k < end; ++k) at(one, std::integral_constant<int, 1>(), k);
}

class Combination {
public:
    Combination(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out)
        : bank_(bank), begin_(begin), end_(end), antiring_(antiring), lines_(lines), out_(out) {}

    /// Samples [k, last) of all outputs.
    void Run(std::size_t k, std::size_t last) const {
        FourRows four;
        for (int i = begin_; i < end_;) {
            if (i + 4 <= end_ && Gather(i, four)) {
                RunFour(four, k, last);
                i += 4;
            } else {
                const Row row = RowOf(i);
                ForEachVector<4>(k, last, [&](auto d, auto vectors, std::size_t at) HWY_ATTR {
                    CombineAt<vectors.value>(d, row, out_[i - begin_], at);
                });
                ++i;
            }
        }
    }

private:
    Row RowOf(int i) const {
        const Bank::Row& info = bank_.row_info(i);
        return {bank_.weights.data() + info.offset,
                lines_ + bank_.first(i),
                info.count,
                info.near_begin,
                info.near_count,
                antiring_};
    }

    /// Fills in the rows of outputs i to i + 3; returns whether they may be summed together.
    bool Gather(int i, FourRows& four) const {
        for (int o = 0; o < 4; ++o) {
            four.row[o] = RowOf(i + o);
            four.out[o] = out_[i + o - begin_];
            four.first[o] = bank_.first(i + o) - bank_.first(i);
            four.end[o] = four.first[o] + four.row[o].count;
            if (o > 0 && (four.first[o] < four.first[o - 1] || four.end[o] < four.end[o - 1])) return false;
        }
        return four.first[3] < four.end[0];
    }

    // As many sums as fit the registers.
    static constexpr int kCount = HWY_TARGET == HWY_AVX3_DL ? 4 : 2;

    static void RunFour(const FourRows& four, std::size_t k, std::size_t last) {
        // Halving, by kernels of radius 1 to 3.
        if (four.is_in_step(12, 2)) k = RunInStep<12, 2>(four, k, last);
        else if (four.is_in_step(8, 2)) k = RunInStep<8, 2>(four, k, last);
        else if (four.is_in_step(4, 2)) k = RunInStep<4, 2>(four, k, last);
        ForEachVector<kCount>(k, last, [&](auto d, auto vectors, std::size_t at) HWY_ATTR {
            FourSums<vectors.value, decltype(d)>(four, at).Run();
        });
    }

    /// Whole vectors only; returns where they end.
    template <int kTaps, int kStep>
    static std::size_t RunInStep(const FourRows& four, std::size_t k, std::size_t last) {
        return ForEachWholeVector<kCount>(k, last, [&](auto d, auto vectors, std::size_t at) HWY_ATTR {
            FourSums<vectors.value, decltype(d)>(four, at).template RunInStep<kTaps, kStep>();
        });
    }

    const Bank& bank_;
    int begin_, end_;
    float antiring_;
    ConstLines lines_;
    Lines out_;
};

void Combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    const Combination combination(bank, begin, end, antiring, lines, out);
    // Outputs that lie together read mostly the same lines: a strip of those stays in the first cache meanwhile.
    constexpr std::size_t strip = 1024;
    for (std::size_t k = 0; k < length; k += strip) combination.Run(k, std::min(length, k + strip));
}

#endif  // BANDLIMIT_NO_VECTORS

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {
BANDLIMIT_EXPORT(Combine);
void combine(const Bank& bank, int begin, int end, float antiring, ConstLines lines, Lines out, std::size_t length) {
    BANDLIMIT_DISPATCH(Combine)(bank, begin, end, antiring, lines, out, length);
}
}  // namespace bandlimit
#endif
