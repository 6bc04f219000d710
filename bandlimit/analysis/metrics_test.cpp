#include "bandlimit/analysis/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bandlimit/core/edge.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Image<float> noise(int width, int height, int channels, std::uint64_t seed) {
    Random random(seed);
    Image<float> image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.view()(x, y, c) = static_cast<float>(random.uniform());
    return image;
}

/// `image` with a part of another one mixed in.
Image<float> mixed(View<const float> image, View<const float> other, float part) {
    Image<float> out(image.width, image.height, image.channels);
    for (int c = 0; c < image.channels; ++c)
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                out.view()(x, y, c) = (1 - part) * image(x, y, c) + part * other(x, y, c);
    return out;
}

/// Structural similarity by its definition: direct sums over the window, in double, with the moments of a and b.
double direct_ssim(View<const float> a, View<const float> b) {
    const bool small = a.width < 11 || a.height < 11;
    const int margin = small ? 0 : 5;
    double total = 0;
    for (int y = margin; y < a.height - margin; ++y)
        for (int x = margin; x < a.width - margin; ++x) {
            double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = -5; j <= 5; ++j)
                for (int i = -5; i <= 5; ++i) {
                    const double w = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
                    const int px = resolve(x + i, a.width, Edge::reflect), py = resolve(y + j, a.height, Edge::reflect);
                    const double va = double(a(px, py)), vb = double(b(px, py));
                    weights += w, ma += w * va, mb += w * vb, aa += w * va * va, bb += w * vb * vb, ab += w * va * vb;
                }
            ma /= weights, mb /= weights;
            const double var_a = aa / weights - ma * ma, var_b = bb / weights - mb * mb, cov = ab / weights - ma * mb;
            total += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (var_a + var_b + 9e-4));
        }
    return total / (double(a.width - 2 * margin) * (a.height - 2 * margin));
}

TEST(Errors, ByHand) {
    Image<float> a(2, 2), b(2, 2);
    a.view()(0, 0) = 1, b.view()(1, 1) = -0.5f;
    EXPECT_EQ(mse(a.view(), b.view()), (1 + 0.25) / 4);
    EXPECT_EQ(max_abs(a.view(), b.view()), 1);
    EXPECT_NEAR(psnr(a.view(), b.view()), 10 * std::log10(4 / 1.25), 1e-12);
}

TEST(Errors, IdenticalImages) {
    const Image<float> a = noise(30, 20, 3, 1);
    const Metrics m = compare(a.view(), a.view());
    EXPECT_EQ(m.mse, 0);
    EXPECT_EQ(m.max_abs, 0);
    EXPECT_EQ(m.psnr(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(m.ssim, 1);
}

TEST(Errors, OfAConstantOffset) {
    Image<float> a(40, 30), b(40, 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) b.view()(x, y) = 0.25f;
    const Metrics m = compare(a.view(), b.view());
    EXPECT_EQ(m.mse, 0.0625);
    EXPECT_NEAR(m.psnr(), 20 * std::log10(4.0), 1e-12);
    EXPECT_NEAR(m.ssim, 1e-4 / (0.0625 + 1e-4), 1e-6);  // luminance alone; rounding over C1 and C2
}

TEST(Ssim, EqualsItsDefinition) {
    for (const auto& [w, h] : {std::pair{11, 11}, {12, 40}, {33, 25}, {10, 30}, {30, 4}, {1, 1}, {5, 100}, {20, 90}}) {
        const Image<float> a = noise(w, h, 1, 2), other = noise(w, h, 1, 3);
        for (const float part : {0.02f, 0.3f, 1.0f}) {
            const Image<float> b = mixed(a.view(), other.view(), part);
            // Means in float of values up to 1 are within 12 * 2^-24; that over C2 = 9e-4 and averaged over positions.
            EXPECT_NEAR(ssim(a.view(), b.view()), direct_ssim(a.view(), b.view()), 2e-5)
                << w << " x " << h << " " << part;
        }
    }
}

TEST(Ssim, IsSymmetricAndPerChannel) {
    const Image<float> a = noise(24, 19, 3, 4), b = noise(24, 19, 3, 5);
    const Metrics m = compare(a.view(), b.view());
    EXPECT_EQ(m.ssim, ssim(b.view(), a.view()));
    double mean = 0;
    for (int c = 0; c < 3; ++c) {
        const Measures& channel = m.per_channel[static_cast<std::size_t>(c)];
        EXPECT_EQ(channel.ssim, ssim(channels_of(a.view(), c), channels_of(b.view(), c)));
        EXPECT_EQ(channel.mse, mse(channels_of(a.view(), c), channels_of(b.view(), c)));
        mean += channel.ssim / 3;
    }
    EXPECT_NEAR(m.ssim, mean, 1e-15);
}

TEST(Border, LeavesOutWhatItSays) {
    Image<float> a = noise(40, 37, 2, 6);
    const Image<float> b = noise(40, 37, 2, 7);
    const Metrics inner = compare(cropped(a.view(), 6, 6, 28, 25), cropped(b.view(), 6, 6, 28, 25));
    for (int x = 0; x < 40; ++x) a.view()(x, 5) = 1000;  // must not matter
    const Metrics bordered = compare(a.view(), b.view(), 6);
    EXPECT_EQ(bordered.mse, inner.mse);
    EXPECT_EQ(bordered.max_abs, inner.max_abs);
    EXPECT_EQ(bordered.ssim, inner.ssim);
}

TEST(Meters, GiveTheSameBitsForAnyBlocksAndThreads) {
    const int width = 23, height = 211;
    const Image<float> a = noise(width, height, 3, 8), b = mixed(a.view(), noise(width, height, 3, 9).view(), 0.2f);
    for (const int border : {0, 3, 7}) {  // 7 leaves 9 columns: less than a window
        const Metrics whole = compare(a.view(), b.view(), border, {1});
        for (const int block : {1, 2, 10, 64, 75, 200})
            for (const int threads : {1, 3}) {
                ErrorMeter errors(width, height, 3, border, {threads});
                SsimMeter similarity(width, height, 3, border, {threads});
                for (int y = 0; y < height; y += block) {
                    const int rows = std::min(block, height - y);
                    errors.add_rows(cropped(a.view(), 0, y, width, rows), cropped(b.view(), 0, y, width, rows));
                    similarity.add_rows(cropped(a.view(), 0, y, width, rows), cropped(b.view(), 0, y, width, rows));
                }
                std::vector<Measures> channels;
                errors.fill(channels);
                similarity.fill(channels);
                const Metrics blocks = summarize(channels);
                EXPECT_EQ(blocks.mse, whole.mse) << block;
                EXPECT_EQ(blocks.max_abs, whole.max_abs) << block;
                EXPECT_EQ(blocks.ssim, whole.ssim) << block;
            }
    }
}

TEST(Meters, MeasureWideImagesByStripsOfColumns) {
    // Against the definition where one strip ends and the next, of a few columns, begins; and the same bits again.
    const int width = 2 * 512 + 13, height = 12;
    const Image<float> a = noise(width, height, 2, 14), b = mixed(a.view(), noise(width, height, 2, 15).view(), 0.3f);
    for (int c = 0; c < 2; ++c) {
        const View<const float> va = channels_of(a.view(), c), vb = channels_of(b.view(), c);
        EXPECT_NEAR(ssim(va, vb), direct_ssim(va, vb), 2e-5);
    }
    const double one = compare(a.view(), b.view(), 0, {1}).ssim;
    EXPECT_EQ(compare(a.view(), b.view(), 0, {3}).ssim, one);
    SsimMeter meter(width, height, 2, 0, {2});
    for (int y = 0; y < height; ++y)
        meter.add_rows(cropped(a.view(), 0, y, width, 1), cropped(b.view(), 0, y, width, 1));
    std::vector<Measures> channels;
    meter.fill(channels);
    EXPECT_EQ(summarize(channels).ssim, one);
}

TEST(Meters, DoNotDependOnTheLayout) {
    const Image<float> a = noise(20, 15, 3, 10), b = noise(20, 15, 3, 11);
    Image<float> interleaved(20, 15, 3, Layout::interleaved);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 20; ++x) interleaved.view()(x, y, c) = a.view()(x, y, c);
    EXPECT_EQ(ssim(interleaved.view(), b.view()), ssim(a.view(), b.view()));
    EXPECT_EQ(mse(interleaved.view(), b.view()), mse(a.view(), b.view()));
}

TEST(Metrics, NotFiniteCountsAsZero) {
    Image<float> a = noise(16, 16, 1, 12), zeroed = a.clone();
    const Image<float> b = noise(16, 16, 1, 13);
    a.view()(3, 4) = nan, a.view()(7, 7) = std::numeric_limits<float>::infinity();
    zeroed.view()(3, 4) = zeroed.view()(7, 7) = 0;
    EXPECT_EQ(mse(a.view(), b.view()), mse(zeroed.view(), b.view()));
    EXPECT_EQ(max_abs(a.view(), b.view()), max_abs(zeroed.view(), b.view()));
    EXPECT_EQ(ssim(a.view(), b.view()), ssim(zeroed.view(), b.view()));
    EXPECT_EQ(psnr(a.view(), a.view()), std::numeric_limits<double>::infinity());
}

TEST(Metrics, RefuseWhatMakesNoSense) {
    const Image<float> a = noise(8, 8, 1, 1), other = noise(8, 9, 1, 1);
    EXPECT_THROW(compare(a.view(), other.view()), Error);
    EXPECT_THROW(compare(a.view(), a.view(), 4), Error);
    EXPECT_NO_THROW(compare(a.view(), a.view(), 3));
    EXPECT_THROW(compare(a.view(), a.view(), -1), Error);
    ErrorMeter meter(8, 8, 1);
    std::vector<Measures> channels;
    EXPECT_THROW(meter.fill(channels), Error);
    EXPECT_THROW(meter.add_rows(other.view(), other.view()), Error);
}

}  // namespace
}  // namespace bandlimit
