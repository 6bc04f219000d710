#include "bandlimit/design/kernel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Use = KernelFitOptions::Use;

Kernel kernel_of(const KernelFitOptions& options) { return piecewise_kernel(fit_kernel(options).pieces, "fitted"); }

void expect_same(const Kernel& a, const Kernel& b, double tolerance) {
    EXPECT_NEAR(a.radius, b.radius, 1e-15);
    for (double x = 0; x < a.radius + 0.5; x += 0x1p-6) ASSERT_NEAR(a.value(x), b.value(x), tolerance) << x;
}

/// The m-th derivative of a piece at x.
double derivative(const KernelPiece& piece, double x, int m) {
    double sum = 0;
    for (std::size_t n = static_cast<std::size_t>(m); n < piece.coefficients.size(); ++n) {
        double factor = piece.coefficients[n];
        for (int i = 0; i < m; ++i) factor *= static_cast<double>(n) - i;
        sum += factor * std::pow(x - piece.begin, static_cast<double>(n) - m);
    }
    return sum;
}

/// The loss of any kernel, from its spectrum.
double loss_of(const Kernel& kernel, Use use, double slope) {
    const auto at = [&](double f) {
        const double distance = use == Use::grow ? std::abs(f - std::round(f)) : f;
        return std::pow(distance, -slope) * std::pow(relative_spectrum(kernel, f) - (f < 0.5 ? 1 : 0), 2);
    };
    return integrate(at, 0, 8, 32);
}

const KernelFitOptions various[] = {
    {},
    {.radius = 2, .interpolating = true},
    {.radius = 3, .smoothness = 2, .use = Use::shrink},
    {.radius = 1.5, .degree = 2},
    {.radius = 2.5, .pieces = 10, .degree = 4, .smoothness = 2, .max_overshoot = 0.05},
    {.radius = 3, .pieces = 12, .interpolating = true, .max_overshoot = 0.1},
    {.radius = 1.25, .pieces = 5, .degree = 3},
    {.radius = 4, .degree = 5, .smoothness = 1, .like = lanczos(4)},
};

TEST(KernelFit, SumOfShiftedCopiesIsOne) {
    Random random(4);
    for (const KernelFitOptions& options : various) {
        const Kernel kernel = kernel_of(options);
        EXPECT_EQ(kernel.radius, options.radius);
        for (int trial = 0; trial < 200; ++trial) {
            const double x = random.uniform();
            double sum = 0;
            for (int k = -10; k <= 10; ++k) sum += kernel.value(x + k);
            ASSERT_NEAR(sum, 1, 1e-12) << options.radius << ' ' << x;
        }
    }
}

TEST(KernelFit, IsSmoothAtItsKnots) {
    for (const KernelFitOptions& options : various) {
        const KernelPieces pieces = fit_kernel(options).pieces;
        for (int m = 0; m <= options.smoothness; ++m) {
            for (std::size_t p = 0; p < pieces.size(); ++p) {
                const double end = pieces[p].end;
                const double after = p + 1 < pieces.size() ? derivative(pieces[p + 1], end, m) : 0;
                EXPECT_NEAR(derivative(pieces[p], end, m), after, 1e-10) << options.radius << ' ' << p << ' ' << m;
            }
            if (m % 2 == 1) {
                EXPECT_NEAR(derivative(pieces[0], 0, m), 0, 1e-10) << "even functions have a flat top";
            }
        }
    }
}

TEST(KernelFit, InterpolatesWhereAskedTo) {
    for (const KernelFitOptions& options : various) {
        if (!options.interpolating) continue;
        const Kernel kernel = kernel_of(options);
        for (int n = 0; n < 5; ++n) EXPECT_NEAR(kernel.value(n), n == 0 ? 1 : 0, 1e-12);
    }
}

TEST(KernelFit, FindsTheOnlyKernelWhereThereIsOne) {
    expect_same(kernel_of({.radius = 0.5, .degree = 0, .smoothness = -1}), box(), 1e-13);
    expect_same(kernel_of({.radius = 1, .degree = 1, .smoothness = 0}), tent(), 1e-13);
    expect_same(kernel_of({.radius = 1.5, .degree = 2, .smoothness = 1}), quadratic_bspline(), 1e-13);
    expect_same(kernel_of({.radius = 2, .degree = 3, .smoothness = 2}), bspline(), 1e-13);
}

TEST(KernelFit, OfCubicsIsTheBestOfTheirFamily) {
    // Smooth cubics of radius 2 that sum to 1 are cubic(B, C).
    for (const Use use : {Use::grow, Use::shrink}) {
        const KernelFit fit = fit_kernel({.use = use});
        const Kernel kernel = piecewise_kernel(fit.pieces, "fitted");
        const double b = 6 * kernel.value(1), c = -derivative(fit.pieces[0], 1, 1) - b / 2;
        expect_same(kernel, cubic(b, c), 1e-12);
        EXPECT_NEAR(loss_of(kernel, use, 2), fit.loss, 1e-9);
        for (const double db : {-0.02, 0.0, 0.02})
            for (const double dc : {-0.02, 0.0, 0.02})
                EXPECT_GE(loss_of(cubic(b + db, c + dc), use, 2), fit.loss - 1e-9);
    }
}

TEST(KernelFit, FreedomDoesNoHarmAndConditionsCost) {
    for (const Use use : {Use::grow, Use::shrink}) {
        const double plain = fit_kernel({.radius = 2, .use = use}).loss;
        EXPECT_LT(fit_kernel({.radius = 2, .pieces = 8, .use = use}).loss, plain);
        EXPECT_LT(fit_kernel({.radius = 2, .degree = 4, .use = use}).loss, plain);
        EXPECT_LT(fit_kernel({.radius = 3, .use = use}).loss, plain);
        EXPECT_GT(fit_kernel({.radius = 2, .smoothness = 2, .use = use}).loss, plain);
        EXPECT_GE(fit_kernel({.radius = 2, .interpolating = true, .use = use}).loss, plain);
    }
}

TEST(KernelFit, OvershootStaysBelowItsLimit) {
    for (const Use use : {Use::grow, Use::shrink})
        for (const double limit : {0.1, 0.05, 0.0}) {
            const KernelFit fit = fit_kernel({.radius = 3, .pieces = 12, .use = use, .max_overshoot = limit});
            EXPECT_LE(fit.overshoot, limit + 1e-9);
            const Kernel kernel = piecewise_kernel(fit.pieces, "fitted");
            double highest = 0;
            for (int i = 0; i < 200; ++i) {
                double answer = 0;
                if (use == Use::shrink) answer = 0.5 + integrate(kernel.value, 0, 0.015 * i, 64);
                for (int k = -4; use == Use::grow && k <= i % 8 - 4; ++k) answer += kernel.value(k + i / 200.0);
                highest = std::max(highest, answer);
            }
            // Between the phases where it is limited: second derivatives of about 10, times (1 / 128)^2 / 2.
            EXPECT_LE(highest, 1 + limit + 5e-4);
        }
}

TEST(KernelFit, ImitatesAKernelThatItCanHold) {
    const KernelFit fit = fit_kernel({.radius = 2, .like = mitchell()});
    expect_same(piecewise_kernel(fit.pieces, "fitted"), mitchell(), 1e-9);
    EXPECT_LT(fit.error, 1e-18);
}

TEST(KernelFit, SaysWhenThereIsNone) {
    EXPECT_THROW(fit_kernel({.radius = 1, .degree = 3, .smoothness = 2}), Error) << "C2 cubics need four pieces";
    EXPECT_THROW(fit_kernel({.radius = 1.3, .pieces = 2, .degree = 1, .smoothness = 0}), Error);
    EXPECT_THROW(fit_kernel({.radius = 2, .pieces = 3, .degree = 5, .smoothness = 0}), Error)
        << "kinks at 2/3 that no copy cancels";
}

TEST(KernelFit, RefusesOptionsOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double radius : {0.0, 0.4, 9.0, nan}) EXPECT_THROW(fit_kernel({.radius = radius}), Error);
    for (const int pieces : {-1, 65}) EXPECT_THROW(fit_kernel({.pieces = pieces}), Error);
    for (const int degree : {-1, 8}) EXPECT_THROW(fit_kernel({.degree = degree}), Error);
    for (const int smoothness : {-2, 3}) EXPECT_THROW(fit_kernel({.smoothness = smoothness}), Error);
    for (const double slope : {-0.1, 2.1, nan}) EXPECT_THROW(fit_kernel({.slope = slope}), Error);
    for (const double limit : {-0.1, nan}) EXPECT_THROW(fit_kernel({.max_overshoot = limit}), Error);
    EXPECT_THROW(fit_kernel({.like = jinc_lanczos(2)}), Error);
}

}  // namespace
}  // namespace bandlimit
