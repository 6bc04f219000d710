#include "bandlimit/core/targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/targets_test.h"

namespace bandlimit {
namespace {

constexpr Target all[]{Target::scalar, Target::sse4, Target::avx2, Target::avx512, Target::neon, Target::wasm};

std::string error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

TEST(Targets, NamesAreParsed) {
    for (const Target target : all) EXPECT_EQ(parse_target(name_of(target)), target);
    for (const char* wrong : {"", "AVX2", "avx", "avx2 ", "avx2,sse4", "avx3"})
        EXPECT_EQ(error_of([&] { parse_target(wrong); }),
                  message("target \"", wrong, "\" is unknown; choose scalar, sse4, avx2, avx512, neon or wasm"));
}

TEST(Targets, ScalarIsAlwaysThere) { EXPECT_EQ(supported_targets().front(), Target::scalar); }

#ifdef __x86_64__
TEST(Targets, AreThoseOfTheMachine) {
    std::vector<Target> expected{Target::scalar};
    if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("aes")) expected.push_back(Target::sse4);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) expected.push_back(Target::avx2);
    if (__builtin_cpu_supports("avx512vbmi2") && __builtin_cpu_supports("avx512vnni"))
        expected.push_back(Target::avx512);
    EXPECT_EQ(supported_targets(), expected);
}
#endif

TEST(Targets, OneIsUsedUntilTheEndOfItsScope) {
    const Target before = current_target();
    for_each_target([&](Target outer) {
        EXPECT_EQ(current_target(), outer);
        for_each_target([&](Target inner) { EXPECT_EQ(current_target(), inner); });
        EXPECT_EQ(current_target(), outer);
    });
    EXPECT_EQ(current_target(), before);
}

TEST(Targets, WhatTheMachineLacksIsRefused) {
    const Target before = current_target();
    const std::vector<Target> supported = supported_targets();
    for (const Target target : all) {
        if (std::find(supported.begin(), supported.end(), target) != supported.end()) continue;
        const std::string error = error_of([&] { use_target(target); });
        EXPECT_TRUE(error.starts_with(message("use_target: this machine or build lacks ", name_of(target), "; pass ")))
            << error;
        EXPECT_EQ(current_target(), before);
    }
}

/// Ends this process, which has not read the variable, after printing what that leads to: the error, twice the same, or
/// the target.
[[noreturn]] void say_target_with(const char* value) {
    ::setenv("BANDLIMIT_TARGETS", value, 1);
    const std::string error = error_of([] { current_target(); }), again = error_of([] { current_target(); });
    const std::string said = error.empty() ? std::string(name_of(current_target())) : error;
    std::fprintf(stderr, "[%s]\n", again == error ? said.c_str() : "not the same again");
    std::exit(0);
}

class TargetVariable : public testing::Test {
protected:
    // A fresh process: this one has read the variable.
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(TargetVariable, NamesTheTargetInUse) {
    for (const Target target : supported_targets()) {
        const std::string name(name_of(target));
        EXPECT_EXIT(say_target_with(name.c_str()), testing::ExitedWithCode(0), "\\[" + name + "\\]");
    }
}

TEST_F(TargetVariable, LeavesTheWidestWhereItIsEmpty) {
    const std::string widest(name_of(supported_targets().back()));
    EXPECT_EXIT(say_target_with(""), testing::ExitedWithCode(0), "\\[" + widest + "\\]");
}

TEST_F(TargetVariable, IsAnErrorEachTimeWhereItNamesNoTarget) {
    for (const char* wrong : {"nonsense", "AVX2", "sse4,avx2"})
        EXPECT_EXIT(say_target_with(wrong), testing::ExitedWithCode(0),
                    message("\\[the environment variable BANDLIMIT_TARGETS is \"", wrong,
                            "\", which is not an instruction set; set it to scalar"));
}

TEST_F(TargetVariable, IsAnErrorWhereTheMachineLacksTheTarget) {
    const char* const foreign = supported_targets().back() == Target::neon ? "avx2" : "neon";
    EXPECT_EXIT(say_target_with(foreign), testing::ExitedWithCode(0),
                message("is \"", foreign, "\", which this machine or build lacks; set it to scalar"));
}

}  // namespace
}  // namespace bandlimit
