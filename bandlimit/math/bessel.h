// The special functions that kernels are made of.
// Stability: inner.
#pragma once

namespace bandlimit {

/// sin(pi x), exactly 0 at the integers and exactly +-1 halfway between them.
double sin_pi(double x);

/// sin(pi x) / (pi x); 1 at 0, exactly 0 at the other integers.
double sinc(double x);

/// Bessel functions of the first kind, of order 0 and 1. Absolute error below 1e-15 for |x| < 100.
double bessel_j0(double x);
double bessel_j1(double x);

/// Modified Bessel function of the first kind, order 0. Relative error below 1e-15.
double bessel_i0(double x);

/// J1(pi r) / (pi r), the 2D counterpart of sinc: the transform of a disc. 1/2 at 0.
double jinc(double r);

/// The n-th zero of jinc, n >= 1: 1.2197, 2.2331, 3.2383, ... Throws Error for n < 1.
double jinc_zero(int n);

}  // namespace bandlimit
