// Discs from separable filters: sums of complex phasors times Gaussians that approximate a disc of radius 1.
//
// Everything here is in closed form: in s = r^2 a phasor is exp(-p s) with p = a - ib, and so are products of them.
// Lengths are in radii of the disc, frequencies in cycles per radius.
// Stability: evolving.
#pragma once
#include <functional>

#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// The most components that fit_disk makes. Each adds 4 multiply-adds per tap, and reduces the error by less than the last.
constexpr int most_disk_components = 5;

/// The `count` components whose sum is nearest to the disc in mean square, sorted by b.
///
/// error    0.0860, 0.0374, 0.0230, 0.0164, 0.0127 for 1 to 5 components, in the sense of disk_error(); none of 60
///          random starts led to less
/// cost     milliseconds
/// throws   Error unless 1 <= count <= most_disk_components
Components fit_disk(int count);

/// Published components, for a disc whose radius is not 1.
struct PublishedDisk {
    Components components;
    double radius = 1;  ///< of the disc that they are the nearest to, in the unit of their a and b
    double reach = 1;   ///< in that unit, where the filters that use them end
};

/// The components of Niemitalo 2011 for 1 and 2 of them, with the reach that Garcia 2017 ("Circular Separable
/// Convolution Depth of Field") gives them. They are for weights divided by their sum: see fitted_to_disk().
///
/// throws   Error unless count is 1 or 2
PublishedDisk published_disk(int count);

/// Components of a disc of that radius, for a disc of radius 1 and as high as is nearest to it.
/// throws   Error unless radius > 0, and as value_at()
Components fitted_to_disk(const Components& components, double radius);

/// The squared relative error: the integral of (K - disc)^2 over the plane, relative to the integral of disc^2.
///
/// error    1e-15 times the square of the sum of |A| + |B|, for a of 0.1 and more
/// throws   Error as value_at()
double disk_error(const Components& components);

/// How the profile K(r) differs from that of the disc, which drops from 1 to 0.
struct DiskProfile {
    double centre = 0;         ///< K(0)
    double flat_until = 0;     ///< where K leaves 1 on its way down to 0; 0 if it is never 1
    double inner_ringing = 0;  ///< the largest |K - 1| up to there
    double zero_from = 0;      ///< where K first reaches 0; infinite if it never does
    double outer_ringing = 0;  ///< the largest |K| from there on
};
/// throws   Error as value_at()
DiskProfile disk_profile(const Components& components);

/// The Fourier transform of the kernel along a line through its centre, 1 at frequency 0.
/// throws   Error as value_at(), and for components whose integral is 0
double disk_response(const Components& components, double cycles_per_radius);
/// The Fourier transform of the disc itself.
double disc_response(double cycles_per_radius);

/// The pass band of a response that is 1 at frequency 0.
struct DiskBand {
    double half = 0;     ///< the frequency at which it has fallen to 1/2
    double zero = 0;     ///< the first frequency at which it is 0; infinite if there is none below 4 cycles per radius
    double leakage = 0;  ///< the largest |response| from there to 4 cycles per radius
};
/// example  disk_band(disc_response)     // 0.353, 0.610, 0.132
DiskBand disk_band(const std::function<double(double)>& response);

}  // namespace bandlimit
