// Tables for the codes of sRGB, built once, when first used.
// Stability: inner.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandlimit {

/// The linear light of every code, correctly rounded: [256] or [65536].
template <class Code>
const std::vector<float>& srgb_light();

/// The upper half of a positive float: its exponent and 7 bits of its mantissa. Floats with one upper half form a
/// bucket, and buckets are numbered as the floats are ordered.
constexpr std::uint32_t bucket_of(std::uint32_t float_bits) { return float_bits >> 16; }

/// Encoding is monotonic, so a code is the number of thresholds that a value has reached: thresholds[k - 1] is the
/// smallest float whose exact encoding is at least k - 1/2 codes, for k >= 1. Everything else here follows from them.
struct SrgbThresholds {
    std::vector<float> thresholds;       ///< [largest code]
    std::vector<std::uint32_t> reached;  ///< by the first float of each bucket up to that behind 1: few are left to try
};
template <class Code>
const SrgbThresholds& srgb_thresholds();

/// The definition: the code nearest to the exact encoding of a float; what is not finite gives 0.
template <class Code>
Code srgb_code(float light);

/// 8-bit codes in one look-up: for a float in [lowest, 1] with these bits, the code is
///     (entries[bucket_of(bits)] + (bits & 0xffff)) >> 16, added as integers.
///
/// A bucket holds one threshold at most. Its entry holds the code at its start in the upper half and 2^16 less the
/// lower half of the threshold below, so that the sum carries into the code where the threshold is reached.
struct SrgbCarryTable {
    float lowest = 0;            ///< where the first bucket with a threshold starts; its code is 0
    std::vector<float> entries;  ///< integers, bit by bit; 1,700 of them lie in [lowest, 1], the others are never read
};
const SrgbCarryTable& srgb_carry_table();

/// 16-bit codes in three look-ups: for a float in [lowest, 1] with these bits,
///     k = floor(start[b] + slope[b] * (bits & 0xffff)), with b = bucket_of(bits),
/// is the code or the code plus 1, rounded at every step or fused, and the code is k - (x < threshold[k]).
///
/// Within a bucket the encoding is nearly straight: a chord stays within 1/8 code of it, and 1/4 is added.
struct SrgbChordTable {
    float lowest = 0;                 ///< where the first bucket with a threshold starts; its code is 0
    std::vector<float> start, slope;  ///< 2,700 of them lie in [lowest, 1], the others are never read
    std::vector<float> threshold;     ///< [65536]: the smallest float of each code
};
const SrgbChordTable& srgb_chord_table();

}  // namespace bandlimit
