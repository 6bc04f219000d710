#include "bandlimit/core/overlap.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/filter/bokeh.h"
#include "bandlimit/filter/convolve.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/byte_bank.h"
#include "bandlimit/resample/fetch_banks.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {
namespace {

template <class A, class B>
bool share(const View<A>& a, const View<B>& b) {
    const bool result = overlap(footprint_of(a), footprint_of(b));
    EXPECT_EQ(overlap(footprint_of(b), footprint_of(a)), result);
    return result;
}

template <class T>
View<T> every_second_row(View<T> v, int first) {
    v.data += first * v.dy;
    v.dy *= 2;
    v.height /= 2;
    return v;
}

TEST(Overlap, PartsOfOneImageThatShareNoSampleAreApart) {
    for (const Layout layout : {Layout::planar, Layout::interleaved}) {
        Image<float> image(4000, 3000, 4, layout), other(4000, 3000, 4, layout);
        const View<float> v = image.view();
        EXPECT_TRUE(share(v, v));
        EXPECT_FALSE(share(v, other.view()));
        EXPECT_TRUE(share(v, transposed(flipped_x(flipped_y(v)))));
        EXPECT_FALSE(share(cropped(v, 0, 0, 2000, 3000), cropped(v, 2000, 0, 2000, 3000))) << "halves side by side";
        EXPECT_TRUE(share(cropped(v, 0, 0, 2001, 3000), cropped(v, 2000, 0, 2000, 3000)));
        EXPECT_FALSE(share(cropped(v, 0, 0, 4000, 1500), cropped(v, 0, 1500, 4000, 1500))) << "halves above each other";
        EXPECT_FALSE(share(channels_of(v, 0), channels_of(v, 3)));
        EXPECT_FALSE(share(channels_of(v, 0, 2), flipped_x(channels_of(v, 2, 2))));
        EXPECT_TRUE(share(channels_of(v, 0, 3), channels_of(v, 2, 2)));
        EXPECT_FALSE(share(every_second_row(v, 0), flipped_y(every_second_row(v, 1))));
        EXPECT_FALSE(share(cropped(v, 0, 0, 0, 3000), v)) << "a view without samples";
        EXPECT_THROW(check_apart("filter", v, cropped(v, 10, 10, 5, 5)), Error);
        EXPECT_NO_THROW(check_apart("filter", v, other.view()));
    }
}

TEST(Overlap, IsThatOfTheBytesForAnyStrides) {
    Random random(1);
    int shared = 0;
    std::vector<std::uint32_t> memory(400);
    const auto any_view = [&](auto* data, std::ptrdiff_t samples) {
        for (;;) {
            View<std::remove_pointer_t<decltype(data)>> v{data + random.integer(0, int(samples) - 1),
                                                          random.integer(1, 6),
                                                          random.integer(1, 6),
                                                          random.integer(1, 3),
                                                          random.integer(-9, 9),
                                                          random.integer(-40, 40),
                                                          random.integer(-100, 100)};
            bool is_inside = true;
            for (int corner = 0; corner < 8; ++corner) {
                const auto* at =
                    &v(corner & 1 ? v.width - 1 : 0, corner & 2 ? v.height - 1 : 0, corner & 4 ? v.channels - 1 : 0);
                is_inside &= at >= data && at < data + samples;
            }
            if (is_inside) return v;
        }
    };
    const auto bytes_of = [](const auto& v) {
        std::set<std::uintptr_t> bytes;
        for (int c = 0; c < v.channels; ++c)
            for (int y = 0; y < v.height; ++y)
                for (int x = 0; x < v.width; ++x)
                    for (std::size_t b = 0; b < sizeof(v(0, 0, 0)); ++b)
                        bytes.insert(reinterpret_cast<std::uintptr_t>(&v(x, y, c)) + b);
        return bytes;
    };
    for (int round = 0; round < 3000; ++round) {
        const auto a = any_view(memory.data(), 400);
        const auto b = any_view(reinterpret_cast<std::uint8_t*>(memory.data()), 1600);
        const auto of_a = bytes_of(a), of_b = bytes_of(b);
        bool expected = false;
        for (const auto byte : of_b) expected |= of_a.count(byte) > 0;
        ASSERT_EQ(share(a, b), expected) << round;
        shared += expected;
    }
    EXPECT_GT(shared, 300);
    EXPECT_LT(shared, 2700);
}

TEST(Overlap, IsRefusedByEveryFilterFromAViewToAView) {
    Image<float> image(12, 9, 2);
    const View<float> a = cropped(image.view(), 0, 0, 8, 8), b = cropped(image.view(), 3, 1, 8, 8);
    const View<float> beside = cropped(image.view(), 8, 0, 4, 9);
    const Grid grid{{8}, {8}};
    const Bank bank = make_bank(tent(), Axis{8}, Axis{8}, Edge::clamp);
    EXPECT_THROW(apply(bank, a, b), Error);
    EXPECT_THROW(apply_scalar(bank, a, b), Error);
    EXPECT_THROW(apply_adjoint(bank, a, b), Error);
    EXPECT_THROW(Resizer(grid, grid, 2).run({a, 0, {}}, {b, 0, {}, {}}), Error);
    EXPECT_THROW(Resizer(grid, grid, 2).run({a, 0, {}}, {a, 0, {}, {}}), Error);
    const auto terms = bank_terms(Taps{0, {1}}, grid, grid, Edge::clamp, Edge::clamp);
    EXPECT_THROW(term_filter(terms, true).run({a, 0, {}}, {b, 0, {}, {}}, {}), Error);
    const ConvolutionWeights weights{Terms{{{1.0}, {1.0}}}, 0, 0};
    for (const Method method : {Method::direct, Method::fft}) {
        const Convolution convolution(weights, 8, 8, {.method = method});
        EXPECT_THROW(convolution.run({a, 0, {}}, {b, 0, {}, {}}), Error) << name_of(method);
        EXPECT_THROW(boosted(convolution, 2, true).run({a, 0, {}}, {b, 0, {}, {}}), Error);
    }
    Image<std::uint8_t> codes(8, 8);
    EXPECT_THROW(resize_bytes_scalar(make_byte_banks(bank, bank), codes.view(), 0, codes.view(), 0), Error);
    EXPECT_NO_THROW(Resizer(grid, {{4}, {8}}, 2).run({a, 0, {}}, {cropped(beside, 0, 0, 4, 8), 0, {}, {}}));
}

}  // namespace
}  // namespace bandlimit
