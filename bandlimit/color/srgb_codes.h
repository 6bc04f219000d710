// Tables for the codes of sRGB, built once, when first used.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandlimit {

/// The linear light of every code, correctly rounded: [256] or [65536].
template <class Code>
const std::vector<float>& srgb_light();

/// Finds the code nearest to the exact encoding of a float.
///
/// Encoding is monotonic, so a code is the number of thresholds that a value has reached: [k - 1] is the smallest float
/// whose exact encoding is at least k - 1/2 codes, for k of 1 and more. Both tables below follow from these.
template <class Code>
const std::vector<float>& srgb_thresholds();

/// The definition: the number of thresholds reached; what is not finite gives 0.
template <class Code>
Code srgb_code(float light);

/// The upper half of a positive float: its exponent and 7 bits of its mantissa. Floats with one upper half form a
/// bucket, and buckets are numbered as the floats are ordered.
constexpr std::uint32_t bucket_of(std::uint32_t float_bits) { return float_bits >> 16; }

/// 8-bit codes in one look-up: for a float in [lowest, 1] with these bits, the code is
///     (entries[bucket_of(bits) - first] + (bits & 0xffff)) >> 16.
///
/// A bucket holds one threshold at most. Its entry holds the code at its start in the upper half and 2^16 less the
/// lower half of the threshold below, so that the sum carries into the code where the threshold is reached.
struct SrgbCarryTable {
    float lowest = 0;  ///< where the first bucket starts; its code is 0
    std::uint32_t first = 0;
    std::vector<std::uint32_t> entries;  ///< about 1,700
};
const SrgbCarryTable& srgb_carry_table();

/// 16-bit codes in three look-ups: for a float in [lowest, 1] with these bits,
///     k = floor(start[b] + slope[b] * (bits & 0xffff)), with b = bucket_of(bits) - first,
/// is the code or the code plus 1, rounded at every step or fused, and the code is k - (x < threshold[k]).
///
/// Within a bucket the encoding is nearly straight: a chord stays within 1/8 code of it, and 1/4 is added.
struct SrgbChordTable {
    float lowest = 0;  ///< where the first bucket starts; its code is 0
    std::uint32_t first = 0;
    std::vector<float> start, slope;  ///< of about 2,700 buckets
    std::vector<float> threshold;     ///< [65536]: the smallest float of each code
};
const SrgbChordTable& srgb_chord_table();

}  // namespace bandlimit
