#include "bandlimit/job/analyze.h"

#include <gtest/gtest.h>

#include "bandlimit/core/error.h"

namespace bandlimit::job {
namespace {

TEST(AnalyzeJob, ATentHalfwayBetweenSamplesAveragesTwo) {
    const Analysis a = analyze_kernel(tent(), {.phases = {0.5}, .frequencies = {0.5}, .bank = BankRows{4, 2, {1}}});
    ASSERT_EQ(a.phases.size(), 1u);
    EXPECT_EQ(a.phases[0].weights, (std::vector<std::vector<double>>{{0.5, 0.5}}));
    EXPECT_EQ(a.phases[0].variance, 0.5);
    EXPECT_NEAR(std::abs(a.phases[0].responses[0].h), 0, 1e-15);  // cos(pi f)
    ASSERT_EQ(a.rows.size(), 1u);
    EXPECT_EQ(a.rows[0].output, 1);
    double total = 0;
    for (const float w : a.rows[0].weights) total += w;
    EXPECT_NEAR(total, 1, 1e-6);
}

TEST(AnalyzeJob, TapsLieAtTheirOnePhase) {
    const TapsFile file{.kind = "downsample", .factor = 2, .taps = Taps{-1, {0.125, 0.375, 0.375, 0.125}, 2}};
    const Analysis a = analyze_taps(file, "half", {.bank = BankRows{8, 4, {0}}});
    EXPECT_EQ(a.phases[0].phase, 0.5);
    EXPECT_EQ(a.phases[0].centroid, 0.5);
    EXPECT_FALSE(a.radius);
    EXPECT_THROW(analyze_taps(file, "half", {.bank = BankRows{8, 3, {0}}}), Error);
}

TEST(AnalyzeJob, RefusesWhatIsOutOfRange) {
    EXPECT_THROW(analyze_kernel(tent(), {.phases = {1}}), Error);
    EXPECT_THROW(analyze_kernel(tent(), {.frequencies = {1e9}}), Error);
    EXPECT_THROW(analyze_kernel(tent(), {.bank = BankRows{4, 2, {2}}}), Error);
    EXPECT_THROW(read_subject("no-such-kernel"), Error);
}

}  // namespace
}  // namespace bandlimit::job
