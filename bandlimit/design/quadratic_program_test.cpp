#include "bandlimit/design/quadratic_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// A random convex program of n unknowns on the plane sum x = 1; 0 < x_i, and `more` half spaces that hold (1, .., 1) /
/// n.
QuadraticProgram random_program(Random& random, std::size_t n, std::size_t more) {
    QuadraticProgram program{std::vector<double>(n * n), {}, {std::vector<double>(n, 1), 1}, {}};
    std::vector<double> root(n * n);
    for (double& r : root) r = random.uniform(-1, 1);
    for (std::size_t i = 0; i < n; ++i) {
        program.gradient.push_back(random.uniform(-2, 2));
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t k = 0; k < n; ++k) program.hessian[i * n + j] += root[k * n + i] * root[k * n + j];
            if (i == j) program.hessian[i * n + j] += 0.1;
        }
        program.limits.push_back({std::vector<double>(n), 0});
        program.limits.back().factors[i] = 1;
    }
    for (std::size_t m = 0; m < more; ++m) {
        Halfspace limit{{}, -0.05 * random.uniform()};
        for (std::size_t i = 0; i < n; ++i) {
            limit.factors.push_back(random.uniform(-1, 1));
            limit.bound += limit.factors.back() / static_cast<double>(n);
        }
        program.limits.push_back(std::move(limit));
    }
    return program;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

double objective(const QuadraticProgram& program, const std::vector<double>& x) {
    double value = -dot(program.gradient, x);
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x.size(); ++j) value += program.hessian[i * x.size() + j] * x[i] * x[j] / 2;
    return value;
}

bool is_allowed(const QuadraticProgram& program, const std::vector<double>& x) {
    for (const Halfspace& limit : program.limits)
        if (dot(limit.factors, x) < limit.bound - 1e-9) return false;
    return std::abs(dot(program.plane.factors, x) - program.plane.bound) < 1e-9;
}

// A convex program has one minimum: no step that is allowed leads down from it, however small.
TEST(QuadraticProgram, NoAllowedStepLeadsDown) {
    Random random(5);
    for (int round = 0; round < 60; ++round) {
        const std::size_t n = 2 + static_cast<std::size_t>(round) % 8;
        const QuadraticProgram program = random_program(random, n, static_cast<std::size_t>(round) % 12);
        const auto x = solve(program);
        ASSERT_TRUE(x);
        ASSERT_TRUE(is_allowed(program, *x));
        const double least = objective(program, *x);
        for (int trial = 0; trial < 300; ++trial) {
            std::vector<double> y = *x;
            const double size = std::pow(10, -random.uniform(0, 4));
            for (double& v : y) v += size * random.uniform(-1, 1);
            const double excess = (dot(program.plane.factors, y) - 1) / static_cast<double>(n);
            for (double& v : y) v -= excess;
            EXPECT_TRUE(!is_allowed(program, y) || objective(program, y) >= least - 1e-9) << round;
        }
    }
}

TEST(QuadraticProgram, MeetsConditionsByHand) {
    // The point of x + y = 1 that is nearest (2, 0): (1.5, -.5); and with y >= 0, (1, 0).
    QuadraticProgram program{{1, 0, 0, 1}, {2, 0}, {{1, 1}, 1}, {}};
    EXPECT_NEAR(solve(program)->at(0), 1.5, 1e-12);
    program.limits.push_back({{0, 1}, 0});
    EXPECT_NEAR(solve(program)->at(0), 1, 1e-12);
    EXPECT_NEAR(solve(program)->at(1), 0, 1e-12);
}

TEST(QuadraticProgram, ConditionsThatExcludeEachOtherHaveNoSolution) {
    QuadraticProgram program{{1, 0, 0, 1}, {0, 0}, {{1, 1}, 1}, {{{1, 0}, 1}, {{0, 1}, 1}}};
    EXPECT_FALSE(solve(program));
    program.limits[1].bound = -1;
    EXPECT_TRUE(solve(program));
}

TEST(QuadraticProgram, RefusesSizesThatDisagree) {
    EXPECT_THROW(solve({{1}, {1, 2}, {{1, 1}, 1}, {}}), Error);
    EXPECT_THROW(solve({{}, {}, {{}, 1}, {}}), Error);
}

}  // namespace
}  // namespace bandlimit
