#include "bench/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bandlimit::bench {
namespace {

double code_at(const Case& c, std::span<const std::byte> bytes, std::size_t i) {
    if (c.channels > 1) return std::to_integer<int>(bytes[i]);
    float value;
    std::memcpy(&value, &bytes[i * sizeof value], sizeof value);
    return 255.0 * static_cast<double>(value);
}

}  // namespace

Difference difference(const Case& c, std::span<const std::byte> a, std::span<const std::byte> b) {
    constexpr int border = 8;
    Difference result;
    double sum = 0, count = 0;
    for (const Level& level : levels_of(c)) {
        if (std::min(level.width, level.height) < 64) break;
        const std::size_t first = level.offset / c.sample_bytes();
        for (int y = border; y < level.height - border; ++y)
            for (int x = border * c.channels; x < (level.width - border) * c.channels; ++x) {
                const auto i = first +
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width * c.channels) +
                               static_cast<std::size_t>(x);
                const double d = std::abs(code_at(c, a, i) - code_at(c, b, i));
                result.largest = std::max(result.largest, d);
                sum += d, ++count;
            }
    }
    result.mean = sum / count;
    return result;
}

}  // namespace bandlimit::bench
