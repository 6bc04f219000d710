// Reconstruction kernels made to measure.
// Stability: evolving.
#pragma once
#include <limits>
#include <optional>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/kernel/piecewise.h"

namespace bandlimit {

struct KernelFitOptions {
    /// What the kernel is for: that decides which frequencies beyond 1/2 disturb.
    enum class Use {
        grow,   ///< they are images of those below, each as strong as what it mirrors
        shrink  ///< they are detail of the picture that folds, the weaker the finer
    };

    double radius = 2;           ///< source pitches, 0.5 to 8
    int pieces = 0;              ///< of equal length on [-radius, radius], 1 to 64; 0: one per pitch
    int degree = 3;              ///< of the polynomials, 0 to 7
    int smoothness = 1;          ///< how many derivatives are continuous, at the ends too: -1 (jumps) to degree - 1
    bool interpolating = false;  ///< 1 at 0 and 0 at the other integers
    Use use = Use::grow;
    double slope = 2;                 ///< pictures have the power spectrum f^-slope, 0 to 2
    std::optional<Kernel> like = {};  ///< imitate its spectrum instead of the ideal low-pass; not radial
    double max_overshoot = std::numeric_limits<double>::infinity();  ///< >= 0: of the answer to a unit step, above 1
};

struct KernelFit {
    KernelPieces pieces;
    double loss = 0;       ///< what was minimised
    double error = 0;      ///< integral of (H - target)^2 over 0 < f < 8 relative to that of target^2
    double overshoot = 0;  ///< by how much the answer to a unit step exceeds 1
};

/// The kernel of polynomial pieces whose shifted copies sum to 1 everywhere, and whose spectrum H has the least
///
///     integral over 0 < f < 8 of S(f) (H(f) - target(f))^2,   f in cycles per pitch,
///
/// where the target is 1 below 1/2 and 0 beyond, or the relative spectrum of `like`, and S(f) = f^-slope to shrink;
/// to grow, or stay, S takes the distance of f from the nearest integer. Steps and their answers: those of enlarging
/// at all phases to grow, of shrinking by a large factor to shrink.
///
/// error    conditions hold to about 1e-13
/// cost     about 800 rows by half the pieces times (degree + 1) unknowns
/// throws   Error for options out of range, and where no kernel meets all conditions
/// source   as kernel/least_squares.cpp, with polynomials for a Fourier series
/// example  fit_kernel({.radius = 2, .smoothness = 2})    // pieces of the cubic B-spline, the only such kernel
KernelFit fit_kernel(const KernelFitOptions& options);

}  // namespace bandlimit
