#include "bandlimit/color/transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bandlimit {
namespace {

TEST(Srgb, KnownValues) {
    EXPECT_EQ(srgb_to_linear(0), 0);
    EXPECT_NEAR(srgb_to_linear(1), 1, 0x1p-53);
    EXPECT_NEAR(linear_to_srgb(1), 1, 0x1p-53);
    EXPECT_EQ(linear_to_srgb(0), 0);
    // IEC 61966-2-1 by hand: ((0.5 + 0.055) / 1.055)^2.4 and 1.055 * 0.5^(1/2.4) - 0.055.
    EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114048223255, 1e-15);
    EXPECT_NEAR(linear_to_srgb(0.5), 0.7353569830524495, 1e-15);
    EXPECT_EQ(srgb_to_linear(0.04), 0.04 / 12.92);
    EXPECT_EQ(linear_to_srgb(0.003), 0.003 * 12.92);
}

TEST(Srgb, InverseBothWays) {
    for (double x = 0.0004; x < 20; x *= 1.01) {
        ASSERT_NEAR(linear_to_srgb(srgb_to_linear(x)), x, 8e-16 * x + 1e-16) << x;
        ASSERT_NEAR(srgb_to_linear(linear_to_srgb(x)), x, 8e-16 * x + 1e-16) << x;
    }
}

TEST(Srgb, PiecesOfTheStandardMeetOnlyToSevenDigits) {
    // The constants of the standard are rounded: the pieces differ by 3e-8 at their border, less than any 16-bit code.
    EXPECT_NEAR(srgb_to_linear(std::nextafter(0.04045, 1)), srgb_to_linear(0.04045), 1e-8);
    EXPECT_NEAR(linear_to_srgb(std::nextafter(0.0031308, 1)), linear_to_srgb(0.0031308), 3e-8);
}

TEST(Srgb, IsOddAndKeepsNan) {
    for (double x = 0; x < 2; x += 0.01) {
        ASSERT_EQ(srgb_to_linear(-x), -srgb_to_linear(x));
        ASSERT_EQ(linear_to_srgb(-x), -linear_to_srgb(x));
    }
    EXPECT_TRUE(std::signbit(srgb_to_linear(-0.0)));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(srgb_to_linear(nan)));
    EXPECT_TRUE(std::isnan(linear_to_srgb(nan)));
}

TEST(Transfer, NamesAndDispatch) {
    EXPECT_EQ(name_of(Transfer::srgb), "srgb");
    EXPECT_EQ(name_of(Transfer::linear), "linear");
    EXPECT_EQ(decode(Transfer::linear, 0.3), 0.3);
    EXPECT_EQ(encode(Transfer::linear, 0.3), 0.3);
    EXPECT_EQ(decode(Transfer::srgb, 0.3), srgb_to_linear(0.3));
    EXPECT_EQ(encode(Transfer::srgb, 0.3), linear_to_srgb(0.3));
}

}  // namespace
}  // namespace bandlimit
