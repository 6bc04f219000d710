#include "bandlimit/texture/alpha_coverage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

namespace bandlimit {
namespace {

/// Alphas that are stored as a value that passes, and those that are not.
struct Border {
    double passes;   ///< from here on they pass
    double inside;   ///< well above
    double outside;  ///< well below
};

template <class Code>
Border border_of_codes(float threshold) {
    constexpr int largest = std::numeric_limits<Code>::max();
    int code = static_cast<int>(static_cast<double>(threshold) * largest);
    while (code > 0 && from_code(static_cast<Code>(code - 1)) >= threshold) --code;
    while (code < largest && from_code(static_cast<Code>(code)) < threshold) ++code;
    return {(code - 0.5) / largest, (code - 0.25) / largest, (code - 0.75) / largest};
}

Border border_of(Depth depth, float threshold) {
    if (depth == Depth::u8) return border_of_codes<std::uint8_t>(threshold);
    if (depth == Depth::u16) return border_of_codes<std::uint16_t>(threshold);
    double passes = static_cast<double>(threshold);
    if (depth == Depth::f16) {
        Half first = to_half(threshold);
        if (to_float(first) < threshold) ++first.bits;
        const Half before{static_cast<std::uint16_t>(first.bits - 1)};  // threshold > 0, so there is one
        passes = (static_cast<double>(to_float(first)) + static_cast<double>(to_float(before))) / 2;
        if (first.bits % 2 != 0) passes = std::nextafter(passes, 2.0);  // ties go to even
    }
    constexpr double margin = 1.0 / 256;
    return {passes, passes * (1 + margin), passes * (1 - margin)};
}

}  // namespace

std::size_t count_passing(const AnyConstView& image, int channel, double threshold) {
    const auto limit = static_cast<float>(threshold);
    std::size_t count = 0;
    std::visit(
        [&](const auto& v) {
            using T = std::remove_cvref_t<decltype(v(0, 0, 0))>;
            for (int y = 0; y < v.height; ++y)
                for (int x = 0; x < v.width; ++x) {
                    float alpha = 0;
                    if constexpr (std::is_same_v<T, Half>) alpha = to_float(v(x, y, channel));
                    else if constexpr (std::is_integral_v<T>) alpha = from_code(v(x, y, channel));
                    else alpha = v(x, y, channel);
                    if (alpha >= limit) ++count;
                }
        },
        image);
    return count;
}

double coverage_factor(std::vector<float> alphas, double share, Depth depth, double threshold) {
    for (float& alpha : alphas)
        if (!std::isfinite(alpha) || alpha < 0) alpha = 0;
    const double wanted = share * static_cast<double>(alphas.size());
    auto count = static_cast<std::size_t>(std::lround(wanted));
    const Border border = border_of(depth, static_cast<float>(threshold));
    const auto at = [&](std::size_t i) {  // the i-th largest, from 0
        const auto place = alphas.begin() + static_cast<std::ptrdiff_t>(i);
        std::nth_element(alphas.begin(), place, alphas.end(), std::greater<>());
        return *place;
    };
    if (count > 0 && count < alphas.size()) {
        // Of equal alphas all pass or none.
        const float last = at(count - 1);
        const auto above = static_cast<std::size_t>(
            std::count_if(alphas.begin(), alphas.end(), [&](float alpha) { return alpha > last; }));
        const auto with = above + static_cast<std::size_t>(std::count(alphas.begin(), alphas.end(), last));
        if (with > count)
            count = wanted - static_cast<double>(above) < static_cast<double>(with) - wanted ? above : with;
    }
    if (count > 0 && at(count - 1) == 0)  // no factor makes a zero pass
        count = static_cast<std::size_t>(
            std::count_if(alphas.begin(), alphas.end(), [](float alpha) { return alpha > 0; }));
    const double in = count > 0 ? static_cast<double>(at(count - 1)) : border.passes;
    const double out = count < alphas.size() ? static_cast<double>(at(count)) : 0;
    if (in >= border.passes && out < border.passes) return 1;
    if (count == 0) return border.outside / out;
    if (count == alphas.size()) return border.inside / in;
    return border.passes / ((in + out) / 2);
}

}  // namespace bandlimit
