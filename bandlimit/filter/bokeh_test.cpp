#include "bandlimit/filter/bokeh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

double sum(const WeightGrid& grid) { return std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0); }

TEST(Aperture, IsAsLargeAsItsRadius) {
    for (const double radius : {0.5, 1.0, 2.25, 7.5, 25.0, 60.7}) {
        const WeightGrid disc = aperture("disc:1", radius);
        EXPECT_EQ(disc.width, 2 * std::ceil(radius - 0.5) + 1);
        // Points that lie on the border count as outside: up to a pitch of 1/16 sample around.
        const double area = std::numbers::pi * radius * radius;
        EXPECT_NEAR(sum(disc), area, 2 * std::numbers::pi * radius / 16) << radius;
    }
    EXPECT_NEAR(sum(aperture("box:0.5", 20)), 400, 40.0 / 16 * 2 + 1);
}

TEST(Aperture, IsSymmetricAndAntialiased) {
    for (const double radius : {3.0, 6.3}) {
        const WeightGrid disc = aperture("disc:1", radius);
        const int n = disc.width;
        bool has_soft_edge = false;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                EXPECT_NEAR(disc.at(x, y), disc.at(n - 1 - x, y), 1e-12);
                EXPECT_NEAR(disc.at(x, y), disc.at(y, x), 1e-12);
                EXPECT_LE(disc.at(x, y), 1 + 1e-12);
                has_soft_edge |= disc.at(x, y) > 0.2 && disc.at(x, y) < 0.8;
                const double r = std::hypot(x - n / 2, y - n / 2);
                if (std::abs(r - radius) > 1) {
                    EXPECT_NEAR(disc.at(x, y), r < radius, 1e-12);
                }
            }
        EXPECT_TRUE(has_soft_edge);
    }
}

TEST(Aperture, RefusesWhatIsNone) {
    EXPECT_THROW(aperture("disc:1", 0.4), Error);
    EXPECT_THROW(aperture("disc:1", 1001), Error);
    EXPECT_THROW(aperture("disc:1", std::nan("")), Error);
    EXPECT_THROW(aperture("disk:1", 5), Error);
}

Image<float> boosted(const Image<float>& image, double gamma, bool premultiply, Encoding encoding) {
    const Convolution convolution(with_unit_sum(centred(aperture("disc:1", 3))), image.width(), image.height(),
                                  {.premultiply = premultiply});
    Image<float> out(image.width(), image.height(), image.channels(), Layout::interleaved);
    boosted(convolution, gamma, premultiply).run({image.view(), 0, encoding}, {out.view(), 0, encoding, {}}, {2});
    return out;
}

TEST(Boost, IsTheMeanOfPowers) {
    Image<float> image(15, 15, 1, Layout::interleaved);
    for (int i = 0; i < 225; ++i) image.view().data[i] = 0.1f;
    image.view()(7, 7) = 1;
    const WeightGrid disc = grid_of(with_unit_sum(centred(aperture("disc:1", 3))));
    const Image<float> found = boosted(image, 4, true, {});
    const double middle = disc.at(3, 3);
    // Relative errors of floats, and the root takes them down.
    EXPECT_NEAR(found.view()(7, 7), std::pow(middle + (1 - middle) * 1e-4, 0.25), 1e-5);
    EXPECT_NEAR(found.view()(0, 0), 0.1, 1e-6);
    EXPECT_THROW(boosted(image, 0, true, {}), Error);
    EXPECT_THROW(boosted(image, INFINITY, true, {}), Error);
}

TEST(Boost, LeavesConstantsAndAlphaAlone) {
    for (const bool premultiply : {true, false})
        for (const bool associated : {true, false}) {
            Image<float> image(12, 10, 4, Layout::interleaved);
            for (int i = 0; i < 120; ++i) {
                float* const p = image.view().data + 4 * i;
                p[0] = 0.3f, p[1] = -0.2f, p[2] = 0.5f, p[3] = 0.5f;
            }
            const Image<float> found = boosted(image, 7, premultiply, {Transfer::linear, 3, associated});
            for (int i = 0; i < 480; ++i)  // powers and roots in double, each stored in float: 7 roundings at most
                ASSERT_NEAR(found.view().data[i], image.view().data[i], 2e-6);
        }
}

TEST(Boost, ReportsProgressThatGrowsToOne) {
    const Image<float> image(40, 300, 3);
    Image<float> out(40, 300, 3);
    for (const Method method : {Method::direct, Method::fft}) {
        const Convolution convolution(with_unit_sum(centred(aperture("disc:1", 3))), 40, 300, {.method = method});
        double last = 0;
        boosted(convolution, 7, true)
            .run(SourceRows{image.view(), 0, {}}, {out.view(), 0, {}, {}}, {2}, [&](double done) {
                EXPECT_GT(done, last);
                last = done;
            });
        EXPECT_EQ(last, 1);
    }
}

}  // namespace
}  // namespace bandlimit
