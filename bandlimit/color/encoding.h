// From stored samples to linear light, and back, a row at a time.
// Stability: stable.
#pragma once
#include <span>

#include "bandlimit/color/depth.h"
#include "bandlimit/color/transfer.h"

namespace bandlimit {

// Tables for sRGB codes are built when first used: in 0.3 ms for 8 bits, in 2 (decoding) and 9 ms (encoding) for 16.

/// What the stored samples of an image mean.
struct Encoding {
    Transfer transfer = Transfer::linear;  ///< of every channel but alpha
    int alpha = -1;                        ///< the channel that is coverage, or -1
    bool associated = false;               ///< colour is stored multiplied by alpha
};

/// Throws Error, in the name of `function`, unless alpha is one of `channels` channels or -1. Every function that takes
/// an Encoding calls it.
void check_encoding(const char* function, const Encoding& encoding, int channels);

/// Reads row `y` of `image` as linear light, channels interleaved, into `row`.
///
/// `premultiplied` asks for colour multiplied by alpha; colour that is stored multiplied stays multiplied either way.
///
/// shapes   row [width * channels]
/// range    any stored value; integers become [0, 1]
/// cost     up to 4 channels: a vector look-up per colour sample of sRGB codes, arithmetic for other codes and halves.
///          One sample at a time for floats and halves of sRGB, for more channels with alpha, and for channels that are
///          not side by side
void decode_row(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row);

/// Writes `row` to row `y` of `image`.
///
/// `premultiplied` says what the row holds, not what decode_row was asked for: a source that is stored associated gives
/// premultiplied rows either way. Integers are clamped and rounded to the nearest code of the exact transfer function;
/// values that are not finite become 0. Colour is divided by alpha sample by sample, correctly rounded; alpha of zero
/// or less gives zero colour. (Multiplying by 1 / alpha was measured: it saves a tenth of the time for sRGB bytes, and
/// rounds once more.)
///
/// shapes   row [width * channels]
/// returns  whether a value that is not finite became the code 0
/// cost     as decode_row, plus a division per colour sample where colour must be divided by alpha; allocates nothing
bool encode_row(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored);

/// Lays `row` (channels interleaved, alpha among them) over an opaque colour, and drops alpha.
///
/// shapes   row [width * channels], background [channels - 1] in linear light, out [width * (channels - 1)]
/// throws   Error for an alpha that is not one of the channels
void composite_row(std::span<const float> row, bool premultiplied, int channels, int alpha,
                   std::span<const float> background, std::span<float> out);

}  // namespace bandlimit
