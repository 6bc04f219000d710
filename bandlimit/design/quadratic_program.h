// Least squares under linear conditions.
// Stability: inner.
#pragma once
#include <optional>
#include <vector>

namespace bandlimit {

/// factors . x >= bound.
struct Halfspace {
    std::vector<double> factors;
    double bound = 0;
};

/// Minimise x' H x / 2 - g' x over x that lie on one hyperplane and in all of some half spaces.
struct QuadraticProgram {
    std::vector<double> hessian;    ///< n x n, row after row; symmetric and positive definite
    std::vector<double> gradient;   ///< g; n >= 1
    Halfspace plane;                ///< where factors . x == bound
    std::vector<Halfspace> limits;  ///< and what x must also satisfy
};

/// The x that solves `program`; nothing if no x meets the conditions.
///
/// error   conditions hold to 1e-10 of the scale of their factors, where H has a condition below 1e8
/// cost    (n + active limits)^3 for each limit that becomes active, about one per active limit
/// throws  Error if sizes disagree
/// source  D. Goldfarb & A. Idnani, A numerically stable dual method for solving strictly convex quadratic programs,
///         Mathematical Programming 27, 1983; every step solves its equations anew, as n is small here
std::optional<std::vector<double>> solve(const QuadraticProgram& program);

}  // namespace bandlimit
