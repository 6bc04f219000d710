// What the program says of patterns of samples, and what it makes of scenes: analyze --pattern, supersample.
#include <cmath>
#include <map>

#include "apps/run_program_test.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/sampling/pattern_analysis.h"

namespace bandlimit {
namespace {

using nlohmann::json;

json report(const Shell& shell, const std::string& line) {
    const Outcome run = shell(line + " --json");
    EXPECT_TRUE(succeeds(run)) << line;
    return json::parse(run.out, nullptr, false);
}

TEST(AnalyzePattern, ReportsPointsAndEdges) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json r = report(shell, "analyze --pattern d3d:4");
    EXPECT_EQ(r["points"], json::parse("[[-0.125,-0.375],[0.375,-0.125],[-0.375,0.125],[0.125,0.375]]"));
    ASSERT_EQ(r["edges"].size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(r["edges"][i]["degrees"], sweep_degrees[i]);
    EXPECT_EQ(r["edges"][0]["levels"], 5);
    EXPECT_EQ(r["edges"][0]["steps"], json::parse("[0.25,0.25,0.25,0.25]"));
    EXPECT_NEAR(r["edges"][0]["max_gap"].get<double>(), 0.25, 1e-12);
    EXPECT_EQ(r["edges"][3]["levels"], 3);
    EXPECT_NEAR(r["edges"][3]["rms"].get<double>(), 0.133, 0.0005);
    EXPECT_EQ(r["edges"][4]["levels"], 5);
    EXPECT_EQ(report(shell, "analyze --pattern rotated:4")["edges"][0]["steps"], json::parse("[0.25,0.5,0.25]"));
}

TEST(AnalyzePattern, PrintsDrawsAndLists) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome run = shell("analyze --pattern sobol:16:3 --plot p.svg");
    ASSERT_TRUE(succeeds(run));
    EXPECT_NE(run.out.find("sobol:16:3: 16 points per pixel"), std::string::npos) << run;
    EXPECT_NE(run.out.find("discrepancy"), std::string::npos) << run;
    EXPECT_TRUE(bytes_of(shell / "p.svg").find("</svg>") != std::string::npos);
    EXPECT_NE(shell("analyze --list-patterns").out.find("n-rooks:N:SEED"), std::string::npos);
    EXPECT_TRUE(succeeds(shell("analyze --pattern rotated:16")));  // leaves the pixel
}

TEST(AnalyzePattern, WrongCommandLines) {
    const Shell shell(BANDLIMIT_PROGRAM);
    EXPECT_TRUE(fails(2, shell("analyze --pattern hex:4"), "regular:N"));
    EXPECT_TRUE(fails(2, shell("analyze --pattern d3d:3"), "2, 4, 8 and 16"));
    EXPECT_TRUE(fails(2, shell("analyze --pattern regular:5"), "4 or 9"));
    EXPECT_TRUE(fails(2, shell("analyze --pattern sobol"), "sobol:16:1"));
    EXPECT_TRUE(fails(2, shell("analyze tent --pattern d3d:4"), "--pattern"));
    EXPECT_TRUE(fails(2, shell("analyze --pattern d3d:4 --phase 0"), "--plot"));
    EXPECT_TRUE(fails(2, shell("analyze --pattern d3d:4 --plot p.bmp"), ".svg or .png"));
}

TEST(Supersample, DrawsTheSameFileWithAnyNumberOfThreads) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const char* options : {"", "--vary 4 --kernel lanczos2 --tone karis", "--mixed checkerboard --kernel tent",
                                "--pattern regular:4 --kernel mitchell --reconstruct tent --frame 3"}) {
        const std::string line = std::string("--size 40x30 ") + options + " --threads ";
        ASSERT_TRUE(succeeds(shell("supersample zoneplate a.exr " + line + "1")));
        ASSERT_TRUE(succeeds(shell("supersample zoneplate b.exr " + line + "3")));
        const Image<float> a = job::read_picture(shell / "a.exr"), b = job::read_picture(shell / "b.exr");
        ASSERT_EQ(a.width(), 40);
        ASSERT_EQ(a.channels(), 4);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                for (int c = 0; c < 4; ++c) ASSERT_EQ(a.view()(x, y, c), b.view()(x, y, c)) << options;
    }
}

TEST(Supersample, WritesEveryFormat) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const char* name : {"a.png", "a.jpg", "a.hdr", "a.tif"}) {
        ASSERT_TRUE(
            succeeds(shell(std::string("supersample edge ") + name + " --size 9x5 --pattern d3d:2 --kernel box")))
            << name;
        EXPECT_EQ(job::read_picture(shell / name).width(), 9);
    }
}

TEST(Supersample, ReportsEdgesAliasesAndErrors) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const json r = report(shell, "supersample zoneplate a.png --size 32x32 --pattern sobol:16:1 --kernel mitchell");
    EXPECT_EQ(r["pattern"], "sobol:16:1");
    EXPECT_EQ(r["samples_per_pixel"], 16);
    EXPECT_EQ(r["edges"].size(), 36u);
    EXPECT_GT(r["alias_energy"], 0);
    EXPECT_LT(r["alias_energy"], 0.1);
    double before = 0;
    for (const json& count : r["psnr"]) {
        EXPECT_GT(count["psnr"], before) << count;
        before = count["psnr"];
    }
    EXPECT_EQ(r["psnr"].size(), 7u);
    std::map<std::string, double> tent_errors;
    for (const json& m : r["mixed_resolution"])
        if (m["kernel"] == "tent") tent_errors[m["mode"]] = m["rmse"];
    EXPECT_NEAR(tent_errors["checkerboard"] / tent_errors["uniform"], 1, 0.02);
    EXPECT_NEAR(tent_errors["checkerboard"], 0.134, 0.001);
    EXPECT_NEAR(tent_errors["interlaced"], 0.164, 0.001);
    EXPECT_EQ(r["outline"].size(), 4u);
}

TEST(Supersample, WrongCommandLines) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const std::string good = "supersample edge out.png --size 8x8 ";
    EXPECT_TRUE(fails(2, shell("supersample hills out.png --size 8x8"), "zoneplate"));
    EXPECT_TRUE(fails(2, shell("supersample edge out.png"), "--size"));
    EXPECT_TRUE(fails(2, shell("supersample edge out.png --size 8"), "--size"));
    EXPECT_TRUE(fails(2, shell("supersample edge out.xyz --size 8x8"), "xyz"));
    EXPECT_TRUE(fails(2, shell(good + "--pattern d3d:5"), "2, 4, 8 and 16"));
    EXPECT_TRUE(fails(2, shell(good + "--kernel nearest"), "box"));
    EXPECT_TRUE(fails(2, shell(good + "--kernel lanczos17"), "radius 16"));
    EXPECT_TRUE(fails(2, shell(good + "--tone reinhard"), "karis"));
    EXPECT_TRUE(fails(2, shell(good + "--mixed half"), "checkerboard"));
    EXPECT_TRUE(fails(2, shell(good + "--mixed full --tone karis"), "--mixed"));
    EXPECT_TRUE(fails(2, shell(good + "--mixed full --pattern d3d:2"), "--mixed"));
    EXPECT_TRUE(fails(2, shell(good + "--vary x"), "--vary"));
    EXPECT_TRUE(fails(1, shell("supersample edge none/out.png --size 8x8"), "none"));
    EXPECT_TRUE(shell.files().empty());
}

}  // namespace
}  // namespace bandlimit
