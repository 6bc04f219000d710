#include "bandlimit/filter/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Measure = CornerOptions::Measure;

/// A turned square, in pixels from the picture's corner.
struct Square {
    double x, y, half, degrees;

    /// Corner 0 to 3.
    Corner corner(int i) const {
        const double u = i & 1 ? half : -half, v = i & 2 ? half : -half, a = degrees * std::numbers::pi / 180;
        return {x + std::cos(a) * u - std::sin(a) * v, y + std::sin(a) * u + std::cos(a) * v, 0};
    }
    bool holds(double px, double py) const {
        const double a = degrees * std::numbers::pi / 180, u = px - x, v = py - y;
        return std::max(std::abs(std::cos(a) * u + std::sin(a) * v), std::abs(std::cos(a) * v - std::sin(a) * u)) <
               half;
    }
};

/// Each pixel is the mean over its square, by n x n points: edges err by up to 1 / (2 n) pixels.
Image<float> drawn(const Square& square, int size, int n) {
    Image<float> image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            int inside = 0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) inside += square.holds(x + (i + 0.5) / n, y + (j + 0.5) / n);
            image.view()(x, y) = static_cast<float>(inside) / static_cast<float>(n * n);
        }
    return image;
}

/// How far the four corners are at most from those of the square.
double error_of(const Square& square, const std::vector<Corner>& corners) {
    double worst = 0;
    for (int i = 0; i < 4; ++i) {
        const Corner truth = square.corner(i);
        double nearest = std::numeric_limits<double>::infinity();
        for (const Corner& c : corners) nearest = std::min(nearest, std::hypot(c.x - truth.x, c.y - truth.y));
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(Corners, OfASquareAreWithin5HundredthsOfAPixel) {
    for (const Square& square : {Square{24, 24, 10, 0},
                                 {24.3, 23.6, 10, 0},
                                 {24.5, 24.5, 9, 0},
                                 {24.1, 24.8, 11, 20},
                                 {24, 24.4, 10, 45},
                                 {23.7, 24.2, 10, 33}})
        for (const Measure measure : {Measure::harris, Measure::shi_tomasi}) {
            const Image<float> image = drawn(square, 48, square.degrees == 0 ? 40 : 12);
            const std::vector<Corner> corners = find_corners(image.view(), {.measure = measure});
            ASSERT_EQ(corners.size(), 4u) << square.degrees;
            EXPECT_LT(error_of(square, corners), 0.05) << square.degrees << ' ' << square.x;
        }
}

TEST(Corners, MoveAndTurnWithThePicture) {
    const Image<float> image = drawn({20.3, 18.6, 8, 15}, 40, 8);
    const std::vector<Corner> corners = find_corners(image.view());
    const std::vector<Corner> mirrored = find_corners(flipped_x(image.view()));
    const std::vector<Corner> swapped = find_corners(transposed(image.view()));
    ASSERT_EQ(corners.size(), 4u);
    ASSERT_EQ(mirrored.size(), 4u);
    for (const Corner& c : corners) {
        const auto has = [](const std::vector<Corner>& all, double x, double y) {
            return std::any_of(all.begin(), all.end(),
                               [&](const Corner& d) { return std::hypot(d.x - x, d.y - y) < 1e-3; });
        };
        EXPECT_TRUE(has(mirrored, 40 - c.x, c.y));
        EXPECT_TRUE(has(swapped, c.y, c.x));
    }
}

TEST(Corners, AreNotWhereNothingOrOnlyEdgesAre) {
    Image<float> image(30, 30);
    EXPECT_TRUE(find_corners(image.view()).empty());
    for (int y = 0; y < 30; ++y)
        for (int x = 15; x < 30; ++x) image.view()(x, y) = 1;
    EXPECT_TRUE(find_corners(image.view()).empty());
    EXPECT_TRUE(find_corners(image.view(), {.measure = Measure::harris}).empty());
    const Image<float> one(1, 1);
    EXPECT_TRUE(find_corners(one.view()).empty());
}

TEST(Corners, OfNaNsAreNoneAndThoseElsewhereStay) {
    const Square square{30, 30, 8, 0};
    Image<float> image = drawn(square, 60, 4);
    image.view()(2, 57) = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Corner> corners = find_corners(image.view());
    for (const Corner& c : corners) EXPECT_TRUE(std::isfinite(c.x) && std::isfinite(c.y));
    EXPECT_LT(error_of(square, corners), 0.05);
}

TEST(Corners, AreSortedApartAndTheSameForAnyThreads) {
    Random random(5);
    Image<float> image(60, 50, 2);
    for (int c = 0; c < 2; ++c)
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 60; ++x) image.view()(x, y, c) = static_cast<float>(random.uniform());
    const std::vector<Corner> corners = find_corners(image.view(), {.distance = 5}, {1});
    const std::vector<Corner> threads = find_corners(image.view(), {.distance = 5}, {3});
    ASSERT_GT(corners.size(), 10u);
    ASSERT_EQ(corners.size(), threads.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        EXPECT_EQ(corners[i].x, threads[i].x);
        EXPECT_LE(corners[i].strength, corners[i > 0 ? i - 1 : 0].strength);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GE(std::hypot(corners[i].x - corners[k].x, corners[i].y - corners[k].y), 5);
    }
}

TEST(Corners, OptionsOutOfRangeAreRefused) {
    const Image<float> image(8, 8);
    EXPECT_THROW(find_corners(Image<float>(0, 0).view()), Error);
    EXPECT_THROW(find_corners(image.view(), {.k = 0.3}), Error);
    EXPECT_THROW(find_corners(image.view(), {.sigma = 0}), Error);
    EXPECT_THROW(find_corners(image.view(), {.least = 2}), Error);
    EXPECT_THROW(find_corners(image.view(), {.distance = -1}), Error);
    EXPECT_THROW(find_corners(image.view(), {.reach = 1}), Error);
    EXPECT_THROW(find_corners(image.view(), {.edge = Edge::renormalize}), Error);
}

}  // namespace
}  // namespace bandlimit
