#include "bandlimit/kernel/radial_weights.h"

#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

RadialWeights radial_weights_at(const Kernel& kernel, double phase_x, double phase_y) {
    if (!is_radial(kernel))
        fail("radial_weights_at: ", kernel.name, " is separable; pass a radial kernel such as jinc3");
    RadialWeights result{static_cast<int>(std::ceil(phase_x - kernel.radius)),
                         static_cast<int>(std::ceil(phase_y - kernel.radius)),
                         0,
                         0,
                         {},
                         0};
    const int last_x = static_cast<int>(std::floor(phase_x + kernel.radius));
    const int last_y = static_cast<int>(std::floor(phase_y + kernel.radius));
    result.width = last_x - result.first_x + 1, result.height = last_y - result.first_y + 1;
    for (int y = result.first_y; y <= last_y; ++y)
        for (int x = result.first_x; x <= last_x; ++x) {
            result.weights.push_back(kernel.value(std::hypot(x - phase_x, y - phase_y)));
            result.sum += result.weights.back();
        }
    if (cancels(result.weights)) fail("radial_weights_at: the weights of ", kernel.name, " sum to ", result.sum);
    for (double& w : result.weights) w /= result.sum;
    return result;
}

}  // namespace bandlimit
