#include "bandlimit/color/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

template <class Code>
class Integers : public testing::Test {};
using Codes = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(Integers, Codes);

TYPED_TEST(Integers, EveryCodeRoundTripsAndTheEndsAreExact) {
    const int largest = std::numeric_limits<TypeParam>::max();
    EXPECT_EQ(from_code(TypeParam{0}), 0.0f);
    EXPECT_EQ(from_code(static_cast<TypeParam>(largest)), 1.0f);
    for (int code = 0; code <= largest; ++code) {
        const float value = from_code(static_cast<TypeParam>(code));
        ASSERT_EQ(value, static_cast<float>(static_cast<long double>(code) / largest)) << code;
        ASSERT_EQ(to_code<TypeParam>(static_cast<double>(value)), code);
    }
}

TYPED_TEST(Integers, RoundAtTheMiddleBetweenCodes) {
    const int largest = std::numeric_limits<TypeParam>::max();
    for (int code = 0; code < largest; ++code) {
        // The floats around (code + 1/2) / largest, judged by exact arithmetic: x * largest has 40 bits.
        float x = static_cast<float>((code + 0.5) / largest);
        for (int step = 0; step < 3; ++step) x = std::nextafter(x, 0.0f);
        for (int step = 0; step < 7; ++step, x = std::nextafter(x, 2.0f)) {
            const int nearest = static_cast<double>(x) * largest < code + 0.5 ? code : code + 1;
            ASSERT_EQ(to_code<TypeParam>(static_cast<double>(x)), nearest) << code << ' ' << step;
        }
    }
    EXPECT_EQ(to_code<TypeParam>(0.5), (largest + 1) / 2) << "a tie goes up";
}

TYPED_TEST(Integers, ClampAndZeroWhatIsNotFinite) {
    const int largest = std::numeric_limits<TypeParam>::max();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double x : {-1e300, -1.0, -1e-9, -0.0}) EXPECT_EQ(to_code<TypeParam>(x), 0);
    for (const double x : {1.0, 1.0001, 7.0, 1e300}) EXPECT_EQ(to_code<TypeParam>(x), largest);
    for (const double x : {infinity, -infinity, std::nan("")}) EXPECT_EQ(to_code<TypeParam>(x), 0);
}

TEST(Depth, NamesReadBack) {
    for (const Depth depth : all_depths()) EXPECT_EQ(parse_depth(name_of(depth)), depth);
    try {
        parse_depth("u12");
        FAIL() << "an unknown name must throw";
    } catch (const Error& error) {
        const std::string text = error.what();
        for (const Depth depth : all_depths()) EXPECT_NE(text.find(name_of(depth)), std::string::npos) << text;
    }
}

TEST(Depth, ViewsKnowTheirDepth) {
    std::uint16_t code = 7;
    Half half;
    const AnyView u16 = View<std::uint16_t>{&code, 1, 1}, f16 = View<Half>{&half, 1, 1};
    EXPECT_EQ(depth_of(const_view(AnyView{View<std::uint8_t>{}})), Depth::u8);
    EXPECT_EQ(depth_of(const_view(u16)), Depth::u16);
    EXPECT_EQ(depth_of(const_view(f16)), Depth::f16);
    EXPECT_EQ(depth_of(const_view(AnyView{View<float>{}})), Depth::f32);
    EXPECT_EQ(std::get<View<const std::uint16_t>>(const_view(u16)).data, &code);
    EXPECT_EQ(size_of(Depth::u8), 1u);
    EXPECT_EQ(size_of(Depth::u16), 2u);
    EXPECT_EQ(size_of(Depth::f16), 2u);
    EXPECT_EQ(size_of(Depth::f32), 4u);
    EXPECT_TRUE(is_integer(Depth::u16) && !is_integer(Depth::f16));
}

}  // namespace
}  // namespace bandlimit
