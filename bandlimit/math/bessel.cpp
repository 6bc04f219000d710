#include "bandlimit/math/bessel.h"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/SpecialFunctions>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {
constexpr double pi = std::numbers::pi;
}

double sin_pi(double x) {
    // fmod is exact, and so is each step here: no multiple of pi is ever rounded.
    double r = std::fmod(std::abs(x), 2.0);
    const double sign = (x < 0) != (r >= 1) ? -1 : 1;
    if (r >= 1) r -= 1;
    if (r > 0.5) r = 1 - r;
    return r == 0 ? 0 : sign * std::sin(pi * r);
}

double sinc(double x) { return x == 0 ? 1 : sin_pi(x) / (pi * x); }

double bessel_j0(double x) { return Eigen::numext::bessel_j0(x); }
double bessel_j1(double x) { return Eigen::numext::bessel_j1(x); }
double bessel_i0(double x) { return Eigen::numext::bessel_i0(x); }

double jinc(double r) { return r == 0 ? 0.5 : bessel_j1(pi * r) / (pi * r); }

double jinc_zero(int n) {
    if (n < 1) fail("jinc_zero: n = ", n, "; zeros are counted from 1");
    // McMahon's expansion (Abramowitz & Stegun 9.5.12) starts within 1e-3; Newton's steps double the digits.
    const double b = (n + 0.25) * pi;
    double x = b - 3 / (8 * b) + 3 / (128 * b * b * b);
    for (int step = 0; step < 4; ++step) x -= bessel_j1(x) / (bessel_j0(x) - bessel_j1(x) / x);
    return x / pi;
}

}  // namespace bandlimit
