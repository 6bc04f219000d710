// What our files share of OpenImageIO. Not for callers: it is included by .cpp files of this room only.
#pragma once
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "bandlimit/io/image_file.h"

namespace bandlimit {

/// What a file says beside its pixels.
struct ImageReader::Metadata {
    OIIO::ParamValueList attributes;
    Transfer transfer = Transfer::linear;  ///< what a colour profile among them applies to
};

/// Lets OpenImageIO and OpenEXR keep at most `threads` threads busy (0: all cores); with 1 the caller works alone.
void use_threads(int threads);

/// An error text of a codec as part of one line; "unknown reason" for an empty one.
std::string one_line(std::string_view text);

/// The bytes of an ICC profile among the attributes of a file, or nothing.
std::string_view profile_in(const OIIO::ParamValueList& attributes);

/// a * b, or the largest number if that is larger.
constexpr std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b) {
    constexpr auto largest = std::numeric_limits<std::uint64_t>::max();
    return b != 0 && a > largest / b ? largest : a * b;
}

/// Decoded bytes of the tiles that pass through OpenImageIO in one call: enough of them for many threads, and few
/// enough that its copies do not matter.
constexpr std::uint64_t bytes_at_once = 16 << 20;

/// How many columns of a row of tiles that is, at least one tile. No end beyond the picture is looked at.
int tile_columns_at_once(const OIIO::ImageSpec& spec);

inline OIIO::TypeDesc type_of(Depth depth) {
    switch (depth) {
        case Depth::u8: return OIIO::TypeDesc::UINT8;
        case Depth::u16: return OIIO::TypeDesc::UINT16;
        case Depth::f16: return OIIO::TypeDesc::HALF;
        case Depth::f32: break;
    }
    return OIIO::TypeDesc::FLOAT;
}

/// What `spec`, read from a file of this format, says in our words; levels and subimages are left at 1.
ImageInfo info_of(const OIIO::ImageSpec& spec, const std::string& format);

/// The format of a file that begins with `head`, as OpenImageIO names it; "" if it is none that we read.
/// `path` decides for TGA alone, which has no signature.
std::string format_of(std::span<const unsigned char> head, const std::string& path);

}  // namespace bandlimit
