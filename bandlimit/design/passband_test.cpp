#include "bandlimit/design/passband.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// What the reads of a shader come to: Wronski's published filter.
Fetches published() {
    Fetches fetches;
    for (const double s : {-1.0, 1.0}) {
        for (const double t : {-1.0, 1.0}) fetches.push_back({s * 0.75777, t * 0.75777, 0.37487566});
        fetches.push_back({s * 2.907, 0, -0.12487566});
        fetches.push_back({0, s * 2.907, -0.12487566});
    }
    return fetches;
}

const Fetches box{{0, 0, 1}};

/// The mean of |H - ideal|^2 by quadrature, with the jumps of the ideal on borders of panels.
double mean_error(const PlacedWeights& w, int factor) {
    const double edge = 0.5 / factor;
    const auto pass = [&](double f) { return std::norm(response(w, f) - 1.0); };
    const auto stop = [&](double f) { return std::norm(response(w, f)); };
    return integrate(pass, -edge, edge, 4) + integrate(stop, -0.5, -edge, 6) + integrate(stop, edge, 0.5, 6);
}

double mean_error(const PlacedWeights2D& w, int factor) {
    const double edge = 0.5 / factor;
    double sum = 0;
    const auto add = [&](double from, double to, bool passes) {
        const Quadrature along = quadrature(from, to, 2);
        for (std::size_t i = 0; i < along.at.size(); ++i) {
            const double fx = along.at[i];
            const auto pass = [&](double fy) { return std::norm(response(w, fx, fy) - (passes ? 1.0 : 0.0)); };
            const auto stop = [&](double fy) { return std::norm(response(w, fx, fy)); };
            sum += along.weights[i] *
                   (integrate(stop, -0.5, -edge) + integrate(pass, -edge, edge) + integrate(stop, edge, 0.5));
        }
    };
    add(-0.5, -edge, false), add(-edge, edge, true), add(edge, 0.5, false);
    return sum;
}

TEST(BandError, EqualsQuadrature) {
    Random random(2);
    for (const int factor : {2, 3, 4}) {
        PlacedWeights any(-2.3, {});
        for (int j = 0; j < 6; ++j) any.weights.push_back(random.uniform(-0.5, 1));
        const BandError e = band_error(any, factor);
        EXPECT_NEAR(e.whole, mean_error(any, factor), 1e-12);
        EXPECT_NEAR(e.whole, e.pass / factor + e.stop * (1 - 1.0 / factor), 1e-13);
        PlacedWeights2D square(-1.5, -0.7, 4, {});
        for (int j = 0; j < 12; ++j) square.weights.push_back(random.uniform(-0.5, 1));
        const BandError e2 = band_error(square, factor);
        EXPECT_NEAR(e2.whole, mean_error(square, factor), 1e-9);  // two panels of 16 points a side
        EXPECT_NEAR(e2.whole, e2.pass / factor / factor + e2.stop * (1 - 1.0 / factor / factor), 1e-13);
    }
}

// Figures of the literature to all digits that are given.
TEST(BandError, OfThePublishedFilterAndOfTheBox) {
    const BandError eight = band_error(weights_of(published(), 0.5), 2), one = band_error(weights_of(box, 0.5), 2);
    EXPECT_NEAR(eight.whole, 0.02779, 5e-6);
    EXPECT_NEAR(eight.pass, 0.0650, 1e-4);  // 0.06506
    EXPECT_NEAR(one.whole, 0.09472, 5e-6);
    EXPECT_NEAR(one.pass, 0.0485, 5e-5);
    EXPECT_THROW(band_error(weights_of(box, 0.5), 1), Error);
}

TEST(WeightsOf, AreThoseOfBilinearReads) {
    // The response of a read is that of its four texels, which lie at whole distances from each other.
    const Fetches fetches{{0.3, -1.8, 2}, {-2.5, 0.5, -1}, {0.3, -1.8, 1}};
    const PlacedWeights2D w = weights_of(fetches, 0.5);
    double sum = 0, x = 0, y = 0;
    for (std::size_t i = 0; i < w.weights.size(); ++i) {
        const double at_x = w.first_x + static_cast<double>(i % static_cast<std::size_t>(w.width));
        EXPECT_NEAR(std::abs(at_x - std::floor(at_x)), 0.5, 1e-15);
        sum += w.weights[i];
        x += w.weights[i] * at_x;
        y += w.weights[i] * (w.first_y + static_cast<double>(i / static_cast<std::size_t>(w.width)));
    }
    EXPECT_NEAR(sum, 2, 1e-14);
    EXPECT_NEAR(x, 3 * 0.3 + 2.5, 1e-14);  // linear reads are exact for ramps
    EXPECT_NEAR(y, 3 * -1.8 - 0.5, 1e-14);
    EXPECT_NEAR(weights_of({{-2.5, 0.5, -1}}, 0.5).weights[0], -1, 1e-15);  // on a texel
    EXPECT_THROW(weights_of({}, 0.5), Error);
    EXPECT_THROW(weights_of({{std::numeric_limits<double>::quiet_NaN(), 0, 1}}, 0.5), Error);
    EXPECT_THROW(weights_of({{0, 1e9, 1}}, 0.5), Error);
}

TEST(MaxGain, IsTheTopOfThePublishedFilter) {
    EXPECT_NEAR(max_gain(weights_of(published(), 0.5)), 1.22, 0.005);  // on the diagonal
    EXPECT_NEAR(max_gain(weights_of(box, 0.5)), 1, 1e-12);
    // (1 + 2 cos(2 pi (f - .3)))/3 along both axes, off the axes and off any grid.
    const PlacedWeights shifted(-1, {-0.3, 1, 0.4});
    EXPECT_NEAR(max_gain(PlacedWeights2D(shifted, shifted)), max_gain(shifted) * max_gain(shifted), 1e-6);
}

}  // namespace
}  // namespace bandlimit
