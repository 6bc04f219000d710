#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

void expect_same(const Kernel& a, const Kernel& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.radius, b.radius) << a.name;
    EXPECT_EQ(a.form, b.form) << a.name;
    EXPECT_EQ(a.knots, b.knots) << a.name;
    for (double x = 0; x < a.radius + 1; x += 0.037) ASSERT_EQ(a.value(x), b.value(x)) << a.name << ' ' << x;
}

std::string error_of(const std::string& name) {
    try {
        parse_kernel(name);
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << name << " must be refused";
    return {};
}

TEST(Parse, EveryExampleOfTheListReadsBackFromItsOwnName) {
    EXPECT_GE(kernel_list().size(), 18u);
    for (const KernelInfo& info : kernel_list()) {
        EXPECT_FALSE(info.summary.empty());
        const Kernel kernel = parse_kernel(info.example);
        EXPECT_EQ(kernel.name, info.example);
        expect_same(parse_kernel(kernel.name), kernel);
    }
}

TEST(Parse, AnyParameterReadsBackFromTheName) {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        const double b = random.uniform(-2, 2), c = random.uniform(-2, 2), radius = random.uniform(0.5, 9);
        expect_same(parse_kernel(cubic(b, c).name), cubic(b, c));
        expect_same(parse_kernel(truncated_sinc(radius).name), truncated_sinc(radius));
        expect_same(parse_kernel(gaussian(radius).name), gaussian(radius));
        expect_same(parse_kernel(kaiser(radius, b * b).name), kaiser(radius, b * b));
    }
    for (int lobes = 1; lobes <= 12; ++lobes)
        for (const Kernel& kernel :
             {lanczos(lobes), jinc_lanczos(lobes), jinc_lanczos_unscaled(lobes), radial_lanczos(lobes)})
            expect_same(parse_kernel(kernel.name), kernel);
}

TEST(Parse, NamesMeanTheirKernels) {
    expect_same(parse_kernel("cubic:0:0.5"), cubic(0, 0.5));
    expect_same(parse_kernel("cubic:-1:1e-2"), cubic(-1, 0.01));
    expect_same(parse_kernel("lanczos5"), lanczos(5));
    expect_same(parse_kernel("jinc3-unscaled"), jinc_lanczos_unscaled(3));
    expect_same(parse_kernel("kaiser:3.5:8"), kaiser(3.5, 8));
    expect_same(parse_kernel("mitchell"), mitchell());
    for (double x = 0; x < 2; x += 0.01) {
        ASSERT_EQ(parse_kernel("mitchell").value(x), cubic(1.0 / 3, 1.0 / 3).value(x));
        ASSERT_EQ(parse_kernel("catmull-rom").value(x), cubic(0, 0.5).value(x));
        ASSERT_EQ(parse_kernel("bspline").value(x), cubic(1, 0).value(x));
    }
}

TEST(Parse, Aliases) {
    for (const auto& [word, meaning] : {std::pair{"point", "nearest"},
                                        {"area", "box"},
                                        {"linear", "tent"},
                                        {"bilinear", "tent"},
                                        {"triangle", "tent"},
                                        {"quadratic-bspline", "quadratic"},
                                        {"biquadratic", "quadratic"},
                                        {"b-spline", "bspline"},
                                        {"cubic-bspline", "bspline"},
                                        {"catrom", "catmull-rom"},
                                        {"catmullrom", "catmull-rom"},
                                        {"lanczos", "lanczos3"},
                                        {"ewa-lanczos", "jinc3"},
                                        {"jinc", "jinc3"}})
        EXPECT_EQ(parse_kernel(word).name, meaning) << word;
}

TEST(Parse, WordsOfManyMeaningsAreRefusedWithTheCandidates) {
    for (const char* word : {"bicubic", "cubic"}) {
        const std::string text = error_of(word);
        for (const char* candidate : {"bspline", "catmull-rom", "mitchell", "cubic:B:C"})
            EXPECT_NE(text.find(candidate), std::string::npos) << text;
    }
    EXPECT_NE(error_of("gauss").find("gaussian:SIGMA"), std::string::npos);
}

TEST(Parse, UnknownNamesListWhatIsKnown) {
    for (const char* word : {"", "spline36", "Lanczos3", "lanczos3 ", "lanczosx", "lanczos3x", "jinc-unscaled", "3"}) {
        const std::string text = error_of(word);
        for (const KernelInfo& info : kernel_list()) EXPECT_NE(text.find(info.name), std::string::npos) << text;
    }
}

TEST(Parse, ParametersMustBeCompleteNumbersInRange) {
    for (const char* name : {"cubic:1",     "cubic:1:2:3", "cubic:1:x",          "cubic:1:",   "cubic::1",
                             "cubic:1,2",   "cubic:nan:0", "cubic:0:inf",        "sinc",       "sinc:0",
                             "sinc:-3",     "sinc:4x",     "gaussian",           "gaussian:0", "kaiser:4",
                             "kaiser:4:-1", "tent:1",      "nearest:",           "lanczos0",   "lanczos-1",
                             "lanczos3:1",  "lanczos:3",   "lanczos99999999999", "jinc0",      "radial-lanczos0",
                             "cubic: 1:1",  "cubic:0x1:1"})
        EXPECT_FALSE(error_of(name).empty()) << name;
}

}  // namespace
}  // namespace bandlimit
