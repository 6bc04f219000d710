// Roughness maps: what may be averaged of them, and what lost normals add.
// Stability: inner.
#pragma once
#include <optional>
#include <span>

#include "bandlimit/core/view.h"

namespace bandlimit {

/// What is averaged of perceptual roughness r in [0, 1]: r^4, the square of the width alpha = r^2 of microfacet models.
///
/// Beckmann's and, near its peak, GGX's distribution of slopes has the variance alpha^2 / 2 along each axis, and the
/// variances of slopes about one mean add.
float roughness_variance(float roughness);
/// The way back, of [0, 1]; what lies outside is clamped.
float roughness_of_variance(float variance);

/// What normals whose mean has this length add to roughness_variance(): 2 / kappa, where kappa is the concentration of
/// the von Mises-Fisher distribution with this mean, kappa = R (3 - R^2) / (1 - R^2). Infinite for R = 0.
///
/// Such normals have slopes of variance 1 / kappa along each axis, and alpha^2 is twice the variance of slopes.
/// Spreads below 2^-20, which are roundings of floats, count as none.
/// source  Toksvig 2005, "Mipmapping normal maps" (the length of the mean measures the spread); Banerjee et al. 2005
///         (kappa from R); Han et al. 2007, "Frequency domain normal map filtering"; Neubelt & Pettineo 2013,
///         "Crafting a next-gen material pipeline for The Order: 1886" (roughness and vMF lobes)
float lost_variance(float mean_length);

/// lost_variance() of each mean vector of a row.
///
/// shapes  means [w x h x 3], row [w]
void lost_variances(View<const float> means, int y, std::span<float> row);

}  // namespace bandlimit
