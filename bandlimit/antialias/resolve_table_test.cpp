#include "bandlimit/antialias/resolve_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

TEST(ResolveTable, SumsToOne) {
    for (const char* kernel : {"box", "tent", "bspline", "mitchell", "lanczos3", "gaussian:0.5", "blackman-harris",
                               "blackman-harris-window", "jinc2", "jinc3"})
        for (const char* pattern : {"d3d:2", "rotated:16", "random:5:1", "checkerboard"}) {
            const ResolveTable table = resolve_table(parse_pattern(pattern), parse_kernel(kernel));
            EXPECT_EQ(table.weights.size(), static_cast<std::size_t>(table.side() * table.side() * table.samples));
            EXPECT_NEAR(std::accumulate(table.weights.begin(), table.weights.end(), 0.0), 1, 1e-12)
                << kernel << " of " << pattern;
        }
}

TEST(ResolveTable, BoxTakesThePixelsOwnSamplesAlike) {
    for (const char* name : {"d3d:16", "regular:9", "sobol:32:4"}) {  // of d3d:16 one lies on the left border
        const SamplePattern pattern = parse_pattern(name);
        const ResolveTable table = resolve_table(pattern, box());
        EXPECT_EQ(table.reach, 0);
        for (const double weight : table.weights) EXPECT_NEAR(weight, 1.0 / pattern.count(), 1e-15);
    }
    // Those of rotated:16 that leave the pixel belong to a neighbour, which gets them from here.
    EXPECT_EQ(resolve_table(rotated_pattern(16), box()).reach, 1);
}

TEST(ResolveTable, WeightsAreTheKernelWhereTheSampleLies) {
    const SamplePattern pattern = d3d_pattern(4);
    const ResolveTable table = resolve_table(pattern, mitchell());
    const auto value = [&](int dx, int dy, int s) {
        const Point& p = pattern.points[static_cast<std::size_t>(s)];
        return mitchell().value(dx + p.x) * mitchell().value(dy + p.y);
    };
    EXPECT_EQ(table.reach, 2);
    const double scale = table.weight(0, 0, 0) / value(0, 0, 0);
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
            for (int s = 0; s < 4; ++s) EXPECT_NEAR(table.weight(dx, dy, s), scale * value(dx, dy, s), 1e-15);
    const ResolveTable radial = resolve_table(pattern, jinc_lanczos(2));
    const Point& p = pattern.points[1];
    EXPECT_NEAR(radial.weight(1, -1, 1) / radial.weight(0, 0, 1),
                jinc_lanczos(2).value(std::hypot(1 + p.x, -1 + p.y)) / jinc_lanczos(2).value(std::hypot(p.x, p.y)),
                1e-12);
}

TEST(CombinedKernel, OfTwoBoxesIsTheTentAndOfDifferentOnesATrapezoid) {
    const Kernel combined = combined_kernel(box(), 1, box()), flat = combined_kernel(box(), 0.5, box());
    for (const double x : {-1.2, -1.0, -0.7, 0.0, 0.3, 0.99}) EXPECT_NEAR(combined.value(x), tent().value(x), 1e-14);
    EXPECT_NEAR(flat.value(0.25), 1, 1e-14);
    EXPECT_NEAR(flat.value(0.5), 0.5, 1e-14);
    EXPECT_NEAR(flat.value(0.7), 0.1, 1e-14);
    EXPECT_EQ(flat.radius, 0.75);
    // B-splines are boxes convolved with themselves.
    for (const double x : {0.0, 0.4, 1.3, 1.9})
        EXPECT_NEAR(combined_kernel(tent(), 1, tent()).value(x), bspline().value(x), 1e-14);
}

/// Samples of random values, `per_axis` in each pixel from -reach to reach.
struct FineSamples {
    int per_axis, reach;
    std::uint64_t seed = 3;

    double pitch() const { return 1.0 / per_axis; }
    double value(int i, int j) const {
        return uniform_from(hash_of(seed, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)));
    }
    /// Where sample i lies from the centre of pixel 0.
    double position(int i) const { return (i + 0.5) * pitch() - 0.5; }
};

TEST(CombinedKernel, EqualsTheFourSteps) {
    // Over-sample; reconstruct; band-limit; resample at the centre of pixel 0. The second step is a function of two
    // coordinates, made of all samples around a point; the third its integral, weighted. Both are polynomials between
    // multiples of half the fine pitch, so Gauss's quadrature there is exact but for rounding.
    const FineSamples fine{2, 4};
    for (const Kernel& reconstruction : {tent(), box(), quadratic_bspline()})
        for (const Kernel& band_limit : {box(), tent(), mitchell()}) {
            const auto reconstructed = [&](double x, double y) {
                double sum = 0;
                const int i0 = static_cast<int>(std::floor((x + 0.5) * fine.per_axis)), margin = 2;
                const int j0 = static_cast<int>(std::floor((y + 0.5) * fine.per_axis));
                for (int j = j0 - margin; j <= j0 + margin; ++j)
                    for (int i = i0 - margin; i <= i0 + margin; ++i)
                        sum += fine.value(i, j) * reconstruction.value((x - fine.position(i)) / fine.pitch()) *
                               reconstruction.value((y - fine.position(j)) / fine.pitch());
                return sum;
            };
            const double r = band_limit.radius;
            const Quadrature nodes = quadrature(-r, r, static_cast<int>(2 * r * fine.per_axis * 2));
            double steps = 0;
            for (std::size_t b = 0; b < nodes.at.size(); ++b)
                for (std::size_t a = 0; a < nodes.at.size(); ++a)
                    steps += nodes.weights[a] * nodes.weights[b] * band_limit.value(nodes.at[a]) *
                             band_limit.value(nodes.at[b]) * reconstructed(nodes.at[a], nodes.at[b]);

            const SamplePattern pattern = regular_pattern(fine.per_axis * fine.per_axis);
            const ResolveTable table = resolve_table(pattern, band_limit, reconstruction);
            double combined = 0;
            for (int dy = -table.reach; dy <= table.reach; ++dy)
                for (int dx = -table.reach; dx <= table.reach; ++dx)
                    for (int s = 0; s < table.samples; ++s)
                        combined += table.weight(dx, dy, s) * fine.value(dx * fine.per_axis + s % fine.per_axis,
                                                                         dy * fine.per_axis + s / fine.per_axis);
            EXPECT_NEAR(combined, steps, 1e-12) << reconstruction.name << ", " << band_limit.name;
        }
}

TEST(ResolveTable, RefusesKernelsThatResolveNothing) {
    EXPECT_THROW(resolve_table(d3d_pattern(4), nearest()), Error);
    EXPECT_THROW(resolve_table({"none", {}}, box()), Error);
    EXPECT_THROW(resolve_table(d3d_pattern(4), lanczos(17)), Error);
    Kernel narrow = tent();  // no sample lies so near to the centre
    narrow.radius = 0.04;
    narrow.value = [](double x) { return tent().value(x / 0.04); };
    EXPECT_THROW(resolve_table(d3d_pattern(4), narrow), Error);
    EXPECT_THROW(resolve_table(d3d_pattern(4), jinc_lanczos(3), tent()), Error);
    EXPECT_THROW(combined_kernel(tent(), 0, tent()), Error);
}

}  // namespace
}  // namespace bandlimit
