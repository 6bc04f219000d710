#include "bandlimit/design/gaussian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Form = GaussianOptions::Form;
constexpr Form all_forms[] = {Form::least_squares, Form::sampled, Form::integrated, Form::discrete};
constexpr double sigmas[] = {0.1, 0.3, 0.5, 0.8, 1, 2.5, 7};

double error_of(const Taps& taps, double sigma) {
    const auto g = [&](double f) { return gaussian_response(sigma, f); };
    return integrate([&](double f) { return std::norm(response(taps, f) - g(f)); }, 0, 0.5, 32) /
           integrate([&](double f) { return g(f) * g(f); }, 0, 0.5, 32);
}

TEST(Gaussian, IsSymmetricPositiveAndSumsToOne) {
    for (const double sigma : sigmas)
        for (const Form form : all_forms)
            for (const int fetches : {1, 2, 3, 4, 9, 20}) {
                const GaussianDesign design = design_gaussian({.sigma = sigma, .fetches = fetches, .form = form});
                const auto& w = design.taps.weights;
                ASSERT_EQ(w.size(), static_cast<std::size_t>(2 * fetches - 1));
                EXPECT_EQ(design.taps.first, 1 - fetches);
                EXPECT_NEAR(sum(design.taps), 1, 1e-14);
                for (std::size_t j = 0; j < w.size(); ++j) {
                    EXPECT_EQ(w[j], w[w.size() - 1 - j]);
                    EXPECT_GE(w[j], 0) << sigma;
                }
                EXPECT_NEAR(design.error, error_of(design.taps, sigma), 1e-12);
            }
}

TEST(Gaussian, ReadsAreExactlyTheTapsAndNoMoreThanAskedFor) {
    for (const double sigma : sigmas)
        for (const Form form : all_forms)
            for (int fetches = 1; fetches <= 12; ++fetches) {
                const GaussianDesign design = design_gaussian({.sigma = sigma, .fetches = fetches, .form = form});
                std::vector<double> weights(design.taps.weights.size() + 1);
                for (std::size_t i = 0; i < design.reads.size(); ++i) {
                    const LinearRead& read = design.reads[i];
                    const double at = read.offset - design.taps.first, whole = std::floor(at);
                    weights[static_cast<std::size_t>(whole)] += read.weight * (1 - (at - whole));
                    weights[static_cast<std::size_t>(whole) + 1] += read.weight * (at - whole);
                    EXPECT_EQ(read.offset, -design.reads[design.reads.size() - 1 - i].offset) << "symmetric";
                }
                EXPECT_LE(design.reads.size(), static_cast<std::size_t>(fetches));
                for (std::size_t j = 0; j < design.taps.weights.size(); ++j)
                    EXPECT_NEAR(weights[j], design.taps.weights[j], 1e-15) << sigma << ' ' << fetches;
            }
}

TEST(Gaussian, LeastSquaresIsTheLeastNearbyAndOfAllForms) {
    Random random(5);
    for (const double sigma : {0.3, 0.5, 1.0, 2.0})
        for (const int fetches : {2, 3, 5}) {
            const GaussianDesign best = design_gaussian({.sigma = sigma, .fetches = fetches});
            for (const Form form : all_forms)
                EXPECT_LE(best.error,
                          design_gaussian({.sigma = sigma, .fetches = fetches, .form = form}).error + 1e-14);
            for (int trial = 0; trial < 50; ++trial) {
                Taps near = best.taps;
                double total = 0;
                for (std::size_t j = 0; j < near.weights.size(); ++j) {
                    near.weights[j] = std::max(near.weights[j] + 0.01 * (random.uniform() - 0.5), 0.0);
                    total += near.weights[j];
                }
                for (double& w : near.weights) w /= total;
                EXPECT_GE(error_of(near, sigma), best.error - 1e-13);
            }
        }
}

TEST(Gaussian, Variances) {
    for (const double sigma : {0.3, 0.5, 1.0, 3.0}) {
        const auto variance = [&](Form form) {
            // Far enough that nothing is cut off: 10 sigma and a few samples.
            const int fetches = 12 + static_cast<int>(10 * sigma);
            return design_gaussian({.sigma = sigma, .fetches = fetches, .form = form}).variance;
        };
        EXPECT_NEAR(variance(Form::discrete), sigma * sigma, 1e-11);
        if (sigma < 1) continue;
        // Aliases of exp(-2 (pi sigma f)^2) at f = 1, of 3e-9 at sigma = 1, times (2 pi)^2 sigma^4.
        EXPECT_NEAR(variance(Form::sampled), sigma * sigma, 3e-7);
        EXPECT_NEAR(variance(Form::integrated), sigma * sigma + 1 / 12.0, 3e-7);
    }
}

TEST(Gaussian, KnownWeights) {
    // exp(-1/4) I_0(1/4) and so on, by the series I_n(t) = sum (t/2)^(2m+n) / (m! (m+n)!).
    const auto bessel_i = [](int n, double t) {
        double term = std::pow(t / 2, n) / std::tgamma(n + 1), sum = 0;
        for (int m = 1; m < 20; ++m) sum += term, term *= t * t / 4 / (m * (m + n));
        return sum;
    };
    const GaussianDesign design = design_gaussian({.sigma = 0.5, .fetches = 12, .form = Form::discrete});
    for (int n = 0; n < 4; ++n)
        EXPECT_NEAR(design.taps.weights[static_cast<std::size_t>(11 + n)], std::exp(-0.25) * bessel_i(n, 0.25), 1e-14);
    // Much wider than its reach it is a box; one read is the identity.
    for (const double w : design_gaussian({.sigma = 250, .fetches = 2}).taps.weights) EXPECT_NEAR(w, 1 / 3.0, 1e-5);
    EXPECT_EQ(design_gaussian({.sigma = 2, .fetches = 1}).taps.weights, std::vector<double>{1});
    // Halves: the pair at 0 and 1, and its mirror image.
    const GaussianDesign two = design_gaussian({.sigma = 1, .fetches = 2, .form = Form::sampled});
    ASSERT_EQ(two.reads.size(), 2u);
    EXPECT_NEAR(two.reads[1].weight, 0.5, 1e-15);
    EXPECT_NEAR(two.reads[1].offset, std::exp(-0.5) / (0.5 + std::exp(-0.5)), 1e-15);
}

TEST(Gaussian, ByDefaultReachesThreeSigma) {
    for (const double sigma : {0.5, 1.0, 2.2, 10.0}) {
        const GaussianDesign design = design_gaussian({.sigma = sigma});
        EXPECT_EQ(-design.taps.first, std::ceil(3 * sigma));
        if (sigma >= 1) {
            // Of the energy, exp(-9) and less lies beyond.
            EXPECT_LT(design.error, 1e-4);
            EXPECT_NEAR(design.variance, sigma * sigma, 0.02 * sigma * sigma);
        }
    }
}

TEST(Gaussian, RefusesOptionsOutOfRange) {
    for (const double sigma : {0.0, -1.0, 251.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(design_gaussian({.sigma = sigma}), Error);
    for (const int fetches : {-1, 0, 2049}) EXPECT_THROW(design_gaussian({.fetches = fetches}), Error);
}

}  // namespace
}  // namespace bandlimit
