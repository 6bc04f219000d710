#include "bandlimit/kernel/terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// Two phasors near those of a disc, and a plain Gaussian.
const Components two{{1.4, 6.7, 0.7, -0.5}, {2.4, 2.1, 0.1, 4.8}};
const Components bell{{2, 0, 1, 0}};

/// What rounding may do to a weight: a few roundings of products whose factors are at most |A| + |B|.
double rounding(const Components& components) {
    double size = 0;
    for (const Component& c : components) size += std::abs(c.A) + std::abs(c.B);
    return 16 * std::numeric_limits<double>::epsilon() * size;
}

TEST(Components, ValueIsTheRealPartOfPhasors) {
    for (const double r : {0.0, 0.3, 1.0, 1.7}) {
        std::complex<double> sum;
        for (const Component& c : two) sum += std::complex(c.A, -c.B) * std::exp(std::complex(-c.a, c.b) * (r * r));
        EXPECT_NEAR(value_at(two, r), sum.real(), rounding(two)) << r;
    }
    EXPECT_EQ(value_at(bell, 0.5), std::exp(-0.5));
}

TEST(Components, IntegralIsThatOfTheirValue) {
    for (const Components& components : {two, bell}) {
        // Beyond 6 radii exp(-a r^2) is below 1e-21.
        const double expected =
            integrate([&](double r) { return 2 * std::numbers::pi * r * value_at(components, r); }, 0, 6, 64);
        EXPECT_NEAR(integral(components), expected, 1e-13);
    }
    EXPECT_DOUBLE_EQ(integral(bell), std::numbers::pi / 2);
}

TEST(Components, TermsAreTheKernelAtTheSamples) {
    for (const double radius : {0.75, 3.0, 6.5}) {
        for (const int reach : {0, 1, 9}) {
            const Terms terms = separable_terms(two, radius, reach);
            ASSERT_EQ(terms.size(), 4u);
            const WeightGrid grid = expanded(terms);
            ASSERT_EQ(grid.width, 2 * reach + 1);
            ASSERT_EQ(grid.height, 2 * reach + 1);
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x)
                    EXPECT_NEAR(grid.at(x + reach, y + reach), value_at(two, std::hypot(x, y) / radius),
                                rounding(two) * (1 + 8 * (x * x + y * y) / (radius * radius)))  // and of the phase
                        << radius << " " << x << " " << y;
        }
    }
}

TEST(Components, TermsHaveTheSymmetriesOfACircle) {
    const int reach = 13;
    const WeightGrid grid = expanded(separable_terms(two, 8, reach));
    const auto weight = [&](int x, int y) { return grid.at(x + reach, y + reach); };
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            EXPECT_EQ(weight(x, y), weight(-x, y));
            EXPECT_EQ(weight(x, y), weight(x, -y));
            EXPECT_NEAR(weight(x, y), weight(y, x), 8 * rounding(two));
        }
    // Points of one distance that no symmetry of the grid maps on each other.
    EXPECT_NEAR(weight(5, 0), weight(3, 4), 8 * rounding(two));
    EXPECT_NEAR(weight(8, 1), weight(7, 4), 8 * rounding(two));
    EXPECT_NEAR(weight(13, 0), weight(5, 12), 8 * rounding(two));
}

TEST(Components, WeightsSumToTheIntegral) {
    // By Poisson's summation formula the rest is the spectrum at whole frequencies: below exp(-pi^2 radius^2 a / (a^2 +
    // b^2)), which is 1e-11 for the faster phasor at radius 10.
    for (const double radius : {10.0, 17.3}) {
        const int reach = static_cast<int>(6 * radius);
        EXPECT_NEAR(sum(separable_terms(two, radius, reach)) / (radius * radius), integral(two), 1e-10);
    }
}

TEST(Components, WhatReachCutsIsBelowItsShare) {
    for (const Components& components : {two, bell}) {
        for (const double radius : {0.4, 4.0, 11.5}) {
            int previous = 0;
            for (const double share : {0.1, 0.01, 0.001}) {
                const int reach = reach_for(components, radius, share), far = 4 * reach + 8;
                EXPECT_GE(reach, previous);
                previous = reach;
                const WeightGrid grid = expanded(separable_terms(components, radius, far));
                double cut = 0;
                for (int y = -far; y <= far; ++y)
                    for (int x = -far; x <= far; ++x)
                        if (std::max(std::abs(x), std::abs(y)) > reach) cut += std::abs(grid.at(x + far, y + far));
                EXPECT_LE(cut, share * integral(components) * radius * radius) << radius << " " << share;
            }
        }
    }
    // A Gaussian is cut by just that: one sample less would be too much.
    const double radius = 100;
    const int reach = reach_for(bell, radius, 0.01);
    const auto rest = [&](double half_side) { return 1 - std::pow(std::erf(std::sqrt(2) * half_side / radius), 2); };
    EXPECT_LE(rest(reach + 0.5), 0.01);
    EXPECT_GT(rest(reach - 0.5), 0.01);
}

TEST(Terms, SumIsThatOfTheGrid) {
    Random random(7);
    Terms terms(3, Term{std::vector<double>(5), std::vector<double>(8)});
    for (Term& term : terms) {
        for (double& weight : term.column) weight = random.uniform() - 0.25;
        for (double& weight : term.row) weight = random.uniform() - 0.25;
    }
    const auto total = [](const Terms& of) {
        double all = 0;
        for (const double weight : expanded(of).weights) all += weight;
        return all;
    };
    EXPECT_NEAR(sum(terms), total(terms), 1e-13);
    const Terms unit = with_unit_sum(terms);
    EXPECT_NEAR(total(unit), 1, 1e-13);
    EXPECT_NEAR(expanded(unit).at(3, 2) * total(terms), expanded(terms).at(3, 2), 1e-14);
}

TEST(Terms, RefuseWhatHasNoMeaning) {
    EXPECT_THROW(with_unit_sum({}), Error);
    EXPECT_THROW(with_unit_sum({{{1, -1}, {1, 1}}}), Error);
    EXPECT_THROW(value_at({}, 0), Error);
    EXPECT_THROW(integral({{0, 1, 1, 1}}), Error);
    EXPECT_THROW(separable_terms({{1, NAN, 1, 1}}, 1, 1), Error);
    EXPECT_THROW(separable_terms(bell, 0, 1), Error);
    EXPECT_THROW(separable_terms(bell, INFINITY, 1), Error);
    EXPECT_THROW(separable_terms(bell, 1, -1), Error);
    EXPECT_THROW(reach_for(bell, 1, 0), Error);
    EXPECT_THROW(reach_for(bell, 1, 1), Error);
    EXPECT_THROW(reach_for(bell, 1e9, 0.01), Error);
    EXPECT_THROW(reach_for({{1, 0, -1, 0}}, 1, 0.01), Error);
}

}  // namespace
}  // namespace bandlimit
