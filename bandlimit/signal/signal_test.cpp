#include "bandlimit/signal/signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/signal/render.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double sum_of(const Image<float>& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += static_cast<double>(image.view()(x, y));
    return sum;
}

/// The total of the exact means of the cells, in double precision.
double total(const Signal& signal, int width, int height) {
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) sum += signal.mean({double(x), double(y), x + 1.0, y + 1.0});
    return sum;
}

/// Every kind of signal, with options that are not the defaults.
std::vector<Signal> all_signals(const Frame& f) {
    const int width = static_cast<int>(f.width), height = static_cast<int>(f.height);
    return {zone_plate(f, {.max_frequency = 0.4, .phase = 0.1}),
            siemens_star(f, {.spokes = 9, .phase = 0.3}),
            siemens_star(f, {.spokes = 9, .phase = 0.3, .sinusoid = true}),
            chirp(f),
            chirp(f, {.angle = 33, .phase = 0.2}),
            chirp(f, {.from = 0.4, .to = 0.01, .exponential = true, .angle = 90}),
            step_edge(f, {.angle = 17, .offset = 0.3}),
            stripes({.period = 5.5, .angle = 20, .phase = 0.4, .duty = 0.3}),
            stripes({.period = 5.5, .angle = 20, .phase = 0.4, .sinusoid = true}),
            checkerboard({.size = 2.5}),
            rectangle(f, {.cell = Cell{1.25, 2.5, 9.5, 7.125}}),
            disc(f, {.center = Point{7.2, 6.1}, .radius = 4.3}),
            ramp(f, {.angle = 130, .length = 11}),
            impulse(f, {.corner = Point{3.25, 4.5}}),
            thin_line(f, {.angle = 62, .offset = -1.3, .width = 0.4}),
            white_noise({.seed = 3}),
            band_limited_noise(width, height, {.seed = 4}),
            constant(0.3)};
}

TEST(Signals, AreFiniteAndInRangeEverywhere) {
    Random random(1);
    for (const Signal& signal : all_signals({16, 12}))
        for (int k = 0; k < 2000; ++k) {
            const double x = random.uniform(-20, 36), y = random.uniform(-20, 32);
            const double value = signal.value(k % 3 ? x : std::floor(x), k % 5 ? y : std::floor(y));
            EXPECT_TRUE(std::isfinite(value)) << signal.name;
            // Noise of RMS 0.1 stays within five of them here.
            EXPECT_GE(value, -1e-15) << signal.name;
            EXPECT_LE(value, 1 + 1e-15) << signal.name;
        }
}

TEST(Signals, TheMeanOfACellIsThatOfItsQuarters) {
    Random random(2);
    for (const Signal& signal : all_signals({16, 12})) {
        if (!signal.mean) continue;
        for (int k = 0; k < 200; ++k) {
            const double x = random.uniform(-4, 18), y = random.uniform(-4, 14);
            const double w = random.uniform(0.1, 2), h = random.uniform(0.1, 2);
            const double quarters = signal.mean({x, y, x + w, y + h}) + signal.mean({x + w, y, x + 2 * w, y + h}) +
                                    signal.mean({x, y + h, x + w, y + 2 * h}) +
                                    signal.mean({x + w, y + h, x + 2 * w, y + 2 * h});
            // Differences of positions of some 20 pixels, over parts of 0.1: 200 roundings of 1e-16, or few times that.
            EXPECT_NEAR(signal.mean({x, y, x + 2 * w, y + 2 * h}), quarters / 4, 1e-12) << signal.name;
        }
    }
}

TEST(Signals, TheMeanOfASmallCellIsTheValue) {
    Random random(3);
    for (const Signal& signal : all_signals({16, 12})) {
        if (!signal.mean) continue;
        int differ = 0;
        for (int k = 0; k < 300; ++k) {
            const double x = random.uniform(-4, 20), y = random.uniform(-4, 16), e = 1e-5;
            // Slopes are below 4 per pixel; only cells that an outline crosses may differ.
            differ += std::abs(signal.mean({x - e, y - e, x + e, y + e}) - signal.value(x, y)) > 4 * e;
        }
        EXPECT_LE(differ, 1) << signal.name;
    }
}

TEST(Signals, AProductIsTheSignal) {
    Random random(4);
    int products = 0;
    for (const Signal& s : all_signals({16, 12})) {
        if (!s.product) continue;
        ++products;
        for (int k = 0; k < 100; ++k) {
            const double x = random.uniform(-4, 20), y = random.uniform(-4, 16);
            const double value = s.product->offset + (s.product->x.value(x) * s.product->y.value(y)).real();
            EXPECT_NEAR(value, s.value(x, y), 1e-13) << s.name;
        }
    }
    EXPECT_EQ(products, 4);
}

TEST(Signals, WavesTellTheirLocalFrequency) {
    for (const Signal& s : all_signals({16, 12})) {
        if (!s.product) continue;
        for (const Wave& wave : {s.product->x, s.product->y})
            for (double x = 0.3; x < 12; x += 0.7) {
                constexpr double h = 1e-5;
                const double periods = std::arg(wave.value(x + h) / wave.value(x - h)) / (2 * pi);
                EXPECT_NEAR(std::abs(periods) / (2 * h), wave.frequency(x), 1e-8) << s.name;
            }
    }
}

TEST(Signals, WithRangeMapsValuesMeansAndProducts) {
    for (const Signal& signal : all_signals({16, 12})) {
        const Signal mapped = with_range(signal, 0.25, -1);
        const auto map = [](double v) { return 0.25 - 1.25 * v; };
        EXPECT_NEAR(mapped.value(3.3, 4.4), map(signal.value(3.3, 4.4)), 1e-14) << signal.name;
        EXPECT_EQ(bool(mapped.mean), bool(signal.mean));
        if (signal.mean) {
            EXPECT_NEAR(mapped.mean({3, 4, 4, 5}), map(signal.mean({3, 4, 4, 5})), 1e-14) << signal.name;
        }
        ASSERT_EQ(mapped.product.has_value(), signal.product.has_value());
        if (!signal.product) continue;
        const WaveProduct& p = *mapped.product;
        EXPECT_NEAR(p.offset + (p.x.value(3.3) * p.y.value(4.4)).real(), mapped.value(3.3, 4.4), 1e-14) << signal.name;
    }
}

TEST(ZonePlate, FrequenciesAtCentreAndBorder) {
    const Frame frame{64, 48};
    const Signal plate = zone_plate(frame);
    EXPECT_EQ(plate.value(32, 24), 1);
    EXPECT_EQ(plate.product->x.frequency(32), 0);
    EXPECT_DOUBLE_EQ(plate.product->x.frequency(0), 0.5);
    EXPECT_DOUBLE_EQ(plate.product->x.frequency(64), 0.5);
    EXPECT_DOUBLE_EQ(plate.product->y.frequency(0), 0.375);
    // The number of periods from the centre to the border is the mean frequency times the distance: 8, so a crest.
    EXPECT_DOUBLE_EQ(plate.value(64, 24), 1);
    EXPECT_NEAR(zone_plate(frame, {.phase = 0.5}).value(32, 24), 0, 1e-15);
    EXPECT_NEAR(zone_plate(frame, {.phase = 0.25}).value(32, 24), 0.5, 1e-15);
}

TEST(ZonePlate, IsRoundAndSymmetric) {
    const Signal plate = zone_plate({40, 40});
    for (double angle = 0; angle < 2 * pi; angle += 0.3)
        EXPECT_NEAR(plate.value(20 + 13.7 * std::cos(angle), 20 + 13.7 * std::sin(angle)), plate.value(33.7, 20),
                    1e-12);
    for (const Sampling& sampling : {Sampling::point(), Sampling::exact(), Sampling::supersampled(mitchell(), 4)}) {
        const Image<float> image = render(plate, 40, 40, sampling);
        // Supersampling sums in float in the order of the taps, which a flip reverses.
        const float bound = sampling.mode == Sampling::Mode::supersampled ? 1e-6f : 1e-7f;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                EXPECT_NEAR(image.view()(x, y), image.view()(39 - x, y), bound);
                EXPECT_NEAR(image.view()(x, y), image.view()(x, 39 - y), bound);
                EXPECT_NEAR(image.view()(x, y), image.view()(y, x), bound);
            }
    }
}

TEST(SiemensStar, HasItsSpokes) {
    for (const int spokes : {1, 2, 7, 72}) {
        const Signal star = siemens_star({100, 100}, {.spokes = spokes});
        int rises = 0;
        bool was_bright = true;  // the first spoke lies around angle 0
        for (int k = 1; k < 10000; ++k) {
            const double angle = 2 * pi * k / 10000;
            const bool bright = star.value(50 + 30 * std::cos(angle), 50 + 30 * std::sin(angle)) > 0.5;
            rises += bright && !was_bright;
            was_bright = bright;
        }
        EXPECT_EQ(rises, spokes);
    }
}

TEST(SiemensStar, PhaseTurnsIt) {
    const Signal star = siemens_star({100, 100}, {.spokes = 10, .sinusoid = true});
    const Signal turned = siemens_star({100, 100}, {.spokes = 10, .phase = 0.25, .sinusoid = true});
    const double turn = 2 * pi * 0.25 / 10;
    for (double angle = 0; angle < 6; angle += 0.1)
        EXPECT_NEAR(star.value(50 + 20 * std::cos(angle), 50 + 20 * std::sin(angle)),
                    turned.value(50 + 20 * std::cos(angle + turn), 50 + 20 * std::sin(angle + turn)), 1e-12);
    EXPECT_EQ(star.value(50, 50), 0.5);
    EXPECT_EQ(star.value(0, 0), 0.5);  // outside the radius
}

TEST(SiemensStar, HalfOfItIsBright) {
    const Image<float> star = render(siemens_star({64, 64}, {.spokes = 8}), 64, 64, Sampling::supersampled(box(), 4));
    EXPECT_NEAR(sum_of(star) / (64 * 64), 0.5, 1e-3);
}

TEST(Chirp, FrequencyGoesFromTo) {
    for (const bool exponential : {false, true}) {
        const Signal s = chirp({128, 16}, {.from = 0.02, .to = 0.4, .exponential = exponential});
        EXPECT_DOUBLE_EQ(s.product->x.frequency(0), 0.02);
        EXPECT_NEAR(s.product->x.frequency(64), exponential ? std::sqrt(0.02 * 0.4) : 0.21, 1e-15);
        EXPECT_DOUBLE_EQ(s.product->x.frequency(128), 0.4);
        EXPECT_EQ(s.value(0, 3), 1);
    }
    EXPECT_NEAR(chirp({64, 64}, {.from = 0.1, .to = 0.1, .exponential = true}).value(5, 0), 0, 1e-12);  // half a period
}

TEST(Chirp, IsTheSameTurned) {
    const Signal right = chirp({64, 64}), down = chirp({64, 64}, {.angle = 90}), left = chirp({64, 64}, {.angle = 180});
    const Signal nearly = chirp({64, 64}, {.angle = 1e-9});
    for (double t = 0.5; t < 64; ++t) {
        EXPECT_NEAR(right.value(t, 7), down.value(7, t), 1e-12);
        EXPECT_NEAR(right.value(t, 7), left.value(64 - t, 7), 1e-12);
        // The mean through waves and the mean through one integral across the cell.
        EXPECT_NEAR(right.mean({t, 2, t + 1, 3}), nearly.mean({t, 2, t + 1, 3}), 1e-7);
    }
}

TEST(Chirp, FastOnesAverageOut) {
    const Signal fast = chirp({64, 64}, {.from = 40.3, .to = 40.3, .angle = 33});
    const double turn = 33 * pi / 180, fx = 40.3 * std::cos(turn), fy = 40.3 * std::sin(turn);
    const double gain = std::sin(pi * fx) / (pi * fx) * std::sin(pi * fy) / (pi * fy);
    for (double x = 3; x < 60; x += 4.3)
        EXPECT_NEAR(fast.mean({x, 9, x + 1, 10}) - 0.5, gain * (fast.value(x + 0.5, 9.5) - 0.5), 1e-12);
}

TEST(StepEdge, CoversWhatLiesBeyondIt) {
    EXPECT_NEAR(total(step_edge({16, 12}, {.angle = 0, .offset = 1.25}), 16, 12), 12 * 6.75, 1e-12);
    EXPECT_NEAR(total(step_edge({16, 12}, {.angle = 90, .offset = 1.25}), 16, 12), 16 * 4.75, 1e-12);
    // Through the middle it halves the frame at any angle.
    for (double angle = 0; angle < 360; angle += 7.3)
        EXPECT_NEAR(total(step_edge({16, 12}, {.angle = angle}), 16, 12), 96, 1e-12) << angle;
    EXPECT_EQ(step_edge({16, 12}, {.angle = 0}).value(8, 3), 0.5);
    EXPECT_EQ(step_edge({16, 12}, {.angle = 0}).value(9, 3), 1);
}

TEST(Stripes, TheMeanIsTheDuty) {
    for (const double duty : {0.0, 0.25, 0.6, 1.0})
        for (const double period : {0.25, 4.0, 8.0}) {
            EXPECT_NEAR(total(stripes({.period = period, .phase = 0.3, .duty = duty}), 16, 4) / 64, duty, 1e-12);
            EXPECT_NEAR(total(stripes({.period = period, .angle = 90, .phase = 0.3, .duty = duty}), 4, 16) / 64, duty,
                        1e-12);
        }
    // Turned by the angle of 3 : 4 : 5, the pattern of period 12/5 repeats every 4 pixels along x and 3 along y.
    const double angle = std::atan2(4, 3) * 180 / pi;
    EXPECT_NEAR(total(stripes({.period = 2.4, .angle = angle, .duty = 0.37}), 4, 3) / 12, 0.37, 1e-12);
}

TEST(Stripes, RepeatWithTheirPeriod) {
    for (const bool sinusoid : {false, true}) {
        const Signal s = stripes({.period = 3, .duty = 0.4, .sinusoid = sinusoid});
        const Signal later = stripes({.period = 3, .phase = 0.25, .duty = 0.4, .sinusoid = sinusoid});
        for (double x = 0.1; x < 6; x += 0.37) {
            EXPECT_NEAR(s.value(x, 1), s.value(x + 3, 8), 1e-12);
            EXPECT_NEAR(s.mean({x, 1, x + 1, 2}), s.mean({x - 6, 1, x - 5, 2}), 1e-12);
            EXPECT_NEAR(s.value(x + 0.75, 1), later.value(x, 1), 1e-12);
        }
    }
    EXPECT_EQ(stripes({.period = 4}).value(1, 0), 1);
    EXPECT_EQ(stripes({.period = 4}).value(3, 0), 0);
    EXPECT_EQ(stripes({.period = 4, .sinusoid = true}).value(1, 0), 1);
}

TEST(Checkerboard, AlternatesAndAverages) {
    const Signal board = checkerboard({.size = 2});
    EXPECT_EQ(board.value(1, 1), 1);
    EXPECT_EQ(board.value(3, 1), 0);
    EXPECT_EQ(board.value(3, 3), 1);
    EXPECT_EQ(board.value(-1, 1), 0);
    EXPECT_EQ(board.value(2, 1), 0.5);
    EXPECT_NEAR(total(board, 8, 4) / 32, 0.5, 1e-15);
    EXPECT_NEAR(board.mean({0, 0, 3, 2}), 2.0 / 3, 1e-15);
    EXPECT_NEAR(checkerboard({.size = 0.5}).mean({0, 0, 1, 1}), 0.5, 1e-15);
}

TEST(Rectangle, CoversItsArea) {
    EXPECT_NEAR(total(rectangle({16, 12}), 16, 12), 48, 1e-12);
    EXPECT_NEAR(total(rectangle({16, 12}, {.cell = Cell{1.3, 2.7, 8.1, 9.9}}), 16, 12), 6.8 * 7.2, 1e-12);
    EXPECT_EQ(rectangle({16, 12}).value(4, 5), 0.5);
    EXPECT_EQ(rectangle({16, 12}).value(4, 3), 0.25);
}

TEST(Disc, CellsAddUpToItsArea) {
    for (const double radius : {0.3, 1.0, 7.77, 25.0}) {
        const Signal d = disc({64, 64}, {.center = Point{31.3, 32.9}, .radius = radius});
        EXPECT_NEAR(total(d, 64, 64) / (pi * radius * radius), 1, 1e-12) << radius;
    }
}

TEST(Ramp, IsStraightWithinAndConstantBeyond) {
    const Signal across = ramp({10, 4});
    EXPECT_DOUBLE_EQ(across.value(2.5, 1), 0.25);
    EXPECT_DOUBLE_EQ(across.mean({2, 1, 3, 2}), 0.25);
    EXPECT_EQ(across.value(-3, 1), 0);
    EXPECT_EQ(across.value(13, 1), 1);
    // Half of the cell is 0, half rises to 1/10.
    EXPECT_NEAR(across.mean({-1, 0, 1, 1}), 0.025, 1e-15);
    EXPECT_NEAR(total(ramp({16, 12}, {.angle = 77}), 16, 12) / 192, 0.5, 1e-13);
    EXPECT_NEAR(total(ramp({16, 12}, {.angle = 77, .length = 3}), 16, 12) / 192, 0.5, 1e-13);
}

TEST(Impulse, IsOnePixelOrItsShareOfFour) {
    const Image<float> centred = render(impulse({9, 8}), 9, 8);
    EXPECT_EQ(centred.view()(4, 4), 1);
    EXPECT_EQ(sum_of(centred), 1);
    const Image<float> shifted = render(impulse({9, 8}, {.corner = Point{2.25, 3}}), 9, 8, Sampling::exact());
    EXPECT_FLOAT_EQ(shifted.view()(2, 3), 0.75f);
    EXPECT_FLOAT_EQ(shifted.view()(3, 3), 0.25f);
    EXPECT_FLOAT_EQ(static_cast<float>(sum_of(shifted)), 1);
}

TEST(ThinLine, AreaIsWidthTimesLength) {
    for (const double width : {0.01, 0.3, 1.0, 2.5}) {
        EXPECT_NEAR(total(thin_line({16, 12}, {.angle = 0, .offset = 0.2, .width = width}), 16, 12), 12 * width, 1e-12);
        EXPECT_NEAR(total(thin_line({16, 12}, {.angle = 90, .offset = 0.2, .width = width}), 16, 12), 16 * width,
                    1e-12);
        // A slanted line that leaves through top and bottom is a parallelogram there.
        EXPECT_NEAR(total(thin_line({16, 12}, {.angle = 20, .width = width}), 16, 12),
                    12 / std::cos(20 * pi / 180) * width, 1e-12);
    }
}

TEST(Signals, RefuseWrongOptions) {
    const Frame frame{16, 16};
    EXPECT_THROW(zone_plate({0, 16}), Error);
    EXPECT_THROW(zone_plate({16, nan}), Error);
    EXPECT_THROW(zone_plate(frame, {.max_frequency = 0}), Error);
    EXPECT_THROW(zone_plate(frame, {.phase = nan}), Error);
    EXPECT_THROW(zone_plate(frame, {.radius = -1}), Error);
    EXPECT_THROW(siemens_star(frame, {.spokes = 0}), Error);
    EXPECT_THROW(siemens_star(frame, {.center = Point{nan, 0}}), Error);
    EXPECT_THROW(chirp(frame, {.from = -0.1}), Error);
    EXPECT_THROW(chirp(frame, {.from = 0, .exponential = true}), Error);
    EXPECT_THROW(chirp(frame, {.angle = nan}), Error);
    EXPECT_THROW(step_edge(frame, {.offset = nan}), Error);
    EXPECT_THROW(stripes({.period = 0}), Error);
    EXPECT_THROW(stripes({.duty = 1.1}), Error);
    EXPECT_THROW(checkerboard({.size = 0}), Error);
    EXPECT_THROW(rectangle(frame, {.cell = Cell{2, 2, 2, 4}}), Error);
    EXPECT_THROW(disc(frame, {.radius = 0}), Error);
    EXPECT_THROW(ramp(frame, {.length = 0}), Error);
    EXPECT_THROW(impulse(frame, {.corner = Point{0, nan}}), Error);
    EXPECT_THROW(thin_line(frame, {.width = 0}), Error);
    EXPECT_THROW(with_range(constant(1), 0, nan), Error);
    EXPECT_THROW(constant(nan), Error);
}

}  // namespace
}  // namespace bandlimit
