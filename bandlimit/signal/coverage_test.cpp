#include "bandlimit/signal/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;

Cell random_cell(Random& random) {
    const double x = random.uniform(-3, 3), y = random.uniform(-3, 3);
    return {x, y, x + random.uniform(0.1, 2), y + random.uniform(0.1, 2)};
}

/// The mean of `inside` over a cell by counting a grid of points; wrong by about one row of them at an outline.
double counted(const Cell& cell, const std::function<bool(double, double)>& inside) {
    constexpr int n = 400;
    int count = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            count +=
                inside(cell.x0 + (cell.x1 - cell.x0) * (i + 0.5) / n, cell.y0 + (cell.y1 - cell.y0) * (j + 0.5) / n);
    return count / double(n) / n;
}
constexpr double count_bound = 2.0 / 400;

TEST(Coverage, IsExactWhereItCanBe) {
    EXPECT_EQ(direction_at(0).x, 1);
    EXPECT_EQ(direction_at(0).y, 0);
    EXPECT_EQ(direction_at(90).x, 0);
    EXPECT_EQ(direction_at(90).y, 1);
    EXPECT_EQ(direction_at(180).x, -1);
    EXPECT_EQ(direction_at(-90).y, -1);
    EXPECT_EQ(direction_at(45).x, direction_at(45).y);
    EXPECT_NEAR(direction_at(30).x, std::sqrt(0.75), 1e-15);
    EXPECT_NEAR(direction_at(30).y, 0.5, 1e-15);
}

TEST(ShareBelow, KnownCases) {
    const Cell unit{0, 0, 1, 1};
    EXPECT_EQ(share_below(unit, direction_at(0), 0.25), 0.25);
    EXPECT_EQ(share_below(unit, direction_at(90), 0.75), 0.75);
    EXPECT_EQ(share_below(unit, direction_at(180), -0.75), 0.25);
    EXPECT_NEAR(share_below(unit, direction_at(45), std::sqrt(0.5)), 0.5, 1e-15);
    // A corner: a right isosceles triangle whose height on the diagonal is 0.1 has the area 0.1^2.
    EXPECT_NEAR(share_below(unit, direction_at(45), 0.1), 0.01, 1e-15);
    EXPECT_EQ(share_below(unit, direction_at(45), -1), 0);
    EXPECT_EQ(share_below(unit, direction_at(45), 2), 1);
}

TEST(ShareBelow, AgreesWithCounting) {
    Random random(1);
    for (int k = 0; k < 60; ++k) {
        const Cell cell = random_cell(random);
        const UnitVector direction = direction_at(random.uniform(-180, 180));
        const auto [low, high] = extent_along(cell, direction);
        const double t = random.uniform(low - 0.1, high + 0.1);
        const auto inside = [&](double x, double y) { return direction.along(x, y) < t; };
        EXPECT_NEAR(share_below(cell, direction, t), counted(cell, inside), count_bound);
    }
}

TEST(ShareBelow, GrowsAndIsSymmetric) {
    Random random(2);
    for (int k = 0; k < 200; ++k) {
        const Cell cell = random_cell(random);
        const double degrees = random.uniform(0, 360), t = random.uniform(-4, 4);
        const double share = share_below(cell, direction_at(degrees), t);
        EXPECT_LE(share, share_below(cell, direction_at(degrees), t + 1e-3));
        EXPECT_NEAR(share + share_below(cell, direction_at(degrees + 180), -t), 1, 1e-13);
        const Cell mirrored{-cell.x1, cell.y0, -cell.x0, cell.y1};
        EXPECT_NEAR(share, share_below(mirrored, direction_at(180 - degrees), t), 1e-13);
    }
}

TEST(MeanAlong, OfAStepIsTheShareBelow) {
    Random random(3);
    for (int k = 0; k < 100; ++k) {
        const Cell cell = random_cell(random);
        const UnitVector direction = direction_at(45.0 * random.integer(0, 8) + (k % 2) * 7.3);
        const double t = random.uniform(-4, 4);
        const double mean = mean_along(cell, direction, [t](double s) { return s < t ? 1.0 : 0.0; }, {t});
        EXPECT_NEAR(mean, share_below(cell, direction, t), 1e-13);
    }
}

TEST(MeanAlong, OfAWaveIsAProductOfSincs) {
    const Cell cell{1, 2, 2.5, 3};
    const UnitVector direction = direction_at(20);
    for (const double f : {0.1, 0.5, 3.0, 40.0}) {
        const auto wave = [f](double t) { return std::cos(2 * pi * f * t); };
        const auto sinc = [](double x) { return std::sin(pi * x) / (pi * x); };
        const double expected = wave(direction.along(1.75, 2.5)) * sinc(f * direction.x * 1.5) * sinc(f * direction.y);
        EXPECT_NEAR(mean_along(cell, direction, wave, {}, f), expected, 1e-13);
    }
}

TEST(DiscArea, KnownCases) {
    EXPECT_NEAR(disc_area({-9, -9, 9, 9}, 2), 4 * pi, 1e-13);
    EXPECT_NEAR(disc_area({0, -9, 9, 9}, 2), 2 * pi, 1e-13);
    EXPECT_NEAR(disc_area({0, 0, 1, 1}, 1), pi / 4, 1e-15);
    EXPECT_EQ(disc_area({0, 0, 1, 1}, 2), 1);
    EXPECT_EQ(disc_area({2, 2, 3, 3}, 2), 0);
    EXPECT_NEAR(disc_area({-0.1, -0.1, 0.1, 0.1}, 0.05), pi * 0.0025, 1e-16);
    // A segment: radius 1, cut at distance 1/2.
    EXPECT_NEAR(disc_area({0.5, -1, 1, 1}, 1), std::acos(0.5) - 0.5 * std::sqrt(0.75), 1e-15);
}

TEST(DiscArea, AgreesWithCounting) {
    Random random(4);
    for (int k = 0; k < 60; ++k) {
        const Cell cell = random_cell(random);
        const double radius = random.uniform(0.2, 4);
        const auto inside = [&](double x, double y) { return std::hypot(x, y) < radius; };
        EXPECT_NEAR(disc_area(cell, radius) / area(cell), counted(cell, inside), 2 * count_bound);
    }
}

TEST(DiscArea, PartsAddUp) {
    Random random(5);
    for (int k = 0; k < 200; ++k) {
        const Cell c = random_cell(random);
        const double radius = random.uniform(0.2, 4), x = random.uniform(c.x0, c.x1), y = random.uniform(c.y0, c.y1);
        const double parts = disc_area({c.x0, c.y0, x, y}, radius) + disc_area({x, c.y0, c.x1, y}, radius) +
                             disc_area({c.x0, y, x, c.y1}, radius) + disc_area({x, y, c.x1, c.y1}, radius);
        EXPECT_NEAR(parts, disc_area(c, radius), 1e-14);
    }
}

TEST(BrightLength, CountsWholeAndPartPeriods) {
    EXPECT_DOUBLE_EQ(bright_length(10, 4, 0.5), 6);
    EXPECT_DOUBLE_EQ(bright_length(9, 4, 0.5), 5);
    EXPECT_DOUBLE_EQ(bright_length(-1, 4, 0.5), 0);
    EXPECT_DOUBLE_EQ(bright_length(-4, 4, 0.5), -2);
}

TEST(PanelsFor, RefusesWhatCannotBeIntegrated) {
    EXPECT_EQ(panels_for(0), 1);
    EXPECT_EQ(panels_for(2.5), 3);
    EXPECT_THROW(panels_for(1e7), Error);
    EXPECT_THROW(panels_for(std::nan("")), Error);
}

}  // namespace
}  // namespace bandlimit
