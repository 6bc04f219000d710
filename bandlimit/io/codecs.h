// What this room asks of a library of codecs. Such a library is a folder of this room, as oiio/, and gives a table of
// functions; nothing outside the folder knows the library's headers. Not for callers.
// Stability: inner.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "bandlimit/io/image_file.h"

namespace bandlimit {

/// What a file says beside its pixels.
struct ImageReader::Metadata {
    std::shared_ptr<const void> attributes;  ///< in the terms of the library that read them; null: none
    Transfer transfer = Transfer::linear;    ///< what a colour profile among them applies to
};

/// A picture as its file stores it.
struct StoredPicture {
    ImageInfo info;                        ///< as callers see it: upright; levels and subimages are left at 1
    int tile_width = 0, tile_height = 0;   ///< 0 x 0: rows
    int rows_at_once = 1;                  ///< rows that the codec decodes together
    std::string compression;               ///< none, zip, lzw, ...; "" if it is not known
    std::shared_ptr<const void> metadata;  ///< Metadata::attributes
};

/// How many pictures a file holds.
struct Parts {
    int levels = 1, subimages = 1;
};

/// A file that is being read. Every function throws std::runtime_error "PATH: what is wrong; what to do".
struct Decoder {
    StoredPicture picture;
    /// Reads the stored rows [y, y + rows.height) into packed rows of the picture's depth. Where there are tiles, these
    /// are the rows of one row of tiles. In any order; ascending is cheap.
    std::function<void(int y, const AnyView& rows)> read;
    std::function<Parts()> count_parts;
};

/// Where a new file goes.
struct Destination {
    std::string path;        ///< for messages
    std::string unfinished;  ///< the file while it is written, for codecs that must open it themselves; the others use:
    std::function<std::int64_t()> tell, size;
    std::function<bool(std::int64_t offset)> seek;
    std::function<std::size_t(void* data, std::size_t size)> read;
    std::function<std::size_t(const void* data, std::size_t size)> write;
};

/// A file that is being written. Every function throws std::runtime_error "PATH: what is wrong; what to do".
struct Encoder {
    /// Writes the rows from y on, in order, in the target's depth. Where there are tiles, these are the rows of one row
    /// of tiles, all of them whole: the view goes beyond the picture.
    std::function<void(int y, const AnyConstView& rows)> write;
    /// Completes the file.
    std::function<void()> close;
};

/// A library of codecs. `threads` are as for ImageReader.
struct Codecs {
    Decoder (*decode)(const std::string& path, const std::string& format, int threads);
    Encoder (*encode)(const Destination& destination, const ImageTarget& target, const FormatAbilities& format,
                      int threads);
};

/// OpenImageIO, for all formats. The first call may load it, which takes a third of a second.
///
/// throws   std::runtime_error where it is not to be found
const Codecs& oiio_codecs();

/// a * b, or the largest number if that is larger.
constexpr std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b) {
    constexpr auto largest = std::numeric_limits<std::uint64_t>::max();
    return b != 0 && a > largest / b ? largest : a * b;
}

/// With the letters of ASCII made small.
inline std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// Decoded bytes of the tiles that pass through a codec in one call: enough of them for many threads, and few enough
/// that its copies do not matter.
constexpr std::uint64_t bytes_at_once = 16 << 20;

}  // namespace bandlimit

/// Where OpenImageIO's table is: linked into the program, or in the module bandlimit_oiio.so.
extern "C" const bandlimit::Codecs* bandlimit_oiio_codecs();
