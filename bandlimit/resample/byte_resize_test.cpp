#include "bandlimit/resample/byte_resize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/operator_checker_test.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

std::vector<Kernel> kernels() { return {nearest(), box(), tent(), catmull_rom(), mitchell(), lanczos(3), lanczos(5)}; }

Image<std::uint8_t> noise(Random& random, int width, int height, int channels, Layout layout) {
    Image<std::uint8_t> image(width, height, channels, layout);
    // Runs of the extreme codes reach the largest sums.
    const bool extreme = random.integer(0, 2) == 0;
    for (std::ptrdiff_t i = 0; i < std::ptrdiff_t{width} * height * channels; ++i)
        image.view().data[i] = static_cast<std::uint8_t>(extreme ? 255 * random.integer(0, 1) : random.integer(0, 255));
    return image;
}

/// A view of the same samples seen from another side.
template <class T>
View<T> turned(View<T> v, int how) {
    if (how & 1) v = {v.data + (v.height - 1) * v.dy, v.width, v.height, v.channels, v.dx, -v.dy, v.dc};
    if (how & 2) v = {v.data + (v.width - 1) * v.dx, v.width, v.height, v.channels, -v.dx, v.dy, v.dc};
    return v;
}

bool all_fit(const ByteBank& bank) {
    int fitting = 0;
    for_each_run(bank, 0, bank.bank->output_count(),
                 [&](int begin, int end, bool fits) { fitting += fits ? end - begin : 0; });
    return fitting == bank.bank->output_count();
}

std::string difference(View<const std::uint8_t> a, View<const std::uint8_t> b) {
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < a.channels; ++c)
                if (a(x, y, c) != b(x, y, c))
                    return message("at ", x, ' ', y, ' ', c, ": ", int{a(x, y, c)}, " for ", int{b(x, y, c)});
    return {};
}

TEST(ResizeBytes, GivesTheCodesOfItsDefinitionOnEveryTarget) {
    Random random(1);
    for (int run = 0; run < 150; ++run) {
        int width = random.integer(1, 300), height = random.integer(1, 90);
        const int new_width = random.integer(1, run % 3 ? 200 : 600), new_height = random.integer(1, 100);
        const int channels = random.integer(1, 6);
        if (run % 7 == 1) width = 2 * new_width, height = 2 * new_height;  // means of 2 x 2
        const Kernel kernel = kernels()[static_cast<std::size_t>(run) % kernels().size()];
        const Edge edge = all_edges()[static_cast<std::size_t>(run / 7) % all_edges().size()];
        const auto layout = [&] { return random.integer(0, 2) == 0 ? Layout::planar : Layout::interleaved; };
        // The same interval, flipped, or what lies beside the picture.
        const Axis places[] = {{new_width, 1, 0},   {new_width, 0, 1},      {new_width, 0, 1},  {new_width, 0, 1},
                               {new_width, 1.2, 2}, {new_width, -0.3, 0.5}, {new_width, -3, -1}};
        const bool reads_outside = edge != Edge::zero && edge != Edge::renormalize;
        const Axis to_x = places[run % (reads_outside ? 7 : 4)];
        const Bank x = make_bank(kernel, {width}, to_x, edge);
        const Bank y = make_bank(kernel, {height}, {new_height, 0, run % 5 ? 1 : 0.7}, edge);
        const ByteBanks banks = make_byte_banks(x, y);
        ASSERT_TRUE(all_fit(banks.x) && all_fit(banks.y));
        const Image<std::uint8_t> src = noise(random, width, height, channels, layout());
        Image<std::uint8_t> expected(new_width, new_height, channels), found(new_width, new_height, channels, layout());
        const View<const std::uint8_t> from = turned(src.view(), run);
        resize_bytes_scalar(banks, from, 0, expected.view(), 0);
        const BytePlan plan = make_byte_plan(banks);
        for_each_target([&](Target) {
            const int cut = random.integer(0, new_height);
            RunMonitor nobody;
            const View<std::uint8_t> to = turned(found.view(), run / 4);
            if (cut > 0) resize_bytes(plan, from, 0, to, 0, 0, cut, nobody);
            if (cut < new_height) {  // with the rows alone that it needs
                const IndexRange rows = stored_indices(indices_read(y, cut, new_height), height, edge);
                resize_bytes(plan, cropped(from, 0, rows.begin, width, rows.end - rows.begin), rows.begin,
                             cropped(to, 0, cut, new_width, new_height - cut), cut, cut, new_height, nobody);
            }
            ASSERT_EQ(difference(to, expected.view()), "")
                << kernel.name << ' ' << name_of(edge) << ' ' << width << 'x' << height << 'x' << channels << " to "
                << new_width << 'x' << new_height;
        });
    }
}

TEST(ResizeBytes, WideImagesAreThoseOfTheirDefinition) {
    Random random(3);
    for (const Edge edge : all_edges())
        for (const int channels : {1, 3, 4}) {
            const int width = random.integer(5000, 9000), height = 120, new_width = random.integer(2000, 4000);
            const Bank x = make_bank(lanczos(3), {width}, {new_width}, edge);
            const Bank y = make_bank(lanczos(3), {height}, {9}, edge);
            const ByteBanks banks = make_byte_banks(x, y);
            const BytePlan plan = make_byte_plan(banks);
            EXPECT_EQ(plan.strips_of_four.size() > 2, edge != Edge::wrap);
            const Image<std::uint8_t> src = noise(random, width, height, channels, Layout::interleaved);
            Image<std::uint8_t> expected(new_width, 9, channels), found(new_width, 9, channels, Layout::interleaved);
            resize_bytes_scalar(banks, src.view(), 0, expected.view(), 0);
            RunMonitor nobody;
            resize_bytes(plan, src.view(), 0, found.view(), 0, 0, 9, nobody);
            ASSERT_EQ(difference(found.view(), expected.view()), "") << name_of(edge) << ' ' << channels;
        }
}

TEST(ResizeBytes, KeepsConstantsExactly) {
    for (const Kernel& kernel : kernels())
        for (const int size : {5, 37, 80}) {
            const Bank bank = make_bank(kernel, {37}, {size}, Edge::renormalize);
            const ByteBanks banks = make_byte_banks(bank, bank);
            for (int code = 0; code < 256; ++code) {
                Image<std::uint8_t> src(37, 37), dst(size, size);
                std::fill_n(src.view().data, 37 * 37, static_cast<std::uint8_t>(code));
                resize_bytes_scalar(banks, src.view(), 0, dst.view(), 0);
                for (int i = 0; i < size * size; ++i) ASSERT_EQ(dst.view().data[i], code) << kernel.name;
            }
        }
}

TEST(ResizeBytes, ErrsByOneCodeAtMost) {
    Random random(2);
    for (const Kernel& kernel : kernels())
        for (const auto& [width, height] : {std::pair{100, 90}, {50, 45}, {27, 24}, {200, 180}, {33, 250}}) {
            const Image<std::uint8_t> src = noise(random, 100, 90, 3, Layout::interleaved);
            Image<float> values(100, 90, 3, Layout::interleaved), exact(width, height, 3, Layout::interleaved);
            for (int i = 0; i < 100 * 90 * 3; ++i) values.view().data[i] = float(src.view().data[i]);
            Image<std::uint8_t> codes(width, height, 3, Layout::interleaved);
            const Resizer resizer({{100}, {90}}, {{width}, {height}}, 3, {.reconstruction = kernel});
            resizer.run({View<const float>(values.view()), 0, {}}, {exact.view(), 0, {}, {}});
            resizer.run({View<const std::uint8_t>(src.view()), 0, {}}, {codes.view(), 0, {}, {}});
            for (int i = 0; i < width * height * 3; ++i) {
                const float clamped = std::clamp(exact.view().data[i], 0.0f, 255.0f);
                // Half a code of the last rounding; weights and the rows between add a tenth.
                ASSERT_LT(std::abs(clamped - float(codes.view().data[i])), 0.65f) << kernel.name;
            }
        }
}

TEST(ByteBank, LeavesToFloatsWhatMayOverflow) {
    const Taps sharpening{-1, {-0.5, 2, -0.5}};
    const Bank bank = make_bank(sharpening, 20, Edge::clamp), plain = make_bank(tent(), {20}, {20}, Edge::clamp);
    const ByteBanks banks = make_byte_banks(bank, plain), turned = make_byte_banks(plain, bank);
    for (int i = 0; i < 20; ++i) {
        EXPECT_FALSE(banks.x.fits(i) || turned.y.fits(i));
        EXPECT_TRUE(banks.y.fits(i) && turned.x.fits(i));
    }
}

TEST(ByteBank, DecidesForEachRowAlone) {
    // Steps of little more than 2: of the pairs of a box some come to 1, others do not.
    const Bank whole = make_bank(box(), {517}, {258}, Edge::renormalize);
    const ByteBanks banks = make_byte_banks(whole, whole);
    bool has_13 = false, has_14 = false;
    for (int first = 0; first < 258; first += 43) {
        const Bank bank = make_bank(box(), {517}, Axis{258}.cells(first, first + 43), Edge::renormalize);
        const ByteBanks part = make_byte_banks(bank, bank);
        for (int i = 0; i < 43; ++i) {
            ASSERT_EQ(part.y.bits_of(i), banks.y.bits_of(first + i));
            ASSERT_EQ(part.x.bits_of(i), banks.x.bits_of(first + i));
            has_13 |= part.y.bits_of(i) == 13, has_14 |= part.y.bits_of(i) == 14;
        }
    }
    EXPECT_TRUE(has_13 && has_14);
}

}  // namespace
}  // namespace bandlimit
