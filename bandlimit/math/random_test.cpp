#include "bandlimit/math/random.h"

#include <gtest/gtest.h>

#include <array>
#include <climits>
#include <cmath>
#include <set>

namespace bandlimit {
namespace {

TEST(Random, IsTheSequenceOfSplitMix64) {
    // The first outputs that the authors' reference code gives for seed 1234567.
    Random random(1234567);
    EXPECT_EQ(random.bits(), 6457827717110365317u);
    EXPECT_EQ(random.bits(), 3203168211198807973u);
}

TEST(Random, UniformHasTheMomentsOfTheUniformDistribution) {
    Random random(7);
    const int count = 100000;
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform();
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        sum += x, squares += x * x;
    }
    // Five standard deviations: sqrt(1/12 / count) of the mean, sqrt(4/45 / count) of the mean square.
    EXPECT_NEAR(sum / count, 0.5, 5 * std::sqrt(1.0 / 12 / count));
    EXPECT_NEAR(squares / count, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / count));
}

TEST(Random, RangesHoldAndReachTheirEnds) {
    Random random(8);
    std::set<int> seen;
    for (int i = 0; i < 1000; ++i) {
        seen.insert(random.integer(-2, 3));
        const double x = random.uniform(-4, -3);
        ASSERT_GE(x, -4);
        ASSERT_LT(x, -3);
        random.integer(INT_MIN, INT_MAX);  // the sanitizer sees an overflow
    }
    EXPECT_EQ(seen, (std::set{-2, -1, 0, 1, 2, 3}));
    EXPECT_EQ(random.integer(5, 5), 5);
}

TEST(Random, HashesDependOnEveryArgumentAndItsPlace) {
    EXPECT_EQ(hash_of(1234567), 6457827717110365317u);  // the first output of SplitMix64 for this seed
    EXPECT_EQ(hash_of(3, 4, 5), hash_of(3, 4, 5));
    const std::set<std::uint64_t> different{hash_of(3, 4, 5), hash_of(3, 5, 4), hash_of(4, 3, 5),
                                            hash_of(3, 4, 6), hash_of(3, 4),    hash_of(3, 4, 5, 0)};
    EXPECT_EQ(different.size(), 6u);
    // Each of the 64 bits is set about half of the time: within five standard deviations.
    constexpr int count = 4096;
    std::array<int, 64> set_bits{};
    for (std::uint64_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < 64; ++b) set_bits[b] += static_cast<int>(hash_of(1, i, 7) >> b & 1);
    for (const int n : set_bits) EXPECT_NEAR(n, count / 2.0, 5 * std::sqrt(count / 4.0));
}

}  // namespace
}  // namespace bandlimit
