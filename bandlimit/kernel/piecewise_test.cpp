#include "bandlimit/kernel/piecewise.h"

#include <gtest/gtest.h>

#include <limits>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// Catmull-Rom in distances from its knots.
KernelPieces catmull_rom_pieces() { return {{0, 1, {1, 0, -2.5, 1.5}}, {1, 2, {0, -0.5, 1, -0.5}}}; }

TEST(Piecewise, IsThePolynomialsThatItIsMadeOf) {
    const Kernel kernel = piecewise_kernel(catmull_rom_pieces(), "mine");
    EXPECT_EQ(kernel.name, "mine");
    EXPECT_EQ(kernel.radius, 2);
    EXPECT_EQ(kernel.knots, std::vector<double>{1});
    for (double x = -3; x <= 3; x += 0x1p-6) EXPECT_NEAR(kernel.value(x), catmull_rom().value(x), 1e-15) << x;
}

TEST(Piecewise, IsTheMeanOfBothSidesAtItsEnd) {
    const Kernel kernel = piecewise_kernel({{0, 0.5, {1}}}, "box");
    EXPECT_EQ(kernel.value(0.25), 1);
    EXPECT_EQ(kernel.value(-0.5), 0.5);
    EXPECT_EQ(kernel.value(0.75), 0);
}

TEST(Piecewise, RefusesPiecesThatDoNotFit) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const KernelPieces& pieces :
         {KernelPieces{}, KernelPieces{{0.5, 1, {1}}}, KernelPieces{{0, 1, {1}}, {1.5, 2, {1}}},
          KernelPieces{{0, 0, {1}}}, KernelPieces{{0, nan, {1}}}, KernelPieces{{0, infinity, {1}}},
          KernelPieces{{0, 1001, {1}}}, KernelPieces{{0, 1, {}}}, KernelPieces{{0, 1, {1, nan}}},
          KernelPieces{{0, 1, std::vector<double>(17, 0.0)}}})
        EXPECT_THROW(piecewise_kernel(pieces, "x"), Error);
}

}  // namespace
}  // namespace bandlimit
