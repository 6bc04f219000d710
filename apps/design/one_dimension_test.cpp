// bandlimit design derivative, gaussian, sharpen and kernel from outside.
#include <cmath>
#include <string>
#include <vector>

#include "apps/run_program_test.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit {
namespace {

using nlohmann::json;

/// One clear line that holds `part`, and the exit code of a command line that is wrong.
void expect_usage_error(const Shell& shell, const std::string& line, const std::string& part) {
    const Outcome run = shell(line);
    EXPECT_EQ(run.code, 2) << line << ' ' << run;
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(part), std::string::npos) << line << ' ' << run;
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run;
}

TEST(Design1d, DerivativesKeepOrLoseSlopesAndSaySo) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome lost = shell("design derivative --taps 9 --optimal least-squares");
    EXPECT_EQ(lost.code, 0) << lost;
    EXPECT_NE(lost.out.find("slopes are lost; keep them with --ramp"), std::string::npos) << lost;
    const Outcome kept =
        shell("design derivative --taps 9 --optimal least-squares --ramp --plot derivative.svg -o derivative.json");
    EXPECT_EQ(kept.code, 0) << kept;
    EXPECT_EQ(shell.files(), (std::set<std::string>{"derivative.json", "derivative.svg"}));
    const TapsFile file = read_taps(shell / "derivative.json");
    EXPECT_EQ(file.kind, "derivative");
    ASSERT_TRUE(file.taps && file.error);
    EXPECT_EQ(file.taps->first, -4);
    EXPECT_NEAR(file.taps->weights[5], 61 / 60.0, 1e-12);
}

TEST(Design1d, GaussiansAreFetchesAndTaps) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell("design gaussian --sigma 2 --fetches 5 --json");
    ASSERT_EQ(run.code, 0) << run;
    const json r = run.json();
    EXPECT_EQ(r["kind"], "gaussian");
    EXPECT_EQ(r["fetches"].size(), 5u);
    EXPECT_EQ(r["taps"]["weights"].size(), 9u);
    EXPECT_EQ(r["cost"], 10) << "along both axes";
    double sum = 0;
    for (const json& fetch : r["fetches"]) sum += fetch["weight"].get<double>();
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LT(r["error"].get<double>(), 0.002);
}

TEST(Design1d, SharpeningUndoesWhatItNames) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell("design sharpen --undo bspline --taps 31 --band 1/2 --phase 0 --json");
    ASSERT_EQ(run.code, 0) << run;
    EXPECT_NEAR(run.json()["taps"]["weights"][15].get<double>(), std::sqrt(3.0), 1e-8);
}

TEST(Design1d, AFittedKernelIsUsedAsAnyOther) {
    const Shell shell(BANDLIMIT_PROGRAM);
    // The only such kernel is the cubic B-spline: files made by either are the same.
    EXPECT_EQ(shell("design kernel --radius 2 --smoothness 2 -o mine.json --plot mine.svg").code, 0);
    const Outcome mine = shell("analyze mine.json --at 0,1 --phase 1/3 --json"),
                  named = shell("analyze bspline --at 0,1 --phase 1/3 --json");
    ASSERT_EQ(mine.code, 0) << mine;
    const json a = mine.json()["phases"][0]["weights"], b = named.json()["phases"][0]["weights"];
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].get<double>(), b[i].get<double>(), 1e-12);
    EXPECT_EQ(shell("pattern zoneplate z.png --size 32x32").code, 0);
    const Outcome resized = shell("resize z.png mine.png --size 20x45 --kernel mine.json --json");
    ASSERT_EQ(resized.code, 0) << resized;
    EXPECT_EQ(resized.json()["kernel"]["x"], "mine.json");
    EXPECT_EQ(shell("resize z.png named.png --size 20x45 --kernel bspline").code, 0);
    const Outcome compared = shell("compare mine.png named.png --json");
    // Of 900 codes some may round the other way: each adds (1 / 255)^2 / 900.
    EXPECT_LT(compared.json()["mse"].get<double>(), 1e-7) << compared;
}

TEST(Design1d, BadInputIsOneClearLine) {
    const Shell shell(BANDLIMIT_PROGRAM);
    expect_usage_error(shell, "design derivative --taps 1", "2 to 255");
    expect_usage_error(shell, "design gaussian --sigma 0", "0.1 to 250");
    expect_usage_error(shell, "design sharpen --undo jinc2", "radial");
    expect_usage_error(shell, "design kernel --radius 1 --smoothness 2", "no kernel of radius 1");
}

}  // namespace
}  // namespace bandlimit
