#include "bandlimit/color/encoding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/filter/bokeh.h"
#include "bandlimit/filter/convolve.h"
#include "bandlimit/resample/fetch_banks.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/resample/term_filter.h"
#include "bandlimit/texture/cascade.h"
#include "bandlimit/texture/level_filter.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Row = std::vector<float>;

/// The standard in extended precision, independent of the library.
long double exact_encode(long double x) {
    return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}
long double exact_decode(long double x) { return x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L); }

template <class T>
Row decoded(const Image<T>& image, const Encoding& stored, bool premultiplied) {
    Row row(static_cast<std::size_t>(image.width() * image.channels()));
    decode_row(image.view(), 0, stored, premultiplied, row);
    return row;
}

template <class T>
struct Encoded {
    Image<T> image;
    bool lost = false;  ///< what encode_row returned
};

template <class T>
Encoded<T> encoded(const Row& row, int channels, const Encoding& stored, bool premultiplied) {
    Encoded<T> result{Image<T>(static_cast<int>(row.size()) / channels, 1, channels, Layout::interleaved)};
    result.lost = encode_row(row, premultiplied, result.image.view(), 0, stored);
    return result;
}

template <class T>
Image<T> image_of(const std::vector<T>& samples, int channels) {
    Image<T> image(static_cast<int>(samples.size()) / channels, 1, channels, Layout::interleaved);
    std::copy(samples.begin(), samples.end(), image.view().data);
    return image;
}

template <class Code>
std::vector<Code> all_codes() {
    std::vector<Code> codes;
    for (int code = 0; code <= std::numeric_limits<Code>::max(); ++code) codes.push_back(static_cast<Code>(code));
    return codes;
}

template <class Code>
class IntegerRows : public testing::Test {};
using Codes = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(IntegerRows, Codes);

TYPED_TEST(IntegerRows, EveryCodeDecodesToTheNearestFloatAndSurvives) {
    const auto codes = all_codes<TypeParam>();
    const int largest = std::numeric_limits<TypeParam>::max();
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        const Row row = decoded(image_of(codes, 1), {transfer}, false);
        for (int code = 0; code <= largest; ++code) {
            const long double value = static_cast<long double>(code) / largest;
            const long double exact = transfer == Transfer::srgb ? exact_decode(value) : value;
            ASSERT_EQ(row[static_cast<std::size_t>(code)], static_cast<float>(exact)) << code;
        }
        EXPECT_EQ(row.front(), 0.0f);
        EXPECT_EQ(row.back(), 1.0f);
        const auto back = encoded<TypeParam>(row, 1, {transfer}, false);
        EXPECT_FALSE(back.lost);
        for (int code = 0; code <= largest; ++code) ASSERT_EQ(back.image.view()(code, 0), code);
    }
}

TYPED_TEST(IntegerRows, SrgbCodesAreThoseOfTheExactFunctionAtEveryThreshold) {
    const int largest = std::numeric_limits<TypeParam>::max();
    Row row;
    std::vector<int> expected;
    for (int code = 0; code < largest; ++code) {
        const long double border = (code + 0.5L) / largest;
        float x = static_cast<float>(exact_decode(border));
        for (int step = 0; step < 3; ++step) x = std::nextafter(x, 0.0f);
        for (int step = 0; step < 7; ++step, x = std::nextafter(x, 2.0f)) {
            row.push_back(x);
            expected.push_back(exact_encode(x) < border ? code : code + 1);
        }
    }
    const auto result = encoded<TypeParam>(row, 1, {Transfer::srgb}, false);
    for (std::size_t i = 0; i < row.size(); ++i)
        ASSERT_EQ(result.image.view()(static_cast<int>(i), 0), expected[i]) << row[i];
}

TYPED_TEST(IntegerRows, WhatIsOutsideIsClampedAndWhatIsNotFiniteBecomesZero) {
    const auto largest = std::numeric_limits<TypeParam>::max();
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        const Row inside{-1e30f, -1e-30f, -0.0f, 1.0f, 1.5f, 1e30f, std::numeric_limits<float>::denorm_min()};
        const auto clamped = encoded<TypeParam>(inside, 1, {transfer}, false);
        EXPECT_FALSE(clamped.lost);
        for (int i = 0; i < 7; ++i) EXPECT_EQ(clamped.image.view()(i, 0), i >= 3 && i <= 5 ? largest : 0) << i;
        for (const float bad : {nan, infinity, -infinity}) {
            const auto result = encoded<TypeParam>({0.5f, bad}, 1, {transfer}, false);
            EXPECT_TRUE(result.lost);
            EXPECT_EQ(result.image.view()(1, 0), 0);
        }
    }
}

TEST(Floats, PassThroughWithTheirTransfer) {
    const Row row{-2.0f, -0.0f, 0.25f, 1.0f, 700.0f, infinity, nan};
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        const auto stored = encoded<float>(row, 1, {transfer}, false);
        EXPECT_FALSE(stored.lost) << "nothing is lost in a float";
        for (std::size_t i = 0; i + 1 < row.size(); ++i)
            EXPECT_EQ(stored.image.view()(static_cast<int>(i), 0),
                      static_cast<float>(encode(transfer, static_cast<double>(row[i]))));
        EXPECT_TRUE(std::isnan(stored.image.view()(6, 0)));
        const Row back = decoded(stored.image, {transfer}, false);
        // Two roundings to float, the first enlarged by the power 2.4.
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(back[i], row[i], 4 * 0x1p-24 * std::abs(row[i]));
    }
    const auto halves = encoded<Half>(row, 1, {}, false);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(halves.image.view()(static_cast<int>(i), 0), to_half(row[i]));
}

TEST(Alpha, IsCoverageAndHasNoTransferFunction) {
    const Row row = decoded(image_of<std::uint8_t>({128, 128}, 2), {Transfer::srgb, 1}, false);
    EXPECT_EQ(row[0], static_cast<float>(exact_decode(128 / 255.0L)));
    EXPECT_EQ(row[1], 128 / 255.0f);
    EXPECT_EQ((encoded<std::uint8_t>(row, 2, {Transfer::srgb, 1}, false).image.view()(0, 0, 1)), 128);
}

TEST(Alpha, PremultipliesColourOnly) {
    const auto image = image_of<float>({0.5f, -2.0f, 8.0f, 0.25f, 1, 2, 3, 1}, 4);
    EXPECT_EQ(decoded(image, {Transfer::linear, 3}, true), (Row{0.125f, -0.5f, 2.0f, 0.25f, 1, 2, 3, 1}));
    EXPECT_EQ(decoded(image, {Transfer::linear, 3}, false), (Row{0.5f, -2.0f, 8.0f, 0.25f, 1, 2, 3, 1}));
    EXPECT_EQ(decoded(image, {Transfer::linear, 3, true}, true), (Row{0.5f, -2.0f, 8.0f, 0.25f, 1, 2, 3, 1}))
        << "what is stored premultiplied is not multiplied again";
    EXPECT_EQ(decoded(image_of<float>({0.5f, 3, 5}, 3), {Transfer::linear, 0}, true), (Row{0.5f, 1.5f, 2.5f}))
        << "alpha may be any channel";
}

TEST(Alpha, ZeroAlphaGivesZeroColour) {
    const Encoding straight{Transfer::linear, 1}, associated{Transfer::linear, 1, true};
    const Row hidden{5, 0, infinity, 0, nan, 0};
    EXPECT_EQ(decoded(image_of<float>({5, 0, infinity, 0, nan, 0}, 2), straight, true), (Row{0, 0, 0, 0, 0, 0}));
    for (const bool premultiplied : {false, true}) {
        // From one form to the other, either way.
        const auto result = encoded<float>(hidden, 2, premultiplied ? straight : associated, premultiplied);
        for (int x = 0; x < 3; ++x) EXPECT_EQ(result.image.view()(x, 0, 0), 0) << x << premultiplied;
    }
    const auto codes = encoded<std::uint8_t>(hidden, 2, straight, true);
    EXPECT_FALSE(codes.lost) << "no value that is not finite became a code";
}

TEST(Alpha, StraightIsUntouched) {
    const auto codes = image_of<std::uint8_t>({200, 100, 50, 0, 1, 2, 3, 4}, 4);
    const Encoding stored{Transfer::srgb, 3};
    const auto back = encoded<std::uint8_t>(decoded(codes, stored, false), 4, stored, false);
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(back.image.view()(x, 0, c), codes.view()(x, 0, c));
}

TEST(Alpha, PremultipliedRoundTripKeepsEveryCodeOfVisibleColour) {
    std::vector<std::uint8_t> samples;
    for (int alpha = 1; alpha < 256; alpha += 2)
        for (int colour = 0; colour < 256; ++colour)
            samples.insert(samples.end(), {static_cast<std::uint8_t>(colour), static_cast<std::uint8_t>(alpha)});
    const auto image = image_of(samples, 2);
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        const Encoding stored{transfer, 1};
        const auto back = encoded<std::uint8_t>(decoded(image, stored, true), 2, stored, true);
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 2; ++c) ASSERT_EQ(back.image.view()(x, 0, c), image.view()(x, 0, c)) << x;
    }
}

TEST(Alpha, StraightRowsAreMultipliedForAnAssociatedFile) {
    const auto result = encoded<float>({3, 0.5f}, 2, {Transfer::linear, 1, true}, false);
    EXPECT_EQ(result.image.view()(0, 0, 0), 1.5f);
    EXPECT_EQ(result.image.view()(0, 0, 1), 0.5f);
    EXPECT_EQ((encoded<float>({3, 0.5f}, 2, {Transfer::linear, 1, true}, true).image.view()(0, 0, 0)), 3);
}

TEST(Alpha, QuotientsThatOverflowAreReported) {
    const auto result = encoded<std::uint8_t>({1e30f, 1e-30f}, 2, {Transfer::linear, 1}, true);
    EXPECT_EQ(result.image.view()(0, 0, 0), 0);
    EXPECT_TRUE(result.lost);
}

TEST(Composite, LaysOverAnOpaqueColour) {
    const Row background{1, 0.5f, 0.25f};
    const Row straight{0, 0, 0, 1, 8, 8, 8, 0, 1, 1, 1, 0.5f};
    const Row expected{0, 0, 0, 1, 0.5f, 0.25f, 1, 0.75f, 0.625f};
    Row out(9);
    composite_row(straight, false, 4, 3, background, out);
    EXPECT_EQ(out, expected);
    const Row premultiplied{0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0.5f, 0.5f, 0.5f};
    composite_row(premultiplied, true, 4, 3, background, out);
    EXPECT_EQ(out, expected);

    Row grey(1);
    composite_row(Row{0.25f, 1}, false, 2, 0, Row{0.5f}, grey);
    EXPECT_EQ(grey, Row{0.625f}) << "alpha may come first";
    composite_row(Row{nan, 0}, false, 2, 1, Row{0.5f}, grey);
    EXPECT_EQ(grey, Row{0.5f}) << "zero alpha contributes no colour";
}

TEST(Encoding, FollowsStridesAndRows) {
    Image<std::uint16_t> planar(5, 3, 2), interleaved(5, 3, 2, Layout::interleaved);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            for (int c = 0; c < 2; ++c)
                planar.view()(x, y, c) = interleaved.view()(x, y, c) =
                    static_cast<std::uint16_t>(1000 * y + 10 * x + c);
    for (int y = 0; y < 3; ++y) {
        Row a(10), b(10);
        decode_row(View<const std::uint16_t>(planar.view()), y, {Transfer::srgb}, false, a);
        decode_row(View<const std::uint16_t>(flipped_x(interleaved.view())), y, {Transfer::srgb}, false, b);
        for (std::size_t x = 0; x < 5; ++x)
            for (std::size_t c = 0; c < 2; ++c) ASSERT_EQ(a[2 * x + c], b[2 * (4 - x) + c]);
        Image<std::uint16_t> out(5, 3, 2);
        encode_row(a, false, out.view(), y, {Transfer::srgb});
        for (int x = 0; x < 5; ++x)
            for (int c = 0; c < 2; ++c) {
                ASSERT_EQ(out.view()(x, y, c), planar.view()(x, y, c));
                ASSERT_EQ(out.view()(x, (y + 1) % 3, c), 0) << "other rows are untouched";
            }
    }
    Row too_short(9);
    EXPECT_THROW(decode_row(View<const std::uint16_t>(planar.view()), 0, {}, false, too_short), Error);
    EXPECT_THROW(encode_row(too_short, false, planar.view(), 0, {}), Error);
}

/// A public function that takes an Encoding, called with one for pictures of four channels.
struct TakesEncoding {
    std::string name;
    std::function<void(const Encoding&)> call;
};

std::vector<TakesEncoding> functions_that_take_encodings() {
    static Image<float> from(8, 8, 4, Layout::interleaved), to(8, 8, 4, Layout::interleaved);
    static std::vector<float> row(8 * 4);
    const Grid grid{{8}, {8}};
    const auto resize = [=](const Encoding& a, const Encoding& b) {
        Resizer(grid, grid, 4).run({from.view(), 0, a}, {to.view(), 0, b, {}});
    };
    const auto terms = [=](const Encoding& a, const Encoding& b) {
        term_filter(bank_terms(Taps{0, {1}}, grid, grid, Edge::clamp, Edge::clamp), true)
            .run({from.view(), 0, a}, {to.view(), 0, b, {}}, {});
    };
    const auto level = [=](const Encoding& a, const Encoding& b) {
        level_filter(Auto{}, grid, grid, 4, {}).run({from.view(), 0, a}, {to.view(), 0, b, {}}, {});
    };
    const ConvolutionWeights weights{Terms{{{1.0}, {1.0}}}, 0, 0};
    const auto convolve = [=](Method method, const Encoding& a, const Encoding& b) {
        Convolution(weights, 8, 8, {.method = method}).run({from.view(), 0, a}, {to.view(), 0, b, {}});
    };
    const auto bright = [=](const Encoding& a, const Encoding& b) {
        boosted(Convolution(weights, 8, 8), 2, true).run({from.view(), 0, a}, {to.view(), 0, b, {}});
    };
    const TexelFormat format{4, Depth::f32};
    const View<const float> base = from.view();
    const std::vector<AnyConstView> faces(6, base);
    return {
        {"decode_row", [](const Encoding& e) { decode_row(from.view(), 0, e, true, row); }},
        {"encode_row", [](const Encoding& e) { encode_row(row, true, to.view(), 0, e); }},
        {"Resizer::run, source", [=](const Encoding& e) { resize(e, {}); }},
        {"Resizer::run, target", [=](const Encoding& e) { resize({}, e); }},
        {"term_filter, run, source", [=](const Encoding& e) { terms(e, {}); }},
        {"term_filter, run, target", [=](const Encoding& e) { terms({}, e); }},
        {"level_filter, run, source", [=](const Encoding& e) { level(e, {}); }},
        {"level_filter, run, target", [=](const Encoding& e) { level({}, e); }},
        {"Convolution::run, source", [=](const Encoding& e) { convolve(Method::direct, e, {}); }},
        {"Convolution::run, target", [=](const Encoding& e) { convolve(Method::direct, {}, e); }},
        {"Convolution::run by FFT, source", [=](const Encoding& e) { convolve(Method::fft, e, {}); }},
        {"Convolution::run by FFT, target", [=](const Encoding& e) { convolve(Method::fft, {}, e); }},
        {"boosted, run, source", [=](const Encoding& e) { bright(e, {}); }},
        {"boosted, run, target", [=](const Encoding& e) { bright({}, e); }},
        {"MipCascade", [](const Encoding& e) { MipCascade(8, 8, 4, e, 1, {}); }},
        {"make_mips", [=](const Encoding& e) { make_mips(base, e, format); }},
        {"make_mips of data", [=](const Encoding& e) { make_mips(base, e, format, {.role = Role::data}); }},
        {"make_mips of normals", [=](const Encoding& e) { make_mips(base, e, format, {.role = Role::normal}); }},
        {"make_mips by fetches", [=](const Encoding& e) { make_mips(base, e, format, {.filter = downsample8()}); }},
        {"MipStream", [=](const Encoding& e) { MipStream(8, 8, 4, Depth::f32, e, format); }},
        {"make_cube_mips", [=](const Encoding& e) { make_cube_mips(faces, e, format); }},
    };
}

TEST(Encoding, EveryFunctionThatTakesOneRefusesAnAlphaThatIsNoChannel) {
    for (const TakesEncoding& f : functions_that_take_encodings()) {
        for (const int alpha : {-1, 3}) EXPECT_NO_THROW(f.call({Transfer::linear, alpha})) << f.name << ' ' << alpha;
        for (const int alpha : {-2, 4, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
            EXPECT_THROW(f.call({Transfer::linear, alpha}), Error) << f.name << ' ' << alpha;
    }
    std::vector<float> row(8 * 4), opaque(8 * 3);
    const std::vector<float> background(3);
    for (const int alpha : {-2, -1, 4})
        EXPECT_THROW(composite_row(row, true, 4, alpha, background, opaque), Error) << alpha;
}

}  // namespace
}  // namespace bandlimit
