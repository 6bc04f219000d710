#include "bandlimit/filter/window_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bandlimit/filter/window_rows.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h, which includes this file once per instruction set.
#include <hwy/highway.h>

#include "bandlimit/core/dispatch.h"

#ifndef BANDLIMIT_FILTER_WINDOW_ROWS_ONCE
#define BANDLIMIT_FILTER_WINDOW_ROWS_ONCE
namespace bandlimit {

/// The definition of sum_blocks(), for one row.
inline void sum_blocks_of_row(const double* in, double* out, int length, int width, double* suffix) {
    for (int start = 0; start < width; start += length) {
        double sum = 0, rest = 0;
        for (int i = length - 1; i >= 0; --i) suffix[i] = sum += in[start + i];
        for (int i = 0, end = std::min(length, width - start); i < end; ++i) {
            out[start + i] = suffix[i] + rest;
            rest += in[start + length + i];
        }
    }
}

}  // namespace bandlimit
#endif

HWY_BEFORE_NAMESPACE();
namespace bandlimit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No operation here fuses a product with a sum: all targets have the bits of one number at a time.
using D = hn::CappedTag<double, window_group>;
using V = hn::Vec<D>;
using Singles = hn::Rebind<float, D>;

HWY_INLINE V Promoted(const float* from) { return hn::PromoteTo(D(), hn::LoadU(Singles(), from)); }

void SlideRow(double* to, const double* in, const double* out, int count, std::uint8_t* begins_anew) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V share = hn::Set(d, 0x1p-20);
    for (int x = 0; x < count; x += lanes) {
        V sum = hn::LoadU(d, to + x);
        if (in != nullptr) sum = hn::Add(sum, hn::LoadU(d, in + x));
        if (out != nullptr) {
            const V gone = hn::LoadU(d, out + x);
            sum = hn::Sub(sum, gone);
            if (!hn::AllFalse(d, hn::Gt(hn::Mul(hn::Abs(gone), share), hn::Abs(sum))))
                begins_anew[x / window_group] = 1;
        }
        hn::StoreU(sum, d, to + x);
    }
}

#if HWY_MAX_BYTES >= 32
using Four = hn::FixedTag<double, 4>;
using Fours = hn::Vec<Four>;

/// Four rows of four become four columns.
HWY_INLINE void Transpose(Fours* v) {
    const Four d;
    const Fours low01 = hn::InterleaveLower(d, v[0], v[1]), high01 = hn::InterleaveUpper(d, v[0], v[1]);
    const Fours low23 = hn::InterleaveLower(d, v[2], v[3]), high23 = hn::InterleaveUpper(d, v[2], v[3]);
    v[0] = hn::ConcatLowerLower(d, low23, low01), v[1] = hn::ConcatLowerLower(d, high23, high01);
    v[2] = hn::ConcatUpperUpper(d, low23, low01), v[3] = hn::ConcatUpperUpper(d, high23, high01);
}

/// Sample x of four rows.
HWY_INLINE Fours ColumnAt(const double* const* rows, int x) {
    const Four d;
    const Fours low = hn::InterleaveLower(d, hn::Set(d, rows[0][x]), hn::Set(d, rows[1][x]));
    const Fours high = hn::InterleaveLower(d, hn::Set(d, rows[2][x]), hn::Set(d, rows[3][x]));
    return hn::ConcatUpperLower(d, high, low);
}

/// Four samples of four rows, as columns.
HWY_INLINE void LoadColumns(const double* const* rows, int x, Fours* columns) {
    for (int r = 0; r < 4; ++r) columns[r] = hn::LoadU(Four(), rows[r] + x);
    Transpose(columns);
}

/// Of G times four rows, the sums from each sample of a block to its end: suffix[4 (G i + g)] are those of sample i.
template <int G>
HWY_INLINE void SumBackwards(const double* const* in, int start, int length, double* suffix) {
    const Four d;
    Fours sums[G];
    for (int g = 0; g < G; ++g) sums[g] = hn::Zero(d);
    int i = length;
    for (; i >= 4; i -= 4)
        for (int g = 0; g < G; ++g) {
            Fours columns[4];
            LoadColumns(in + 4 * g, start + i - 4, columns);
            for (int k = 3; k >= 0; --k) {
                sums[g] = hn::Add(sums[g], columns[k]);
                hn::StoreU(sums[g], d, suffix + 4 * (G * (i - 4 + k) + g));
            }
        }
    for (--i; i >= 0; --i)
        for (int g = 0; g < G; ++g) {
            sums[g] = hn::Add(sums[g], ColumnAt(in + 4 * g, start + i));
            hn::StoreU(sums[g], d, suffix + 4 * (G * i + g));
        }
}

/// Those and the sums of the next block up to where windows of the first `count` samples end.
template <int G>
HWY_INLINE void SumForwards(const double* const* in, double* const* out, int start, int length, int count,
                            const double* suffix) {
    const Four d;
    Fours rest[G];
    for (int g = 0; g < G; ++g) rest[g] = hn::Zero(d);
    int i = 0;
    for (; i + 4 <= count; i += 4)
        for (int g = 0; g < G; ++g) {
            Fours columns[4], sums[4];
            LoadColumns(in + 4 * g, start + length + i, columns);
            for (int k = 0; k < 4; ++k) {
                sums[k] = hn::Add(hn::LoadU(d, suffix + 4 * (G * (i + k) + g)), rest[g]);
                rest[g] = hn::Add(rest[g], columns[k]);
            }
            Transpose(sums);
            for (int r = 0; r < 4; ++r) hn::StoreU(sums[r], d, out[4 * g + r] + start + i);
        }
    for (; i < count; ++i)
        for (int g = 0; g < G; ++g) {
            double column[4];
            hn::StoreU(hn::Add(hn::LoadU(d, suffix + 4 * (G * i + g)), rest[g]), d, column);
            for (int r = 0; r < 4; ++r) out[4 * g + r][start + i] = column[r];
            rest[g] = hn::Add(rest[g], ColumnAt(in + 4 * g, start + length + i));
        }
}

template <int G>
void SumBlocksOf(const double* const* in, double* const* out, int length, int width, double* suffix) {
    for (int start = 0; start < width; start += length) {
        SumBackwards<G>(in, start, length, suffix);
        SumForwards<G>(in, out, start, length, std::min(length, width - start), suffix);
    }
}

void SumBlocks(int rows, const double* const* in, double* const* out, int length, int width, double* suffix) {
    int r = 0;
    for (; r + 8 <= rows; r += 8) SumBlocksOf<2>(in + r, out + r, length, width, suffix);
    for (; r + 4 <= rows; r += 4) SumBlocksOf<1>(in + r, out + r, length, width, suffix);
    if (r == rows) return;
    if (rows >= 4) {  // some again
        SumBlocksOf<1>(in + rows - 4, out + rows - 4, length, width, suffix);
        return;
    }
    for (; r < rows; ++r) sum_blocks_of_row(in[r], out[r], length, width, suffix);
}
#else
void SumBlocks(int rows, const double* const* in, double* const* out, int length, int width, double* suffix) {
    for (int r = 0; r < rows; ++r) sum_blocks_of_row(in[r], out[r], length, width, suffix);
}
#endif

void MultiplyRows(const double* a, const double* b, double* to, int count) {
    const D d;
    for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d)))
        hn::StoreU(hn::Mul(hn::LoadU(d, a + x), hn::LoadU(d, b + x)), d, to + x);
}

void ScaleRow(const double* from, double factor, double* to, int count) {
    const D d;
    for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d)))
        hn::StoreU(hn::Mul(hn::LoadU(d, from + x), hn::Set(d, factor)), d, to + x);
}

void RecentreRow(const float* from, double offset, double* to, int count) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int x = 0;  // rows of pictures have no memory after their end
    for (; x + lanes <= count; x += lanes) hn::StoreU(hn::Sub(Promoted(from + x), hn::Set(d, offset)), d, to + x);
    for (; x < count; ++x) to[x] = static_cast<double>(from[x]) - offset;
}

void Widen(FiniteRange& range, const float* row, int count) {
    const hn::ScalableTag<float> d;
    using F = hn::Vec<decltype(d)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const F infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    F least = infinity, most = hn::Neg(infinity);
    int x = 0;
    for (; x + lanes <= count; x += lanes) {
        const F v = hn::LoadU(d, row + x);
        const auto is_finite = hn::Lt(hn::Abs(v), infinity);
        range.is_whole = range.is_whole && hn::AllTrue(d, is_finite);
        least = hn::Min(least, hn::IfThenElse(is_finite, v, infinity));
        most = hn::Max(most, hn::IfThenElse(is_finite, v, hn::Neg(infinity)));
    }
    range.least = std::min(range.least, hn::GetLane(hn::MinOfLanes(d, least)));
    range.most = std::max(range.most, hn::GetLane(hn::MaxOfLanes(d, most)));
    for (; x < count; ++x) {
        if (!std::isfinite(row[x])) {
            range.is_whole = false;
        } else {
            range.least = std::min(range.least, row[x]);
            range.most = std::max(range.most, row[x]);
        }
    }
}

/// The models of a few windows side by side.
template <int P>
struct Linear {
    V mean[P], covariance[P][P], inverse[P];

    HWY_INLINE Linear(const double* const* sums, V per_weight, double epsilon, int x) {
        const D d;
        V noise[P];
        for (int k = 0; k < P; ++k) mean[k] = hn::Mul(hn::LoadU(d, sums[1 + k] + x), per_weight);
        for (int k = 0, plane = 1 + P; k < P; ++k)
            for (int l = k; l < P; ++l, ++plane) {
                const V square = hn::Mul(hn::LoadU(d, sums[plane] + x), per_weight);
                V c = hn::Sub(square, hn::Mul(mean[k], mean[l]));
                if (k == l) {
                    c = hn::Max(c, hn::Zero(d));
                    noise[k] =
                        hn::Add(hn::Mul(square, hn::Set(d, variance_noise)), hn::Mul(c, hn::Set(d, dependence_noise)));
                    c = hn::Add(c, hn::Set(d, epsilon));
                }
                covariance[l][k] = c;
            }
        Factorise(noise);
    }

    /// covariance becomes L, below its diagonal, and inverse the inverse of D, 0 where a guide is left out.
    HWY_INLINE void Factorise(const V* noise) {
        const D d;
        for (int k = 0; k < P; ++k) {
            const V pivot = covariance[k][k];
            inverse[k] = hn::IfThenElseZero(hn::Gt(pivot, noise[k]), hn::Div(hn::Set(d, 1.0), pivot));
            for (int i = P - 1; i > k; --i) {
                const V l = hn::Mul(covariance[i][k], inverse[k]);
                for (int j = k + 1; j <= i; ++j)
                    covariance[i][j] = hn::Sub(covariance[i][j], hn::Mul(l, covariance[j][k]));
                covariance[i][k] = l;
            }
        }
    }

    HWY_INLINE void Solve(V* a) const {
        for (int k = 0; k < P; ++k)
            for (int i = k + 1; i < P; ++i) a[i] = hn::Sub(a[i], hn::Mul(covariance[i][k], a[k]));
        for (int k = P - 1; k >= 0; --k) {
            a[k] = hn::Mul(a[k], inverse[k]);
            for (int i = k + 1; i < P; ++i) a[k] = hn::Sub(a[k], hn::Mul(covariance[i][k], a[i]));
        }
    }
};

template <int P>
void SolveLinear(const LinearFit& fit, int count, float* const* to) {
    const D d;
    const Singles singles;
    constexpr int first_signal = 1 + P + P * (P + 1) / 2;
    for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
        const V per_weight = hn::Div(hn::Set(d, 1.0), hn::LoadU(d, fit.sums[0] + x));
        const Linear<P> model(fit.sums, per_weight, fit.epsilon, x);
        for (int s = 0; s < fit.signals; ++s) {
            const double* const* const sums = fit.sums + first_signal + s * (1 + P);
            const V mean = hn::Mul(hn::LoadU(d, sums[0] + x), per_weight);
            V a[P];
            for (int k = 0; k < P; ++k)
                a[k] = hn::Sub(hn::Mul(hn::LoadU(d, sums[1 + k] + x), per_weight), hn::Mul(mean, model.mean[k]));
            model.Solve(a);
            V value = mean;
            for (int k = 0; k < P; ++k) {
                const V from =
                    fit.at != nullptr ? hn::Sub(hn::LoadU(d, fit.at[k] + x), model.mean[k]) : hn::Neg(model.mean[k]);
                value = hn::Add(value, hn::Mul(a[k], from));
            }
            float* const* const out = to + s * (fit.at != nullptr ? 1 : 1 + P);
            hn::StoreU(hn::DemoteTo(singles, value), singles, out[0] + x);
            if (fit.at == nullptr)
                for (int k = 0; k < P; ++k) hn::StoreU(hn::DemoteTo(singles, a[k]), singles, out[1 + k] + x);
        }
    }
}

void SolveLinearRow(const LinearFit& fit, int count, float* const* to) {
    switch (fit.guides) {
        case 1: SolveLinear<1>(fit, count, to); break;
        case 2: SolveLinear<2>(fit, count, to); break;
        case 3: SolveLinear<3>(fit, count, to); break;
        default: SolveLinear<4>(fit, count, to);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace bandlimit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bandlimit {

BANDLIMIT_EXPORT(SlideRow);
BANDLIMIT_EXPORT(SumBlocks);
BANDLIMIT_EXPORT(MultiplyRows);
BANDLIMIT_EXPORT(ScaleRow);
BANDLIMIT_EXPORT(RecentreRow);
BANDLIMIT_EXPORT(Widen);
BANDLIMIT_EXPORT(SolveLinearRow);

void slide_row(double* to, const double* in, const double* out, int count, std::uint8_t* begins_anew) {
    BANDLIMIT_DISPATCH(SlideRow)(to, in, out, count, begins_anew);
}
void sum_blocks(int rows, const double* const* in, double* const* out, int length, int width, double* suffix) {
    BANDLIMIT_DISPATCH(SumBlocks)(rows, in, out, length, width, suffix);
}
void multiply_rows(const double* a, const double* b, double* to, int count) {
    BANDLIMIT_DISPATCH(MultiplyRows)(a, b, to, count);
}
void scale_row(const double* from, double factor, double* to, int count) {
    BANDLIMIT_DISPATCH(ScaleRow)(from, factor, to, count);
}
void recentre_row(const float* from, double offset, double* to, int count) {
    BANDLIMIT_DISPATCH(RecentreRow)(from, offset, to, count);
}
void widen(FiniteRange& range, const float* row, int count) { BANDLIMIT_DISPATCH(Widen)(range, row, count); }
void solve_linear_row(const LinearFit& fit, int count, float* const* to) {
    BANDLIMIT_DISPATCH(SolveLinearRow)(fit, count, to);
}

}  // namespace bandlimit
#endif
