#include "bandlimit/resample/apply.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/naive_test.h"
#include "bandlimit/resample/operator_checker_test.h"

namespace bandlimit {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_with_payload = std::bit_cast<float>(0x7fc12345u);

Image<float> noise(int width, int height, int channels, std::uint64_t seed) {
    Image<float> image(width, height, channels);
    Random random(seed);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = static_cast<float>(random.uniform(-1, 2));
    return image;
}

Image<float> row_of(const std::vector<float>& samples) {
    Image<float> image(static_cast<int>(samples.size()), 1);
    for (std::size_t x = 0; x < samples.size(); ++x) image.view()(static_cast<int>(x), 0) = samples[x];
    return image;
}

Image<float> applied(const Bank& bank, View<const float> src, double antiring = 0) {
    Image<float> result(bank.output_count(), src.height, src.channels);
    apply(bank, src, result.view(), {}, antiring);
    return result;
}

template <class Visit>
void for_each(View<const float> v, Visit visit) {
    for (int c = 0; c < v.channels; ++c)
        for (int y = 0; y < v.height; ++y)
            for (int x = 0; x < v.width; ++x) visit(x, y, c);
}

/// The largest |x| that noise() makes.
constexpr double largest = 2;

/// All rows of a resampling from n to m samples; made once, since the checker asks for them again and again.
const std::vector<NaiveRow>& rows_of(const Kernel& kernel, int n, int m, Edge edge) {
    static std::map<std::tuple<std::string, int, int, Edge>, std::vector<NaiveRow>> known;
    std::vector<NaiveRow>& rows = known[{kernel.name, n, m, edge}];
    for (int i = static_cast<int>(rows.size()); i < m; ++i)
        rows.push_back(naive_row(kernel, Axis{n, 0, double(n)}, Axis{m, 0, double(n)}, i, edge));
    return rows;
}

/// The columns of the same matrix. How many taps fold onto a sample is not known here: take all of the rows that read
/// it.
const std::vector<NaiveRow>& columns_of(const Kernel& kernel, int n, int m, Edge edge) {
    static std::map<std::tuple<std::string, int, int, Edge>, std::vector<NaiveRow>> known;
    std::vector<NaiveRow>& columns = known[{kernel.name, n, m, edge}];
    if (!columns.empty()) return columns;
    columns.resize(std::size_t(n));
    for (const NaiveRow& row : rows_of(kernel, n, m, edge))
        for (std::size_t x = 0; x < columns.size(); ++x) {
            columns[x].weights.push_back(row.weights[x]);
            if (row.weights[x] != 0) columns[x].sum_abs += row.sum_abs, columns[x].taps += row.taps;
        }
    return columns;
}

struct Resampling {
    Kernel kernel;
    Edge edge;
    int numerator, denominator;  ///< of the scale

    int outputs(int inputs) const { return std::max(1, inputs * numerator / denominator); }
    Axis src(int n) const { return {n, 0, double(n)}; }
    Axis dst(int n) const { return {outputs(n), 0, double(n)}; }
    const NaiveRow& row(int n, int i) const { return rows_of(kernel, n, outputs(n), edge)[std::size_t(i)]; }

    Operator as_operator(double antiring = 0) const {
        Operator op;
        op.output_size = [*this](Size size) { return Size{outputs(size.width), size.height}; };
        op.run = [*this, antiring](View<const float> src, View<float> dst, Window w, Parallel parallel) {
            const Axis part = this->dst(src.width).cells(w.x, w.x + w.width);
            const Bank bank = make_bank(kernel, this->src(src.width), part, edge);
            apply(bank, cropped(src, 0, w.y, src.width, w.height), dst, parallel, antiring);
        };
        op.reference = [*this](View<const float> src, int x, int y, int c) {
            return dot(row(src.width, x), src, y, c);
        };
        op.bound = [*this](View<const float> src, int x, int, int) {
            const NaiveRow& at = row(src.width, x);
            return dot_bound(at.taps, at.sum_abs * largest);
        };
        return op;
    }
};

std::vector<Resampling> resamplings() {
    return {{lanczos(3), Edge::reflect, 1, 2}, {mitchell(), Edge::renormalize, 3, 2}, {bspline(), Edge::wrap, 1, 1},
            {box(), Edge::clamp, 2, 5},        {catmull_rom(), Edge::zero, 7, 3},     {tent(), Edge::clamp, 1, 40}};
}

TEST(Apply, PassesTheOperatorChecker) {
    for (const Resampling& r : resamplings())
        EXPECT_TRUE(check_operator(r.as_operator())) << r.kernel.name << ' ' << name_of(r.edge);
}

TEST(Apply, WithAntiringPassesTheOperatorChecker) {
    const Resampling r{lanczos(3), Edge::reflect, 3, 2};
    Operator op = r.as_operator(0.75);
    op.reference = [r](View<const float> src, int i, int y, int c) {
        const double sum = dot(r.row(src.width, i), src, y, c);
        const double at = r.src(src.width).index(r.dst(src.width).position(i));
        double low = INFINITY, high = -INFINITY;
        for (int s = static_cast<int>(std::floor(at - 1)); s <= at + 1; ++s)
            if (std::abs(s - at) < 1 - 1e-9) {
                const double x = src(resolve(s, src.width, r.edge), y, c);
                low = std::min(low, x), high = std::max(high, x);
            }
        return 0.25 * sum + 0.75 * std::clamp(sum, low, high);
    };
    // The rounding of the sum, and three of values up to 4.
    const auto bound_of_sum = op.bound;
    op.bound = [bound_of_sum](View<const float> src, int x, int y, int c) {
        return bound_of_sum(src, x, y, c) + 3 * 4 * 0x1p-24;
    };
    EXPECT_TRUE(check_operator(op));
}

TEST(Apply, IsItsScalarDefinitionOnEveryTarget) {
    for (const Resampling& r : resamplings())
        for (const double antiring : {0.0, 0.5, 1.0})
            for (const auto& [width, height, channels] : {std::tuple{33, 70, 3}, {64, 1, 1}, {5, 129, 1}, {1, 40, 4}}) {
                const Image<float> src = noise(width, height, channels, 1);
                const Bank bank = make_bank(r.kernel, r.src(width), r.dst(width), r.edge);
                Image<float> expected(bank.output_count(), height, channels);
                apply_scalar(bank, src.view(), expected.view(), antiring);
                const int n = width;
                for_each_target([&](Target target) {
                    const Image<float> result = applied(bank, src.view(), antiring);
                    for_each(result.view(), [&](int x, int y, int c) {
                        const double bound =
                            has_fused_multiply_add(target) ? 0 : 2 * dot_bound(r.row(n, x).taps + 3, 2 * largest);
                        ASSERT_NEAR(double(result.view()(x, y, c)), double(expected.view()(x, y, c)), bound)
                            << r.kernel.name << ' ' << n << ' ' << x << ' ' << y << ' ' << c;
                    });
                });
            }
}

TEST(Apply, IdentityKeepsEveryBit) {
    const std::vector<float> samples{-0.0f, 0.0f,     infinity, 1.5f,  nan_with_payload, -infinity,        1e-40f,
                                     -0.0f, infinity, infinity, 3e38f, -3e38f,           nan_with_payload, 0.1f};
    for (const Kernel& kernel :
         {nearest(), box(), tent(), quadratic_interpolating(), catmull_rom(), lanczos(2), lanczos(3)})
        for (const Edge edge : all_edges())
            for (const double antiring : {0.0, 0.5, 1.0}) {
                const Image<float> src = row_of(samples);
                const Axis axis{src.width(), 0.3, 9.1};
                const Image<float> result = applied(make_bank(kernel, axis, axis, edge), src.view(), antiring);
                for (int x = 0; x < src.width(); ++x)
                    ASSERT_EQ(std::bit_cast<std::uint32_t>(result.view()(x, 0)),
                              std::bit_cast<std::uint32_t>(src.view()(x, 0)))
                        << kernel.name << ' ' << name_of(edge) << ' ' << antiring << ' ' << x;
            }
}

TEST(Apply, ConstantsSurvive) {
    for (const Resampling& r : resamplings()) {
        if (r.edge == Edge::zero) continue;
        for (int n = 1; n <= 40; ++n) {
            const Image<float> result = applied(make_bank(r.kernel, r.src(n), r.dst(n), r.edge),
                                                row_of(std::vector(std::size_t(n), 3.0f)).view());
            for (int i = 0; i < result.width(); ++i) {
                const NaiveRow& row = r.row(n, i);
                ASSERT_NEAR(result.view()(i, 0), 3.0f, dot_bound(row.taps, 3 * row.sum_abs))
                    << r.kernel.name << n << ' ' << i;
            }
        }
    }
}

TEST(Apply, SeparableIsTheDirectSumInTwoDimensions) {
    const Resampling x{lanczos(2), Edge::reflect, 3, 2}, y{mitchell(), Edge::wrap, 1, 2};
    const Image<float> src = noise(7, 6, 2, 4);
    Image<float> middle = applied(make_bank(x.kernel, x.src(7), x.dst(7), x.edge), src.view());
    Image<float> result(middle.width(), 3, 2);
    apply(make_bank(y.kernel, y.src(6), y.dst(6), y.edge), transposed(View<const float>(middle.view())),
          transposed(result.view()));
    for_each(result.view(), [&](int i, int j, int c) {
        const NaiveRow &row_x = x.row(7, i), &row_y = y.row(6, j);
        double sum = 0;
        for (int v = 0; v < 6; ++v) sum += row_y.weights[std::size_t(v)] * dot(row_x, src.view(), v, c);
        const double bound = dot_bound(row_x.taps + row_y.taps, row_x.sum_abs * row_y.sum_abs * largest);
        ASSERT_NEAR(double(result.view()(i, j, c)), sum, bound) << i << ' ' << j << ' ' << c;
    });
}

TEST(Apply, NanReachesOnlyTheOutputsWhoseRowCoversIt) {
    for (const Resampling& r : resamplings())
        for (const float bad : {nan_with_payload, infinity})
            for (const int n : {1, 5, 33}) {
                const Bank bank = make_bank(r.kernel, r.src(n), r.dst(n), r.edge);
                const Image<float> clean = noise(n, 20, 3, 6), clean_result = applied(bank, clean.view());
                for (int at = 0; at < n; ++at) {
                    Image<float> dirty = clean.clone();
                    dirty.view()(at, 13, 1) = bad;
                    const Image<float> result = applied(bank, dirty.view());
                    for_each(result.view(), [&](int x, int y, int c) {
                        bool covers = false;
                        for (int j = 0; j < bank.row_info(x).count; ++j)
                            covers = covers || resolve(bank.first(x) + j, n, r.edge) == at;
                        if (y == 13 && c == 1 && covers) ASSERT_FALSE(std::isfinite(result.view()(x, y, c)));
                        else
                            ASSERT_EQ(result.view()(x, y, c), clean_result.view()(x, y, c))
                                << x << ' ' << y << ' ' << c;
                    });
                }
            }
}

TEST(Antiring, AStepDoesNotOvershoot) {
    std::vector<float> step(40, 0.25f);
    std::fill(step.begin() + 20, step.end(), 0.75f);
    for (const auto& [m, n] : {std::pair{97, 40}, {15, 40}, {40, 40}}) {
        const Bank bank = make_bank(lanczos(3), Axis{n}, Axis{m}, Edge::reflect);
        double overshoot[3] = {};
        for (int k = 0; k < 3; ++k) {
            const Image<float> result = applied(bank, row_of(step).view(), k / 2.0);
            for (int i = 0; i < m; ++i)
                overshoot[k] =
                    std::max({overshoot[k], double(result.view()(i, 0)) - 0.75, 0.25 - double(result.view()(i, 0))});
        }
        EXPECT_EQ(overshoot[2], 0) << m;
        if (m == n) continue;
        EXPECT_GT(overshoot[0], 0.01) << m;
        EXPECT_NEAR(overshoot[1], overshoot[0] / 2, 0x1p-22) << m;
    }
}

TEST(Antiring, OneStaysWithinTheNearestSamples) {
    for (const Resampling& r : resamplings())
        for (int n = 1; n <= 40; n += 3) {
            const Bank bank = make_bank(r.kernel, r.src(n), r.dst(n), r.edge);
            Image<float> src = noise(n, 7, 1, 9);
            // Values of very different size: the limit must hold to the last bit.
            for_each(src.view(), [&](int x, int y, int) {
                src.view()(x, y) = std::ldexp(src.view()(x, y), (x * 7 + y * 5) % 40 - 30);
            });
            const Image<float> result = applied(bank, src.view(), 1);
            for_each(result.view(), [&](int i, int y, int) {
                const Bank::Row& row = bank.row_info(i);
                float low = infinity, high = -infinity;
                for (int j = row.near_begin; j < row.near_begin + row.near_count; ++j) {
                    const float x = src.view()(resolve(bank.first(i) + j, n, r.edge), y);
                    low = std::min(low, x), high = std::max(high, x);
                }
                ASSERT_GE(result.view()(i, y), low) << r.kernel.name << ' ' << n << ' ' << i;
                ASSERT_LE(result.view()(i, y), high) << r.kernel.name << ' ' << n << ' ' << i;
            });
        }
}

TEST(Antiring, LeavesWhatDoesNotOvershootAlone) {
    const Image<float> src = noise(30, 5, 2, 10);
    const Bank bank =
        make_bank(bspline(), Axis{30}, Axis{71}, Edge::clamp);  // of positive weights, mostly within range
    const Image<float> without = applied(bank, src.view()), with = applied(bank, src.view(), 1);
    int same = 0;
    for_each(with.view(), [&](int x, int y, int c) {
        const Bank::Row& row = bank.row_info(x);
        float low = infinity, high = -infinity;
        for (int j = row.near_begin; j < row.near_begin + row.near_count; ++j) {
            const float v = src.view()(resolve(bank.first(x) + j, 30, Edge::clamp), y, c);
            low = std::min(low, v), high = std::max(high, v);
        }
        const float plain = without.view()(x, y, c);
        if (plain < low || plain > high) return;
        ++same;
        ASSERT_EQ(with.view()(x, y, c), plain);
    });
    EXPECT_GT(same, 200);
}

TEST(Antiring, MustBeAShare) {
    const Image<float> src(4, 1);
    Image<float> dst(4, 1);
    const Bank bank = make_bank(tent(), Axis{4}, Axis{4}, Edge::clamp);
    for (const double bad : {-0.1, 1.1, std::nan("")}) {
        EXPECT_THROW(apply(bank, src.view(), dst.view(), {}, bad), Error);
        EXPECT_THROW(apply_scalar(bank, src.view(), dst.view(), bad), Error);
    }
}

TEST(Adjoint, PassesTheOperatorChecker) {
    for (const Resampling& r : resamplings()) {
        if (r.denominator > 5) continue;  // its output would be 40 times as wide, and say nothing new
        // The adjoint of the bank that takes n to m, where m is the width of what the checker gives.
        const Resampling back{r.kernel, r.edge, r.denominator, r.numerator};
        Operator op;
        op.output_size = [back](Size size) { return Size{back.outputs(size.width), size.height}; };
        const auto inputs = [back](int m) { return back.outputs(m); };
        const auto axes = [=](int m) { return std::pair{Axis{inputs(m), 0, 1}, Axis{m, 0, 1}}; };
        op.run = [=](View<const float> src, View<float> dst, Window w, Parallel parallel) {
            const auto [from, to] = axes(src.width);
            Image<float> whole(from.count, w.height, src.channels);
            apply_adjoint(make_bank(r.kernel, from, to, r.edge), cropped(src, 0, w.y, src.width, w.height),
                          whole.view(), parallel);
            if (w.width == from.count)  // all of it: as the caller wants it
                return apply_adjoint(make_bank(r.kernel, from, to, r.edge), cropped(src, 0, w.y, src.width, w.height),
                                     dst, parallel);
            for_each(dst, [&](int x, int y, int c) { dst(x, y, c) = whole.view()(w.x + x, y, c); });
        };
        const auto columns = [=](int m) -> const std::vector<NaiveRow>& {
            return columns_of(r.kernel, inputs(m), m, r.edge);
        };
        op.reference = [=](View<const float> src, int x, int y, int c) {
            return dot(columns(src.width)[std::size_t(x)], src, y, c);
        };
        op.bound = [=](View<const float> src, int x, int, int) {
            const NaiveRow& at = columns(src.width)[std::size_t(x)];
            return dot_bound(at.taps, at.sum_abs * largest);
        };
        EXPECT_TRUE(check_operator(op)) << r.kernel.name << ' ' << name_of(r.edge);
    }
}

TEST(Adjoint, MovesTheBankAcrossTheInnerProduct) {
    for (const Resampling& r : resamplings())
        for (int n = 1; n <= 40; ++n) {
            const Bank bank = make_bank(r.kernel, r.src(n), r.dst(n), r.edge);
            const Image<float> u = noise(n, 3, 2, 11), v = noise(bank.output_count(), 3, 2, 12);
            const Image<float> au = applied(bank, u.view());
            Image<float> av(n, 3, 2);
            apply_adjoint(bank, v.view(), av.view());
            double left = 0, right = 0, bound = 0;
            for_each(v.view(), [&](int x, int y, int c) {
                left += double(au.view()(x, y, c)) * double(v.view()(x, y, c));
                // Each product of a weight and two samples is rounded along either way, in sums of at most this many.
                const NaiveRow& row = r.row(n, x);
                bound += 2 * dot_bound(row.taps + bank.output_count(), row.sum_abs * largest * largest);
            });
            for_each(u.view(),
                     [&](int x, int y, int c) { right += double(u.view()(x, y, c)) * double(av.view()(x, y, c)); });
            ASSERT_NEAR(left, right, bound) << r.kernel.name << ' ' << n;
        }
}

TEST(Apply, RefusesShapesThatDisagree) {
    const Bank bank = make_bank(tent(), Axis{5}, Axis{3}, Edge::clamp);
    const Image<float> src(5, 2, 2);
    for (const auto& [w, h, c] : {std::tuple{5, 2, 2}, {3, 3, 2}, {3, 2, 1}, {4, 2, 2}}) {
        Image<float> dst(w, h, c);
        EXPECT_THROW(apply(bank, src.view(), dst.view()), Error);
        EXPECT_THROW(apply_scalar(bank, src.view(), dst.view()), Error);
        EXPECT_THROW(apply_adjoint(bank, View<const float>(dst.view()), Image<float>(5, 2, 2).view()), Error);
    }
    Image<float> dst(3, 2, 2);
    EXPECT_THROW(apply(bank, Image<float>(4, 2, 2).view(), dst.view()), Error);
    EXPECT_THROW(apply(bank, src.view(), dst.view(), {-1}), Error);
    EXPECT_NO_THROW(apply(bank, src.view(), dst.view()));
    Image<float> none(3, 0);
    EXPECT_NO_THROW(apply(bank, Image<float>(5, 0).view(), none.view()));
}

}  // namespace
}  // namespace bandlimit
