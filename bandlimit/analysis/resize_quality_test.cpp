// How near resizing comes to an ideal low-pass, on the zone plate that resamplers are compared by.
#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/signal/render.h"

namespace bandlimit {
namespace {

constexpr int plate_size = 1024;

/// sin(pi r^2 / size), amplitude 0.45 about 1/2: Nyquist at the borders. Pixels are means of 8 x 8 points, as a
/// camera's would be: point samples hold more of what is hard, and give 2 dB less.
const Image<float>& plate() {
    static const Image<float> image =
        render(with_range(zone_plate({plate_size, plate_size}, {.phase = -0.25}), 0.05, 0.95), plate_size, plate_size,
               Sampling::supersampled(box(), 8));
    return image;
}

struct Case {
    const char* name;
    int size;
    double source;  ///< the first so many source samples along each axis become `size`
};
constexpr Case halve{"/ 2", plate_size / 2, plate_size}, by_3_7{"/ 3.7", 276, 276 * 3.7},
    twice{"x 2", 2 * plate_size, plate_size};

int border(const Case& c) { return static_cast<int>(std::lround(c.size * 0.05)); }

/// Resamples stored samples that mean themselves into `to`.
void resize(const AnyConstView& from, const AnyView& to, const Case& c, const Kernel& kernel) {
    const Axis src{plate_size, 0, plate_size}, dst{c.size, 0, c.source};
    const Resizer resizer({src, src}, {dst, dst}, 1, {.reconstruction = kernel, .edge = Edge::reflect});
    resizer.run({from, 0, {}}, {to, 0, {}, {}});
}

Image<float> resized(const Case& c, const Kernel& kernel) {
    Image<float> out(c.size, c.size);
    resize(plate().view(), out.view(), c, kernel);
    return out;
}

/// What is left of the plate below the Nyquist frequency of both grids, and nothing else: a sinc of 40 lobes a side.
Image<float> ideal(const Case& c) { return resized(c, kaiser(40, 10)); }

/// Resized from 8-bit codes to 8-bit codes.
Image<float> resized_codes(const Case& c, const Kernel& kernel) {
    Image<std::uint8_t> in(plate_size, plate_size), out(c.size, c.size);
    for (int y = 0; y < plate_size; ++y)
        for (int x = 0; x < plate_size; ++x)
            in.view()(x, y) = static_cast<std::uint8_t>(std::lround(plate().view()(x, y) * 255));
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
    for (const auto& [at, with_box, with_catmull_rom, with_lanczos3] :
         {Row{halve, 21.335, 24.927, 27.478}, Row{by_3_7, 26.315, 29.601, 32.067},
          Row{twice, 17.595, 23.415, 27.780}}) {
        const Image<float> exact = ideal(at);
        const auto quality = [&](const Kernel& kernel) {
            return psnr(resized(at, kernel).view(), exact.view(), border(at));
        };
        EXPECT_NEAR(quality(box()), with_box, 1e-3) << at.name;
        EXPECT_NEAR(quality(catmull_rom()), with_catmull_rom, 1e-3) << at.name;
        EXPECT_NEAR(quality(lanczos(3)), with_lanczos3, 1e-3) << at.name;
    }
}

TEST(ResizeQuality, CodesLoseAtMostATwentiethOfADecibel) {
    for (const Case& at : {halve, by_3_7, twice}) {
        const Image<float> exact = ideal(at);
        for (const Kernel& kernel : {box(), catmull_rom(), lanczos(3)}) {
            const double floats = psnr(resized(at, kernel).view(), exact.view(), border(at)),
                         codes = psnr(resized_codes(at, kernel).view(), exact.view(), border(at));
            EXPECT_GT(codes, floats - 0.05) << at.name << ' ' << kernel.name;
        }
    }
}

}  // namespace
}  // namespace bandlimit
