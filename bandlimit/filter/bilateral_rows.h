// The loop of the bilateral filter over a row: each output the mean of the samples about it, weighted by how near they are
// and by how alike their guides are. bilateral_tile.h lays out what it reads.
// Stability: inner.
#pragma once
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace bandlimit {

/// A row of outputs. Samples lie in planes of floats: channel c of the sample i columns right of and j rows below that of
/// output x is at [c * plane + j * row + i + x]. Where vectors run, up to 15 floats behind the last sample of a row are
/// read and behind the last output are written, for nothing.
struct BilateralRow {
    int width = 0;
    int signals = 1, guides = 1;
    int radius_x = 0, radius_y = 0;
    const float* space = nullptr;   ///< weights [2 radius_y + 1][2 radius_x + 1]
    const float* scales = nullptr;  ///< [guides]: what differences in range are multiplied by, above 0
    const float* signal = nullptr;  ///< of output 0; finite
    const float* guide = nullptr;  ///< the same; channel 0 of samples that are left out is infinite, all else is finite
    const float* centre = nullptr;  ///< channel 0 of the guide of the outputs: as `guide`, but never infinite
    std::ptrdiff_t row = 0, plane = 0;
    float* out = nullptr;  ///< channel c of output x is at [c * out_plane + x]; NaN where all weights are 0
    std::ptrdiff_t out_plane = 0;
};

/// The polynomial of falloff(): 2^-t for t in [-1/2, 1/2] is 1 + t (falloff_terms[0] + t (falloff_terms[1] + ...)).
inline constexpr float falloff_terms[] = {-0.693147004f, 0.240222424f, -0.0555073358f, 0.00967151299f, -0.00132647308f};
/// Minus x from 0 to 127, added to it, becomes an integer, with the exponent of 2^-x in its lowest bits.
inline constexpr float falloff_shift = 12583039;

/// 2^-x for x >= 0; 0 from 127 on. 1 at 0.
/// error   below 3e-7 of the result, up to x = 126
inline float falloff(float x) {
    const float limited = x < 127 ? x : 127;
    const float shifted = falloff_shift - limited;
    const float t = limited + (shifted - falloff_shift);
    float sum = falloff_terms[4];
    for (int k = 3; k >= 0; --k) sum = std::fma(sum, t, falloff_terms[k]);
    sum = std::fma(sum, t, 1.0f);
    return sum * std::bit_cast<float>(std::bit_cast<std::uint32_t>(shifted) << 23);
}

/// What falloff() of a squared difference in range must be given: differences times this, for exp(-d^2 / (2 sigma^2)).
/// For sigma 0 as large as floats allow, so that whatever differs by 1e-36 or more has no weight.
double range_scale(double sigma);

/// The definition.
void bilateral_row_scalar(const BilateralRow& row);
/// The same by vectors along the row: the same bits, where multiply-add is fused.
void bilateral_row(const BilateralRow& row);

}  // namespace bandlimit
