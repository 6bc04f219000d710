// 16-bit floats.
// Stability: stable.
#pragma once
#include <cstdint>

namespace bandlimit {

/// An IEEE 754 binary16 number, as stored. Arithmetic is done in float.
struct Half {
    std::uint16_t bits = 0;
    friend bool operator==(Half, Half) = default;
};

/// Exact.
float to_float(Half h);
/// Rounded to nearest, ties to even; beyond 65519.99 infinite; a NaN stays a NaN.
Half to_half(float x);

}  // namespace bandlimit
