#include "bandlimit/analysis/line_probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bandlimit/analysis/resizers_test.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

TEST(LineProbe, MeasuresTheWeightsOfABank) {
    for (const Ratio& ratio : {Ratio{1, 2}, Ratio{37, 100}, Ratio{5, 3}}) {
        const LineProbe probe = line_probe(ratio);
        const auto make = [](int inputs, int outputs) {
            return make_bank(lanczos(3), Axis{inputs}, Axis{outputs}, Edge::renormalize);
        };
        const Image<float> image = draw(probe, 0.25f, 0.75f);
        const Image<float> result =
            by_bank(make, [](float v) { return v; })(image.view(), probe.outputs, probe.out_height());
        const MeasuredBank measured = measure(probe, result.view(), 0.25, 0.75);
        const Bank bank = make(probe.inputs, probe.outputs);
        for (int i = 0; i < probe.outputs; ++i) {
            std::vector<double> expected(std::size_t(probe.inputs), 0);
            for (std::size_t k = 0; k < bank.row(i).size(); ++k)
                expected[std::size_t(bank.first(i)) + k] = double(bank.row(i)[k]);
            const int middle = static_cast<int>(measured.corner_position(i));
            const int near = std::min(12, probe.period() / 2 - 1);
            for (int j = std::max(0, middle - near); j < std::min(probe.inputs, middle + near); ++j)
                // Two passes of float sums.
                ASSERT_NEAR(measured.weight(i, j), expected[std::size_t(j)], 2e-6) << i << ", " << j;
        }
        EXPECT_NEAR(measured.bias, 0, 1e-6);
    }
}

TEST(LineProbe, ShowsEveryPhaseAndLeavesRoomForTheKernel) {
    for (const Ratio& ratio :
         {Ratio{1, 2}, Ratio{37, 100}, Ratio{2, 1}, Ratio{100, 37}, Ratio{127, 128}, Ratio{1, 8}}) {
        const LineProbe probe = line_probe(ratio);
        EXPECT_GT(probe.period(), 2 * probe.reach * ratio.stretch());
        EXPECT_GT(probe.band, 2 * probe.reach * ratio.stretch());
        EXPECT_EQ(probe.outputs * ratio.from, probe.inputs * ratio.to);
        EXPECT_EQ(probe.out_height() * ratio.from, probe.height() * ratio.to);
        MeasuredBank bank{ratio, probe.reach, probe.inputs, probe.outputs, probe.period(), {}};
        std::set<long> phases;
        for (int i = bank.interior_begin(); i < bank.interior_end(); ++i)
            phases.insert(std::lround((bank.corner_position(i) - std::floor(bank.corner_position(i))) * 1e6) % 1000000);
        EXPECT_GE(int(phases.size()), ratio.to) << ratio.to << "/" << ratio.from;
    }
}

TEST(LineProbe, NoiseFallsByTheRootOfTheBands) {
    const LineProbe probe = line_probe({1, 2});
    Image<float> result(probe.outputs, probe.out_height());
    Random random(7);
    const double sigma = 0.01;
    for_samples(result.view(), [&](float) {  // uniform on +-sqrt(3) sigma
        return static_cast<float>(0.5 + sigma * std::sqrt(3.0) * random.uniform(-1, 1));
    });
    const MeasuredBank bank = measure(probe, result.view(), 0.25, 0.75, sigma);
    double square = 0;
    for (const double w : bank.weights) square += w * w / double(bank.weights.size());
    EXPECT_NEAR(bank.noise, sigma / 0.25 / std::sqrt(32.0), 1e-12);
    EXPECT_NEAR(std::sqrt(square), bank.noise, 0.1 * bank.noise);  // 1426 weights: 2 % standard deviation
}

TEST(LineProbe, RatiosAndErrors) {
    const auto expect = [](double scale, int to, int from) {
        const Ratio r = ratio_of(scale);
        EXPECT_EQ(r.to, to) << scale;
        EXPECT_EQ(r.from, from) << scale;
    };
    expect(0.5, 1, 2), expect(0.37, 37, 100), expect(100.0 / 37, 100, 37), expect(1, 1, 1), expect(10.0 / 37, 10, 37);
    for (const double bad : {0.1, 9.0, 0.0, std::nan(""), 0.123456789}) EXPECT_THROW(ratio_of(bad), Error) << bad;
    EXPECT_THROW(line_probe({1, 2}, 0.5), Error);
    const LineProbe probe = line_probe({1, 2});
    EXPECT_THROW(measure(probe, draw(probe, 0, 1).view(), 0, 1), Error);
    const Image<float> result(probe.outputs, probe.out_height());
    EXPECT_THROW(measure(probe, result.view(), 0.5, 0.5), Error);
}

}  // namespace
}  // namespace bandlimit
