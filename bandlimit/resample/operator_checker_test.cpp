#include "bandlimit/resample/operator_checker_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <utility>

namespace bandlimit {
namespace {

float blurred(View<const float> src, int x, int y, int c) {
    const float left = src(std::max(x - 1, 0), y, c), right = src(std::min(x + 1, src.width - 1), y, c);
    return 0.25f * left + 0.5f * src(x, y, c) + 0.25f * right;
}

/// [1 2 1]/4 along x, written to be right: the broken ones below differ from it in one thing each.
void blur(View<const float> src, View<float> dst, Window window, Parallel) {
    for (int c = 0; c < dst.channels; ++c)
        for (int y = 0; y < dst.height; ++y)
            for (int x = 0; x < dst.width; ++x) dst(x, y, c) = blurred(src, window.x + x, window.y + y, c);
}

using Run = decltype(Operator::run);

Operator blur_run_by(Run run) {
    return {std::move(run),
            [](View<const float> src, int x, int y, int c) {
                const double left = src(std::max(x - 1, 0), y, c), right = src(std::min(x + 1, src.width - 1), y, c);
                return 0.25 * left + 0.5 * src(x, y, c) + 0.25 * right;
            },
            // Values are at most 2; two sums are rounded, products by powers of 2 are exact.
            [](View<const float>, int, int, int) { return 2 * 2 * 0x1p-24; }};
}

float next(float x) { return std::nextafter(x, std::numeric_limits<float>::infinity()); }

TEST(OperatorChecker, PassesWhatIsRight) {
    EXPECT_TRUE(check_operator(blur_run_by(blur)));
    Operator halve{[](View<const float> src, View<float> dst, Window window, Parallel) {
                       for (int c = 0; c < dst.channels; ++c)
                           for (int y = 0; y < dst.height; ++y)
                               for (int x = 0; x < dst.width; ++x)
                                   dst(x, y, c) = src(2 * (window.x + x), window.y + y, c);
                   },
                   [](View<const float> src, int x, int y, int c) { return double(src(2 * x, y, c)); },
                   [](View<const float>, int, int, int) { return 0.0; },
                   [](Size size) {
                       return Size{(size.width + 1) / 2, size.height};
                   }};
    EXPECT_TRUE(check_operator(halve));
}

struct Broken {
    const char* what;
    Run run;
    const char* complaint;  ///< what the checker must say
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.what; }

class BrokenOperators : public testing::TestWithParam<Broken> {};

TEST_P(BrokenOperators, Fail) {
    const testing::AssertionResult result = check_operator(blur_run_by(GetParam().run));
    EXPECT_FALSE(result);
    EXPECT_NE(std::string(result.message()).find(GetParam().complaint), std::string::npos) << result.message();
}

/// Does the right thing, and then something else.
template <class Also>
Run blur_and(Also also) {
    return [also](View<const float> src, View<float> dst, Window window, Parallel parallel) {
        blur(src, dst, window, parallel);
        also(src, dst, window, parallel);
    };
}

const Broken broken_operators[] = {
    {"writes behind the end",
     blur_and([](auto, View<float> dst, Window, Parallel) { dst(dst.width, dst.height - 1, dst.channels - 1) = 0; }),
     "written outside"},
    {"writes before the begin", blur_and([](auto, View<float> dst, Window, Parallel) { dst(-1, 0) = 0; }),
     "written outside"},
    {"writes into the padding of rows", blur_and([](auto, View<float> dst, Window, Parallel) {
         if (dst.dc == 1 && dst.dx == dst.channels && dst.dy > dst.width * dst.dx) dst.data[dst.width * dst.dx] = 0;
     }),
     "written outside"},
    {"leaves a sample of wide rows unwritten",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         const int width = dst.width > 20 ? dst.width - 1 : dst.width;
         blur(src, cropped(dst, 0, 0, width, dst.height), {window.x, window.y, width, window.height}, parallel);
     },
     "not written"},
    {"leaves the last channel unwritten",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         blur(src, channels_of(dst, 0, std::min(dst.channels, 3)), window, parallel);
     },
     "not written"},
    {"uses its input as scratch",
     blur_and([](View<const float> src, auto, Window, Parallel) { const_cast<float&>(src(0, 0)) += 1; }),
     "input was changed"},
    {"depends on the number of threads", blur_and([](auto, View<float> dst, Window, Parallel parallel) {
         if (parallel.threads == 7) dst(0, 0) = next(dst(0, 0));
     }),
     "in the plain run"},
    {"differs when repeated", blur_and([calls = std::make_shared<int>(0)](auto, View<float> dst, Window, Parallel) {
         if (++*calls % 2 == 0) dst(0, 0) = next(dst(0, 0));
     }),
     "in the plain run"},
    {"takes samples of the input for neighbours in memory",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         src.dx = 1;
         blur(src, dst, window, parallel);
     },
     "in the plain run"},
    {"takes input rows to be without padding",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         if (src.dx == 1) src.dy = src.width;
         blur(src, dst, window, parallel);
     },
     "in the plain run"},
    {"takes output strides to be positive",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         if (dst.dx < 0) dst = flipped_x(dst);
         blur(src, dst, window, parallel);
     },
     "in the plain run"},
    {"takes output channels to be interleaved",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         if (dst.dx == 3) dst.dc = 1;  // three channels, or planes of one sample in three
         blur(src, dst, window, parallel);
     },
     "written outside"},
    {"reads outside its input",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         blur(src, dst, window, parallel);
         dst(0, 0) += 0 * src.data[-1];
     },
     "the reference"},
    {"is off by one in a window",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         if (window.x > 0) window.x -= 1;
         blur(src, dst, window, parallel);
     },
     "in the plain run"},
    {"filters a window by itself",
     [](View<const float> src, View<float> dst, Window w, Parallel parallel) {
         blur(cropped(src, w.x, w.y, w.width, w.height), dst, {0, 0, w.width, w.height}, parallel);
     },
     "in the plain run"},
    {"is less exact than it says", blur_and([](auto, View<float> dst, Window, Parallel) { dst(0, 0) += 4 * 0x1p-22f; }),
     "allowed"},
    {"is wrong for one width only", blur_and([](View<const float> src, View<float> dst, Window, Parallel) {
         if (src.width == 17) dst(dst.width - 1, 0) += 1;
     }),
     "allowed"},
    {"is wrong in the fourth channel only", blur_and([](auto, View<float> dst, Window, Parallel) {
         if (dst.channels == 4) dst(0, 0, 3) += 1;
     }),
     "allowed"},
    {"makes a NaN",
     blur_and([](auto, View<float> dst, Window, Parallel) { dst(0, 0) = std::numeric_limits<float>::quiet_NaN(); }),
     "allowed"},
    {"sums in another order where samples lie side by side",
     [](View<const float> src, View<float> dst, Window window, Parallel parallel) {
         blur(src, dst, window, parallel);
         if (dst.dc != 1) return;
         for (int x = 0; x < dst.width; ++x) {
             const int at = window.x + x;
             const float left = src(std::max(at - 1, 0), window.y),
                         right = src(std::min(at + 1, src.width - 1), window.y);
             dst(x, 0) = 0.25f * left + (0.5f * src(at, window.y) + 0.25f * right);
         }
     },
     "in the plain run"},
    {"has other bits without vectors", blur_and([](auto, View<float> dst, Window, Parallel) {
         if (current_target() == Target::scalar) dst(0, 0) += 0x1p-22f;
     }),
     "scalar: input"},
#ifdef __x86_64__
    {"is less exact than it says without fused multiply-add", blur_and([](auto, View<float> dst, Window, Parallel) {
         if (!has_fused_multiply_add(current_target())) dst(0, 0) += 4 * 0x1p-22f;
     }),
     "sse4: input"},
#endif
};

INSTANTIATE_TEST_SUITE_P(All, BrokenOperators, testing::ValuesIn(broken_operators));

}  // namespace
}  // namespace bandlimit
