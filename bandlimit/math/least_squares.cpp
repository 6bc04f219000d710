#include "bandlimit/math/least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// How far from each other numbers may be that should be equal, relative to their size.
constexpr double tolerance = 1e-11;

Eigen::Map<const Matrix> matrix_of(std::span<const double> coefficients, std::size_t columns) {
    return {coefficients.data(), static_cast<Index>(coefficients.size() / columns), static_cast<Index>(columns)};
}

Eigen::Map<const Vector> vector_of(std::span<const double> values) {
    return {values.data(), static_cast<Index>(values.size())};
}

bool are_finite(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

/// The least squares solution that uses only the columns in `used`; 0 elsewhere.
Vector solve_with(const Matrix& a, const Vector& b, const std::vector<Index>& used) {
    Matrix part(a.rows(), static_cast<Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i) part.col(static_cast<Index>(i)) = a.col(used[i]);
    const Vector found = part.colPivHouseholderQr().solve(b);
    Vector x = Vector::Zero(a.cols());
    for (std::size_t i = 0; i < used.size(); ++i) x[used[i]] = found[static_cast<Index>(i)];
    return x;
}

/// Moves x towards `goal`, as far as the columns in `used` stay positive; those that reach 0 leave `used`. Returns
/// whether it got there.
bool step_towards(const Vector& goal, Vector& x, std::vector<Index>& used) {
    double share = 1;
    for (const Index j : used)
        if (goal[j] <= 0) share = std::min(share, x[j] / (x[j] - goal[j]));
    const bool arrives = std::all_of(used.begin(), used.end(), [&](Index j) { return goal[j] > 0; });
    x += share * (goal - x);
    std::erase_if(used, [&](Index j) {
        const bool leaves = goal[j] <= 0 && x[j] <= std::numeric_limits<double>::epsilon();
        if (leaves) x[j] = 0;
        return leaves;
    });
    return arrives;
}

Vector non_negative(const Matrix& a, const Vector& b) {
    Vector x = Vector::Zero(a.cols());
    std::vector<Index> used;
    const double enough = tolerance * std::max(1.0, a.cwiseAbs().maxCoeff()) * std::max(1.0, b.norm());
    // Each round lowers the error, so that no set of columns comes back; the bound is for rounding.
    for (Index round = 0; round < 10 * (a.cols() + a.rows()); ++round) {
        Vector slope = a.transpose() * (b - a * x);
        for (const Index j : used) slope[j] = 0;
        Index best = 0;
        if (!(slope.maxCoeff(&best) > enough)) return x;
        used.push_back(best);
        for (Vector goal = solve_with(a, b, used); !step_towards(goal, x, used);) goal = solve_with(a, b, used);
    }
    return x;
}

/// The shortest y with e y >= f. Throws Error if there is none.
Vector least_distance(const Matrix& e, const Vector& f) {
    Matrix dual(e.cols() + 1, e.rows());
    dual << e.transpose(), f.transpose();
    Vector goal = Vector::Zero(e.cols() + 1);
    goal[e.cols()] = 1;
    const Vector rest = dual * non_negative(dual, goal) - goal;
    if (rest.norm() < tolerance) fail("LeastSquares: the conditions contradict each other; loosen one");
    return -rest.head(e.cols()) / rest[e.cols()];
}

/// A point that meets equalities, and the directions in which one may leave it.
struct Free {
    Vector origin;
    Matrix directions;  ///< orthonormal columns
};

Free free_of(const Eigen::Map<const Matrix>& rows, const Eigen::Map<const Vector>& values, Index unknowns) {
    if (rows.rows() == 0) return {Vector::Zero(unknowns), Matrix::Identity(unknowns, unknowns)};
    // Rows of one size, so that the rank does not depend on their units.
    Vector scale = rows.rowwise().norm();
    for (double& s : scale) s = s > 0 ? 1 / s : 1;
    const Matrix scaled = scale.asDiagonal() * rows;
    const Vector wanted = scale.cwiseProduct(values);
    Eigen::ColPivHouseholderQR<Matrix> qr;
    qr.setThreshold(tolerance);
    qr.compute(scaled.transpose());
    const Index rank = qr.rank();
    const Matrix q = qr.householderQ() * Matrix::Identity(unknowns, unknowns);
    const Matrix spanned = q.leftCols(rank);
    const Matrix on_span = scaled * spanned;
    const Vector origin = spanned * on_span.colPivHouseholderQr().solve(wanted);
    if ((scaled * origin - wanted).cwiseAbs().maxCoeff() > 1e-9 * std::max(1.0, wanted.cwiseAbs().maxCoeff()))
        fail("LeastSquares: the conditions contradict each other; loosen one");
    return {origin, q.rightCols(unknowns - rank)};
}

}  // namespace

LeastSquares::LeastSquares(int unknowns) : unknowns_(static_cast<std::size_t>(unknowns)) {
    if (unknowns < 1 || unknowns > 4096) fail("LeastSquares: unknowns = ", unknowns, "; pass 1 to 4096");
}

void LeastSquares::add(Rows& rows, const char* function, std::span<const double> row, double value,
                       double scale) const {
    if (row.size() != unknowns_)
        fail("LeastSquares::", function, ": a row of ", row.size(), "; pass one of ", unknowns_, ", the unknowns");
    if (!are_finite(row) || !std::isfinite(value) || !(scale >= 0) || !std::isfinite(scale))
        fail("LeastSquares::", function, ": a number is not finite or a weight is negative; pass finite ones");
    for (const double coefficient : row) rows.coefficients.push_back(scale * coefficient);
    rows.values.push_back(scale * value);
}

void LeastSquares::minimise(std::span<const double> row, double target, double weight) {
    add(squares_, "minimise", row, target, std::sqrt(weight));
}

void LeastSquares::equal(std::span<const double> row, double value) { add(equalities_, "equal", row, value, 1); }

void LeastSquares::at_most(std::span<const double> row, double limit) { add(limits_, "at_most", row, limit, 1); }

std::vector<double> LeastSquares::solve() const {
    const Index unknowns = static_cast<Index>(unknowns_);
    const auto [origin, directions] =
        free_of(matrix_of(equalities_.coefficients, unknowns_), vector_of(equalities_.values), unknowns);
    const auto result = [](const Vector& x) { return std::vector<double>(x.begin(), x.end()); };
    const auto squares = matrix_of(squares_.coefficients, unknowns_);
    if (directions.cols() == 0 || (squares.rows() == 0 && limits_.values.empty())) return result(origin);

    // In the free directions: |a z - b| is to be small.
    const Matrix a = squares * directions;
    const Vector b = vector_of(squares_.values) - squares * origin;
    const bool all_is_decided = a.norm() <= 1e-14 * squares.norm();  // what is left is rounding
    if (limits_.values.empty() && all_is_decided) return result(origin);
    const auto fail_free = [] {
        fail("LeastSquares: limits on unknowns that the rows leave free; add a row for each");
    };
    if (a.rows() == 0) fail_free();
    const Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition(a);
    const Vector best = decomposition.solve(b);
    const auto limits = matrix_of(limits_.coefficients, unknowns_);
    if (limits.rows() == 0) return result(origin + directions * best);

    // With a = q r the rows ask for a short y = r (z - best).
    if (decomposition.rank() < a.cols()) fail_free();
    const Eigen::HouseholderQR<Matrix> qr(a);
    const Matrix r = qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
    const Matrix slopes = limits * directions;
    const Matrix e = -r.transpose().triangularView<Eigen::Lower>().solve(Matrix(slopes.transpose())).transpose();
    const Vector f = slopes * best + limits * origin - vector_of(limits_.values);
    if (f.maxCoeff() <= 0) return result(origin + directions * best);
    const Vector y = least_distance(e, f);
    return result(origin + directions * (best + Vector(r.triangularView<Eigen::Upper>().solve(y))));
}

std::vector<double> non_negative_least_squares(std::span<const double> a, std::span<const double> b) {
    if (b.empty() || a.empty() || a.size() % b.size() != 0 || !are_finite(a) || !are_finite(b))
        fail("non_negative_least_squares: ", a.size(), " coefficients for ", b.size(),
             " rows; pass finite ones, as many in each row");
    const Vector x = non_negative(matrix_of(a, a.size() / b.size()), vector_of(b));
    return {x.begin(), x.end()};
}

}  // namespace bandlimit
