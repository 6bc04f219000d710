// What the files of this folder share. Not for callers: only they include OpenImageIO.
// Stability: inner.
#pragma once
#include <OpenImageIO/imageio.h>

#include <string>
#include <string_view>

#include "bandlimit/io/codecs.h"

namespace bandlimit::oiio {

/// A share in the pools of threads of OpenImageIO and OpenEXR, which belong to the process and must not change their
/// size while a file is open. The first open file sets it to `threads` (0: all cores); others that are open at the same
/// time take it as it is. A file of one thread is told besides to use no pool.
class PoolShare {
public:
    explicit PoolShare(int threads);
    ~PoolShare();
    PoolShare(const PoolShare&) = delete;
    PoolShare& operator=(const PoolShare&) = delete;
};

/// An error text of a codec as part of one line; "the codec gives no reason" for an empty one.
std::string one_line(std::string_view text);

/// The bytes of an ICC profile among the attributes of a file, or nothing.
std::string_view profile_in(const OIIO::ParamValueList& attributes);

/// How many columns of a row of tiles make `bytes_at_once`, at least one tile. No end beyond the picture is looked at.
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

/// The functions of this folder's table.
Decoder decode(const std::string& path, const std::string& format, int threads);
Encoder encode(const Destination& destination, const ImageTarget& target, const FormatAbilities& format, int threads);

}  // namespace bandlimit::oiio
