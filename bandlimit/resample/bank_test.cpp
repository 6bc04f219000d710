#include "bandlimit/resample/bank.h"

#include "bandlimit/resample/bank_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/naive_test.h"

namespace bandlimit {
namespace {

constexpr int sizes[] = {1, 2, 3, 4, 5, 7, 8, 13, 16, 23, 33, 40};

std::vector<Kernel> separable_kernels() {
    std::vector<Kernel> kernels{lanczos(1), lanczos(2)};
    for (const KernelInfo& info : kernel_list())
        if (Kernel kernel = parse_kernel(info.example); !is_radial(kernel)) kernels.push_back(std::move(kernel));
    return kernels;
}

std::vector<Kernel> interpolating_kernels() {
    return {nearest(),  box(),      tent(),     quadratic_interpolating(), catmull_rom(),
            lanczos(1), lanczos(2), lanczos(3), truncated_sinc(4),         kaiser(4, 6)};
}

double sum_of(std::span<const float> row) { return std::accumulate(row.begin(), row.end(), 0.0); }

/// The weight of every source sample in output i, with edges folded in.
std::vector<double> dense(const Bank& bank, int i) {
    std::vector<double> weights(static_cast<std::size_t>(bank.inputs));
    for (int j = 0; j < static_cast<int>(bank.row(i).size()); ++j)
        weights[static_cast<std::size_t>(resolve(bank.first(i) + j, bank.inputs, bank.edge))] +=
            double(bank.row(i)[static_cast<std::size_t>(j)]);
    return weights;
}

/// How many weights of output i multiply each source sample.
std::vector<int> taps_on(const Bank& bank, int i) {
    std::vector<int> taps(static_cast<std::size_t>(bank.inputs));
    for (int j = 0; j < bank.row_info(i).count; ++j)
        ++taps[static_cast<std::size_t>(resolve(bank.first(i) + j, bank.inputs, bank.edge))];
    return taps;
}

void expect_same_rows(const Bank& whole, int from, const Bank& part, const std::string& what) {
    for (int i = 0; i < part.output_count(); ++i) {
        ASSERT_EQ(part.first(i), whole.first(from + i)) << what << ' ' << i;
        const auto a = part.row(i), b = whole.row(from + i);
        ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << what << ' ' << i;
        ASSERT_EQ(part.row_info(i).near_begin, whole.row_info(from + i).near_begin) << what << ' ' << i;
        ASSERT_EQ(part.row_info(i).near_count, whole.row_info(from + i).near_count) << what << ' ' << i;
    }
}

template <class Make>
std::string error_of(Make make) {
    try {
        make();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "must be refused";
    return {};
}

TEST(Bank, IsItsDefinitionForEveryKernelEdgeAndSize) {
    for (const Kernel& kernel : separable_kernels())
        for (const Edge edge : all_edges())
            for (const int n : sizes)
                for (const int m : sizes) {
                    const Axis src{n, 0, double(n)}, dst{m, 0, double(n)};
                    const Bank bank = make_bank(kernel, src, dst, edge);
                    ASSERT_EQ(bank.inputs, n);
                    ASSERT_EQ(bank.output_count(), m);
                    for (int i = 0; i < m; ++i) {
                        const NaiveRow naive = naive_row(kernel, src, dst, i, edge);
                        const std::vector<double> weights = dense(bank, i);
                        const std::vector<int> taps = taps_on(bank, i);
                        for (int x = 0; x < n; ++x) {
                            // A weight carries its own rounding and that of the sum before it; folded ones add up.
                            const double bound = std::max(1, taps[std::size_t(x)]) * 0x1p-23 * naive.sum_abs;
                            ASSERT_NEAR(weights[std::size_t(x)], naive.weights[std::size_t(x)], bound)
                                << kernel.name << ' ' << name_of(edge) << ' ' << n << " to " << m << ", output " << i;
                        }
                    }
                }
}

/// What combine() makes of ones.
float sum_as_executed(std::span<const float> row) {
    float sum = row[0];
    for (const float w : row.subspan(1)) sum = std::fma(w, 1.0f, sum);
    return sum;
}

TEST(Bank, RowsSumToExactlyOneAsExecuted) {
    for (const Kernel& kernel : separable_kernels())
        for (const Edge edge : {Edge::clamp, Edge::renormalize})
            for (const auto& [n, m] :
                 {std::pair{1000, 1}, {1000, 7}, {1000, 333}, {37, 1000}, {999, 1000}, {3, 5}, {4000, 9}, {9000, 2}}) {
                const Bank bank = make_bank(kernel, Axis{n}, Axis{m}, edge);
                for (int i = 0; i < m; ++i) {
                    const std::span<const float> row = bank.row(i);
                    const std::string what =
                        message(kernel.name, ' ', name_of(edge), ' ', n, " to ", m, ", output ", i);
                    ASSERT_EQ(sum_as_executed(row), 1) << what;
                    double sum_abs = 0;
                    for (const float w : row) sum_abs += std::abs(double(w));
                    ASSERT_NEAR(sum_of(row), 1, dot_bound(int(row.size()), sum_abs)) << what;
                }
            }
}

TEST(Bank, WeightsAreWithinARoundingOfOne) {
    for (const Kernel& kernel : separable_kernels())
        for (const auto& [n, m] : {std::pair{1000, 7}, {1000, 333}, {37, 1000}, {4000, 9}}) {
            const Axis src{n, 0, double(n)}, dst{m, 0, double(n)};
            const Bank bank = make_bank(kernel, src, dst, Edge::wrap);
            for (int i = 0; i < m; i += 1 + m / 20) {
                const NaiveRow naive = naive_row(kernel, src, dst, i, Edge::wrap);
                const std::vector<double> weights = dense(bank, i);
                const std::vector<int> taps = taps_on(bank, i);
                for (int x = 0; x < n; ++x)
                    ASSERT_NEAR(weights[std::size_t(x)], naive.weights[std::size_t(x)],
                                std::max(1, taps[std::size_t(x)]) * 0x1p-23 * naive.sum_abs)
                        << kernel.name << ' ' << n << " to " << m << ", output " << i;
            }
        }
}

TEST(Taps, OfSumOneSumToExactlyOneAsExecuted) {
    Random random(9);
    for (const int count : {2, 3, 12, 101, 4000}) {
        Taps taps{0, std::vector<double>(std::size_t(count))};
        double sum = 0;
        for (double& w : taps.weights) sum += w = random.uniform() - 0.2;
        for (double& w : taps.weights) w /= sum;
        EXPECT_EQ(sum_as_executed(make_bank(taps, 5000, Edge::clamp).row(50)), 1) << count;
    }
}

TEST(Bank, EndsOfRowsAreNotZero) {
    for (const Kernel& kernel : separable_kernels())
        for (const Edge edge : all_edges())
            for (const auto& [n, m] : {std::pair{12, 12}, {12, 6}, {12, 4}, {21, 7}, {5, 15}, {24, 10}}) {
                const Bank bank = make_bank(kernel, Axis{n}, Axis{m}, edge);
                for (int i = 0; i < m; ++i) {
                    ASSERT_NE(bank.row(i).front(), 0) << kernel.name << name_of(edge) << n << ' ' << m << ' ' << i;
                    ASSERT_NE(bank.row(i).back(), 0) << kernel.name << name_of(edge) << n << ' ' << m << ' ' << i;
                }
            }
}

TEST(Bank, ZerosStayZeros) {
    const Bank taps = make_bank(Taps{0, {0.1, 0, 0.7, 0, 0.2}}, 20, Edge::clamp);
    EXPECT_EQ(taps.row(3)[1], 0);
    EXPECT_EQ(taps.row(3)[3], 0);
    // Outputs at every third sample, from one beside the border on: the first tap inside is a zero of the kernel.
    const Bank cut = make_bank(lanczos(3), Axis{30, 0, 30}, Axis{8, 2, 26}, Edge::renormalize);
    EXPECT_EQ(cut.first(0), 1) << "sample 0 lies one pitch from the output at 3";
}

TEST(Bank, BoxTakesExactAreas) {
    const Bank bank = make_bank(box(), Axis{5}, Axis{2}, Edge::clamp);
    const std::vector<double> left{.4, .4, .2, 0, 0}, right{0, 0, .2, .4, .4};
    for (int x = 0; x < 5; ++x) {
        EXPECT_NEAR(dense(bank, 0)[std::size_t(x)], left[std::size_t(x)], 0x1p-25);
        EXPECT_NEAR(dense(bank, 1)[std::size_t(x)], right[std::size_t(x)], 0x1p-25);
    }
    const Bank odd = make_bank(box(), Axis{903}, Axis{451}, Edge::renormalize);
    for (int i = 0; i < 451; ++i) {
        ASSERT_EQ(odd.first(i), 2 * i);
        ASSERT_EQ(odd.row(i).size(), 3u);
        for (const auto& [j, w] : {std::pair{0, 451 - i}, {1, 451}, {2, i + 1}})
            ASSERT_NEAR(double(odd.row(i)[std::size_t(j)]), w / 903.0, 0x1p-25) << i;
    }
}

TEST(Bank, RationalFactorsShareTheirRows) {
    for (const Edge edge : {Edge::clamp, Edge::reflect, Edge::wrap}) {
        EXPECT_EQ(make_bank(lanczos(3), Axis{4096}, Axis{2048}, edge).rows.size(), 1u);
        EXPECT_EQ(make_bank(lanczos(3), Axis{1000}, Axis{3000}, edge).rows.size(), 3u);
        EXPECT_EQ(make_bank(mitchell(), Axis{1920}, Axis{1280}, edge).rows.size(), 2u);
        EXPECT_EQ(make_bank(tent(), Axis{1080}, Axis{1080}, edge).rows.size(), 1u);
    }
    // Lanczos-3 at half the size reads 2i - 5 to 2i + 6: three outputs at either end lack samples.
    EXPECT_EQ(make_bank(lanczos(3), Axis{4096}, Axis{2048}, Edge::renormalize).rows.size(), 7u);
    EXPECT_EQ(make_bank(box(), Axis{4096}, Axis{2048}, Edge::renormalize).rows.size(), 1u);
}

TEST(Bank, EqualAxesAreTheIdentityForInterpolatingKernels) {
    for (const Kernel& kernel : interpolating_kernels())
        for (const Edge edge : all_edges())
            for (int n = 1; n <= 40; ++n)
                for (const Axis& axis : {Axis{n}, Axis{n, 0, double(n)}, Axis{n, 0.1, 7.3}, Axis{n, 2, -1.7}}) {
                    const Bank bank = make_bank(kernel, axis, axis, edge);
                    for (int i = 0; i < n; ++i) {
                        ASSERT_EQ(bank.first(i), i) << kernel.name << ' ' << n;
                        ASSERT_EQ(bank.row(i).size(), 1u) << kernel.name << ' ' << n;
                        ASSERT_EQ(bank.row(i)[0], 1.0f);
                    }
                }
    for (const Kernel& kernel : {bspline(), mitchell(), quadratic_bspline(), gaussian(0.5)})
        EXPECT_GT(make_bank(kernel, Axis{9}, Axis{9}, Edge::clamp).row(4).size(), 1u) << kernel.name;
}

TEST(Bank, PartsHoldTheBitsOfTheWhole) {
    Random random(3);
    for (int round = 0; round < 600; ++round) {
        const int n = random.integer(1, round % 3 == 0 ? 5000 : 60), m = random.integer(1, round % 2 == 0 ? 5000 : 60);
        const Kernel kernel =
            std::vector{lanczos(3), box(), mitchell(), tent(), nearest(), gaussian(0.7)}[std::size_t(round % 6)];
        const Edge edge = all_edges()[std::size_t(random.integer(0, 4))];
        // The same pair of intervals in cells, in normalised coordinates, and in some odd unit.
        const double begin = std::vector{0.0, 0.0, -0.3}[std::size_t(round % 3)];
        const double end = std::vector{double(n), 1.0, 12.7}[std::size_t(round % 3)];
        const Axis src{n, begin, end}, dst{m, begin, end};
        const Bank whole = make_bank(kernel, src, dst, edge);
        for (int k = 0; k < 6; ++k) {
            const int first = random.integer(0, m - 1), last = k == 0 ? first + 1 : random.integer(first + 1, m);
            const std::string what =
                message(kernel.name, ' ', n, " to ", m, ", cells ", first, " to ", last, ", round ", round);
            ASSERT_NO_FATAL_FAILURE(
                expect_same_rows(whole, first, make_bank(kernel, src, dst.cells(first, last), edge), what));
        }
    }
}

TEST(Bank, PartsOfARegionHoldTheBitsOfTheRegion) {
    Random random(4);
    for (int round = 0; round < 200; ++round) {
        const int n = random.integer(8, 3000), m = random.integer(1, 3000);
        const int x = random.integer(0, n - 4), width = random.integer(1, n - x);
        const Axis src{n, 0, double(n)}, dst{m, double(x), double(x + width)};
        const Bank whole = make_bank(lanczos(3), src, dst, Edge::renormalize);
        const int first = random.integer(0, m - 1), last = random.integer(first + 1, m);
        const std::string what = message(n, " to ", m, ", region ", x, " + ", width, ", cells ", first, " to ", last);
        ASSERT_NO_FATAL_FAILURE(expect_same_rows(
            whole, first, make_bank(lanczos(3), src, dst.cells(first, last), Edge::renormalize), what));
    }
}

TEST(Bank, AFlippedTargetHoldsTheRowsBackwards) {
    for (const Kernel& kernel : separable_kernels()) {
        if (kernel.form == Kernel::Form::nearest) continue;  // of two equally near samples it takes the higher
        for (const Edge edge : all_edges())
            for (const int n : sizes)
                for (const int m : sizes) {
                    const Bank forward = make_bank(kernel, Axis{n}, Axis{m}, edge);
                    const Bank target = make_bank(kernel, Axis{n}, Axis{m, 1, 0}, edge);
                    const Bank source = make_bank(kernel, Axis{n, 1, 0}, Axis{m}, edge);
                    for (int i = 0; i < m; ++i) {
                        const std::vector<double> a = dense(forward, i), b = dense(target, m - 1 - i),
                                                  c = dense(source, i);
                        // Each side carries the roundings of a row; sum |w| is below 2.
                        for (int x = 0; x < n; ++x) {
                            ASSERT_NEAR(a[std::size_t(x)], b[std::size_t(x)], 8 * 0x1p-24)
                                << kernel.name << n << ' ' << m;
                            ASSERT_NEAR(a[std::size_t(x)], c[std::size_t(n - 1 - x)], 8 * 0x1p-24)
                                << kernel.name << n << ' ' << m;
                        }
                    }
                }
    }
}

TEST(Bank, OnlyTheRelationOfTheAxesMatters) {
    for (const Kernel& kernel : separable_kernels())
        for (const auto& [n, m] : {std::pair{17, 5}, {5, 17}, {16, 12}, {9, 9}}) {
            const Bank bank = make_bank(kernel, Axis{n, 0, double(n)}, Axis{m, 1.5, n - 1.0}, Edge::reflect);
            // Shifts and scales by powers of 2 leave every number exact.
            const Bank shifted = make_bank(kernel, Axis{n, 64, 64.0 + n}, Axis{m, 65.5, 63.0 + n}, Edge::reflect);
            const Bank scaled = make_bank(kernel, Axis{n, 0, 4.0 * n}, Axis{m, 6, 4 * (n - 1.0)}, Edge::reflect);
            expect_same_rows(bank, 0, shifted, kernel.name + " shifted");
            expect_same_rows(bank, 0, scaled, kernel.name + " scaled");
        }
}

TEST(Bank, CenterAlignmentByHand) {
    const Axis two{2};
    const Bank bank = make_bank(tent(), two, center_aligned(two, 4), Edge::clamp);
    // Of [0 1]: 0, 1/3, 2/3, 1 is the weight of the second sample.
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(dense(bank, i)[1], i / 3.0, 0x1p-24) << i;
    EXPECT_EQ(dense(bank, 0)[1], 0);
    EXPECT_EQ(dense(bank, 3)[0], 0);
}

TEST(Bank, ARampStaysARamp) {
    // Means of the positions that a row reads: 2i + 1/2 at half the size, (i - 1/2) / 2 at twice.
    for (const Kernel& kernel : {tent(), catmull_rom(), mitchell(), bspline(), quadratic_bspline(), cubic(0.2, 0.4)}) {
        const Bank half = make_bank(kernel, Axis{32}, Axis{16}, Edge::clamp);
        const Bank twice = make_bank(kernel, Axis{32}, Axis{64}, Edge::clamp);
        const auto mean = [](const Bank& bank, int i) {
            double sum = 0;
            for (std::size_t j = 0; j < bank.row(i).size(); ++j)
                sum += (bank.first(i) + double(j)) * double(bank.row(i)[j]);
            return sum;
        };
        // Rounded weights at positions up to 35.
        for (int i = 0; i < 16; ++i) EXPECT_NEAR(mean(half, i), 2 * i + 0.5, 2 * 35 * 0x1p-24) << kernel.name << i;
        for (int i = 0; i < 64; ++i) EXPECT_NEAR(mean(twice, i), (i - 0.5) / 2, 2 * 35 * 0x1p-24) << kernel.name << i;
    }
}

TEST(Bank, IrrationalFactorsKeepPositions) {
    for (const double end : {std::numbers::pi, 1 / std::numbers::sqrt2, 0.123456789012345}) {
        const Axis src{50, 0, 4}, dst{33, 0.25, end};
        const Bank bank = make_bank(catmull_rom(), src, dst, Edge::reflect);
        for (int i = 0; i < dst.count; ++i) {
            const NaiveRow naive = naive_row(catmull_rom(), src, dst, i, Edge::reflect);
            for (int x = 0; x < src.count; ++x)
                ASSERT_NEAR(dense(bank, i)[std::size_t(x)], naive.weights[std::size_t(x)], 2 * 0x1p-24 * naive.sum_abs);
        }
    }
}

TEST(Bank, NearestTakesTheHigherOfTwo) {
    const auto picks = [](const Axis& src, const Axis& dst) {
        const Bank bank = make_bank(nearest(), src, dst, Edge::clamp);
        std::vector<int> all;
        for (int i = 0; i < dst.count; ++i) {
            EXPECT_EQ(bank.row(i).size(), 1u);
            EXPECT_EQ(bank.row(i)[0], 1.0f);
            all.push_back(bank.first(i));
        }
        return all;
    };
    EXPECT_EQ(picks(Axis{2}, Axis{1}), (std::vector{1}));
    EXPECT_EQ(picks(Axis{4}, Axis{2}), (std::vector{1, 3}));
    EXPECT_EQ(picks(Axis{4}, Axis{2, 1, 0}), (std::vector{3, 1})) << "a flip does not change the samples";
    EXPECT_EQ(picks(Axis{3}, Axis{1}), (std::vector{1}));
    EXPECT_EQ(picks(Axis{2}, Axis{3}), (std::vector{0, 1, 1}));
    EXPECT_EQ(picks(Axis{2}, Axis{4}), (std::vector{0, 0, 1, 1}));
    EXPECT_EQ(picks(Axis{5}, Axis{2}), (std::vector{1, 3}));
}

TEST(Bank, NearestSamplesLieWithinOnePitch) {
    for (const auto& [n, m] : {std::pair{8, 16}, {8, 8}, {16, 8}, {12, 8}, {30, 4}}) {
        const Axis src{n, 0, double(n)}, dst{m, 0, double(n)};
        const double stretch = std::max(1.0, double(n) / m);
        for (const Edge edge : {Edge::wrap, Edge::renormalize}) {
            const Bank bank = make_bank(bspline(), src, dst, edge);
            for (int i = 0; i < m; ++i) {
                const Bank::Row& row = bank.row_info(i);
                for (int j = 0; j < row.count; ++j) {
                    const bool near = j >= row.near_begin && j < row.near_begin + row.near_count;
                    const double distance = std::abs(bank.first(i) + j - src.index(dst.position(i)));
                    ASSERT_EQ(near, distance < stretch - 1e-9) << n << " to " << m << ", output " << i << ", tap " << j;
                }
            }
        }
    }
}

TEST(Bank, HugeCountsDoNotOverflow) {
    const Axis wide{70000, 0, 70000}, half{35000, 0, 70000};
    const Bank end = make_bank(tent(), wide, half.cells(34990, 35000), Edge::reflect);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(end.first(i), 2 * (34990 + i) - 1);

    constexpr int huge = 1 << 30;
    const Axis all{huge, 0, double(huge)};
    for (const Edge edge : all_edges()) {
        const Bank last = make_bank(lanczos(3), all, all.cells(huge - 3, huge), edge);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(last.first(i), huge - 3 + i);
        const Bank doubled = make_bank(tent(), all, {4, double(huge) - 2, double(huge)}, edge);
        EXPECT_EQ(doubled.first(0), huge - 3);
    }
    // One output over all of it: more weights than an index can count.
    EXPECT_FALSE(error_of([&] { make_bank(lanczos(3), all, {1, 0, double(huge)}, Edge::wrap); }).empty());
    EXPECT_FALSE(error_of([&] { make_bank(lanczos(1000), all, {1000, 0, double(huge)}, Edge::clamp); }).empty());
}

TEST(Bank, RefusesWhatHasNoMeaning) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const Axis& bad : {Axis{0}, Axis{-1}, Axis{3, 1, 1}, Axis{3, nan, 1}, Axis{3, 0, infinity}}) {
        EXPECT_THROW(make_bank(tent(), bad, Axis{3}, Edge::clamp), Error);
        EXPECT_THROW(make_bank(tent(), Axis{3}, bad, Edge::clamp), Error);
    }
    EXPECT_NE(error_of([] { make_bank(jinc_lanczos(3), Axis{3}, Axis{3}, Edge::clamp); }).find("radial"),
              std::string::npos);
    EXPECT_THROW(make_bank(tent(), Axis{3}, Axis{3, 5, 6}, Edge::zero), Error) << "nothing inside";
    EXPECT_THROW(make_bank(tent(), Axis{3}, Axis{3, 5, 6}, Edge::renormalize), Error);
    EXPECT_NO_THROW(make_bank(tent(), Axis{3}, Axis{3, 5, 6}, Edge::clamp));
    EXPECT_THROW(make_bank(tent(), Axis{3}, Axis{3, 0, 1e300}, Edge::clamp), Error) << "absurdly far";
    EXPECT_THROW(weights_at(tent(), nan), Error);
}

TEST(PhaseWeights, KnownNumbers) {
    const auto expect = [](const Kernel& kernel, double phase, int first, const std::vector<double>& weights) {
        const PhaseWeights at = weights_at(kernel, phase);
        EXPECT_EQ(at.taps.first, first) << kernel.name;
        ASSERT_EQ(at.taps.weights.size(), weights.size()) << kernel.name;
        for (std::size_t j = 0; j < weights.size(); ++j)
            EXPECT_NEAR(at.taps.weights[j], weights[j], 1e-15) << kernel.name;
    };
    expect(lanczos(2), 0.5, -1, {-1 / 16., 9 / 16., 9 / 16., -1 / 16.});
    expect(lanczos(3), 0, 0, {1});
    expect(bspline(), 0, -1, {1 / 6., 4 / 6., 1 / 6.});
    expect(quadratic_bspline(), 0, -1, {1 / 8., 6 / 8., 1 / 8.});
    expect(quadratic_interpolating(), 0.25, -1, {-1 / 16., 14 / 16., 3 / 16.});
    expect(tent(), 0.25, 0, {.75, .25});
    expect(tent(), 1.25, 1, {.75, .25});
    expect(tent(), -0.75, -1, {.75, .25});
    expect(box(), 0.5, 0, {.5, .5});
    expect(nearest(), 0.5, 1, {1});
    EXPECT_NEAR(weights_at(gaussian(0.5), 0).sum, 1 + 2 * std::exp(-2.0) + std::exp(-8.0), 1e-15);
    EXPECT_THROW(weights_at(jinc_lanczos(2), 0), Error);
}

TEST(Taps, AreUsedAsTheyAre) {
    Random random(5);
    for (const Edge edge : {Edge::clamp, Edge::reflect, Edge::wrap, Edge::zero})
        for (int factor = 1; factor <= 4; ++factor)
            for (int count = factor; count <= 40; ++count) {
                Taps taps{random.integer(-4, 2), {}, factor};
                for (int j = random.integer(1, 7); j > 0; --j) taps.weights.push_back(random.uniform(-1, 1));
                // Each output must read something under zero.
                if (edge == Edge::zero) taps.first = -static_cast<int>(taps.weights.size()) / 2;
                const Bank bank = make_bank(taps, count, edge);
                ASSERT_EQ(bank.output_count(), count / factor);
                for (int i = 0; i < bank.output_count(); ++i) {
                    std::vector<double> expected(std::size_t(count), 0.0);
                    double sum_abs = 0;
                    for (std::size_t j = 0; j < taps.weights.size(); ++j) {
                        const int at = resolve(i * factor + taps.first + int(j), count, edge);
                        if (at >= 0) expected[std::size_t(at)] += taps.weights[j];
                        sum_abs += std::abs(taps.weights[j]);
                    }
                    for (int x = 0; x < count; ++x)
                        ASSERT_NEAR(dense(bank, i)[std::size_t(x)], expected[std::size_t(x)], 2 * 0x1p-24 * sum_abs);
                }
            }
}

TEST(Taps, OfABoxAreTheBox) {
    for (int factor = 1; factor <= 8; ++factor) {
        const Taps taps{0, std::vector<double>(std::size_t(factor), 1.0 / factor), factor};
        const Axis src{24 * factor}, dst{24};
        expect_same_rows(make_bank(box(), src, dst, Edge::reflect), 0, make_bank(taps, src, dst, Edge::reflect),
                         message("factor ", factor));
    }
}

TEST(Taps, RenormalizeRestoresTheirSum) {
    const Taps taps{-2, {1, 2, 3, 2, 1}};
    const Bank bank = make_bank(taps, 5, Edge::renormalize);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(sum_of(bank.row(i)), 9, 9 * 0x1p-24) << i;
    EXPECT_EQ(bank.row(0).size(), 3u);
    EXPECT_NEAR(double(bank.row(0)[0]), 3 * 9 / 6.0, 9 * 0x1p-24);
}

TEST(Taps, OfSumZeroCannotBeRenormalised) {
    const Taps derivative{-1, {-0.5, 0, 0.5}};
    EXPECT_NE(error_of([&] { make_bank(derivative, 9, Edge::renormalize); }).find("reflect"), std::string::npos);
    const Bank bank = make_bank(derivative, 9, Edge::reflect);
    EXPECT_EQ(dense(bank, 4), (std::vector<double>{0, 0, 0, -0.5, 0, 0.5, 0, 0, 0}));
}

TEST(Taps, MustFitTheAxes) {
    const Taps half{0, {.5, .5}, 2};
    EXPECT_THROW(make_bank(half, Axis{12}, Axis{4}, Edge::clamp), Error) << "another factor";
    EXPECT_THROW(make_bank(half, Axis{12}, Axis{12}, Edge::clamp), Error);
    EXPECT_THROW(make_bank(half, Axis{12}, Axis{6, 1, 0}, Edge::clamp), Error) << "a flip";
    EXPECT_THROW(make_bank(half, Axis{12, 0, 12}, Axis{6, 0.5, 12.5}, Edge::clamp), Error) << "between samples";
    EXPECT_THROW(make_bank(half, 1, Edge::clamp), Error) << "no output";
    EXPECT_THROW(make_bank(Taps{}, 9, Edge::clamp), Error) << "no weights";
    EXPECT_THROW(make_bank(Taps{0, {std::nan("")}}, 9, Edge::clamp), Error);
    EXPECT_THROW(make_bank(Taps{0, {1}, 0}, 9, Edge::clamp), Error);
    const Bank shifted = make_bank(half, Axis{12, 0, 12}, Axis{3, 4, 10}, Edge::clamp);
    EXPECT_EQ(shifted.first(0), 4);
    EXPECT_EQ(shifted.first(2), 8);
}

TEST(Bank, BytesAreNoLessThanItTakes) {
    for (const auto& [in, out] :
         {std::pair{5, 2}, {2, 5}, {903, 451}, {1, 1000}, {1000, 1}, {4096, 2048}, {10007, 10009}})
        for (const Edge edge : {Edge::clamp, Edge::renormalize}) {
            const Axis src{in, 0, 1}, dst{out, 0, 1};
            const Bank bank = make_bank(lanczos(3), src, dst, edge);
            const std::size_t taken = bank.outputs.size() * sizeof(Bank::Output) +
                                      bank.rows.size() * sizeof(Bank::Row) + bank.weights.size() * sizeof(float);
            EXPECT_GE(bank_bytes(3, src, dst), taken) << in << " to " << out;
        }
    // Shared phases count once.
    EXPECT_LT(bank_bytes(3, Axis{1 << 20, 0, 1}, Axis{1 << 19, 0, 1}), (1u << 19) * sizeof(Bank::Output) + (1u << 16));
}

// Roundings that all go one way would add up to a shift of brightness: each weight takes over what the last one lost.
TEST(RoundedWeights, KeepTheirSum) {
    for (const double weight : {0.1, 0.3, -0.7, 1.0 / 3}) {
        const std::vector<double> weights(1000, weight);
        double sum = 0;
        for (const float w : rounded_weights(weights)) {
            EXPECT_NEAR(double(w), weight, std::abs(weight) * 0x1p-23);
            sum += double(w);
        }
        EXPECT_NEAR(sum, 1000 * weight, std::abs(weight) * 0x1p-23);
    }
}

TEST(BankBuilder, WhatIsNotFinishedReadsInsideAllTheSame) {
    BankBuilder builder(4, 6, Edge::renormalize, CutRows::unfinished);
    const PhaseRow row{-2, {0.25, 0.5, 0.25}, -2, 0};
    for (int i = -1; i < 5; ++i) builder.add({i, 0, 0}, row);
    const Bank bank = builder.take();
    ASSERT_EQ(bank.output_count(), 6);
    for (int i = 0; i < 6; ++i) {
        EXPECT_GE(bank.first(i), 0) << i;
        EXPECT_LE(bank.first(i) + int(bank.row(i).size()), 4) << i;
    }
    EXPECT_EQ(bank.row(0).size(), 1u) << "nothing lies inside";
    EXPECT_EQ(bank.row(0)[0], 0);
    EXPECT_EQ(bank.row(1)[0], 0.25f) << "not rescaled";
}

}  // namespace
}  // namespace bandlimit
