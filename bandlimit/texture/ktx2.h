// Textures in KTX 2.0 files. Not for callers: container.h has the functions.
// Stability: inner.
#pragma once
#include "bandlimit/texture/container_layout.h"

namespace bandlimit {

/// The first bytes of every file.
inline constexpr std::string_view ktx2_identifier = "\xabKTX 20\xbb\r\n\x1a\n";

/// Reads the header of a KTX2 file.
///
/// range    uncompressed formats of 8 and 16 bits, halves and floats, with red first or blue first; three channels are
///          read as four. Rows that go up are turned. No other key matters
/// throws   as container_info
/// source   KTX File Format Specification 2.0 (Khronos Group), section 3
ContainerLayout ktx2_layout(const FileBytes& file);

/// The format in which texels are written; null if there is none.
const NumberedFormat* ktx2_format(const TexelFormat& format);

/// Plans a file for what check_container() accepts: levels from the smallest to the largest, each at
/// a multiple of its texels and of 4 bytes, with the keys KTXorientation and KTXwriter.
///
/// source   as above; descriptor: Khronos Data Format Specification 1.3, section 5
ContainerPlan plan_ktx2(const TextureShape& shape);

}  // namespace bandlimit
