// shrink3 and grow3 are what least_squares.cpp says: the best of their kind, judged by the integrals given there.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

constexpr int lobes = 3, period = 2 * lobes;
using Vector = std::vector<double>;
using Function = std::function<double(double)>;

/// A Fourier series on [-3, 3] by its responses: c[k - 1] at k / 6 cycles per sample, 1 at 0.
struct Series {
    Vector c;

    double value(double x) const {
        if (std::abs(x) >= lobes) return 0;
        double sum = 1;
        for (std::size_t k = 1; k <= c.size(); ++k)
            sum += 2 * c[k - 1] * std::cos(std::numbers::pi * static_cast<double>(k) * x / lobes);
        return sum / period;
    }
    double response(double f) const {
        double sum = sinc(period * f);
        for (std::size_t k = 1; k <= c.size(); ++k) {
            const double at = static_cast<double>(k);
            sum += c[k - 1] * (sinc(period * f - at) + sinc(period * f + at));
        }
        return sum;
    }
};

Series series_of(const Kernel& kernel, int terms) {
    Series series;
    for (int k = 1; k <= terms; ++k)
        series.c.push_back(
            2 * integrate([&](double x) { return kernel.value(x) * sin_pi(k * x / lobes + 0.5); }, 0, lobes, 16));
    return series;
}

/// The errors that the kernels minimise, over 6 of infinitely many bands: what lies beyond adds about 1e-6 of them.
double shrinking_error(const Series& h) {
    const auto at = [&](double f) { return std::pow(f, -2.5) * std::pow(h.response(f) - (f < 0.5 ? 1 : 0), 2); };
    return integrate(at, 0, 0.5, 8) + integrate(at, 0.5, 6, 24);
}
double growing_error(const Series& h) {
    const auto at = [&](double f) {
        double sum = std::pow(1 - h.response(f), 2);
        for (int n = 1; n <= 6; ++n) sum += std::pow(h.response(n - f), 2) + std::pow(h.response(n + f), 2);
        return sum / (f * f);
    };
    return integrate(at, 0, 0.5, 8);
}

/// By how much the answer to a unit step exceeds 1 at worst, where a kernel shrinks by a factor: over all positions of
/// the step among the outputs, in parts of 1 / 1024 of a pitch. 1 is growing, or a shift.
double overshoot(const Function& kernel, int factor) {
    const int phases = 1024 / factor, reach = lobes * factor;
    double worst = 0;
    for (int p = 0; p < phases; ++p) {
        double sum = 0, highest = 0;
        for (int j = -reach; j <= reach; ++j) {
            sum += kernel((j + static_cast<double>(p) / phases) / factor);
            highest = std::max(highest, sum);
        }
        worst = std::max(worst, highest / sum - 1);
    }
    return worst;
}

/// Derivatives of f along directions of the space of coefficients.
Vector gradient(const std::function<double(const Series&)>& f, const Series& at, const std::vector<Vector>& directions,
                double step) {
    Vector slopes;
    for (const Vector& direction : directions) {
        Series up = at, down = at;
        for (std::size_t k = 0; k < at.c.size(); ++k) up.c[k] += step * direction[k], down.c[k] -= step * direction[k];
        slopes.push_back((f(up) - f(down)) / (2 * step));
    }
    return slopes;
}

double cosine_between(const Vector& a, const Vector& b) {
    double aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) aa += a[i] * a[i], bb += b[i] * b[i], ab += a[i] * b[i];
    return ab / std::sqrt(aa * bb);
}

/// All changes of c_1 to c_5 that keep h(3) = 0: 1 + 2 sum (-1)^k c_k = 0.
std::vector<Vector> shrinking_directions() {
    std::vector<Vector> directions(4, Vector(5));
    for (std::size_t i = 0; i < 4; ++i) directions[i][i] = directions[i][i + 1] = 1;
    return directions;
}

/// All changes of c_1 to c_11 that keep c_6 = 0 and h at the integers: sin(pi x) sin(pi j x / 3), j = 1 to 8, not 3.
std::vector<Vector> growing_directions() {
    std::vector<Vector> directions;
    for (const int j : {1, 2, 4, 5, 6, 7, 8}) {
        Vector c(11);
        c[static_cast<std::size_t>(std::abs(j - 3) - 1)] += 1.5;
        c[static_cast<std::size_t>(j + 3 - 1)] -= 1.5;
        directions.push_back(c);
    }
    return directions;
}

TEST(LeastSquares, KernelsAreTheSeriesOfTheirResponses) {
    for (const auto& [kernel, terms] : {std::pair{shrink3(), 5}, {grow3(), 11}}) {
        const Series series = series_of(kernel, terms);
        for (double x = -3.5; x <= 3.5; x += 0x1p-6)
            ASSERT_NEAR(kernel.value(x), series.value(x), 1e-14) << kernel.name << ' ' << x;
        for (int n = 1; n <= 8; ++n) EXPECT_NEAR(series.response(n), 0, 1e-15) << kernel.name << ' ' << n;
    }
    EXPECT_NEAR(shrink3().value(std::nextafter(3, 0)), 0, 1e-15);
    EXPECT_NEAR(series_of(grow3(), 11).c[5], 0, 1e-15);
}

// The error is convex in the coefficients and so is the overshoot: where their gradients are opposite, no kernel of the
// series has less of one and no more of the other. 0.999 is 2.6 degrees; coefficients of 5 digits turn it by 0.5.
TEST(LeastSquares, ShrinkHasTheLeastErrorThatItsOvershootAllows) {
    const Series series = series_of(shrink3(), 5);
    const auto ringing = [](const Series& h) { return overshoot([&](double x) { return h.value(x); }, 64); };
    const Vector of_error = gradient(shrinking_error, series, shrinking_directions(), 1e-2),
                 of_overshoot = gradient(ringing, series, shrinking_directions(), 1e-3);
    EXPECT_LT(cosine_between(of_error, of_overshoot), -0.999);
    EXPECT_NEAR(ringing(series), 0.073, 1e-4);  // 64 is not infinity
}

TEST(LeastSquares, GrowHasTheLeastErrorThatItsOvershootAllows) {
    const Series series = series_of(grow3(), 11);
    const auto ringing = [](const Series& h) { return overshoot([&](double x) { return h.value(x); }, 1); };
    const Vector of_error = gradient(growing_error, series, growing_directions(), 1e-2),
                 of_overshoot = gradient(ringing, series, growing_directions(), 1e-4);
    EXPECT_LT(cosine_between(of_error, of_overshoot), -0.999);
    EXPECT_NEAR(ringing(series), 0.115, 2e-5);
}

TEST(LeastSquares, RingsNoMoreThanLanczos) {
    const Function reference = lanczos(3).value;
    for (const int factor : {1, 2, 3, 4, 8, 64})
        EXPECT_LT(overshoot(shrink3().value, factor), overshoot(reference, factor)) << factor;
    EXPECT_LT(overshoot(grow3().value, 1), overshoot(reference, 1));
    EXPECT_NEAR(overshoot(reference, 1), 0.1178, 1e-4);
    EXPECT_NEAR(overshoot(reference, 64), 0.0731, 1e-4);
}

}  // namespace
}  // namespace bandlimit
