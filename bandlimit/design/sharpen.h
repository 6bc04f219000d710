// Taps that undo what a kernel takes from the pass band.
// Stability: evolving.
#pragma once
#include <complex>
#include <limits>
#include <optional>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

struct SharpenOptions {
    int taps = 7;        ///< odd, 3 to 63
    double band = 0.35;  ///< cycles per sample, 0.05 to 0.5: |f| < band is to come out as it went in
    double max_gain = std::numeric_limits<double>::infinity();  ///< > 1: |H| stays below it at all frequencies
    /// Undo the kernel's weights at this phase, in [0, 1). Default: the mean over all phases, which is its spectrum.
    std::optional<double> phase = {};
};

struct SharpenDesign {
    Taps taps;            ///< symmetric, sum 1
    double error = 0;     ///< mean of |H K - 1|^2 over the band, K the kernel's response
    double droop = 0;     ///< largest |H K - 1| in the band
    double gain = 1;      ///< largest |H|: what it does to noise and ringing at worst
    double variance = 1;  ///< by how much the variance of white noise is scaled
};

/// What `kernel` does to frequency f of the samples that it weighs: its weights at `phase`, or their mean over all
/// phases, each seen from the output. Real, to rounding, without a phase and at phases 0 and 1/2.
std::complex<double> kernel_response(const Kernel& kernel, std::optional<double> phase, double f);

/// Sharpening for the samples that `kernel` weighs: before enlarging by it, or at the coarser pitch after shrinking by
/// it. Least squares of H K against 1 over the band, with a gain of 1 at 0.
///
/// cost     a few hundred spectra of the kernel
/// throws   Error for a radial kernel, one whose response is 0 at 0, and options out of range
/// source   M. Unser, A. Aldroubi & M. Eden, "B-spline signal processing", IEEE Trans. Signal Processing 41, 1993 (the
///          exact inverse at phase 0, by recursion); J. Costella, "The Magic Kernel", 2021 (sharpening by few taps)
/// example  design_sharpen(bspline(), {.taps = 5, .band = 0.3})
SharpenDesign design_sharpen(const Kernel& kernel, const SharpenOptions& options = {});

}  // namespace bandlimit
