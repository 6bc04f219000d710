// What a program needs to use bandlimit: halve a white picture, and see that it stays white.
#include <cmath>

#include "bandlimit/resample/resize.h"

int main() {
    bandlimit::Image<float> white(64, 48);
    for (int y = 0; y < white.height(); ++y)
        for (int x = 0; x < white.width(); ++x) white.view()(x, y) = 1;
    const auto half = bandlimit::resample(white.view(), 32, 24, {.reconstruction = bandlimit::lanczos(3)});
    return std::abs(half.view()(31, 23) - 1) < 1e-6f ? 0 : 1;  // some roundings of weights that sum to 1
}
