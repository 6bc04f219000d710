// The program's design downsample, and what other verbs make of its files, from outside.
#include <cmath>

#include "apps/run_program_test.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit {
namespace {

const std::string verb = "design downsample ";

/// A picture of waves of that many cycles per texel along x.
void save_waves(const std::string& path, double frequency) {
    AnyImage image = image_of<std::uint8_t>(64, 64, 1, [&](int x, int, int) {
        return std::lround(128 + 100 * std::cos(2 * 3.14159265358979 * frequency * x));
    });
    save(path, image);
}

TEST(DesignDownsample, FetchesGoThroughOtherVerbs) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell(verb + "--fetches 8 --json -o eight.json --plot eight.svg");
    ASSERT_TRUE(succeeds(run));
    EXPECT_EQ(bytes_of(shell / "eight.json"), run.out);
    const TapsFile file = parse_taps(run.out, "stdout");
    EXPECT_EQ(file.kind, "downsample");
    EXPECT_EQ(file.factor, 2);
    EXPECT_EQ(file.cost, 8);
    EXPECT_EQ(file.fetches.size(), 8u);
    EXPECT_FALSE(file.taps);
    EXPECT_LE(*file.error, 0.02780);
    // Its response, as analyze sees it: 1 at 0, and less than a tenth at the highest frequency.
    const Outcome seen = shell("analyze eight.json --frequency 0,1/2 --json --plot seen.svg");
    ASSERT_TRUE(succeeds(seen));
    const nlohmann::json phase = seen.json()["phases"][0];
    EXPECT_NEAR(phase["sum"].get<double>(), 1, 1e-12);
    EXPECT_NEAR(phase["response"][0]["gain"].get<double>(), 1, 1e-12);
    EXPECT_LT(phase["response"][1]["gain"].get<double>(), 0.1);
    EXPECT_NEAR(phase["response_diagonal"][1]["gain"].get<double>(), 0, 0.1);
    EXPECT_EQ(phase["weights"].size(), 8u);
    // Mips run it, and say so.
    save_waves(shell / "waves.png", 3.0 / 8);
    const Outcome mips = shell("mips waves.png waves.ktx2 --role data --filter eight.json --json");
    ASSERT_TRUE(succeeds(mips));
    EXPECT_EQ(mips.json()["filter"]["x"], "8 fetches");
}

TEST(DesignDownsample, TapsAreOfOneAxis) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell(verb + "--taps 8 --json");
    ASSERT_TRUE(succeeds(run));
    const TapsFile file = parse_taps(run.out, "stdout");
    ASSERT_TRUE(file.taps);
    EXPECT_NEAR(file.taps->weights[4], 0.46369, 5e-6);
    EXPECT_EQ(file.cost, 8);
    EXPECT_TRUE(file.fetches.empty());
}

TEST(DesignDownsample, ReportsForPeople) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome folded = shell(verb + "--taps 8 --threshold 0.02");
    ASSERT_TRUE(succeeds(folded));
    for (const char* words : {"8 fetches for 32 of 8 x 8 weights", "0.02779", "8 reads", "largest gain", "H at (f, f)"})
        EXPECT_NE(folded.out.find(words), std::string::npos) << words << "\n" << folded.out;
    const Outcome curve = shell(verb + "--upsample --curve");
    ASSERT_TRUE(succeeds(curve));
    EXPECT_NE(curve.out.find("fetches      error"), std::string::npos) << curve.out;
    EXPECT_NE(curve.out.find("upsample by 2"), std::string::npos) << curve.out;
}

TEST(DesignDownsample, RefusesInOneLine) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const auto& [arguments, what] : {std::pair{"--fetches 6", "6 fetches"},
                                          {"--taps 7", "7 taps"},
                                          {"--factor 1", "factor = 1"},
                                          {"--layout ring", "--layout"},
                                          {"--weighting 1", "--weighting"},
                                          {"--max-gain 0.5", "max_gain"}})
        EXPECT_TRUE(fails(2, shell(verb + arguments), what)) << arguments;
}

}  // namespace
}  // namespace bandlimit
