// The work of decode_row(), encode_row() and composite_row(), which have checked the arguments: the definition, a
// sample at a time, and the same by vectors.
// Stability: inner.
#pragma once
#include <span>

#include "bandlimit/color/encoding.h"

namespace bandlimit {

/// What is done to colour: nothing, or a product or quotient with the alpha of its pixel.
enum class ByAlpha { none, multiply, divide };

/// From stored samples to the row that decode_row() is asked for.
constexpr ByAlpha decoding_step(const Encoding& stored, bool premultiplied) {
    return stored.alpha >= 0 && premultiplied && !stored.associated ? ByAlpha::multiply : ByAlpha::none;
}
/// From a row that encode_row() is given to stored samples.
constexpr ByAlpha encoding_step(const Encoding& stored, bool premultiplied) {
    if (stored.alpha < 0 || premultiplied == stored.associated) return ByAlpha::none;
    return premultiplied ? ByAlpha::divide : ByAlpha::multiply;
}

// The definition. Zero alpha takes the colour away, even one that is not finite.
void decode_row_scalar(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                       std::span<float> row);
bool encode_row_scalar(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                       const Encoding& stored);
void composite_row_scalar(std::span<const float> row, bool premultiplied, int channels, int alpha,
                          std::span<const float> background, std::span<float> out);

// The same on current_target(): the same bits, except those of a NaN.
void decode_row_simd(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                     std::span<float> row);
bool encode_row_simd(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                     const Encoding& stored);
void composite_row_simd(std::span<const float> row, bool premultiplied, int channels, int alpha,
                        std::span<const float> background, std::span<float> out);

}  // namespace bandlimit
