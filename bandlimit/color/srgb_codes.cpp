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

std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
float start_of(std::uint32_t bucket) { return std::bit_cast<float>(bucket << 16); }
constexpr std::uint32_t last_bucket = 0x3f80;  // that of 1

std::uint32_t count_reached(const std::vector<float>& thresholds, std::uint32_t begin, std::uint32_t end, float x) {
    const auto first = thresholds.begin();
    return static_cast<std::uint32_t>(std::upper_bound(first + begin, first + end, x) - first);
}

template <class Code>
SrgbThresholds make_thresholds() {
    SrgbThresholds result;
    for (int code = 1; code <= largest_code<Code>; ++code) result.thresholds.push_back(make_threshold<Code>(code));
    for (std::uint32_t bucket = 0; bucket <= last_bucket + 1; ++bucket)
        result.reached.push_back(count_reached(result.thresholds, 0, largest_code<Code>, start_of(bucket)));
    return result;
}

SrgbCarryTable make_carry_table() {
    const SrgbThresholds& codes = srgb_thresholds<std::uint8_t>();
    const std::vector<float>& all = codes.thresholds;
    const std::uint32_t first = bucket_of(bits_of(all.front()));
    SrgbCarryTable table{start_of(first), std::vector<float>(last_bucket + 1)};
    for (std::uint32_t bucket = first; bucket <= last_bucket; ++bucket) {
        const std::uint32_t code = codes.reached[bucket];
        const auto inside = [&](std::uint32_t k) { return k < all.size() && bucket_of(bits_of(all[k])) == bucket; };
        if (inside(code) && inside(code + 1)) throw std::logic_error("SrgbCarryTable: two thresholds in a bucket");
        const std::uint32_t carry = inside(code) ? 0x10000 - (bits_of(all[code]) & 0xffff) : 0;
        const std::uint32_t entry = (code << 16) + carry;
        table.entries[bucket] = std::bit_cast<float>(entry);
    }
    return table;
}

SrgbChordTable make_chord_table() {
    const std::vector<float>& thresholds = srgb_thresholds<std::uint16_t>().thresholds;
    const std::uint32_t first = bucket_of(bits_of(thresholds.front()));
    const std::vector<float> unused(last_bucket + 1);
    SrgbChordTable table{start_of(first), unused, unused, {0.0f}};
    const auto position = [](std::uint32_t bucket) {
        return 65535 * linear_to_srgb(static_cast<double>(start_of(bucket)));
    };
    for (std::uint32_t bucket = first; bucket <= last_bucket; ++bucket) {
        table.start[bucket] = static_cast<float>(position(bucket) + 0.75);
        table.slope[bucket] = static_cast<float>((position(bucket + 1) - position(bucket)) / 0x10000);
    }
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
const SrgbThresholds& srgb_thresholds() {
    static const SrgbThresholds thresholds = make_thresholds<Code>();
    return thresholds;
}

template <class Code>
Code srgb_code(float light) {
    if (!(light > 0 && std::isfinite(light))) return 0;
    if (light >= 1) return largest_code<Code>;
    const SrgbThresholds& codes = srgb_thresholds<Code>();
    const std::uint32_t bucket = bucket_of(bits_of(light));
    return static_cast<Code>(count_reached(codes.thresholds, codes.reached[bucket], codes.reached[bucket + 1], light));
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
template const SrgbThresholds& srgb_thresholds<std::uint8_t>();
template const SrgbThresholds& srgb_thresholds<std::uint16_t>();
template std::uint8_t srgb_code<std::uint8_t>(float light);
template std::uint16_t srgb_code<std::uint16_t>(float light);

}  // namespace bandlimit
