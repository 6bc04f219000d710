#include "bandlimit/sampling/pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bandlimit/core/error.h"
#include "bandlimit/sampling/pattern_analysis.h"

namespace bandlimit {
namespace {

/// How many of `columns` x `rows` cells of a pixel hold a point.
std::size_t filled_cells(const SamplePattern& pattern, int columns, int rows) {
    std::set<std::pair<int, int>> cells;
    for (const Point& p : pattern.points)
        cells.emplace(std::floor((p.x + 0.5) * columns), std::floor((p.y + 0.5) * rows));
    return cells.size();
}

void expect_points(const SamplePattern& pattern, const std::vector<Point>& points) {
    ASSERT_EQ(pattern.points.size(), points.size());
    for (const Point& wanted : points)
        EXPECT_TRUE(std::any_of(pattern.points.begin(), pattern.points.end(),
                                [&](const Point& p) { return std::hypot(p.x - wanted.x, p.y - wanted.y) < 1e-12; }))
            << pattern.name << " lacks (" << wanted.x << ", " << wanted.y << ")";
}

TEST(Pattern, NamesParseToThemselves) {
    for (const PatternInfo& info : pattern_list()) {
        const SamplePattern pattern = parse_pattern(info.example);
        EXPECT_GE(pattern.count(), 1) << info.example;
        const SamplePattern again = parse_pattern(pattern.name);
        EXPECT_EQ(again.name, pattern.name);
        for (std::size_t i = 0; i < pattern.points.size(); ++i) {
            EXPECT_EQ(again.points[i].x, pattern.points[i].x);
            EXPECT_EQ(again.points[i].y, pattern.points[i].y);
        }
        for (const Point& p : pattern.points) EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 0.5) << info.example;
    }
    EXPECT_EQ(parse_pattern("sobol:8").name, "sobol:8:1");
    EXPECT_EQ(parse_pattern("halton:8:409").name, "halton:8:409");
}

TEST(Pattern, NHasTheNumberOfSamples) {
    for (const char* name : {"regular:16", "rotated:16", "d3d:16", "halton:16", "r2:16", "sobol:16:3", "jittered:16:3",
                             "random:16:3", "n-rooks:16:3", "best-candidate:16:3"})
        EXPECT_EQ(parse_pattern(name).count(), 16) << name;
    EXPECT_EQ(parse_pattern("quincunx").count(), 5);
    EXPECT_EQ(parse_pattern("checkerboard").count(), 2);
    EXPECT_EQ(parse_pattern("checkerboard:8").count(), 8);
    EXPECT_EQ(with_count(parse_pattern("jittered:16:7"), 4).name, "jittered:4:7");
}

TEST(Pattern, PointsOfTheSmallOnes) {
    expect_points(regular_pattern(1), {{0, 0}});
    expect_points(regular_pattern(4), {{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}});
    const double r = std::sqrt(2) / 4;  // .354
    expect_points(rotated_pattern(4), {{r, 0}, {-r, 0}, {0, r}, {0, -r}});
    expect_points(d3d_pattern(2), {{0.25, 0.25}, {-0.25, -0.25}});
    expect_points(d3d_pattern(4), {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}});
    expect_points(checkerboard_pattern(), {{-0.25, -0.25}, {0.25, 0.25}});
    expect_points(halton_pattern(3), {{0, -1 / 6.0}, {-0.25, 1 / 6.0}, {0.25, -7 / 18.0}});
}

TEST(Pattern, StratifiedOnesHaveOnePointPerCell) {
    EXPECT_EQ(filled_cells(jittered_pattern(25, 4), 5, 5), 25u);
    for (const SamplePattern& pattern :
         {n_rooks_pattern(7, 5), d3d_pattern(4), d3d_pattern(8), d3d_pattern(16), sobol_pattern(64, 6)}) {
        EXPECT_EQ(static_cast<int>(filled_cells(pattern, pattern.count(), 1)), pattern.count()) << pattern.name;
        EXPECT_EQ(static_cast<int>(filled_cells(pattern, 1, pattern.count())), pattern.count()) << pattern.name;
    }
    EXPECT_EQ(filled_cells(sobol_pattern(64, 6), 8, 8), 64u);
}

TEST(Pattern, BestCandidatesKeepFartherApartThanRandomPoints) {
    // 64 discs that touch are at most 1.07 / 8 of a pixel wide; random points come as near as about 1 / 64.
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        EXPECT_GT(least_distance(best_candidate_pattern(64, seed).points), 0.5 / 8);
        EXPECT_LT(least_distance(random_pattern(64, seed).points), 0.25 / 8);
    }
}

TEST(Pattern, WrappingKeepsPointsInThePixelAndTheirDistances) {
    const SamplePattern pattern = d3d_pattern(16), moved = wrapped(pattern, {0.3, -0.45});
    for (const Point& p : moved.points) EXPECT_TRUE(p.x >= -0.5 && p.x < 0.5 && p.y >= -0.5 && p.y < 0.5);
    EXPECT_NEAR(least_distance(moved.points), least_distance(pattern.points), 1e-12);
    EXPECT_EQ(wrapped(SamplePattern{"", {{0.5, -0.75}}}, {0, 0}).points[0].x, -0.5);
}

TEST(Pattern, SeedsMakeOtherPoints) {
    for (const char* name : {"sobol:16:", "jittered:16:", "random:16:", "n-rooks:16:", "best-candidate:16:"}) {
        const SamplePattern one = parse_pattern(name + std::string("1")), two = parse_pattern(name + std::string("2"));
        bool differ = false;
        for (std::size_t i = 0; i < 16; ++i) differ = differ || one.points[i].y != two.points[i].y;
        EXPECT_TRUE(differ) << name;
    }
}

TEST(Pattern, WrongNamesAreRefused) {
    for (const char* name :
         {"", "grid:4", "regular", "regular:5", "regular:0", "regular:4:1", "regular:-4", "d3d:3", "d3d:32",
          "sobol:1.5", "sobol:x", "sobol:9999", "sobol:4:1:1", "quincunx:5", "checkerboard:4", "rotated:8",
          "jittered:7:1", "halton:4:5000000000", "n-rooks:4294967297"})
        EXPECT_THROW(parse_pattern(name), Error) << name;
    EXPECT_THROW(with_count(d3d_pattern(4), 5), Error);
    EXPECT_THROW(with_count(quincunx_pattern(), 4), Error);
}

}  // namespace
}  // namespace bandlimit
