// Integrals of smooth functions.
// Stability: inner.
#pragma once
#include <functional>
#include <vector>

namespace bandlimit {

/// Where to sample a function, and the factors that turn the sum of its values into an integral.
struct Quadrature {
    std::vector<double> at, weights;
};

/// Gauss-Legendre quadrature on [a, b] with 16 points on each of `panels` equal parts, in ascending order of parts:
/// as in integrate(), for integrating many functions over one interval. Throws Error if panels < 1.
Quadrature quadrature(double a, double b, int panels = 1);

/// The integral of f over [a, b] by Gauss-Legendre quadrature with 16 points on each of `panels` equal parts.
///
/// error  about that of double precision if each panel holds at most two periods of a smooth f; a kink or jump must
///        lie on the border of a panel
/// cost   16 * panels evaluations of f
/// throws Error if panels < 1
double integrate(const std::function<double(double)>& f, double a, double b, int panels = 1);

}  // namespace bandlimit
