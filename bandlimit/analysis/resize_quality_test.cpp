// How near resizing comes to an ideal low-pass, on the zone plate that resamplers are compared by.
#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/analysis/zone_plate_test.h"

namespace bandlimit::plate {
namespace {

/// Resized from 8-bit codes to 8-bit codes.
Image<float> resized_codes(const Case& c, const Kernel& kernel) {
    Image<std::uint8_t> in(size, size), out(c.size, c.size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            in.view()(x, y) = static_cast<std::uint8_t>(std::lround(image().view()(x, y) * 255));
    resize(in.view(), out.view(), c, kernel);
    Image<float> values(c.size, c.size);
    for (int y = 0; y < c.size; ++y)
        for (int x = 0; x < c.size; ++x) values.view()(x, y) = static_cast<float>(out.view()(x, y)) / 255;
    return values;
}

// The numbers were computed apart from the library, in double and as dense matrices: same construction, other code.
// What is published for other resamplers (Lanczos-3: 27.48, 32.04 and 27.78 dB) lies within 0.03 dB of them.
TEST(ResizeQuality, OfTheZonePlateIsWhatDoublePrecisionGives) {
    struct Row {
        Case at;
        double box, catmull_rom, lanczos3;
    };
    for (const Row& row : {Row{halve, 21.335, 24.927, 27.478}, Row{by_3_7, 26.315, 29.601, 32.067},
                           Row{twice, 17.595, 23.415, 27.780}}) {
        const Image<float> exact = ideal(row.at);
        const auto quality = [&](const Kernel& kernel) {
            return psnr(resized(row.at, kernel).view(), exact.view(), row.at.border());
        };
        EXPECT_NEAR(quality(box()), row.box, 1e-3) << row.at.name;
        EXPECT_NEAR(quality(catmull_rom()), row.catmull_rom, 1e-3) << row.at.name;
        EXPECT_NEAR(quality(lanczos(3)), row.lanczos3, 1e-3) << row.at.name;
    }
}

TEST(ResizeQuality, OfTheDefaultKernelsIsAboveThatOfLanczos) {
    for (const auto& [at, kernel, decibels] :
         {std::tuple{halve, shrink3(), 28.46}, {by_3_7, shrink3(), 33.03}, {twice, grow3(), 30.51}})
        EXPECT_NEAR(psnr(resized(at, kernel).view(), ideal(at).view(), at.border()), decibels, 0.01) << at.name;
}

TEST(ResizeQuality, CodesLoseAtMostATwentiethOfADecibel) {
    for (const Case& at : {halve, by_3_7, twice}) {
        const Image<float> exact = ideal(at);
        for (const Kernel& kernel : {box(), catmull_rom(), lanczos(3), shrink3(), grow3()}) {
            const double floats = psnr(resized(at, kernel).view(), exact.view(), at.border()),
                         codes = psnr(resized_codes(at, kernel).view(), exact.view(), at.border());
            EXPECT_GT(codes, floats - 0.05) << at.name << ' ' << kernel.name;
        }
    }
}

}  // namespace
}  // namespace bandlimit::plate
