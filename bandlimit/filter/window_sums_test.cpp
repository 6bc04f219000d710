#include "bandlimit/filter/window_sums.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/targets_test.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

Image<double> noise(int width, int height, int channels) {
    Random random(3);
    Image<double> image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = random.uniform(-1, 1);
    return image;
}

Image<double> summed(const Image<double>& image, int radius, Edge edge, const Parallel& parallel = {2}) {
    const View<const double> in = image.view();
    Image<double> sums(in.width, in.height, in.channels);
    window_sums(
        {in.width, in.height, radius, edge}, in.channels,
        [&](int y, IndexRange xs, double* const* planes) {
            for (int c = 0; c < in.channels; ++c)
                for (int x = xs.begin; x < xs.end; ++x) planes[c][x - xs.begin] = in(x, y, c);
        },
        [&](int y, const double* const* from) {
            for (int c = 0; c < in.channels; ++c)
                for (int x = 0; x < in.width; ++x) sums.view()(x, y, c) = from[c][x];
        },
        parallel);
    return sums;
}

/// From the definition.
double expected(const Image<double>& image, int radius, Edge edge, int x, int y, int c) {
    double sum = 0;
    for (int v = y - radius; v <= y + radius; ++v)
        for (int u = x - radius; u <= x + radius; ++u) {
            const int from_x = resolve(u, image.width(), edge), from_y = resolve(v, image.height(), edge);
            if (from_x >= 0 && from_y >= 0) sum += image.view()(from_x, from_y, c);
        }
    return sum;
}

TEST(WindowSums, AreThoseOfTheDefinitionUnderEveryEdge) {
    for (const auto& [width, height, channels] : {std::tuple{37, 75, 1}, {5, 3, 6}, {1, 1, 2}, {70, 2, 3}, {2, 150, 4}})
        for (const int radius : {0, 1, 4, 11}) {
            const Image<double> image = noise(width, height, channels);
            for (const Edge edge : all_edges()) {
                const Image<double> sums = summed(image, radius, edge);
                for (int c = 0; c < channels; ++c)
                    for (int y = 0; y < height; ++y)
                        for (int x = 0; x < width; ++x)
                            ASSERT_NEAR(sums.view()(x, y, c), expected(image, radius, edge, x, y, c), 1e-11)
                                << radius << ' ' << name_of(edge) << ' ' << x << ',' << y;
            }
        }
}

TEST(WindowSums, WhatIsHugeLeavesNoTraceOutsideItsWindows) {
    Image<double> image = noise(60, 90, 1);
    const int radius = 3;
    image.view()(20, 40) = 1e30;
    image.view()(23, 41) = -1e20;
    image.view()(22, 43) = 1e10;
    const Image<double> sums = summed(image, radius, Edge::renormalize);
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 60; ++x) {
            const auto covers = [&](int u, int v) { return std::abs(x - u) <= radius && std::abs(y - v) <= radius; };
            const double largest = covers(20, 40) ? 1e30 : covers(23, 41) ? 1e20 : covers(22, 43) ? 1e10 : 1;
            ASSERT_NEAR(sums.view()(x, y), expected(image, radius, Edge::renormalize, x, y, 0), 1e-8 * largest)
                << x << ',' << y;
        }
}

TEST(WindowSums, HugeRadiiAreTheSumOfAllThatIsInside) {
    const Image<double> image = noise(9, 40, 1);
    const Image<double> sums = summed(image, BoxWindow::most_radius, Edge::renormalize);
    double sum = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 9; ++x) sum += image.view()(x, y);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 9; ++x) ASSERT_NEAR(sums.view()(x, y), sum, 1e-11);
    EXPECT_EQ(window_counts(9, 500, Edge::renormalize), std::vector<double>(9, 9.0));
    EXPECT_EQ(window_counts(4, 1, Edge::renormalize), (std::vector<double>{2, 3, 3, 2}));
    EXPECT_EQ(window_counts(2, 1, Edge::zero), (std::vector<double>{3, 3}));
}

TEST(WindowSums, HaveTheSameBitsForAnyThreadsAndTarget) {
    const Image<double> image = noise(53, 200, 5);
    const Image<double> one = summed(image, 2, Edge::reflect, {1});
    const auto is_same = [&](const Image<double>& other) {
        for (int c = 0; c < 5; ++c)
            for (int y = 0; y < 200; ++y)
                for (int x = 0; x < 53; ++x)
                    if (one.view()(x, y, c) != other.view()(x, y, c)) return false;
        return true;
    };
    EXPECT_TRUE(is_same(summed(image, 2, Edge::reflect, {3})));
    for_each_target([&](Target) { EXPECT_TRUE(is_same(summed(image, 2, Edge::reflect))); });
}

TEST(WindowSums, RefuseWhatIsOutOfRange) {
    const FillRow fill = [](int, IndexRange, double* const*) {};
    const TakeSums take = [](int, const double* const*) {};
    EXPECT_THROW(window_sums({0, 4, 1}, 1, fill, take), Error);
    EXPECT_THROW(window_sums({4, 4, 1}, 0, fill, take), Error);
    EXPECT_THROW(window_sums({4, 4, -1}, 1, fill, take), Error);
    EXPECT_THROW(window_sums({4, 4, BoxWindow::most_radius + 1}, 1, fill, take), Error);
}

}  // namespace
}  // namespace bandlimit
