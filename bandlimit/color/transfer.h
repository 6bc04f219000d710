// Transfer functions: what a stored value means in linear light.
// Stability: stable.
#pragma once
#include <string_view>

namespace bandlimit {

/// How stored values relate to linear light.
enum class Transfer {
    linear,  ///< they are the same
    srgb     ///< IEC 61966-2-1; continued below 0 as an odd function, above 1 by the power
};

std::string_view name_of(Transfer transfer);

/// sRGB to linear light (IEC 61966-2-1): x / 12.92 up to 0.04045, then ((x + 0.055) / 1.055)^2.4.
/// Odd: f(-x) = -f(x). Any x; NaN gives NaN.
double srgb_to_linear(double encoded);

/// The inverse: 12.92 x up to 0.0031308, then 1.055 x^(1/2.4) - 0.055.
double linear_to_srgb(double linear);

inline double decode(Transfer t, double encoded) { return t == Transfer::srgb ? srgb_to_linear(encoded) : encoded; }
inline double encode(Transfer t, double linear) { return t == Transfer::srgb ? linear_to_srgb(linear) : linear; }

}  // namespace bandlimit
