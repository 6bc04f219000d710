// Continuous Fourier transforms of kernels.
// Stability: evolving.
#pragma once
#include "bandlimit/core/axis.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/fft.h"

namespace bandlimit {

/// The Fourier transform of a kernel at frequency f, real because kernels are even.
///
/// separable  the integral of k(x) cos(2 pi f x) over all x
/// radial     2 pi times the integral of k(r) J0(2 pi f r) r over r > 0: its profile in any direction (the Hankel
///            transform)
///
/// units   f in cycles per pitch: 1/2 is the Nyquist frequency of the samples that the kernel weighs, or of the coarser
///         target when it is widened
/// error   below 1e-12 of the value at 0 up to 16 cycles per pitch, for kernels of at most 100 pitches
/// cost    16 evaluations of the kernel per panel; 4 panels, and one more per period, between two knots
/// throws  Error unless |f| <= 1e6
double spectrum(const Kernel& kernel, double f);

/// spectrum() relative to its value at 0.
double relative_spectrum(const Kernel& kernel, double f);

/// The largest deviation of |relative_spectrum| from 1 on [0, pass_end]. Error below 1e-6.
/// Throws Error for pass_end < 0.
double passband_ripple(const Kernel& kernel, double pass_end);

/// The largest |relative_spectrum| on [stop_begin, stop_end]. Error and throws as above.
double stopband_leakage(const Kernel& kernel, double stop_begin, double stop_end);

/// The share of the kernel's energy beyond the Nyquist frequency 1/2 of the grid it is pitched for: what a kernel that
/// is widened by N to keep every N-th sample lets fold, for a fine N and white input.
///
/// separable  1 - (integral of K^2 over |f| < 1/2) / (integral of K^2 over all f), along one axis
/// radial     the same over the square |fx|, |fy| < 1/2 and the plane
/// error      below 1e-10
double alias_energy(const Kernel& kernel);

/// relative_spectrum() in two dimensions: the product over both axes, or that of the radius. Real parts only.
ComplexGrid relative_spectrum_grid(const Kernel& kernel, const Axis& fx, const Axis& fy);

}  // namespace bandlimit
