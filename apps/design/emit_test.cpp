// bandlimit design --emit: what is printed and written; that it is right is shown where shaders are executed.
#include <array>
#include <set>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

TEST(DesignEmit, PrintsWhatIsPastedAndHowItWasMade) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Outcome soft = shell("design gaussian --sigma 2 --emit glsl --name soft --quiet");
    ASSERT_TRUE(succeeds(soft));
    EXPECT_EQ(soft.err, "");
    for (const char* words : {"vec4 soft_horizontal(", "vec4 soft_vertical(",
                              "Made by: bandlimit design gaussian --sigma 2 --emit glsl --name soft --quiet"})
        EXPECT_NE(soft.out.find(words), std::string::npos) << words;
    // Nine weights of 1 are pasted as a mean: pictures keep their brightness.
    const Outcome box = shell("design separable box:3:2 --rank 1 --emit wgsl");
    ASSERT_TRUE(succeeds(box));
    for (const char* words : {"divided by their sum", "0.111111111,"})
        EXPECT_NE(box.out.find(words), std::string::npos) << words << "\n" << box.out;
    const Outcome lens = shell("design disk --components 1 --emit hlsl");
    ASSERT_TRUE(succeeds(lens));
    EXPECT_NE(lens.out.find("radius of 25 pixels"), std::string::npos);
}

TEST(DesignEmit, WritesEveryLanguage) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("design kernel --radius 2 --emit-to . --quiet")));
    EXPECT_EQ(shell.files(), (std::set<std::string>{"sample_kernel.glsl", "sample_kernel.hlsl", "sample_kernel.wgsl",
                                                    "sample_kernel.metal", "sample_kernel.slang", "sample_kernel.h"}));
}

TEST(DesignEmit, RefusesInOneLineAndWritesNothing) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const auto& [arguments, word] : {std::pair{"gaussian --sigma 2 --emit glsl --name 2x", "2x"},
                                          {"gaussian --sigma 2 --emit glsl --name kernel", "kernel"},
                                          {"gaussian --sigma 2 --emit cobol", "glsl"},
                                          {"gaussian --sigma 2 --emit glsl --json", "--emit-to"}})
        EXPECT_TRUE(fails(2, shell(std::string("design ") + arguments), word)) << arguments;
    EXPECT_TRUE(fails(1, shell("design gaussian --sigma 2 --emit-to none"), "none"));
    EXPECT_TRUE(shell.files().empty());
}

}  // namespace
}  // namespace bandlimit
