#include "apps/page/false_color.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace bandlimit::app {
namespace {

Image<float> row(std::initializer_list<float> values, int channels = 1) {
    Image<float> image(static_cast<int>(values.size()) / channels, 1, channels, Layout::interleaved);
    std::copy(values.begin(), values.end(), image.view().data);
    return image;
}

std::array<float, 3> at(const Image<float>& codes, int x) {
    return {codes.view()(x, 0, 0), codes.view()(x, 0, 1), codes.view()(x, 0, 2)};
}

float brightness(const std::array<float, 3>& c) { return 0.3f * c[0] + 0.59f * c[1] + 0.11f * c[2]; }

TEST(FalseColor, ARampGetsBrighterAllTheWay) {
    Image<float> values(101, 1);
    for (int x = 0; x <= 100; ++x) values.view()(x, 0) = 0.03f * static_cast<float>(x);
    const Image<float> codes = ramp_of(values.view(), 3);
    for (int x = 1; x <= 100; ++x) EXPECT_GT(brightness(at(codes, x)), brightness(at(codes, x - 1))) << x;
    EXPECT_EQ(at(codes, 0), (std::array<float, 3>{0, 0, 0}));
    EXPECT_EQ(at(ramp_of(row({7}).view(), 3), 0), at(codes, 100)) << "beyond the peak is as the peak";
}

TEST(FalseColor, ADivergenceIsWhiteInTheMiddle) {
    const Image<float> codes = divergence_of(row({-2, -1, 0, 1, 2}).view(), 2);
    EXPECT_EQ(at(codes, 2), (std::array<float, 3>{1, 1, 1}));
    for (const int x : {0, 1}) EXPECT_GT(at(codes, x)[2], at(codes, x)[0]) << "blue below";
    for (const int x : {3, 4}) EXPECT_GT(at(codes, x)[0], at(codes, x)[2]) << "red above";
}

TEST(FalseColor, DirectionsHaveHues) {
    const Image<float> codes = directions_of(row({2, 0, 0, 0, -2, 0, 1, 0}, 2).view(), 2);
    EXPECT_EQ(at(codes, 0), (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(at(codes, 1), (std::array<float, 3>{0, 0, 0}));
    EXPECT_NEAR(at(codes, 2)[0], 0, 1e-6);
    EXPECT_NEAR(at(codes, 2)[1], 1, 1e-6);
    EXPECT_NEAR(at(codes, 2)[2], 1, 1e-6);
    EXPECT_NEAR(at(codes, 3)[0], 0.5, 1e-6);
}

TEST(FalseColor, WhatIsNoNumberStandsOut) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Image<float>& codes : {ramp_of(row({nan}).view(), 1), divergence_of(row({nan}).view(), 1),
                                      directions_of(row({1, nan}, 2).view(), 1)})
        EXPECT_GT(at(codes, 0)[1], 3 * at(codes, 0)[2]);
}

TEST(FalseColor, APeakLeavesOutOutliers) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Image<float> values = row({1, -3, 2, nan, 100});
    EXPECT_EQ(peak_of(values.view(), 1, 0.5), 100);
    EXPECT_EQ(peak_of(values.view(), 0.7, 0.5), 3);
    EXPECT_EQ(peak_of(values.view(), 0.7, 5), 5);
    EXPECT_EQ(peak_of(row({3, 4, 0, 1}, 2).view(), 1, 0.5), 5) << "lengths of vectors";
    EXPECT_EQ(peak_of(row({nan}).view(), 1, 0.5), 0.5);
}

}  // namespace
}  // namespace bandlimit::app
