#include "bandlimit/math/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// Weights sum to 2 and values are at most 1: sixteen products and their sum round by less than this.
constexpr double rounding = 64 * 0x1p-53;

TEST(Quadrature, IsExactForPolynomialsUpToDegree31) {
    for (int degree = 0; degree <= 31; ++degree) {
        const auto power = [degree](double x) { return std::pow(x, degree); };
        EXPECT_NEAR(integrate(power, -1, 1), degree % 2 == 0 ? 2.0 / (degree + 1) : 0, rounding) << degree;
        EXPECT_NEAR(integrate(power, 0, 1, 3), 1.0 / (degree + 1), rounding) << degree;
    }
    EXPECT_GT(std::abs(integrate([](double x) { return std::pow(x, 32); }, -1, 1) - 2.0 / 33), 1e-10)
        << "sixteen points cannot do degree 32";
}

TEST(Quadrature, ResolvesTwoPeriodsPerPanel) {
    for (const int panels : {1, 3, 10}) {
        const double f = 2 * 2 * std::numbers::pi * panels;
        const auto wave = [f](double x) { return std::cos(f * x + 0.3); };
        EXPECT_NEAR(integrate(wave, 0, 0.9, panels), (std::sin(f * 0.9 + 0.3) - std::sin(0.3)) / f, 1e-13) << panels;
    }
}

TEST(Quadrature, ReversesWithItsInterval) {
    const auto f = [](double x) { return std::exp(x); };
    EXPECT_NEAR(integrate(f, 2, -1, 4), -integrate(f, -1, 2, 4), 1e-14 * std::exp(2));
    EXPECT_EQ(integrate(f, 1, 1), 0);
}

TEST(Quadrature, PanelsTakeJumps) {
    const auto step = [](double x) { return x < 0 ? 1.0 : 3.0; };
    EXPECT_NEAR(integrate(step, -1, 1, 2), 4, 4 * rounding);
    EXPECT_THROW(integrate(step, 0, 1, 0), Error);
}

}  // namespace
}  // namespace bandlimit
