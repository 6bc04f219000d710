// Kernels that are polynomials between their knots.
// Stability: stable.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/kernel/kernel.h"

namespace bandlimit {

/// A polynomial in the distance from `begin`: on begin <= |x| < end a kernel is the sum of coefficients[n] (|x| -
/// begin)^n.
struct KernelPiece {
    double begin = 0, end = 0;         ///< source pitches
    std::vector<double> coefficients;  ///< constant first
};

/// The half of a kernel at x >= 0, from 0 outwards; the other half is its mirror image.
using KernelPieces = std::vector<KernelPiece>;

/// The value at x of what `pieces` describe; 0 beyond them.
double value_of(const KernelPieces& pieces, double x);

/// `pieces` as a kernel, of the radius at which the last one ends.
///
/// throws   Error for no pieces, 65 or more, one that does not begin where the one before ends (the first: at 0), one
///          that is empty or has no or more than 16 coefficients, what is not finite, and a radius over 1000
Kernel piecewise_kernel(KernelPieces pieces, std::string name);

}  // namespace bandlimit
