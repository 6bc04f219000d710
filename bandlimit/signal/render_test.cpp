#include "bandlimit/signal/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/sanitized_test.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

double largest_difference(const Image<float>& a, const Image<float>& b, int border = 0) {
    double largest = 0;
    for (int y = border; y < a.height() - border; ++y)
        for (int x = border; x < a.width() - border; ++x)
            largest = std::max(largest, std::abs(double(a.view()(x, y)) - double(b.view()(x, y))));
    return largest;
}

Grid grid_of(int width, int height) { return {{width, 0, double(width)}, {height, 0, double(height)}}; }

/// What is added by rounding to float, and by float sums of the taps of a supersampled pixel with kernels whose weights
/// sum to 1 and whose magnitudes sum to below 2, along both axes.
double float_bound(int taps) { return 2 * (taps + 3) * 0x1p-24 * 2; }

TEST(Render, PointTakesTheCentres) {
    const Image<float> image = render(ramp({10, 4}), 10, 4);
    for (int x = 0; x < 10; ++x) EXPECT_FLOAT_EQ(image.view()(x, 2), 0.05f + 0.1f * static_cast<float>(x));
}

TEST(Render, AConstantSurvivesEveryKernel) {
    for (const Kernel& kernel : {box(), tent(), mitchell(), lanczos(3), gaussian(0.5), kaiser(6, 8), jinc_lanczos(3)})
        for (const int samples : {1, 3, 8}) {
            const Image<float> image = render(constant(0.7), 9, 7, Sampling::supersampled(kernel, samples));
            for (int y = 0; y < 7; ++y)
                for (int x = 0; x < 9; ++x)
                    EXPECT_NEAR(image.view()(x, y), 0.7f, 2e-6f) << kernel.name << " " << samples;
        }
}

TEST(Render, ExactIsTheLimitOfSupersampling) {
    const Frame f{24, 20};
    const std::vector<Signal> signals{zone_plate(f),
                                      chirp(f, {.angle = 33}),
                                      chirp(f),
                                      step_edge(f, {.angle = 17}),
                                      stripes({.period = 2.7, .angle = 20, .duty = 0.3}),
                                      stripes({.period = 2.7, .angle = 20, .sinusoid = true}),
                                      checkerboard({.size = 2.3}),
                                      rectangle(f, {.cell = Cell{1.25, 2.6, 9.4, 7.1}}),
                                      disc(f, {.radius = 7.3}),
                                      ramp(f, {.angle = 130, .length = 11}),
                                      impulse(f, {.corner = Point{3.2, 4.6}}),
                                      thin_line(f, {.angle = 62, .width = 0.4})};
    const std::string known = exact_signals();
    for (const Signal& signal : signals) {
        const Image<float> exact = render(signal, 24, 20, Sampling::exact());
        const bool smooth = signal.product || signal.name == "chirp" || signal.name == "ramp";
        double coarse = 0;
        for (const int samples : {8, 64}) {
            const Image<float> sampled = render(signal, 24, 20, Sampling::supersampled(box(), samples));
            const double difference = largest_difference(exact, sampled);
            // The midpoint rule is of second order (|f''| <= 1/2 (2 pi / 2.7)^2 or so here); a jump costs up to a row
            // of samples for each outline in the pixel, of which there are at most two.
            const double bound = smooth ? 1.0 / samples / samples : 2.0 / samples;
            EXPECT_LT(difference, bound + float_bound(samples)) << signal.name << " " << samples;
            if (samples == 8) coarse = difference;
            else EXPECT_LT(difference, coarse + float_bound(samples)) << signal.name;
        }
        EXPECT_NE(known.find(signal.name), std::string::npos) << signal.name << " is not listed";
    }
}

TEST(Render, ExactUnderAnyKernelIsTheLimitOfSupersampling) {
    const Frame f{24, 20};
    const std::vector<Signal> signals{zone_plate(f), chirp(f, {.angle = 90}), chirp(f, {.exponential = true}),
                                      stripes({.period = 4.3, .angle = 20, .sinusoid = true})};
    for (const Signal& signal : signals)
        for (const Kernel& kernel :
             {box(), tent(), quadratic_bspline(), mitchell(), lanczos(3), gaussian(0.6), kaiser(6, 8)}) {
            if (is_sanitized && kernel.radius > 1) continue;  // the same code for longer
            const Image<float> exact = render(signal, 24, 20, Sampling::exact(kernel));
            const Image<float> sampled = render(signal, 24, 20, Sampling::supersampled(kernel, 32));
            const int taps = static_cast<int>(2 * kernel.radius * 32);
            // Sums over regular samples converge fast for smooth kernels, and as their square where a kernel has a
            // kink.
            EXPECT_LT(largest_difference(exact, sampled), 1e-3 + float_bound(taps))
                << signal.name << " " << kernel.name;
        }
}

TEST(Render, ExactUnderAKernelScalesAWaveByItsTransform) {
    // The transform of tent is sinc^2, along each axis.
    for (const double frequency : {0.2, 20.3}) {
        const Signal wave = stripes({.period = 1 / frequency, .angle = 30, .sinusoid = true});
        const Image<float> seen = render(wave, 16, 16, Sampling::exact(tent()));
        const double fx = std::cos(std::numbers::pi / 6) * frequency, fy = frequency / 2;
        const double gain = std::pow(sinc(fx) * sinc(fy), 2);
        const Image<float> expected = render(with_range(wave, 0.5 - gain / 2, 0.5 + gain / 2), 16, 16);
        EXPECT_LT(largest_difference(seen, expected), 1.2e-7);  // two roundings to float
    }
}

TEST(Render, SupersamplingGoesOnBeyondTheBorder) {
    // A kernel that reaches 2.4 pixels out from the first pixel centre's cell, on a ramp that goes on there.
    const Signal slope = ramp({16, 16}, {.angle = 20, .length = 64});
    const Image<float> seen = render(slope, 16, 16, Sampling::supersampled(kaiser(2.9, 3), 8));
    EXPECT_LT(largest_difference(seen, render(slope, 16, 16)), float_bound(48));
}

TEST(Render, ManyBlocksAreOneImage) {
    // 256 samples to the pixel make blocks of 64 rows.
    const Signal slope = ramp({2, 80}, {.angle = 90});
    const Image<float> seen = render(slope, 2, 80, Sampling::supersampled(box(), 256));
    EXPECT_LT(largest_difference(seen, render(slope, 2, 80)), float_bound(256));
}

TEST(Render, AnIdealLowPassKeepsOrRemovesAWave) {
    const Kernel ideal = kaiser(40, 10);
    const auto wave = [](double period) { return stripes({.period = period, .sinusoid = true}); };
    // 0.4 and 0.6 cycles per pixel; the transition of this kernel lies between, with ripples of 1e-5.
    const Image<float> kept = render(wave(2.5), 12, 4, Sampling::exact(ideal));
    EXPECT_LT(largest_difference(kept, render(wave(2.5), 12, 4)), 1e-5);
    const Image<float> removed = render(wave(1 / 0.6), 12, 4, Sampling::exact(ideal));
    EXPECT_LT(largest_difference(removed, render(constant(0.5), 12, 4)), 1e-5);
}

TEST(Render, HalfTheSizeIsTheMeanOfFour) {
    const Signal signal = disc({16, 16}, {.radius = 5.3});
    const Image<float> full = render(signal, 16, 16, Sampling::exact());
    Image<float> half(8, 8);
    render(signal, {{8, 0, 16}, {8, 0, 16}}, Sampling::exact(), half.view());
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const auto at = [&](int dx, int dy) { return full.view()(2 * x + dx, 2 * y + dy); };
            EXPECT_NEAR(half.view()(x, y), (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4, 2e-7f);
        }
}

TEST(Render, FlippedAxesFlipTheImage) {
    const Signal signal = step_edge({12, 10}, {.angle = 30});
    for (const Sampling& sampling : {Sampling::point(), Sampling::exact(), Sampling::supersampled(tent(), 4)}) {
        const Image<float> upright = render(signal, 12, 10, sampling);
        Image<float> flipped(12, 10);
        render(signal, {{12, 12, 0}, {10, 0, 10}}, sampling, flipped_x(flipped.view()));
        EXPECT_LT(largest_difference(upright, flipped), 1e-6);
    }
}

TEST(Render, PartsHaveTheBitsOfTheWholeForAnyNumberOfThreads) {
    const Signal plate = zone_plate({37, 41}), star = siemens_star({37, 41});
    const Grid grid = grid_of(37, 41);
    for (const Sampling& sampling : {Sampling::point(), Sampling::exact(), Sampling::supersampled(box(), 2),
                                     Sampling::supersampled(lanczos(3), 4), Sampling::supersampled(jinc_lanczos(2), 2)})
        for (const Signal* signal : {&plate, &star}) {
            if (sampling.mode == Sampling::Mode::exact && signal == &star) continue;
            const Image<float> whole = render(*signal, 37, 41, sampling, {1});
            EXPECT_EQ(largest_difference(whole, render(*signal, 37, 41, sampling, {3})), 0);
            Image<float> parts(37, 41);
            for (const auto& [begin, end] : {std::pair{0, 9}, std::pair{9, 10}, std::pair{10, 41}})
                render(*signal, {grid.x, grid.y.cells(begin, end)}, sampling,
                       cropped(parts.view(), 0, begin, 37, end - begin), {2});
            EXPECT_EQ(largest_difference(whole, parts), 0) << signal->name << " " << sampling.kernel.name;
        }
}

TEST(Render, OnePixelAndOneSample) {
    EXPECT_EQ(render(ramp({1, 1}), 1, 1, Sampling::supersampled(box(), 1)).view()(0, 0), 0.5f);
    EXPECT_EQ(render(ramp({1, 1}), 1, 1, Sampling::exact()).view()(0, 0), 0.5f);
}

/// The message of the Error that `run` throws.
template <class Run>
std::string refusal(Run run) {
    try {
        run();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Render, RefusesWhatHasNoExactFormAndNamesWhatHas) {
    const Frame f{8, 8};
    for (const Signal& signal : {siemens_star(f), white_noise(), band_limited_noise(8, 8)}) {
        const std::string text = refusal([&] { render(signal, 8, 8, Sampling::exact()); });
        EXPECT_NE(text.find(signal.name), std::string::npos) << text;
        EXPECT_NE(text.find("zoneplate"), std::string::npos) << text;
        EXPECT_NE(text.find("line"), std::string::npos) << text;
        EXPECT_EQ(exact_signals().find(signal.name), std::string::npos);
    }
    EXPECT_NE(refusal([&] { render(disc(f), 8, 8, Sampling::exact(mitchell())); }).find("mitchell"), std::string::npos);
    EXPECT_NE(refusal([&] { render(zone_plate(f), 8, 8, Sampling::exact(jinc_lanczos(2))); }).find("jinc2"),
              std::string::npos);
}

TEST(Render, MemoryGrowsWithTheWidthAlone) {
    const Sampling sampling = Sampling::supersampled(lanczos(3));
    EXPECT_LT(rendering_bytes(grid_of(16384, 16384), sampling), 256u << 20);
    EXPECT_EQ(rendering_bytes(grid_of(16384, 1 << 20), sampling), rendering_bytes(grid_of(16384, 16384), sampling));
    // The rows that one output row is made of are held, whatever they take.
    EXPECT_GT(rendering_bytes(grid_of(1 << 24, 1), sampling), std::uint64_t{4} * 7 * 8 * 8 * (1 << 24));
}

TEST(Render, RefusesWrongArguments) {
    const Signal s = constant(1);
    EXPECT_THROW(render(s, 0, 5), Error);
    EXPECT_THROW(render(s, 5, 5, Sampling::supersampled(box(), 0)), Error);
    EXPECT_THROW(render(s, 5, 5, Sampling::supersampled(box(), 1025)), Error);
    EXPECT_THROW(render(s, 5, 5, Sampling::supersampled(nearest())), Error);
    Image<float> image(4, 4);
    EXPECT_THROW(render(s, grid_of(4, 5), {}, image.view()), Error);
    EXPECT_THROW(render(s, {{4, 0, 0}, {4, 0, 4}}, {}, image.view()), Error);
    EXPECT_THROW(render(s, {{4, 0, std::nan("")}, {4, 0, 4}}, {}, image.view()), Error);
}

}  // namespace
}  // namespace bandlimit
