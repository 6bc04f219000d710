#include "bandlimit/color/transfer.h"

#include <cmath>

namespace bandlimit {

std::string_view name_of(Transfer transfer) { return transfer == Transfer::srgb ? "srgb" : "linear"; }

double srgb_to_linear(double encoded) {
    const double x = std::abs(encoded);
    return std::copysign(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4), encoded);
}

double linear_to_srgb(double linear) {
    const double x = std::abs(linear);
    return std::copysign(x <= 0.0031308 ? x * 12.92 : 1.055 * std::pow(x, 1 / 2.4) - 0.055, linear);
}

}  // namespace bandlimit
