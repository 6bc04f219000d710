// What can be known of a file before a codec sees it. Not for callers.
// Stability: inner.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace bandlimit {

/// A file that exists, is regular, can be read and begins like an image.
struct Probe {
    std::string format;       ///< as OpenImageIO names it
    std::uint64_t bytes = 0;  ///< length of the file
    /// Memory that the codec takes at once when it opens the file, and 0 where it reads row by row.
    std::uint64_t memory_to_open = 0;
    bool is_interlaced = false;  ///< a PNG whose rows come out together
};

/// The format of a file that begins with `head`, as OpenImageIO names it; "" if it is not one that we read.
/// `path` decides for TGA alone, which has no signature.
std::string format_of(std::span<const unsigned char> head, const std::string& path);

/// throws   std::runtime_error, with the path, for anything else
Probe probe(const std::string& path);

/// The most bytes of decoded samples that one byte of a file can hold, or 0 where no bound is known.
///
/// A file that claims more does not hold what it claims, whatever the codec finds out later. Bounds are generous: they
/// include palettes, packed bits and our own wider depths.
/// `row_bytes` are the decoded bytes of a row, `compression` is the word of OpenImageIO.
std::uint64_t largest_expansion(const std::string& format, const std::string& compression, std::uint64_t row_bytes);

}  // namespace bandlimit
