// What OpenImageIO 2.4 lacks of PNM: it writes 8 bits only, and reads the upper half of 16-bit codes one too low.
// Not for callers.
// Stability: inner.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bandlimit/color/depth.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/codecs.h"

namespace bandlimit {

/// Where the rows of a PNM or PFM file lie.
struct PnmLayout {
    int width = 0, height = 0;
    int channels = 1;          ///< 1 grey or 3 RGB
    Depth depth = Depth::u8;   ///< u8 and u16 make PGM or PPM, f32 PFM
    std::int64_t start = 0;    ///< of the pixels, in bytes
    int largest_code = 65535;  ///< white, for u16
};

/// The layout of `path`, if it is a binary PGM or PPM of 16 bits.
std::optional<PnmLayout> find_pnm_of_16_bits(const std::string& path);

/// Reads such a file. Codes are scaled so that white is 65535, and rounded to nearest.
Decoder decode_pnm(const std::string& path, const PnmLayout& layout);

/// Writes the header, and tells where the rows belong. Failures are remembered by `file`.
/// source   netpbm: the pages pgm(5), ppm(5); PFM as Debevec's HDR Shop writes it: rows from bottom to top
PnmLayout write_pnm_header(AtomicFile& file, int width, int height, int channels, Depth depth);

/// Writes the rows of `view`, the first of which is row `y` of the picture.
void write_pnm_rows(AtomicFile& file, const PnmLayout& layout, int y, const AnyConstView& view);

}  // namespace bandlimit
