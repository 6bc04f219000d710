#include "bandlimit/core/axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bandlimit {
namespace {

TEST(Axis, SamplesSitAtCellCentres) {
    const Axis cells{4, 0, 4};
    EXPECT_EQ(cells.pitch(), 1);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(cells.position(i), i + 0.5);
    EXPECT_EQ(cells.position(-0.5), 0);
    EXPECT_EQ(cells.position(3.5), 4);

    const Axis unit{2};
    EXPECT_EQ(unit.position(0), 0.25);
    EXPECT_EQ(unit.position(1), 0.75);
}

TEST(Axis, FlippedAxisCountsFromTheOtherEnd) {
    const Axis axis{8, -1, 3}, flipped{8, 3, -1};
    EXPECT_EQ(flipped.pitch(), -axis.pitch());
    for (int i = 0; i < 8; ++i) EXPECT_EQ(flipped.position(i), axis.position(7 - i));
}

TEST(Axis, IndexIsTheInverseOfPosition) {
    for (int count = 1; count <= 40; ++count)
        for (const auto& [begin, end] : {std::pair{0.0, 1.0}, {-3.0, 7.5}, {1.0, 0.0}, {100.0, 200.25}}) {
            const Axis axis{count, begin, end};
            // A position carries the rounding of begin and of the product; in cells that is count times as much.
            const double bound = 8 * 0x1p-53 * count * (1 + std::abs(begin) + std::abs(end)) / std::abs(end - begin);
            for (double i = -2; i <= count + 1; i += 0.25) ASSERT_NEAR(axis.index(axis.position(i)), i, 4 * bound);
        }
}

TEST(Axis, PartsKeepThePositionsOfTheWhole) {
    const Axis axis{12, 5, 29};  // pitch 2: everything is exact
    for (int first = 0; first < 12; ++first)
        for (int last = first + 1; last <= 12; ++last) {
            const Axis part = axis.cells(first, last);
            ASSERT_EQ(part.count, last - first);
            for (int i = first; i < last; ++i) ASSERT_EQ(part.position(i - first), axis.position(i));
        }
}

TEST(Axis, CenterAlignedMatchesFirstAndLastCentre) {
    for (int n = 2; n <= 40; ++n)
        for (int m = 2; m <= 40; ++m) {
            const Axis source{n, 0, double(n)}, aligned = center_aligned(source, m);
            ASSERT_EQ(aligned.count, m);
            const double bound = 8 * 0x1p-53 * (n + m);
            ASSERT_NEAR(aligned.position(0), 0.5, bound);
            ASSERT_NEAR(aligned.position(m - 1), n - 0.5, bound);
        }
}

TEST(Axis, CenterAlignedKeepsTheIntervalOfASingleSample) {
    for (const auto& [n, m] : {std::pair{1, 5}, {5, 1}, {1, 1}}) {
        const Axis aligned = center_aligned({n, 2, 3}, m);
        EXPECT_EQ(aligned.count, m);
        EXPECT_EQ(aligned.begin, 2);
        EXPECT_EQ(aligned.end, 3);
    }
}

}  // namespace
}  // namespace bandlimit
