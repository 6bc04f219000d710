// What KTX2 and DDS have in common: numbers in headers, and where texels lie. Not for callers.
// Stability: inner.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/texture/container.h"

namespace bandlimit {

/// What is said of texels that are not read.
inline constexpr std::string_view advice_for_texels =
    "which are not read; convert it to 8 or 16 bits, half or float, uncompressed";

/// How a file stores texels.
struct StoredTexels {
    TexelFormat format;  ///< what they are read as
    std::string order;   ///< of the channels in memory: "RGBA", "BGRX" (X is passed over), "R", ...

    std::uint64_t bytes() const { return order.size() * size_of(format.depth); }
};
/// Texels whose channels lie in `order`: R, R and G, or R, G and B with A or without, which then is opaque.
StoredTexels stored_texels(std::string_view order, Depth depth, bool srgb = false);

/// A texel format that a graphics interface has a number for.
struct NumberedFormat {
    std::uint32_t number;
    std::string_view order;  ///< as StoredTexels
    Depth depth;
    bool srgb = false;
};
/// The one of `formats` with this number; null if there is none.
const NumberedFormat* find_format(std::span<const NumberedFormat> formats, std::uint32_t number);
/// The first whose texels lie as `stored`.
const NumberedFormat* find_format(std::span<const NumberedFormat> formats, const StoredTexels& stored);
/// The first for texels of `format` in the order of their channels.
const NumberedFormat* find_format(std::span<const NumberedFormat> formats, const TexelFormat& format);

/// All that a header says.
struct ContainerLayout {
    ContainerInfo info;
    StoredTexels stored;
    bool is_bottom_first = false;  ///< rows go up
    std::vector<LevelPlace> levels;

    std::uint64_t images() const;  ///< layers times faces
    /// Bytes of one image of a level. Does not overflow once check_claims() was passed.
    std::uint64_t image_bytes(int level) const;
};

/// What headers are made of: little-endian numbers in the first bytes of a file, which are never read past their end.
struct FileBytes {
    std::span<const std::byte> start;  ///< the file, or as much of it as container_info() asks for
    std::uint64_t length = 0;          ///< of the file
    const std::string& name;           ///< what errors call it

    std::uint32_t u32(std::uint64_t offset) const;
    std::uint64_t u64(std::uint64_t offset) const;
    std::string_view text(std::uint64_t offset, std::uint64_t bytes) const;
    /// Throws unless the file has the bytes [offset, offset + bytes), calling them `what`.
    void require(std::uint64_t offset, std::uint64_t bytes, std::string_view what) const;
};

/// A count of a header as an int of at most `most`. Throws, calling it `what`.
int checked_count(const FileBytes& file, std::uint32_t value, std::string_view what, int most);

/// Throws unless sizes and counts are those of a texture, and the file long enough for level 0. After that no product
/// of them overflows 64 bits.
void check_claims(const FileBytes& file, const ContainerLayout& layout);

/// Reads the images that `layout` found, all of which lie inside the file.
Texture read_images(std::span<const std::byte> file, const ContainerLayout& layout);

/// The bytes of a header in the making.
class HeaderBytes {
public:
    void u32(std::uint64_t value);  ///< Throws Error if it does not fit
    void u64(std::uint64_t value);
    void zeros(std::uint64_t count) { bytes_.insert(bytes_.end(), count, std::byte{0}); }
    void text(std::string_view text);
    std::size_t size() const { return bytes_.size(); }
    void append(const HeaderBytes& other) { bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end()); }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

}  // namespace bandlimit
