// The environment variable BANDLIMIT_TARGETS, as the program obeys it.
#include "bandlimit/core/targets.h"

#include <cstdlib>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

class TargetsOfTheProgram : public testing::Test {
protected:
    ~TargetsOfTheProgram() override { ::unsetenv("BANDLIMIT_TARGETS"); }

    Outcome run_with(const std::string& value, const std::string& line) const {
        ::setenv("BANDLIMIT_TARGETS", value.c_str(), 1);
        return shell_.start(line);
    }

    const Shell shell_{BANDLIMIT_PROGRAM};
};

TEST_F(TargetsOfTheProgram, AWrongOneIsOneLineAndExitCode2) {
    const std::string line = "pattern checker out.png --size 8x8";
    EXPECT_TRUE(fails(2, run_with("nonsense", line),
                      "BANDLIMIT_TARGETS is \"nonsense\", which is not an instruction set; set it to scalar"));
    const bool is_arm = supported_targets().back() == Target::neon;
    EXPECT_TRUE(
        fails(2, run_with(is_arm ? "avx2" : "neon", line), "which this machine or build lacks; set it to scalar"));
    EXPECT_TRUE(shell_.files().empty());
    EXPECT_EQ(run_with("nonsense", "--help").code, 0);
}

TEST_F(TargetsOfTheProgram, AllThatRoundOncePerTapGiveTheSameFile) {
    AnyImage picture =
        image_of<std::uint8_t>(97, 61, 3, [](int x, int y, int c) { return (x * x + y * 31 + c * 7) % 256; });
    save(shell_ / "in.png", picture);
    for (const char* space : {"srgb", "linear"}) {  // by floats, in integers
        const auto resized = [&](Target target) {
            const std::string out = message(space, '-', name_of(target), ".png");
            EXPECT_TRUE(succeeds(run_with(std::string(name_of(target)),
                                          message("resize in.png ", out, " --size 40x33 --space ", space))));
            return bytes_of(shell_ / out);
        };
        const std::string expected = resized(Target::scalar);
        for (const Target target : supported_targets()) {
            const bool is_in_integers = std::string(space) == "linear";
            if (!has_fused_multiply_add(target) && !is_in_integers) continue;
            EXPECT_EQ(resized(target), expected) << space << ' ' << name_of(target);
        }
    }
}

}  // namespace
}  // namespace bandlimit
