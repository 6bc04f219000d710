#include "bandlimit/color/half.h"

#include <Eigen/Core>

namespace bandlimit {

float to_float(Half h) { return Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(h.bits)); }
Half to_half(float x) { return {Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(x))}; }

}  // namespace bandlimit
