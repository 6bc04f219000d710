// Taps that differentiate.
// Stability: evolving.
#pragma once
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

struct DerivativeOptions {
    enum class Optimal {
        taylor,        ///< exact for polynomials of the highest degree possible with that many taps
        least_squares  ///< the smallest mean square error over the band
    };

    int taps = 5;  ///< 2 to 255: odd on a sample, even halfway between two
    Optimal optimal = Optimal::taylor;
    bool exact_ramp = false;  ///< of least squares: the derivative of a ramp is exact; that of taylor always is
    double band = 0.5;        ///< cycles per sample, 0.05 to 0.5: over |f| < band errors are measured, and minimised
};

/// Antisymmetric taps and their quality. Their response about `position` is
///
///     H(f) = 2i sum_k c_k sin(2 pi f s_k),   the ideal one is 2 pi i f,
///
/// where c_k > 0 at k = 1 is the weight at distance s_k = k (odd numbers of taps) or k - 1/2 (even ones) to the right,
/// and -c_k the weight as far to the left.
struct DerivativeDesign {
    Taps taps;             ///< sum exactly 0; first = -(N - 1) / 2, or 1 - N / 2 of an even number N
    double position = 0;   ///< where the derivative is taken, right of sample i: 0, or 1/2 of even numbers
    double error = 0;      ///< mean of |H - ideal|^2 over the band, relative to that of |ideal|^2
    double ramp_gain = 1;  ///< the derivative of a ramp whose derivative is 1
};

/// Taps for the derivative: out[i] = sum_j weights[j] in[i + first + j] is that at i + position, in values per sample.
///
/// Least squares over all frequencies gives the samples of the sinc's derivative, c_k = (-1)^(k+1) / k, which an even
/// number of terms makes blind to ramps: 9 taps have a ramp gain of 0. With exact_ramp they have one of 1.
///
/// cost     cubic in the taps
/// throws   Error for options out of range
/// source   B. Fornberg, "Generation of finite difference formulas on arbitrarily spaced grids", Math. Comp. 51, 1988
///          (taylor); least squares after B. Wronski, "Computing gradients on grids of pixels and voxels", 2021, with
///          the condition that keeps ramps
/// example  design_derivative({.taps = 5}).taps.weights    // 1/12, -2/3, 0, 2/3, -1/12
DerivativeDesign design_derivative(const DerivativeOptions& options);

}  // namespace bandlimit
