#include "bandlimit/math/least_squares.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

using Vector = std::vector<double>;

constexpr int unknowns = 5, rows = 12;

struct Example {
    std::vector<Vector> rows;
    Vector targets;

    double loss(const Vector& x) const {
        double sum = 0;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            double rest = -targets[i];
            for (std::size_t j = 0; j < x.size(); ++j) rest += rows[i][j] * x[j];
            sum += rest * rest;
        }
        return sum;
    }
    LeastSquares problem() const {
        LeastSquares problem(unknowns);
        for (std::size_t i = 0; i < rows.size(); ++i) problem.minimise(rows[i], targets[i]);
        return problem;
    }
};

Vector random_vector(Random& random, int count) {
    Vector v;
    for (int i = 0; i < count; ++i) v.push_back(2 * random.uniform() - 1);
    return v;
}

Example random_example(Random& random) {
    Example example;
    for (int i = 0; i < rows; ++i) example.rows.push_back(random_vector(random, unknowns));
    example.targets = random_vector(random, rows);
    return example;
}

double dot(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

TEST(LeastSquares, NoPermittedPointNearbyIsBetter) {
    Random random(1);
    for (int trial = 0; trial < 50; ++trial) {
        const Example example = random_example(random);
        LeastSquares problem = example.problem();
        const Vector sum(unknowns, 1.0), other = random_vector(random, unknowns);
        problem.equal(sum, 1);
        problem.equal(other, 0.5);
        std::vector<Vector> limits;
        for (int i = 0; i < 4; ++i) {
            limits.push_back(random_vector(random, unknowns));
            problem.at_most(limits.back(), 0.1);
        }
        Vector x;
        try {
            x = problem.solve();
        } catch (const Error&) {
            continue;  // conditions at random may contradict each other
        }
        EXPECT_NEAR(dot(sum, x), 1, 1e-12);
        EXPECT_NEAR(dot(other, x), 0.5, 1e-12);
        for (const Vector& limit : limits) EXPECT_LE(dot(limit, x), 0.1 + 1e-10);
        const double best = example.loss(x);
        for (int step = 0; step < 300; ++step) {
            // A direction along which both equalities hold, by taking away its parts along them.
            Vector d = random_vector(random, unknowns), along = other;
            const double mean = dot(other, sum) / unknowns;
            for (double& v : along) v -= mean;
            const double a = dot(d, sum) / unknowns, b = dot(d, along) / dot(along, along);
            for (std::size_t j = 0; j < d.size(); ++j) d[j] -= a + b * along[j];
            Vector near = x;
            for (std::size_t j = 0; j < d.size(); ++j) near[j] += 0.01 * d[j];
            bool permitted = true;
            for (const Vector& limit : limits) permitted = permitted && dot(limit, near) <= 0.1;
            if (permitted) {
                EXPECT_GE(example.loss(near), best - 1e-12);
            }
        }
    }
}

TEST(LeastSquares, TheExampleOfItsHeader) {
    LeastSquares problem(2);
    problem.minimise(std::array{1.0, 0.0}, 3);
    problem.minimise(std::array{0.0, 1.0}, 1);
    problem.equal(std::array{1.0, 1.0}, 1);
    Vector x = problem.solve();
    EXPECT_NEAR(x[0], 1.5, 1e-14);
    EXPECT_NEAR(x[1], -0.5, 1e-14);
    problem.at_most(std::array{0.0, -1.0}, 0);
    x = problem.solve();
    EXPECT_NEAR(x[0], 1, 1e-14);
    EXPECT_NEAR(x[1], 0, 1e-14);
}

TEST(LeastSquares, WeightsScaleTheirRows) {
    LeastSquares problem(1);
    problem.minimise(std::array{1.0}, 0, 3);
    problem.minimise(std::array{1.0}, 4, 1);
    EXPECT_NEAR(problem.solve()[0], 1, 1e-15);
}

TEST(LeastSquares, ConditionsMayFollowFromEachOtherAndOfManySolutionsTheShortestIsTaken) {
    LeastSquares problem(3);
    problem.equal(std::array{1.0, 1.0, 1.0}, 3);
    problem.equal(std::array{2.0, 2.0, 2.0}, 6);
    problem.minimise(std::array{1.0, 1.0, 1.0}, 7);
    for (const double x : problem.solve()) EXPECT_NEAR(x, 1, 1e-14);
}

TEST(LeastSquares, ContradictionsAreErrors) {
    LeastSquares equalities(2);
    equalities.equal(std::array{1.0, 1.0}, 3);
    equalities.equal(std::array{2.0, 2.0}, 5);
    EXPECT_THROW(equalities.solve(), Error);
    LeastSquares limits(1);
    limits.minimise(std::array{1.0}, 0);
    limits.at_most(std::array{1.0}, -2);
    limits.at_most(std::array{-1.0}, 1);
    EXPECT_THROW(limits.solve(), Error);
    LeastSquares without_rows(2);
    without_rows.at_most(std::array{1.0, 1.0}, 1);
    EXPECT_THROW(without_rows.solve(), Error);
}

TEST(LeastSquares, RefusesWhatMakesNoSense) {
    EXPECT_THROW(LeastSquares(0), Error);
    EXPECT_THROW(LeastSquares(-1), Error);
    LeastSquares problem(2);
    EXPECT_THROW(problem.minimise(std::array{1.0}, 0), Error);
    EXPECT_THROW(problem.minimise(std::array{1.0, 1.0}, 0, -1), Error);
    EXPECT_THROW(problem.equal(std::array{1.0, std::numeric_limits<double>::quiet_NaN()}, 0), Error);
    EXPECT_THROW(problem.at_most(std::array{1.0, 1.0}, std::numeric_limits<double>::infinity()), Error);
    EXPECT_THROW(non_negative_least_squares(Vector{1, 2, 3}, Vector{1, 2}), Error);
}

TEST(NonNegativeLeastSquares, MeetsTheConditionsOfTheMinimum) {
    Random random(2);
    for (int trial = 0; trial < 50; ++trial) {
        const Example example = random_example(random);
        Vector a;
        for (const Vector& row : example.rows) a.insert(a.end(), row.begin(), row.end());
        const Vector x = non_negative_least_squares(a, example.targets);
        // Karush, Kuhn and Tucker: the slope is 0 where x > 0 and does not fall where x = 0.
        for (std::size_t j = 0; j < unknowns; ++j) {
            double slope = 0;
            for (std::size_t i = 0; i < rows; ++i)
                slope += example.rows[i][j] * (dot(example.rows[i], x) - example.targets[i]);
            EXPECT_GE(x[j], 0);
            EXPECT_GE(slope, -1e-10);
            if (x[j] > 0) {
                EXPECT_NEAR(slope, 0, 1e-10);
            }
        }
    }
}

}  // namespace
}  // namespace bandlimit
