// What a program needs to use bandlimit: halve a row of pixels and see that a constant survives.
#include "bandlimit/resample/apply.h"

int main() {
    bandlimit::Image<float> source(64, 1), half(32, 1);
    for (int x = 0; x < source.width(); ++x) source.view()(x, 0) = 1;
    const auto bank = bandlimit::make_bank(bandlimit::lanczos(3), {64}, {32}, bandlimit::Edge::reflect);
    bandlimit::apply(bank, source.view(), half.view());
    return half.view()(16, 0) > 0.999f && half.view()(16, 0) < 1.001f ? 0 : 1;
}
