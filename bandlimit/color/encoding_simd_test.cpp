// The vector forms against the scalar definition, on every target that this machine has.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bandlimit/color/encoding_rows.h"
#include "bandlimit/color/srgb_codes.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/targets_test.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

using Row = std::vector<float>;

bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}
bool same(std::uint8_t a, std::uint8_t b) { return a == b; }
bool same(std::uint16_t a, std::uint16_t b) { return a == b; }
bool same(Half a, Half b) { return same(to_float(a), to_float(b)); }

template <class Samples>
::testing::AssertionResult same_samples(const Samples& a, const Samples& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!same(a[i], b[i])) return ::testing::AssertionFailure() << "sample " << i << " of " << a.size();
    return ::testing::AssertionSuccess();
}

template <class T>
T random_sample(Random& random) {
    if constexpr (std::is_integral_v<T>) {
        return static_cast<T>(random.uniform() < 0.1 ? 0 : random.bits());
    } else {
        constexpr float special[]{0, -0.0f, 1, nan, infinity, -infinity, denormal, -1, 1e30f, 1e-30f, 0.5f, -1e-40f};
        const auto at = static_cast<std::size_t>(60 * random.uniform());
        const float x = at < std::size(special) ? special[at] : static_cast<float>(1.2 * random.uniform() - 0.1);
        if constexpr (std::is_same_v<T, Half>) return to_half(x);
        else return x;
    }
}

/// Fills `samples` from a pool of random ones, from a random place on.
template <class T>
void fill(std::vector<T>& samples, Random& random) {
    static const std::vector<T> pool = [] {
        Random fixed(11);
        std::vector<T> made(10007);
        for (T& sample : made) sample = random_sample<T>(fixed);
        return made;
    }();
    auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(pool.size()));
    for (T& sample : samples) {
        sample = pool[at];
        at = at + 1 == pool.size() ? 0 : at + 1;
    }
}

/// Two rows of `width` pixels within `memory`, in one of five layouts.
template <class T>
View<T> view_in(std::vector<T>& memory, int width, int channels, int layout) {
    const std::ptrdiff_t w = width, c = channels;
    memory.resize(static_cast<std::size_t>(2 * (w + 5) * (c + 1)));
    T* const data = memory.data();
    switch (layout) {
        case 0: return {data, width, 2, channels, c, w * c, 1};
        case 1: return {data, width, 2, channels, 1, w, 2 * w};  // planar
        case 2: return cropped(View<T>{data, width + 5, 2, channels, c, (w + 5) * c, 1}, 3, 0, width, 2);
        case 3: return flipped_x(View<T>{data, width, 2, channels, c, w * c, 1});
        default: return channels_of(View<T>{data, width, 2, channels + 1, c + 1, w * (c + 1), 1}, 1, channels);
    }
}

struct Meaning {
    Encoding stored;
    bool premultiplied;
};

/// Every transfer function and place of alpha, with and without a change of the form.
std::vector<Meaning> meanings(int channels) {
    std::vector<Meaning> all;
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb})
        for (int alpha = -1; alpha < channels; ++alpha)
            for (const bool associated : {false, true})
                for (const bool premultiplied : {false, true})
                    all.push_back({{transfer, alpha, associated}, premultiplied});
    return all;
}

template <class T>
class Vectors : public testing::Test {};
using Depths = testing::Types<std::uint8_t, std::uint16_t, Half, float>;
TYPED_TEST_SUITE(Vectors, Depths);

/// One row in one layout.
struct Shape {
    int width, channels, layout;
};

template <class T>
testing::AssertionResult decodes_alike(const Shape& s, const Meaning& m, Random& random) {
    std::vector<T> memory;
    const View<T> image = view_in(memory, s.width, s.channels, s.layout);
    fill(memory, random);
    Row expected(static_cast<std::size_t>(s.width * s.channels)), row(expected);
    decode_row_scalar(View<const T>(image), 1, m.stored, m.premultiplied, expected);
    decode_row(View<const T>(image), 1, m.stored, m.premultiplied, row);
    return same_samples(row, expected);
}

template <class T>
testing::AssertionResult encodes_alike(const Shape& s, const Meaning& m, Random& random) {
    Row row(static_cast<std::size_t>(s.width * s.channels));
    fill(row, random);
    if (random.uniform() < 0.5)
        for (float& x : row) x = std::isfinite(x) ? x : 0.25f;
    std::vector<T> expected, memory;
    const View<T> scalar = view_in(expected, s.width, s.channels, s.layout);
    const View<T> image = view_in(memory, s.width, s.channels, s.layout);
    const bool lost = encode_row_scalar(row, m.premultiplied, scalar, 1, m.stored);
    if (encode_row(row, m.premultiplied, image, 1, m.stored) != lost)
        return testing::AssertionFailure() << "lost is " << !lost;
    return same_samples(memory, expected);  // what is outside of the row too
}

template <class T>
void compare(const Shape& s, const Meaning& m, Random& random) {
    const auto what = [&] {
        return message("width ", s.width, " channels ", s.channels, " layout ", s.layout, " alpha ", m.stored.alpha,
                       ' ', name_of(m.stored.transfer), " associated ", m.stored.associated, " row ", m.premultiplied);
    };
    ASSERT_TRUE(decodes_alike<T>(s, m, random)) << what();
    ASSERT_TRUE(encodes_alike<T>(s, m, random)) << what();
}

TYPED_TEST(Vectors, EveryWidthChannelLayoutAndMeaning) {
    for_each_target([](Target) {
        Random random(7);
        for (int channels = 1; channels <= 5; ++channels)
            for (const Meaning& m : meanings(channels))
                for (int layout = 0; layout < 5; ++layout) {
                    // Without a vector form a few widths are enough.
                    const bool scalar = (channels == 5 && layout > 0) ||
                                        (!std::is_integral_v<TypeParam> && m.stored.transfer == Transfer::srgb);
                    for (int width = 0; width <= 70; width += scalar ? 23 : 1)
                        ASSERT_NO_FATAL_FAILURE(compare<TypeParam>({width, channels, layout}, m, random));
                }
    });
}

TYPED_TEST(Vectors, StridesLongerThanABlock) {
    for_each_target([](Target) {
        Random random(8);
        for (const int layout : {0, 1, 3, 4})
            for (const int width : {255, 256, 257, 700})
                ASSERT_NO_FATAL_FAILURE(
                    compare<TypeParam>({width, 4, layout}, {{Transfer::linear, 3, false}, true}, random));
    });
}

template <class Code>
class CodeVectors : public testing::Test {};
using Codes = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(CodeVectors, Codes);

/// The floats within 40 of every boundary between codes.
template <class Code>
Row around_boundaries(Transfer transfer) {
    const int largest = std::numeric_limits<Code>::max();
    Row row;
    for (int code = 0; code < largest; ++code) {
        const auto middle = static_cast<float>(decode(transfer, (code + 0.5) / largest));
        const auto bits = std::bit_cast<std::uint32_t>(middle);
        for (std::uint32_t near = bits - 40; near <= bits + 40; ++near) row.push_back(std::bit_cast<float>(near));
    }
    return row;
}

template <class Code>
void compare_codes(const Row& row, Transfer transfer, bool lost) {
    const int width = static_cast<int>(row.size());
    Image<Code> expected(width, 1), image(width, 1);
    ASSERT_EQ(encode_row_scalar(row, false, expected.view(), 0, {transfer}), lost);
    for_each_target([&](Target) {
        ASSERT_EQ(encode_row(row, false, image.view(), 0, {transfer}), lost);
        for (int x = 0; x < width; ++x)
            ASSERT_EQ(image.view()(x, 0), expected.view()(x, 0)) << std::hexfloat << row[static_cast<std::size_t>(x)];
    });
}

TYPED_TEST(CodeVectors, SameAtEveryBoundary) {
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb})
        compare_codes<TypeParam>(around_boundaries<TypeParam>(transfer), transfer, false);
}

TYPED_TEST(CodeVectors, SameForFloatsOfEveryExponentAndSign) {
    Row finite, other{nan, -nan, infinity, -infinity, std::bit_cast<float>(0x7f800001u)};
    for (std::uint64_t bits = 0; bits < 1ull << 32; bits += 9973) {
        const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        (std::isfinite(x) ? finite : other).push_back(x);
    }
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        compare_codes<TypeParam>(finite, transfer, false);
        compare_codes<TypeParam>(other, transfer, true);
    }
}

TYPED_TEST(CodeVectors, EveryCodeDecodesAlike) {
    const int largest = std::numeric_limits<TypeParam>::max();
    Image<TypeParam> image(largest + 1, 1);
    for (int code = 0; code <= largest; ++code) image.view()(code, 0) = static_cast<TypeParam>(code);
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
        Row expected(static_cast<std::size_t>(largest) + 1), row(expected);
        decode_row_scalar(View<const TypeParam>(image.view()), 0, {transfer}, false, expected);
        for_each_target([&](Target) {
            decode_row(View<const TypeParam>(image.view()), 0, {transfer}, false, row);
            ASSERT_TRUE(same_samples(row, expected));
        });
    }
}

TEST(HalfVectors, EveryHalfDecodesAndEveryRoundingIsTheSame) {
    Image<Half> image(0x10000, 1);
    for (int bits = 0; bits < 0x10000; ++bits) image.view()(bits, 0) = {static_cast<std::uint16_t>(bits)};
    Row middles;
    for (std::uint64_t bits = 0; bits < 1ull << 32; bits += 0x1000)  // every half, every middle, and what is beside
        for (const std::uint64_t near : {bits - 1, bits, bits + 1})
            middles.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(near)));
    Image<Half> expected(static_cast<int>(middles.size()), 1), halves(expected.clone());
    encode_row_scalar(middles, false, expected.view(), 0, {});
    for_each_target([&](Target) {
        Row row(0x10000);
        decode_row(View<const Half>(image.view()), 0, {}, false, row);
        for (std::size_t bits = 0; bits < row.size(); ++bits)
            ASSERT_TRUE(same(row[bits], to_float({static_cast<std::uint16_t>(bits)}))) << bits;
        encode_row(middles, false, halves.view(), 0, {});
        for (int x = 0; x < halves.width(); ++x)
            ASSERT_TRUE(same(halves.view()(x, 0), expected.view()(x, 0))) << middles[static_cast<std::size_t>(x)];
    });
}

TEST(CompositeVectors, EveryWidthAndChannel) {
    for_each_target([](Target) {
        Random random(9);
        for (int channels = 1; channels <= 5; ++channels)
            for (int alpha = 0; alpha < channels; ++alpha)
                for (const bool premultiplied : {false, true})
                    for (std::size_t width = 0; width <= 70; ++width) {
                        const auto colours = static_cast<std::size_t>(channels) - 1;
                        Row row(width * (colours + 1)), background(colours);
                        fill(row, random);
                        fill(background, random);
                        Row expected(width * colours), out(expected);
                        composite_row_scalar(row, premultiplied, channels, alpha, background, expected);
                        composite_row(row, premultiplied, channels, alpha, background, out);
                        ASSERT_TRUE(same_samples(out, expected)) << width << ' ' << channels << ' ' << alpha;
                    }
    });
}

TEST(SrgbTables, ABucketHoldsOneThresholdAndTheTableReachesOne) {
    const SrgbCarryTable& table = srgb_carry_table();
    std::uint32_t last = 0;
    for (const float threshold : srgb_thresholds<std::uint8_t>().thresholds) {
        const std::uint32_t bucket = bucket_of(std::bit_cast<std::uint32_t>(threshold));
        EXPECT_GT(bucket, last);
        last = bucket;
    }
    const std::uint32_t one = bucket_of(std::bit_cast<std::uint32_t>(1.0f));
    ASSERT_EQ(table.entries.size(), one + 1);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(table.entries[one]), 255u << 16);
}

TEST(SrgbTables, AChordGivesTheCodeOrTheNext) {
    // Along a bucket k never falls, so its ends and the two floats at each threshold decide for all floats.
    const SrgbChordTable& table = srgb_chord_table();
    const auto check = [&](std::uint32_t bits) {
        const float x = std::bit_cast<float>(bits);
        if (x < table.lowest || x > 1) return;
        const std::uint32_t bucket = bucket_of(bits);
        const float along = static_cast<float>(bits & 0xffff);
        const int fused = static_cast<int>(std::fma(table.slope[bucket], along, table.start[bucket]));
        const int rounded = static_cast<int>(table.slope[bucket] * along + table.start[bucket]);
        const int code = srgb_code<std::uint16_t>(x);
        ASSERT_TRUE(fused == code || fused == code + 1) << x;
        ASSERT_TRUE(rounded == code || rounded == code + 1) << x;
        ASSERT_TRUE(fused <= 65535 && rounded <= 65535) << x;
    };
    for (const float threshold : srgb_thresholds<std::uint16_t>().thresholds)
        for (const std::uint32_t step : {0, 1}) check(std::bit_cast<std::uint32_t>(threshold) - step);
    for (std::uint32_t bucket = 0; bucket < table.start.size(); ++bucket)
        for (const std::uint32_t end : {0x0000, 0xffff}) check((bucket << 16) + end);
}

}  // namespace
}  // namespace bandlimit
