#include "bandlimit/analysis/shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/sanitized_test.h"
#include "bandlimit/math/random.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double promised = 0.01;

using Scene = std::function<double(double, double)>;

Image<float> draw(const Scene& scene, int width, int height, double shift_x = 0, double shift_y = 0) {
    Image<float> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.view()(x, y) = static_cast<float>(scene(x + 0.5 - shift_x, y + 0.5 - shift_y));
    return image;
}

/// Smooth noise at any position: Gaussian blobs, or a sum of waves.
Scene blobs(std::uint64_t seed, double size, int count, double sigma) {
    struct Blob {
        double x, y, height;
    };
    std::vector<Blob> all;
    Random random(seed);
    for (int i = 0; i < count; ++i)
        all.push_back({random.uniform(-20, size + 20), random.uniform(-20, size + 20), random.uniform(-1, 1)});
    return [all, sigma](double x, double y) {
        double total = 0.5;
        for (const Blob& b : all) {
            const double r2 = (x - b.x) * (x - b.x) + (y - b.y) * (y - b.y);
            if (r2 < 16 * sigma * sigma) total += b.height * std::exp(-r2 / (2 * sigma * sigma));
        }
        return total;
    };
}

Scene zone_plate(double center, double most) {
    return [=](double x, double y) {
        const double r2 = (x - center) * (x - center) + (y - center) * (y - center);
        return 0.5 + 0.5 * std::cos(pi * most / center * r2);
    };
}

/// Like a photograph: soft shapes of many sizes with soft edges on a gradient.
Scene photograph(std::uint64_t seed, double size) {
    struct Disc {
        double x, y, radius, shade;
    };
    std::vector<Disc> discs;
    Random random(seed);
    for (int i = 0; i < 120; ++i)
        discs.push_back({random.uniform(-10, size + 10), random.uniform(-10, size + 10),
                         size / 4 * std::pow(random.uniform(0.15, 1), 2), random.uniform()});
    return [=](double x, double y) {
        double shade = 0.3 + 0.3 * x / size;
        for (const Disc& d : discs) {
            const double inside = 0.5 - 0.5 * std::tanh((std::hypot(x - d.x, y - d.y) - d.radius) / 0.7);
            shade += inside * (d.shade - shade);
        }
        return shade;
    };
}

Image<float> noise(int width, int height, std::uint64_t seed) {
    Random random(seed);
    return draw([&](double, double) { return random.uniform(); }, width, height);
}

Image<float> filtered(View<const float> v, const Bank& along_x, const Bank& along_y) {
    Image<float> rows(along_x.output_count(), v.height), out(along_x.output_count(), along_y.output_count());
    apply(along_x, v, rows.view());
    apply(along_y, transposed(std::as_const(rows).view()), transposed(out.view()));
    return out;
}

void expect_shift(View<const float> a, View<const float> b, double x, double y, double tolerance = promised,
                  const std::string& what = {}) {
    const Shift shift = estimate_shift(a, b);
    ASSERT_TRUE(shift.x && shift.y) << what << " " << shift.x.has_value() << shift.y.has_value();
    EXPECT_NEAR(*shift.x, x, tolerance) << what;
    EXPECT_NEAR(*shift.y, y, tolerance) << what;
}

TEST(Shift, KnownShiftsOfEveryScene) {
    const double shifts[][2] = {{0, 0},      {0.25, -0.4}, {-0.5, 0.5},  {1, 0},
                                {3.3, -2.7}, {-8.6, 0.1},  {17.25, 5.5}, {-30.4, 22.1}};
    const std::pair<std::string, Scene> scenes[] = {
        {"blobs", blobs(1, 128, 400, 2.5)}, {"zone plate", zone_plate(64, 0.45)}, {"photograph", photograph(2, 128)}};
    for (const auto& [name, scene] : scenes) {
        const Image<float> a = draw(scene, 128, 120);
        for (const auto& [x, y] : shifts)
            expect_shift(a.view(), draw(scene, 128, 120, x, y).view(), x, y, promised,
                         message(name, " by ", x, ", ", y));
    }
}

TEST(Shift, OfIdenticalImagesIsExactlyZero) {
    for (const int size : {4, 5, 7, 16, 33, 100}) {
        const Image<float> a = noise(size, size + 3, 3);
        const Shift shift = estimate_shift(a.view(), a.view());
        EXPECT_EQ(shift.x, 0) << size;
        EXPECT_EQ(shift.y, 0) << size;
        if (size > 15) {
            EXPECT_LT(shift.residual, 1e-12) << size;  // floats
        }
    }
}

TEST(Shift, OfWhiteNoiseByWholeSamples) {
    const Image<float> big = noise(200, 180, 4);
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {-7, 4}, {40, -33}})
        expect_shift(cropped(big.view(), 40, 40, 110, 100), cropped(big.view(), 40 - x, 40 - y, 110, 100), x, y);
}

TEST(Shift, SwapsItsSignWithItsArgumentsAndItsAxesWithTransposition) {
    const Scene scene = photograph(5, 96);
    const Image<float> a = draw(scene, 96, 80), b = draw(scene, 96, 80, 2.3, -1.6);
    expect_shift(b.view(), a.view(), -2.3, 1.6);
    expect_shift(transposed(a.view()), transposed(b.view()), -1.6, 2.3);
    expect_shift(flipped_x(a.view()), flipped_x(b.view()), -2.3, -1.6);
}

TEST(Shift, SymmetricFiltersDoNotShift) {
    for (std::uint64_t seed = 6; seed < (is_sanitized ? 7 : 9); ++seed)
        for (const bool white : {true, false}) {
            const Image<float> a = white ? noise(201, 196, seed) : draw(photograph(seed, 200), 201, 196);
            const auto through = [&](const Kernel& kernel, double stretch) {
                const auto bank = [&](int n) {  // by way of fewer samples, or smoothed at the same pitch
                    Taps taps{-12, {}, 1};
                    double total = 0;
                    for (int i = -12; i <= 12; ++i) taps.weights.push_back(kernel.value(i / stretch));
                    for (const double w : taps.weights) total += w;
                    for (double& w : taps.weights) w /= total;
                    return make_bank(taps, n, Edge::reflect);
                };
                return filtered(a.view(), bank(201), bank(196));
            };
            expect_shift(a.view(), through(bspline(), 1).view(), 0, 0, promised, "b-spline");
            expect_shift(a.view(), through(tent(), 3).view(), 0, 0, promised, "tent of 3");
            expect_shift(a.view(), through(lanczos(3), 2).view(), 0, 0, promised, "half-band lanczos");
        }
}

// What the source on half pixels measures: an image halved by a box and doubled again.
TEST(Shift, OfMatchedAndMismatchedResampling) {
    const Taps box_down{0, {0.5, 0.5}, 2};
    const int n = 160, half = n / 2;
    const Bank down = make_bank(box_down, n, Edge::reflect);
    const Bank even_up = make_bank(tent(), Axis{half}, Axis{n}, Edge::clamp);  // [1/4 3/4]
    // Copies and midpoints: output 2i lies on sample i, a quarter of a small sample left of where it belongs.
    const Bank odd_up = make_bank(tent(), Axis{half, 0, double(half)}, Axis{n, 0.25, half + 0.25}, Edge::clamp);
    ASSERT_EQ(even_up.row(10)[0], 0.25f);
    ASSERT_EQ(odd_up.row(10)[0], 1.0f);
    ASSERT_EQ(odd_up.first(10), 5);
    ASSERT_EQ(odd_up.row(11)[0], 0.5f);
    const std::pair<std::string, Image<float>> images[] = {{"photograph", draw(photograph(9, n), n, n)},
                                                           {"blobs", draw(blobs(10, n, 500, 2), n, n)},
                                                           {"noise", noise(n, n, 11)},
                                                           {"zone plate", draw(zone_plate(n / 2.0, 0.5), n, n)}};
    for (const auto& [name, image] : images) {
        const Image<float> small = filtered(image.view(), down, down);
        expect_shift(image.view(), filtered(small.view(), even_up, even_up).view(), 0, 0, promised, name + " even");
        expect_shift(image.view(), filtered(small.view(), odd_up, odd_up).view(), -0.5, -0.5, promised, name + " odd");
    }
}

// A filter between codes of another curve leaves more that no shift and no filter explains.
TEST(Shift, ResidualTellsTheEncodingInWhichAFilterRan) {
    const int n = 128;
    const Taps blur{-2, {1 / 9., 2 / 9., 3 / 9., 2 / 9., 1 / 9.}, 1};
    const Bank bank = make_bank(blur, n, Edge::reflect);
    const auto squared = [](View<const float> v) {
        Image<float> out(v.width, v.height);
        for (int y = 0; y < v.height; ++y)
            for (int x = 0; x < v.width; ++x) out.view()(x, y) = v(x, y) * v(x, y);
        return out;
    };
    const Image<float> codes = draw(photograph(50, n), n, n), linear = squared(codes.view());
    const Image<float> blurred = filtered(codes.view(), bank, bank), squared_later = squared(blurred.view());
    EXPECT_LT(estimate_shift(codes.view(), blurred.view()).residual * 10,
              estimate_shift(linear.view(), squared_later.view()).residual);
}

TEST(Shift, UnderNoise) {
    const Scene scene = photograph(12, 200);
    Image<float> a = draw(scene, 200, 200), b = draw(scene, 200, 200, 0.37, -1.21);
    Random random(13);
    for (const auto& v : {a.view(), b.view()})
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 200; ++x) v(x, y) += static_cast<float>(random.uniform(-0.0866, 0.0866));  // RMS 0.05
    // Gradients of this scene have an RMS near 0.05, and some 0.14 * 200^2 samples count under the taper: noise in both
    // images cannot but move the estimate by about sqrt(2) * 0.05 / 0.05 / 75 = 0.02; this is four times that.
    expect_shift(a.view(), b.view(), 0.37, -1.21, 0.08);
}

TEST(Shift, ReadsChannelsAsTheirMeanAndIgnoresScale) {
    const Scene scene = photograph(14, 64);
    const Image<float> a = draw(scene, 64, 64), b = draw(scene, 64, 64, 1.5, 0.5);
    Image<float> colour_a(64, 64, 3), colour_b(64, 64, 3);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                colour_a.view()(x, y, c) = a.view()(x, y) * static_cast<float>(c);
                colour_b.view()(x, y, c) = b.view()(x, y) * static_cast<float>(1000 - 300 * c) + 77;
            }
    expect_shift(colour_a.view(), colour_b.view(), 1.5, 0.5);
}

TEST(Shift, IsUndefinedForConstantImages) {
    const Image<float> flat = draw([](double, double) { return 0.3; }, 32, 32), a = noise(32, 32, 15);
    for (const Shift& shift : {estimate_shift(flat.view(), flat.view()), estimate_shift(a.view(), flat.view()),
                               estimate_shift(flat.view(), a.view())}) {
        EXPECT_FALSE(shift.x);
        EXPECT_FALSE(shift.y);
    }
}

TEST(Shift, IsUndefinedAlongShortAxes) {
    const Image<float> a = noise(3, 3, 16);
    EXPECT_FALSE(estimate_shift(a.view(), a.view()).x);
    EXPECT_FALSE(estimate_shift(a.view(), a.view()).y);
    const Scene scene = blobs(17, 64, 100, 2);
    for (const int height : {1, 2, 3}) {
        const Image<float> row = draw(scene, 64, height), moved = draw(scene, 64, height, 1.25, 0);
        const Shift wide = estimate_shift(row.view(), moved.view());
        ASSERT_TRUE(wide.x);
        EXPECT_NEAR(*wide.x, 1.25, promised);
        EXPECT_FALSE(wide.y);
        const Shift tall = estimate_shift(transposed(row.view()), transposed(moved.view()));
        EXPECT_FALSE(tall.x);
        ASSERT_TRUE(tall.y);
        EXPECT_NEAR(*tall.y, 1.25, promised);
    }
}

TEST(Shift, OfImagesThatVaryAlongOneAxisIsKnownAlongIt) {
    const Scene blob = blobs(18, 90, 200, 2.5);
    const std::pair<std::string, Scene> profiles[] = {
        {"profile", [=](double x, double) { return blob(x, 30); }},
        {"sine", [](double x, double) { return 0.5 + 0.5 * std::sin(2 * pi * x / 9); }},
        {"edge", [](double x, double) { return 0.5 + 0.5 * std::tanh((x - 45.2) / 0.8); }}};
    for (const auto& [name, scene] : profiles)
        for (const bool with_noise : {false, true}) {
            Image<float> a = draw(scene, 90, 70), b = draw(scene, 90, 70, 1.3, 5);
            Random random(19);
            for (const auto& v : {a.view(), b.view()})
                for (int y = 0; with_noise && y < 70; ++y)
                    for (int x = 0; x < 90; ++x) v(x, y) += static_cast<float>(random.uniform(-0.01, 0.01));
            const Shift wide = estimate_shift(a.view(), b.view());
            ASSERT_TRUE(wide.x) << name << with_noise;
            EXPECT_NEAR(*wide.x, 1.3, promised) << name << with_noise;
            EXPECT_FALSE(wide.y) << name << with_noise;
            const Shift tall = estimate_shift(transposed(a.view()), transposed(b.view()));
            EXPECT_FALSE(tall.x) << name << with_noise;
            ASSERT_TRUE(tall.y) << name << with_noise;
            EXPECT_NEAR(*tall.y, 1.3, promised) << name << with_noise;
        }
}

TEST(Shift, OfDiagonalStripesIsUndefined) {
    for (const double degrees : {10.0, 45.0, 63.0, 135.0}) {
        const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
        const Scene sine = [=](double x, double y) { return 0.5 + 0.5 * std::sin(2 * pi * (c * x + s * y) / 11); };
        const Scene edge = [=](double x, double y) { return 0.5 + 0.5 * std::tanh((c * x + s * y - 30) / 0.7); };
        for (const Scene& scene : {sine, edge}) {
            const Shift shift = estimate_shift(draw(scene, 80, 72).view(), draw(scene, 80, 72, 1, 0).view());
            EXPECT_FALSE(shift.x) << degrees;
            EXPECT_FALSE(shift.y) << degrees;
        }
    }
}

TEST(Shift, OfUnrelatedImagesIsUndefined) {
    for (std::uint64_t seed = 20; seed < (is_sanitized ? 22 : 30); ++seed)
        for (const int size : {24, 64, 150}) {
            const Shift white = estimate_shift(noise(size, size, seed).view(), noise(size, size, seed + 100).view());
            EXPECT_FALSE(white.x || white.y) << "noise " << size;
            const Shift scenes = estimate_shift(draw(photograph(seed, size), size, size).view(),
                                                draw(photograph(seed + 100, size), size, size).view());
            EXPECT_FALSE(scenes.x || scenes.y) << "photograph " << size;
        }
}

TEST(Shift, ReadsWhatIsNotFiniteAsZero) {
    const Scene scene = blobs(40, 64, 150, 2.5);
    Image<float> a = draw(scene, 64, 64), b = draw(scene, 64, 64, 2, 1), zero_a = a.clone(), zero_b = b.clone();
    a.view()(20, 30) = std::numeric_limits<float>::quiet_NaN(), zero_a.view()(20, 30) = 0;
    b.view()(5, 5) = -std::numeric_limits<float>::infinity(), zero_b.view()(5, 5) = 0;
    const Shift shift = estimate_shift(a.view(), b.view()), zeroed = estimate_shift(zero_a.view(), zero_b.view());
    ASSERT_TRUE(shift.x && shift.y);
    EXPECT_EQ(shift.x, zeroed.x);
    EXPECT_EQ(shift.y, zeroed.y);
}

TEST(Shift, LooksAtTheWindowInTheMiddleOnly) {
    const ShiftWindow w = shift_window(1500, 30);
    EXPECT_EQ(w.x, 238);
    EXPECT_EQ(w.width, 1024);
    EXPECT_EQ(w.y, 0);
    EXPECT_EQ(w.height, 30);
    const Image<float> big = noise(1520, 40, 41);
    const View<const float> a = cropped(big.view(), 10, 5, 1500, 30), b = cropped(big.view(), 8, 4, 1500, 30);
    const Shift whole = estimate_shift(a, b);
    const Shift part = estimate_shift(cropped(a, w.x, w.y, w.width, w.height), cropped(b, w.x, w.y, w.width, w.height));
    ASSERT_TRUE(whole.x && whole.y);
    EXPECT_NEAR(*whole.x, 2, promised);
    EXPECT_NEAR(*whole.y, 1, promised);
    EXPECT_EQ(whole.x, part.x);
    EXPECT_EQ(whole.y, part.y);
}

TEST(Shift, HasTheSameBitsForAnyThreads) {
    const Scene scene = photograph(42, 90);
    const Image<float> a = draw(scene, 90, 90), b = draw(scene, 90, 90, 0.3, 0.7);
    const Shift one = estimate_shift(a.view(), b.view(), {1}), three = estimate_shift(a.view(), b.view(), {3});
    EXPECT_EQ(one.x, three.x);
    EXPECT_EQ(one.y, three.y);
}

TEST(Shift, RefusesDifferentShapes) {
    const Image<float> a(8, 8), b(8, 9);
    EXPECT_THROW(estimate_shift(a.view(), b.view()), Error);
    EXPECT_THROW(estimate_shift(Image<float>().view(), Image<float>().view()), Error);
}

}  // namespace
}  // namespace bandlimit
