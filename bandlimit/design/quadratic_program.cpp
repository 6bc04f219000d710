#include "bandlimit/design/quadratic_program.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

VectorXd vector_of(const std::vector<double>& v) {
    return Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size()));
}

/// How far x goes beyond a limit, in units of its factors; positive outside.
double excess(const Halfspace& limit, const VectorXd& x) {
    const VectorXd a = vector_of(limit.factors);
    return (limit.bound - a.dot(x)) / a.norm();
}

/// The method's state: x is the best point under the plane and the limits `active`, as equalities.
class ActiveSet {
public:
    explicit ActiveSet(const QuadraticProgram& program) : program_(program) {
        const auto n = static_cast<Index>(program.gradient.size());
        const MatrixXd h = Eigen::Map<const MatrixXd>(program.hessian.data(), n, n);
        factor_.compute(h);
        normals_ = vector_of(program.plane.factors);
        x_ = factor_.solve(vector_of(program.gradient));
        const VectorXd z = factor_.solve(normals_.col(0));
        x_ += z * ((program.plane.bound - normals_.col(0).dot(x_)) / normals_.col(0).dot(z));
    }

    const VectorXd& x() const { return x_; }

    /// Makes limit p active, letting go of others as needed. False if no x meets it and the active ones.
    bool activate(std::size_t p) {
        const VectorXd a = vector_of(program_.limits[p].factors);
        double multiplier = 0;
        for (;;) {
            // Along z the limit comes closer while the active ones keep; their multipliers fall by r.
            const VectorXd free = factor_.solve(a);
            const MatrixXd spread = factor_.solve(normals_);
            const VectorXd r = (normals_.transpose() * spread).ldlt().solve(normals_.transpose() * free);
            const VectorXd z = free - spread * r;
            const double slope = a.dot(z), whole = slope > 1e-12 * a.dot(free)
                                                       ? (program_.limits[p].bound - a.dot(x_)) / slope
                                                       : infinity;
            const std::size_t first = first_to_leave(r);
            const double part =
                first < active_.size() ? multipliers_[first] / r[static_cast<Index>(first) + 1] : infinity;
            const double step = std::min(whole, part);
            if (!(step < infinity)) return false;
            if (whole < infinity) x_ += step * z;
            for (std::size_t k = 0; k < active_.size(); ++k) multipliers_[k] -= step * r[static_cast<Index>(k) + 1];
            multiplier += step;
            if (whole <= part) return add(p, a, multiplier), true;
            drop(first);
        }
    }

    bool is_active(std::size_t p) const { return std::find(active_.begin(), active_.end(), p) != active_.end(); }

private:
    /// The active limit whose multiplier reaches 0 first; active_.size() if none does.
    std::size_t first_to_leave(const VectorXd& r) const {
        std::size_t first = active_.size();
        double least = infinity;
        for (std::size_t k = 0; k < active_.size(); ++k) {
            const double rate = r[static_cast<Index>(k) + 1];
            if (rate > 1e-14 && multipliers_[k] / rate < least) least = multipliers_[k] / rate, first = k;
        }
        return first;
    }

    void add(std::size_t p, const VectorXd& a, double multiplier) {
        normals_.conservativeResize(Eigen::NoChange, normals_.cols() + 1);
        normals_.rightCols(1) = a;
        active_.push_back(p);
        multipliers_.push_back(multiplier);
    }

    void drop(std::size_t k) {
        const Index column = static_cast<Index>(k) + 1, after = normals_.cols() - column - 1;
        normals_.middleCols(column, after) = normals_.rightCols(after).eval();
        normals_.conservativeResize(Eigen::NoChange, normals_.cols() - 1);
        active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(k));
        multipliers_.erase(multipliers_.begin() + static_cast<std::ptrdiff_t>(k));
    }

    const QuadraticProgram& program_;
    Eigen::LLT<MatrixXd> factor_;
    MatrixXd normals_;  ///< the plane's factors, then those of the active limits
    std::vector<std::size_t> active_;
    std::vector<double> multipliers_;  ///< of the active limits, all >= 0
    VectorXd x_;
};

void check(const QuadraticProgram& program) {
    const std::size_t n = program.gradient.size();
    bool fits = n > 0 && program.hessian.size() == n * n && program.plane.factors.size() == n;
    for (const Halfspace& limit : program.limits) fits = fits && limit.factors.size() == n;
    if (!fits) fail("solve: sizes disagree; pass n x n numbers, n, and n for each condition, with n = ", n, " >= 1");
}

}  // namespace

std::optional<std::vector<double>> solve(const QuadraticProgram& program) {
    check(program);
    ActiveSet set(program);
    // The objective grows with every limit added, so that no set of active ones comes twice, but for rounding.
    for (std::size_t round = 0; round < 50 * (program.limits.size() + 1); ++round) {
        double worst = 1e-11;
        std::size_t p = program.limits.size();
        for (std::size_t k = 0; k < program.limits.size(); ++k)
            if (const double e = excess(program.limits[k], set.x()); e > worst && !set.is_active(k)) worst = e, p = k;
        if (p == program.limits.size()) return std::vector<double>(set.x().begin(), set.x().end());
        if (!set.activate(p)) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace bandlimit
