#include "bandlimit/kernel/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/math/svd.h"

namespace bandlimit {
namespace {

Svd svd_of(const WeightGrid& grid) { return svd(grid.weights, grid.height, grid.width); }

std::size_t rank_of(const WeightGrid& grid) {
    const Svd found = svd_of(grid);
    std::size_t rank = 0;
    while (rank < found.values.size() && found.values[rank] > 1e-12 * found.values[0]) ++rank;
    return rank;
}

double sum(const WeightGrid& grid) { return std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0); }

std::string error_of(const std::string& text) {
    try {
        parse_shape(text);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

// Wronski 2020, as recomputed with numpy.
TEST(Shapes, SingularValuesAndRanksAreThePublishedOnes) {
    const Svd disc = svd_of(parse_shape("disc:50:0.8"));
    const double published[] = {36.744, 9.127, 5.011, 3.765};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(disc.values[i], published[i], 0.0005);
    EXPECT_NEAR(svd_of(parse_shape("box:50:0.7")).values[0], 34, 1e-12);
    EXPECT_EQ(rank_of(parse_shape("disc:50:0.8")), 14u);
    EXPECT_EQ(rank_of(parse_shape("polygon:50:8:0.9:0")), 13u);
    EXPECT_EQ(rank_of(parse_shape("difference-of-gaussians:50:5:6")), 2u);
    EXPECT_EQ(rank_of(parse_shape("gaussian:50:5")), 1u);
    EXPECT_EQ(rank_of(parse_shape("box:50:0.7")), 1u);
    EXPECT_GT(rank_of(parse_shape("oriented-gaussian:50:3:30:30")), 5u);
    EXPECT_EQ(rank_of(parse_shape("oriented-gaussian:50:3:30:90")), 1u);
}

TEST(Shapes, TheDifferenceOfGaussiansIsADonut) {
    const WeightGrid grid = parse_shape("dog:50:5:6");
    EXPECT_NEAR(sum(grid), 928, 0.5);  // all weights are positive: it passes a constant
    EXPECT_EQ(*std::max_element(grid.weights.begin(), grid.weights.end()), 1);
    const Svd found = svd_of(grid);
    EXPECT_NEAR(found.values[0] / found.values[1], 3.74, 0.005);
    EXPECT_EQ(parse_shape("dog:51:5:6").at(25, 25), 0);
}

// Areas of the unit's shapes, times the points per area; the border has about 4 * SIZE points, each off by up to 1.
TEST(Shapes, AreasAreThoseOfGeometry) {
    constexpr double pi = 3.14159265358979323846;
    const int size = 401;
    const double points = 200 * 200.0, slack = 4.0 * size;
    const auto area = [&](const char* text) { return sum(parse_shape(text, size)); };
    EXPECT_NEAR(area("disc:0.8"), 0.8 * pi * points, slack);
    EXPECT_NEAR(area("donut:0.8:0.3"), 0.5 * pi * points, slack);
    EXPECT_NEAR(area("box:0.7"), 1.4 * 1.4 * points, slack);
    EXPECT_NEAR(area("skewed-box:0.5:0.6"), points, slack);  // a shear keeps areas
    for (const int n : {3, 4, 5, 6, 8}) {
        const std::string text = "polygon:" + std::to_string(n) + ":0.45:13";
        EXPECT_NEAR(area(text.c_str()), n * 0.45 * 0.45 * std::tan(pi / n) * points, slack);
    }
    EXPECT_NEAR(area("star:5:0.9:0.4:17"), 5 * 0.9 * 0.4 * std::sin(pi / 5) * points, slack);
    // A star whose notches lie on the edges of a polygon is that polygon.
    EXPECT_NEAR(area("star:4:0.9:0.63639610306789:45"), 2 * 0.81 * points, slack);
}

TEST(Shapes, AnglesGoFromXTowardsY) {
    const int size = 101, middle = 50;
    const WeightGrid right = parse_shape("polygon:3:0.3:0", size);  // an edge faces right, a corner at (-0.6, 0)
    EXPECT_EQ(right.at(middle + 14, middle), 1);
    EXPECT_EQ(right.at(middle + 15, middle), 0);  // on the border
    EXPECT_EQ(right.at(middle - 29, middle), 1);
    const WeightGrid down = parse_shape("polygon:3:0.3:90", size);
    EXPECT_EQ(down.at(middle, middle + 14), 1);
    EXPECT_EQ(down.at(middle, middle - 29), 1);
    const WeightGrid tip = parse_shape("star:5:0.9:0.2:-90", size);  // a tip up
    EXPECT_EQ(tip.at(middle, middle - 44), 1);
    EXPECT_EQ(tip.at(middle, middle + 20), 0);
    const WeightGrid along = parse_shape("oriented-gaussian:3:30:45", size);
    EXPECT_NEAR(along.at(middle + 25, middle + 25), std::exp(-3 * 0.5), 1e-15);
    EXPECT_NEAR(along.at(middle + 25, middle - 25), std::exp(-30 * 0.5), 1e-15);
    const WeightGrid skewed = parse_shape("skewed-box:0.5:0.6", size);  // moves right as y grows
    EXPECT_EQ(skewed.at(middle + 12 + 24, middle + 20), 1);
    EXPECT_EQ(skewed.at(middle - 14, middle + 20), 0);
}

TEST(Shapes, AreSymmetricWhereTheyShouldBe) {
    for (const char* text : {"disc:0.8", "box:0.7", "polygon:4:1:0", "polygon:8:0.9:0", "donut:0.8:0.3", "gaussian:5",
                             "exponential:3", "dog:5:6", "star:4:0.9:0.4:0"}) {
        for (const int size : {11, 50, 51}) {  // of 11 points many lie on borders: 0.64 + 0.16 is 0.8
            const WeightGrid grid = parse_shape(text, size);
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    EXPECT_NEAR(grid.at(x, y), grid.at(size - 1 - x, y), 1e-15) << text << " " << size;
                    EXPECT_NEAR(grid.at(x, y), grid.at(y, x), 1e-15) << text << " " << size;
                }
            }
        }
    }
    EXPECT_EQ(parse_shape("disc:11:0.8").at(9, 7), 0);  // on the border
}

TEST(Shapes, EveryExampleWorks) {
    for (const ShapeInfo& info : shape_list()) {
        EXPECT_TRUE(info.example.starts_with(info.name.substr(0, info.name.find(':') + 1))) << info.name;
        EXPECT_EQ(parse_shape(info.example).width, 50) << info.name;
    }
}

TEST(Shapes, ErrorsSayWhatToWrite) {
    EXPECT_EQ(error_of("disc:50"), "shape \"disc:50\": 1 parameters; write disc:SIZE:LIMIT, e.g. disc:50:0.8");
    EXPECT_EQ(error_of("disc:50:x"),
              "shape \"disc:50:x\": \"x\" is not a number; use disc:SIZE:LIMIT, e.g. disc:50:0.8");
    EXPECT_EQ(error_of("disc:50:-1"), "shape \"disc:50:-1\": LIMIT = -1; pass a number above 0");
    EXPECT_EQ(error_of("disc:1:1"), "shape \"disc:1:1\": SIZE = 1; pass a whole number from 2 to 4096");
    EXPECT_EQ(error_of("disc:nan:1"), "shape \"disc:nan:1\": SIZE = nan; pass a whole number from 2 to 4096");
    EXPECT_EQ(error_of("polygon:50:2:1:0"), "shape \"polygon:50:2:1:0\": N = 2; pass a whole number from 3 to 360");
    EXPECT_EQ(error_of("polygon:50:5:1:inf"), "shape \"polygon:50:5:1:inf\": DEGREES = inf; pass a finite number");
    EXPECT_EQ(error_of("disc:50:0.0001"),
              "shape \"disc:50:0.0001\": all of its 50 x 50 weights are 0; pass a larger shape");
    EXPECT_TRUE(error_of("blob:50").starts_with("shape \"blob:50\" is unknown; choose one of: disc:SIZE:LIMIT, "));
    try {
        parse_shape("disc:50:0.8", 51);
        FAIL();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "shape \"disc:50:0.8\": 2 parameters; write disc:LIMIT, e.g. disc:0.8");
    }
}

}  // namespace
}  // namespace bandlimit
