#include "bandlimit/color/half.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace bandlimit {
namespace {

constexpr int finite_halves = 0x7c00;  // positive ones, 0 included

/// The value by the definition of binary16: sign, 5 bits of exponent, 10 bits of fraction.
double value_of(int bits) {
    const int exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const double magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    return bits & 0x8000 ? -magnitude : magnitude;
}

Half half(int bits) { return {static_cast<std::uint16_t>(bits)}; }

TEST(Half, EveryFiniteValueIsExactAndRoundTrips) {
    for (const int sign : {0, 0x8000})
        for (int bits = 0; bits < finite_halves; ++bits) {
            const float x = to_float(half(sign | bits));
            ASSERT_EQ(double(x), value_of(sign | bits)) << bits;
            ASSERT_EQ(std::signbit(x), sign != 0) << bits;
            ASSERT_EQ(to_half(x), half(sign | bits)) << bits;
        }
}

TEST(Half, InfinityAndNanStayWhatTheyAre) {
    EXPECT_EQ(to_float(half(0x7c00)), std::numeric_limits<float>::infinity());
    EXPECT_EQ(to_float(half(0xfc00)), -std::numeric_limits<float>::infinity());
    for (const int sign : {0, 0x8000}) {
        EXPECT_EQ(to_half(to_float(half(sign | 0x7c00))), half(sign | 0x7c00));
        for (int payload = 1; payload < 1024; ++payload) {
            const float x = to_float(half(sign | 0x7c00 | payload));
            ASSERT_TRUE(std::isnan(x));
            ASSERT_TRUE(std::isnan(to_float(to_half(x))));
        }
    }
    // A payload in the low bits of a float must not be shifted away into an infinity.
    EXPECT_TRUE(std::isnan(to_float(to_half(std::bit_cast<float>(0x7f800001u)))));
}

TEST(Half, RoundsToNearestAndTiesToEven) {
    for (int bits = 0; bits < finite_halves; ++bits) {
        // Beyond the largest finite value the next one would be 65536; from the middle on it is infinite.
        const double low = value_of(bits), high = bits + 1 == finite_halves ? 65536 : value_of(bits + 1);
        const auto middle = static_cast<float>((low + high) / 2);
        ASSERT_EQ(double(middle), (low + high) / 2) << "middles are floats";
        const int even = bits % 2 == 0 ? bits : bits + 1;
        ASSERT_EQ(to_half(middle), half(even)) << bits;
        ASSERT_EQ(to_half(std::nextafter(middle, 0.0f)), half(bits)) << bits;
        ASSERT_EQ(to_half(std::nextafter(middle, 1e9f)), half(bits + 1)) << bits;
        ASSERT_EQ(to_half(-middle), half(0x8000 | even)) << bits;
    }
    EXPECT_EQ(to_half(std::numeric_limits<float>::max()), half(0x7c00));
    EXPECT_EQ(to_half(std::numeric_limits<float>::denorm_min()), half(0));
}

}  // namespace
}  // namespace bandlimit
