#include "bandlimit/math/svd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

std::vector<double> noise(int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<double> values(static_cast<std::size_t>(count));
    for (double& v : values) v = random.uniform(-1, 1);
    return values;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

TEST(Svd, ProductsSumToTheMatrix) {
    for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 7}, {7, 1}, {5, 9}, {9, 5}, {40, 40}}) {
        const std::vector<double> matrix = noise(rows * columns, 3);
        const Svd found = svd(matrix, rows, columns);
        ASSERT_EQ(found.values.size(), static_cast<std::size_t>(std::min(rows, columns)));
        double energy = 0;
        for (const double v : found.values) energy += v * v;
        EXPECT_NEAR(energy, dot(matrix, matrix), 1e-12 * energy);  // the squares of the values are the energy
        for (int r = 0; r < rows; ++r) {
            for (int c = 0; c < columns; ++c) {
                double sum = 0;
                for (std::size_t k = 0; k < found.values.size(); ++k)
                    sum += found.values[k] * found.left[k][static_cast<std::size_t>(r)] *
                           found.right[k][static_cast<std::size_t>(c)];
                EXPECT_NEAR(sum, matrix[static_cast<std::size_t>(r * columns + c)], 1e-13 * found.values[0]);
            }
        }
    }
}

TEST(Svd, VectorsAreOrthonormalAndValuesFall) {
    const Svd found = svd(noise(12 * 8, 4), 12, 8);
    for (std::size_t i = 0; i < found.values.size(); ++i) {
        EXPECT_GE(found.values[i], 0);
        if (i > 0) {
            EXPECT_LE(found.values[i], found.values[i - 1]);
        }
        for (std::size_t j = 0; j <= i; ++j) {
            EXPECT_NEAR(dot(found.left[i], found.left[j]), i == j, 1e-13);
            EXPECT_NEAR(dot(found.right[i], found.right[j]), i == j, 1e-13);
        }
    }
}

TEST(Svd, RankOneHasOneValue) {
    const std::vector<double> u = noise(6, 5), v = noise(11, 6);
    std::vector<double> matrix;
    for (const double a : u)
        for (const double b : v) matrix.push_back(a * b);
    const Svd found = svd(matrix, 6, 11);
    EXPECT_NEAR(found.values[0], std::sqrt(dot(u, u) * dot(v, v)), 1e-14 * 10);
    EXPECT_LT(found.values[1], 1e-15 * 10);
}

TEST(Svd, RefusesWhatIsNoMatrix) {
    const std::vector<double> four{1, 2, 3, std::nan("")};
    EXPECT_THROW(svd(four, 2, 3), Error);
    EXPECT_THROW(svd(four, 0, 4), Error);
    EXPECT_THROW(svd(four, 2, 2), Error);
}

}  // namespace
}  // namespace bandlimit
