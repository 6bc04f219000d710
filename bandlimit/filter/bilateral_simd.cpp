// The vector form of bilateral_row_scalar(): vectors run along the row, never across the window, so each output sees the
// same operations in the same order as in the scalar form.
#include <algorithm>

#include "bandlimit/filter/bilateral_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/filter/bilateral_simd.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {

#if BANDLIMIT_NO_VECTORS

void FilterRow(const BilateralRow& row) { bilateral_row_scalar(row); }

#else

namespace hn = hwy::HWY_NAMESPACE;

const hn::ScalableTag<float> df;
const hn::ScalableTag<uint32_t> du;
using VF = hn::Vec<decltype(df)>;

HWY_INLINE VF Falloff(VF x) {
    const VF limited = hn::Min(x, hn::Set(df, 127.0f)), shift = hn::Set(df, falloff_shift);
    const VF shifted = hn::Sub(shift, limited);
    const VF t = hn::Add(limited, hn::Sub(shifted, shift));
    VF sum = hn::Set(df, falloff_terms[4]);
    sum = hn::MulAdd(sum, t, hn::Set(df, falloff_terms[3]));
    sum = hn::MulAdd(sum, t, hn::Set(df, falloff_terms[2]));
    sum = hn::MulAdd(sum, t, hn::Set(df, falloff_terms[1]));
    sum = hn::MulAdd(sum, t, hn::Set(df, falloff_terms[0]));
    sum = hn::MulAdd(sum, t, hn::Set(df, 1.0f));
    return hn::Mul(sum, hn::BitCast(df, hn::ShiftLeft<23>(hn::BitCast(du, shifted))));
}

/// The guides of the outputs. Members, not an array with loops over it: that keeps them in registers.
template <int kGuides>
struct Guides {
    VF centre, scale;
    Guides<kGuides - 1> rest;

    HWY_INLINE Guides(const float* at, const float* guide, const float* scales, std::ptrdiff_t plane)
        : centre(hn::LoadU(df, at)),
          scale(hn::Set(df, *scales)),
          rest(guide + plane, guide + plane, scales + 1, plane) {}
    HWY_INLINE VF Squared(const float* guide, std::ptrdiff_t plane) const {
        const VF t = Difference(guide);
        return rest.PlusSquared(guide + plane, plane, hn::Mul(t, t));
    }
    HWY_INLINE VF PlusSquared(const float* guide, std::ptrdiff_t plane, VF sum) const {
        const VF t = Difference(guide);
        return rest.PlusSquared(guide + plane, plane, hn::MulAdd(t, t, sum));
    }

private:
    HWY_INLINE VF Difference(const float* guide) const { return hn::Mul(hn::Sub(hn::LoadU(df, guide), centre), scale); }
};
template <>
struct Guides<0> {
    HWY_INLINE Guides(const float*, const float*, const float*, std::ptrdiff_t) {}
    HWY_INLINE VF PlusSquared(const float*, std::ptrdiff_t, VF sum) const { return sum; }
};

/// Any number of them.
struct ManyGuides {
    const float *centre, *guide, *scales;
    int count;

    HWY_INLINE VF Squared(const float* at, std::ptrdiff_t plane) const {
        const VF t = hn::Mul(hn::Sub(hn::LoadU(df, at), hn::LoadU(df, centre)), hn::Set(df, scales[0]));
        VF sum = hn::Mul(t, t);
        for (int c = 1; c < count; ++c) {
            const VF u = hn::Mul(hn::Sub(hn::LoadU(df, at + c * plane), hn::LoadU(df, guide + c * plane)),
                                 hn::Set(df, scales[c]));
            sum = hn::MulAdd(u, u, sum);
        }
        return sum;
    }
};

/// Sums of weighted differences from the middle samples.
template <int kSignals>
struct Sums {
    VF middle, sum;
    Sums<kSignals - 1> rest;

    HWY_INLINE Sums(const float* signal, std::ptrdiff_t plane)
        : middle(hn::LoadU(df, signal)), sum(hn::Zero(df)), rest(signal + plane, plane) {}
    HWY_INLINE void Clear() {
        sum = hn::Zero(df);
        rest.Clear();
    }
    HWY_INLINE void Add(VF weight, const float* signal, std::ptrdiff_t plane) {
        sum = hn::MulAdd(weight, hn::Sub(hn::LoadU(df, signal), middle), sum);
        rest.Add(weight, signal + plane, plane);
    }
    HWY_INLINE void Add(const Sums& other) {
        sum = hn::Add(sum, other.sum);
        rest.Add(other.rest);
    }
    HWY_INLINE void Store(VF weights, float* out, std::ptrdiff_t plane) const {
        hn::StoreU(hn::Add(middle, hn::Div(sum, weights)), df, out);
        rest.Store(weights, out + plane, plane);
    }
};
template <>
struct Sums<0> {
    HWY_INLINE Sums(const float*, std::ptrdiff_t) {}
    HWY_INLINE void Clear() {}
    HWY_INLINE void Add(VF, const float*, std::ptrdiff_t) {}
    HWY_INLINE void Add(const Sums&) {}
    HWY_INLINE void Store(VF, float*, std::ptrdiff_t) const {}
};

template <int kSignals, class AnyGuides>
HWY_INLINE void FilterAt(const BilateralRow& row, const AnyGuides& guides, const float* guide, const float* signal,
                         float* out) {
    const std::ptrdiff_t plane = row.plane;
    const float* space = row.space;
    Sums<kSignals> sums(signal, plane), row_sums = sums;
    VF weights = hn::Zero(df);
    for (int j = -row.radius_y; j <= row.radius_y; ++j) {
        VF row_weights = hn::Zero(df);
        row_sums.Clear();
        const std::ptrdiff_t first = j * row.row - row.radius_x;
        const float* g = guide + first;
        const float* s = signal + first;
        for (int i = -row.radius_x; i <= row.radius_x; ++i, ++g, ++s) {
            const VF weight = hn::Mul(hn::Set(df, *space++), Falloff(guides.Squared(g, plane)));
            row_weights = hn::Add(row_weights, weight);
            row_sums.Add(weight, s, plane);
        }
        weights = hn::Add(weights, row_weights);
        sums.Add(row_sums);
    }
    sums.Store(weights, out, row.out_plane);
}

template <int kSignals>
void FilterSignals(const BilateralRow& row, int first) {
    const float* const signal = row.signal + first * row.plane;
    float* const out = row.out + first * row.out_plane;
    const int n = static_cast<int>(hn::Lanes(df));
    for (int x = 0; x < row.width; x += n) {
        const float *centre = row.centre + x, *guide = row.guide + x;
        if (row.guides == 1)
            FilterAt<kSignals>(row, Guides<1>(centre, guide, row.scales, row.plane), guide, signal + x, out + x);
        else if (row.guides == 3)
            FilterAt<kSignals>(row, Guides<3>(centre, guide, row.scales, row.plane), guide, signal + x, out + x);
        else FilterAt<kSignals>(row, ManyGuides{centre, guide, row.scales, row.guides}, guide, signal + x, out + x);
    }
}

void FilterRow(const BilateralRow& row) {
    for (int c = 0; c < row.signals; c += 4) switch (std::min(4, row.signals - c)) {
            case 1: FilterSignals<1>(row, c); break;
            case 2: FilterSignals<2>(row, c); break;
            case 3: FilterSignals<3>(row, c); break;
            default: FilterSignals<4>(row, c);
        }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {

BANDLIMIT_EXPORT(FilterRow);
void bilateral_row(const BilateralRow& row) { BANDLIMIT_DISPATCH(FilterRow)(row); }

}  // namespace bandlimit
#endif
