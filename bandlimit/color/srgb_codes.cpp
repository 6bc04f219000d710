#include "bandlimit/color/srgb_codes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bandlimit/color/transfer.h"

namespace bandlimit {
namespace {

template <class Code>
constexpr int largest_code = std::numeric_limits<Code>::max();

template <class Code>
std::vector<float> make_light() {
    std::vector<float> light;
    for (int code = 0; code <= largest_code<Code>; ++code)
        light.push_back(static_cast<float>(srgb_to_linear(static_cast<double>(code) / largest_code<Code>)));
    return light;
}

template <class Code>
float make_threshold(int code) {
    const double boundary = (code - 0.5) / largest_code<Code>;
    const auto reaches = [&](float x) { return linear_to_srgb(static_cast<double>(x)) >= boundary; };
    float x = static_cast<float>(srgb_to_linear(boundary));
    while (!reaches(x)) x = std::nextafter(x, 2.0f);
    for (float below; reaches(below = std::nextafter(x, 0.0f));) x = below;
    return x;
}

template <class Code>
std::vector<float> make_thresholds() {
    std::vector<float> thresholds;
    for (int code = 1; code <= largest_code<Code>; ++code) thresholds.push_back(make_threshold<Code>(code));
    return thresholds;
}

std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
float start_of(std::uint32_t bucket) { return std::bit_cast<float>(bucket << 16); }

SrgbCarryTable make_carry_table() {
    const std::vector<float>& thresholds = srgb_thresholds<std::uint8_t>();
    SrgbCarryTable table;
    table.first = bucket_of(bits_of(thresholds.front()));
    table.lowest = start_of(table.first);
    for (std::uint32_t bucket = table.first; bucket <= bucket_of(bits_of(1.0f)); ++bucket) {
        const auto next = std::upper_bound(thresholds.begin(), thresholds.end(), start_of(bucket));
        const auto end = std::lower_bound(next, thresholds.end(), start_of(bucket + 1));
        if (end - next > 1) throw std::logic_error("SrgbCarryTable: two thresholds in a bucket");
        const auto code = static_cast<std::uint32_t>(next - thresholds.begin());
        table.entries.push_back((code << 16) + (next == end ? 0 : 0x10000 - (bits_of(*next) & 0xffff)));
    }
    return table;
}

SrgbChordTable make_chord_table() {
    const std::vector<float>& thresholds = srgb_thresholds<std::uint16_t>();
    SrgbChordTable table;
    table.first = bucket_of(bits_of(thresholds.front()));
    table.lowest = start_of(table.first);
    const auto position = [](std::uint32_t bucket) {
        return 65535 * linear_to_srgb(static_cast<double>(start_of(bucket)));
    };
    for (std::uint32_t bucket = table.first; bucket <= bucket_of(bits_of(1.0f)); ++bucket) {
        table.start.push_back(static_cast<float>(position(bucket) + 0.75));
        table.slope.push_back(static_cast<float>((position(bucket + 1) - position(bucket)) / 0x10000));
    }
    table.threshold = {0.0f};
    table.threshold.insert(table.threshold.end(), thresholds.begin(), thresholds.end());
    return table;
}

}  // namespace

template <class Code>
const std::vector<float>& srgb_light() {
    static const std::vector<float> light = make_light<Code>();
    return light;
}

template <class Code>
const std::vector<float>& srgb_thresholds() {
    static const std::vector<float> thresholds = make_thresholds<Code>();
    return thresholds;
}

template <class Code>
Code srgb_code(float light) {
    if (!std::isfinite(light)) return 0;
    const std::vector<float>& thresholds = srgb_thresholds<Code>();
    return static_cast<Code>(std::upper_bound(thresholds.begin(), thresholds.end(), light) - thresholds.begin());
}

const SrgbCarryTable& srgb_carry_table() {
    static const SrgbCarryTable table = make_carry_table();
    return table;
}

const SrgbChordTable& srgb_chord_table() {
    static const SrgbChordTable table = make_chord_table();
    return table;
}

template const std::vector<float>& srgb_light<std::uint8_t>();
template const std::vector<float>& srgb_light<std::uint16_t>();
template const std::vector<float>& srgb_thresholds<std::uint8_t>();
template const std::vector<float>& srgb_thresholds<std::uint16_t>();
template std::uint8_t srgb_code<std::uint8_t>(float light);
template std::uint16_t srgb_code<std::uint16_t>(float light);

}  // namespace bandlimit
