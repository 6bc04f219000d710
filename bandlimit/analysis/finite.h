// How samples that are not finite count when images are measured.
// Stability: inner.
#pragma once
#include <cmath>

namespace bandlimit {

/// Infinities and NaN count as 0, the code that they are stored as in integer files.
inline float finite_or_zero(float sample) { return std::isfinite(sample) ? sample : 0.0f; }

}  // namespace bandlimit
