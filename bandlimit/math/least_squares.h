// Linear least squares with linear conditions.
// Stability: inner.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace bandlimit {

/// The unknowns x that minimise the sum of weight (row . x - target)^2 over all rows added, among those that meet all
/// conditions.
///
/// example  LeastSquares problem(2);                        // the point nearest to (3, 1) with x + y = 1 and y >= 0
///          problem.minimise(std::array{1.0, 0.0}, 3);
///          problem.minimise(std::array{0.0, 1.0}, 1);
///          problem.equal(std::array{1.0, 1.0}, 1);
///          problem.at_most(std::array{0.0, -1.0}, 0);
///          problem.solve();                                // (1, 0)
class LeastSquares {
public:
    /// Throws Error unless 1 <= unknowns <= 4096.
    explicit LeastSquares(int unknowns);

    /// Adds weight (row . x - target)^2. Throws Error, as do the next two, for a row whose length is not the number of
    /// unknowns and for values that are not finite; also for a weight < 0.
    void minimise(std::span<const double> row, double target, double weight = 1);
    /// The condition row . x = value. Conditions may follow from each other.
    void equal(std::span<const double> row, double value);
    /// The condition row . x <= limit.
    void at_most(std::span<const double> row, double limit);

    /// The solution; the shortest one where several are equally good.
    ///
    /// method   the null space of the equalities; the free part by a rank-revealing orthogonal decomposition; limits as
    ///          a least-distance problem, solved by non-negative least squares
    /// error    conditions are met to about 1e-13 of the size of their terms
    /// cost     (rows + conditions) unknowns^2, and as much again per inequality that holds with equality
    /// throws   Error if the conditions contradict each other, and for inequalities together with rows that leave
    ///          several solutions equally good
    /// source   C. L. Lawson & R. J. Hanson, Solving Least Squares Problems, 1974, chapters 20 and 23
    std::vector<double> solve() const;

private:
    struct Rows {
        std::vector<double> coefficients;  ///< [values][unknowns]
        std::vector<double> values;
    };
    void add(Rows& rows, const char* function, std::span<const double> row, double value, double scale) const;

    std::size_t unknowns_;
    Rows squares_, equalities_, limits_;
};

/// The x >= 0 that minimises |A x - b|. Rows of A one after the other, `b.size()` of them.
///
/// throws   Error if the shapes disagree or a value is not finite
/// source   Lawson & Hanson 1974, chapter 23, algorithm NNLS
std::vector<double> non_negative_least_squares(std::span<const double> a, std::span<const double> b);

}  // namespace bandlimit
