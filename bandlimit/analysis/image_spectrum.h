// Power spectra of images.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/core/view.h"

namespace bandlimit {

/// How samples are weighted before the transform.
enum class Window {
    none,  ///< all alike; suits images that tile, and noise
    hann   ///< sin^2 along both axes, 0 at the edges: keeps the borders from leaking into all frequencies
};

/// Power averaged over rings of equal frequency.
///
/// Bin b holds the frequencies (b - 1/2) step <= |f| < (b + 1/2) step, f in cycles per sample; the last one ends beyond
/// the corner of the spectrum, sqrt(1/2).
struct RadialSpectrum {
    double step = 0;                ///< width of a bin: 1 / max(width, height)
    std::vector<double> density;    ///< mean of |X|^2 / (W H) in the ring: the variance, at every f, for white noise
    std::vector<double> power;      ///< sum of |X|^2 / (W H)^2 in the ring: all together the variance of the image
    std::vector<int> coefficients;  ///< how many frequencies of the transform fell into the ring; may be 0

    double frequency(int bin) const { return bin * step; }
};

/// The radially averaged power spectrum of `image`, its mean removed; the mean of its channels' spectra.
///
/// A window is scaled so that its mean square is 1: `power` then sums to the variance under the window, which equals
/// that of the image only on average.
///
/// range    samples that are not finite count as 0
/// cost     one complex FFT of the image per channel, in double
/// throws   Error for an empty image
RadialSpectrum radial_spectrum(View<const float> image, Window window = Window::hann);

}  // namespace bandlimit
