// Pictures in motion: animated PNG, which browsers show and other programs read as its first picture.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "bandlimit/core/image.h"

namespace bandlimit::job {

/// Writes sRGB codes, frame after frame, to be shown again and again.
///
/// Each frame is compressed as a PNG of its own; only the chunks are put together here.
/// shapes   all of one size with 3 channels
/// units    each is shown for so many milliseconds, 1 to 65535
/// throws   Error for no frames and other shapes; std::runtime_error for files. It appears whole or not at all
/// source   PNG, third edition, 11.3.6: acTL, fcTL and fdAT
void write_animated_png(const std::string& path, std::span<const Image<std::uint8_t>> frames, int milliseconds);

}  // namespace bandlimit::job
