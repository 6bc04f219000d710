#include "bandlimit/math/bessel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;

/// J_n(x) = 1/pi int_0^pi cos(n t - x sin t) dt. The trapezoidal rule of a periodic analytic function converges faster
/// than any power once there are more points than x.
double bessel_integral(int n, double x) {
    const int points = 400;
    long double sum = 0;
    for (int k = 0; k < points; ++k) {
        const long double t = 2 * std::numbers::pi_v<long double> * k / points;
        sum += std::cos(n * t - static_cast<long double>(x) * std::sin(t));
    }
    return static_cast<double>(sum / points);
}

double bessel_i0_series(double x) {
    long double term = 1, sum = 1;
    for (int k = 1; k < 500; ++k) {
        term *= static_cast<long double>(x) * x / 4 / k / k;
        sum += term;
    }
    return static_cast<double>(sum);
}

TEST(Bessel, AgreesWithItsIntegral) {
    for (double x = -100; x <= 100; x += 0.3125) {
        ASSERT_NEAR(bessel_j0(x), bessel_integral(0, x), 1e-15) << x;
        ASSERT_NEAR(bessel_j1(x), bessel_integral(1, x), 1e-15) << x;
    }
}

TEST(Bessel, ModifiedAgreesWithItsSeries) {
    for (double x = 0; x <= 100; x += 0.25) {
        const double exact = bessel_i0_series(x);
        ASSERT_NEAR(bessel_i0(x), exact, 1e-15 * exact) << x;
    }
}

TEST(Sinc, IsExactAtIntegersAndHalves) {
    EXPECT_EQ(sinc(0), 1);
    for (int k = 1; k <= 1000; ++k) {
        ASSERT_EQ(sinc(k), 0);
        ASSERT_EQ(sinc(-k), 0);
        ASSERT_EQ(sin_pi(k + 0.5), k % 2 == 0 ? 1 : -1);
        ASSERT_EQ(sin_pi(-k - 0.5), k % 2 == 0 ? -1 : 1);
    }
}

TEST(Sinc, IsExactBesideIntegers) {
    for (const double small : {0x1p-20, 0x1p-30, 0x1p-40}) {
        const double exact = pi * small;  // less its cube over 6: 1e-12 of it for the first
        for (const int k : {0, 1, 2, 7}) {
            EXPECT_NEAR(std::abs(sin_pi(k + small)), exact, 2e-12 * exact) << k;
            EXPECT_NEAR(std::abs(sin_pi(k - small)), exact, 2e-12 * exact) << k;
        }
    }
}

TEST(Sinc, AgreesWithTheSine) {
    for (double x = -10; x <= 10; x += 0.0137) {
        // The library sine of pi x carries the rounding of its argument: up to 10 pi 2^-53.
        ASSERT_NEAR(sin_pi(x), std::sin(pi * x), 40 * 0x1p-53) << x;
        ASSERT_EQ(sin_pi(-x), -sin_pi(x));
        ASSERT_EQ(sinc(-x), sinc(x));
    }
    EXPECT_NEAR(sinc(0.5), 2 / pi, 0x1p-53);
    EXPECT_NEAR(sinc(1e-9), 1, 0x1p-52);
}

TEST(Jinc, KnownZerosAndValueAtTheOrigin) {
    EXPECT_EQ(jinc(0), 0.5);
    EXPECT_NEAR(jinc(1e-9), 0.5, 0x1p-52);
    EXPECT_NEAR(jinc_zero(1), 1.2197, 5e-5);
    EXPECT_NEAR(jinc_zero(2), 2.2331, 5e-5);
    EXPECT_NEAR(jinc_zero(3), 3.2383, 5e-5);
    for (int n = 1; n <= 100; ++n) {
        const double zero = jinc_zero(n);
        // The slope of J1 at its zero is at most 1, so a zero to the last bit leaves the rounding of pi * zero.
        ASSERT_LE(std::abs(bessel_j1(pi * zero)), 4 * pi * zero * 0x1p-53) << n;
        ASSERT_LT(jinc(zero - 0.1) * jinc(zero + 0.1), 0) << n;
        ASSERT_NEAR(jinc_zero(n + 1) - zero, 1, 0.02) << "no zero is skipped, " << n;
    }
    EXPECT_THROW(jinc_zero(0), Error);
}

TEST(Jinc, IsEven) {
    for (double r = 0; r < 5; r += 0.07) ASSERT_EQ(jinc(-r), jinc(r));
}

}  // namespace
}  // namespace bandlimit
