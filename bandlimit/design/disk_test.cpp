#include "bandlimit/design/disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// The integral of f(r) 2 pi r over [begin, end]; 64 panels hold at most two periods of the fastest phasor here each.
double over_ring(const std::function<double(double)>& f, double begin, double end) {
    return integrate([&](double r) { return 2 * std::numbers::pi * r * f(r); }, begin, end, 64);
}

TEST(Disk, ErrorIsTheIntegral) {
    Random random(3);
    for (int count = 1; count <= 4; ++count) {
        Components components;
        for (int i = 0; i < count; ++i)
            components.push_back({0.8 + 3 * random.uniform(), 20 * random.uniform() - 5, 4 * random.uniform() - 2,
                                  4 * random.uniform() - 2});
        const auto square = [](double x) { return x * x; };
        // exp(-2 a r^2) is below 1e-22 from 6 radii on.
        const double expected = over_ring([&](double r) { return square(value_at(components, r) - 1); }, 0, 1) +
                                over_ring([&](double r) { return square(value_at(components, r)); }, 1, 6);
        EXPECT_NEAR(disk_error(components), expected / std::numbers::pi, 1e-13) << count;
    }
}

TEST(Disk, ErrorsFallWithTheCount) {
    const double most[] = {0.087, 0.039, 0.0231, 0.0165, 0.0127};
    double previous = 1;
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        ASSERT_EQ(fit.size(), static_cast<std::size_t>(count));
        EXPECT_TRUE(std::ranges::is_sorted(fit, {}, &Component::b));
        const double error = disk_error(fit);
        EXPECT_LT(error, most[count - 1]) << count;
        EXPECT_LT(error, previous) << count;
        previous = error;
    }
}

TEST(Disk, NothingNearAFitIsNearer) {
    Random random(5);
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        const double error = disk_error(fit);
        for (int trial = 0; trial < 200; ++trial) {
            Components left = fit, right = fit;
            double size = 0;
            for (std::size_t i = 0; i < fit.size(); ++i)
                for (double Component::*const part : {&Component::a, &Component::b, &Component::A, &Component::B}) {
                    const double step = 1e-3 * (random.uniform() - 0.5);
                    left[i].*part -= step;
                    right[i].*part += step;
                    size += std::abs(step);
                }
            EXPECT_GT(disk_error(left), error);
            EXPECT_GT(disk_error(right), error);
            // The slope, which is 0 up to the curvature's odd part, third order in the step, and rounding.
            EXPECT_NEAR(disk_error(right) - disk_error(left), 0, 10 * size * size * size + 1e-11);
        }
    }
}

TEST(Disk, FitsAreOrthogonalToTheirRest) {
    // Where the height is the best, K and K - disc are orthogonal, and so error = 1 - |K|^2.
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        const double disc = over_ring([&](double r) { return value_at(fit, r); }, 0, 1);
        EXPECT_NEAR(disk_error(fit), 1 - disc / std::numbers::pi, 1e-12) << count;
        const Components again = fitted_to_disk(fit, 1);
        EXPECT_NEAR(again[0].A, fit[0].A, 1e-11);
        EXPECT_NEAR(again[0].B, fit[0].B, 1e-11);
    }
}

TEST(Disk, PublishedOnesFitADiscOfRadius11) {
    const double errors[] = {0.104, 0.039};
    for (const int count : {1, 2}) {
        const PublishedDisk disk = published_disk(count);
        const auto error_at = [&](double radius) { return disk_error(fitted_to_disk(disk.components, radius)); };
        EXPECT_NEAR(disk.radius, 1.10, 0.01);
        EXPECT_NEAR(error_at(disk.radius), errors[count - 1], 5e-4);
        EXPECT_GT(error_at(disk.radius), disk_error(fit_disk(count)));
        EXPECT_LT(error_at(disk.radius), error_at(disk.radius - 1e-4));
        EXPECT_LT(error_at(disk.radius), error_at(disk.radius + 1e-4));
    }
    EXPECT_EQ(published_disk(1).reach, 1.4);
    EXPECT_EQ(published_disk(2).reach, 1.2);
}

TEST(Disk, ScaledComponentsAreTheSameKernel) {
    const PublishedDisk disk = published_disk(2);
    const Components scaled = fitted_to_disk(disk.components, disk.radius);
    const double height = value_at(scaled, 0) / value_at(disk.components, 0);
    for (const double r : {0.2, 0.7, 1.3})
        EXPECT_NEAR(value_at(scaled, r), height * value_at(disk.components, disk.radius * r), 1e-14);
}

TEST(Disk, ProfileOfAGaussian) {
    // 2 exp(-r^2) is 1 at sqrt(ln 2) and never 0; half of it never is 1.
    const DiskProfile high = disk_profile({{1, 0, 2, 0}}), low = disk_profile({{1, 0, 0.5, 0}});
    EXPECT_EQ(high.centre, 2);
    EXPECT_NEAR(high.flat_until, std::sqrt(std::numbers::ln2), 1e-12);
    EXPECT_NEAR(high.inner_ringing, 1, 1e-9);
    EXPECT_TRUE(std::isinf(high.zero_from));
    EXPECT_EQ(high.outer_ringing, 0);
    EXPECT_EQ(low.flat_until, 0);
    EXPECT_EQ(low.inner_ringing, 0.5);
}

TEST(Disk, ProfileOfFits) {
    double width = 2, ringing = 1;
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        const DiskProfile profile = disk_profile(fit);
        EXPECT_NEAR(value_at(fit, profile.flat_until), 1, 1e-12);
        EXPECT_NEAR(value_at(fit, profile.zero_from), 0, 1e-12);
        EXPECT_LT(profile.flat_until, 1);
        EXPECT_GT(profile.zero_from, 1);
        // More components make a steeper edge, and less of a dent in the middle.
        EXPECT_LT(profile.zero_from - profile.flat_until, width);
        EXPECT_LT(profile.inner_ringing, ringing);
        width = profile.zero_from - profile.flat_until;
        ringing = profile.inner_ringing;
        double inner = 0, outer = 0;
        for (double r = 0; r < 3; r += 1e-3) {
            if (r < profile.flat_until) inner = std::max(inner, std::abs(value_at(fit, r) - 1));
            if (r > profile.zero_from) outer = std::max(outer, std::abs(value_at(fit, r)));
        }
        EXPECT_LE(inner, profile.inner_ringing + 1e-12);
        EXPECT_LE(outer, profile.outer_ringing + 1e-12);
        // Steps of 1/1000 miss a peak by at most its curvature, below 4000 here, times 1/8 of their square.
        EXPECT_NEAR(inner, profile.inner_ringing, 5e-4);
        EXPECT_NEAR(outer, profile.outer_ringing, 5e-4);
    }
}

TEST(Disk, ResponseIsTheFourierTransform) {
    const Components fit = fit_disk(3);
    for (const double f : {0.0, 0.2, 0.61, 1.7, 3.0}) {
        const double expected =
            over_ring([&](double r) { return value_at(fit, r) * bessel_j0(2 * std::numbers::pi * f * r); }, 0, 6);
        EXPECT_NEAR(disk_response(fit, f), expected / integral(fit), 1e-13) << f;
        const double disc = over_ring([&](double r) { return bessel_j0(2 * std::numbers::pi * f * r); }, 0, 1);
        EXPECT_NEAR(disc_response(f), disc / std::numbers::pi, 1e-13) << f;
    }
}

TEST(Disk, BandIsTowardsThatOfTheDisc) {
    const DiskBand disc = disk_band(disc_response);
    EXPECT_NEAR(disc_response(disc.half), 0.5, 1e-12);
    EXPECT_NEAR(disc.zero, jinc_zero(1) / 2, 1e-12);
    // The second extremum of J1(x) / x, at the first zero of J2, 5.13562.
    EXPECT_NEAR(disc.leakage, 0.132279, 1e-6);
    double previous = 1;
    for (int count = 1; count <= most_disk_components; ++count) {
        const Components fit = fit_disk(count);
        const DiskBand band = disk_band([&](double f) { return disk_response(fit, f); });
        EXPECT_LT(std::abs(band.half - disc.half), previous) << count;
        EXPECT_NEAR(band.zero, disc.zero, 0.005);
        EXPECT_GT(band.leakage, disc.leakage);
        previous = std::abs(band.half - disc.half);
    }
    // The transform of exp(-pi r^2) is exp(-pi f^2), which has no zero.
    const Components bell{{std::numbers::pi, 0, 1, 0}};
    const DiskBand band = disk_band([&](double f) { return disk_response(bell, f); });
    EXPECT_NEAR(band.half, std::sqrt(std::numbers::ln2 / std::numbers::pi), 1e-12);
    EXPECT_TRUE(std::isinf(band.zero));
    EXPECT_EQ(band.leakage, 0);
}

TEST(Disk, RefuseWhatHasNoMeaning) {
    EXPECT_THROW(fit_disk(0), Error);
    EXPECT_THROW(fit_disk(6), Error);
    EXPECT_THROW(published_disk(3), Error);
    EXPECT_THROW(fitted_to_disk(fit_disk(1), 0), Error);
    EXPECT_THROW(fitted_to_disk({{1, 0, 0, 0}}, 1), Error);
    EXPECT_THROW(disk_error({}), Error);
    EXPECT_THROW(disk_error({{-1, 0, 1, 0}}), Error);
    EXPECT_THROW(disk_response({{1, 0, 0, 0}}, 1), Error);
    EXPECT_THROW(disk_profile({}), Error);
}

}  // namespace
}  // namespace bandlimit
