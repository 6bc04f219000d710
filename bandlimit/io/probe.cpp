#include "bandlimit/io/probe.h"

#include <array>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/regular_file.h"

namespace bandlimit {
namespace {

/// Reads two big-endian bytes; -1 at the end of the file.
int read_u16(std::FILE* file) {
    const int high = std::fgetc(file), low = std::fgetc(file);
    return low == EOF ? -1 : high * 256 + low;
}

/// The coefficients of a progressive or arithmetic multi-scan JPEG, all of which libjpeg keeps while it decodes; else
/// 0.
std::uint64_t jpeg_memory(std::FILE* file) {
    std::fseek(file, 2, SEEK_SET);
    for (;;) {
        int marker = std::fgetc(file);
        if (marker != 0xff) return 0;  // not where a marker should be: libjpeg will say what is wrong
        while (marker == 0xff) marker = std::fgetc(file);
        const int length = read_u16(file);
        if (marker == EOF || length < 2) return 0;
        const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (is_frame) {
            const bool is_progressive = (marker & 3) == 2;
            std::fgetc(file);  // bits of a sample
            const int height = read_u16(file), width = read_u16(file), components = std::fgetc(file);
            if (!is_progressive || components == EOF || height < 0 || width < 0) return 0;
            constexpr std::uint64_t coefficient_bytes = 2;
            return static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(width) *
                   static_cast<std::uint64_t>(components) * coefficient_bytes;
        }
        if (std::fseek(file, length - 2, SEEK_CUR) != 0) return 0;
    }
}

/// Refuses a PNG file with a chunk that is longer than the file: libpng makes room for it, and fills it with zeros,
/// before it reads. Pixels it reads piece by piece: who lacks some of those learns that later, and gets the rows
/// before.
void check_png_chunks(std::FILE* file, std::uint64_t bytes, const std::string& path) {
    constexpr std::uint64_t signature = 8, around = 12;  // length, name and checksum
    for (std::uint64_t start = signature; start + around <= bytes;) {
        std::array<unsigned char, 8> head{};
        std::fseek(file, static_cast<long>(start), SEEK_SET);
        if (std::fread(head.data(), 1, head.size(), file) != head.size()) return;
        const std::uint64_t length = std::uint64_t{head[0]} << 24 | head[1] << 16 | head[2] << 8 | head[3];
        const std::string_view name(reinterpret_cast<const char*>(head.data()) + 4, 4);
        if (length > bytes - start && name != "IDAT")
            fail_file(path, "claims a chunk of ", length, " bytes and has ", bytes, "; the file is damaged");
        start += around + length;
    }
}

/// Reads up to and including a zero byte; the length before it, or -1 where the file or `limit` ends first.
int skip_text(std::FILE* file, int limit) {
    for (int length = 0; length <= limit; ++length) {
        const int byte = std::fgetc(file);
        if (byte == EOF) return -1;
        if (byte == 0) return length;
    }
    return -1;
}

/// Refuses an EXR file with an attribute that is longer than the file: OpenEXR makes room for it before it reads.
void check_exr_attributes(std::FILE* file, std::uint64_t bytes, const std::string& path) {
    constexpr int longest_name = 255;
    constexpr int several_parts = 0x10;  // in the second byte of the version
    std::fseek(file, 5, SEEK_SET);
    const int flags = std::fgetc(file);
    const bool has_parts = flags != EOF && (flags & several_parts) != 0;
    std::fseek(file, 8, SEEK_SET);
    // Name, type, length, content; an empty name ends a header, and in files of several parts two of them end the last.
    for (bool was_empty = !has_parts;;) {
        const int name = skip_text(file, longest_name);
        if (name < 0 || (name == 0 && was_empty)) return;
        was_empty = name == 0 || !has_parts;
        if (name == 0) continue;
        std::array<unsigned char, 4> size{};
        if (skip_text(file, longest_name) < 0 || std::fread(size.data(), 1, size.size(), file) != size.size()) return;
        const std::uint64_t length = size[0] | size[1] << 8 | size[2] << 16 | std::uint64_t{size[3]} << 24;
        if (length > bytes)
            fail_file(path, "claims an attribute of ", length, " bytes and has ", bytes, "; the file is damaged");
        std::fseek(file, static_cast<long>(length), SEEK_CUR);
    }
}

/// Deflate spends at least one bit on a length and one on a distance of at most 258 bytes.
constexpr std::uint64_t deflate_expansion = 1032;
/// A code of at most 12 bits stands for a string that is one longer than another code's: at most 4096 bytes.
constexpr std::uint64_t lzw_expansion = 4096 * 8 / 9;
/// Runs of up to 128 bytes in two.
constexpr std::uint64_t run_expansion = 64;

std::uint64_t expansion_of(std::string_view compression) {
    constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> bounds{{{"none", 1},
                                                                                {"packbits", run_expansion},
                                                                                {"rle", run_expansion},
                                                                                {"lzw", lzw_expansion},
                                                                                {"zip", deflate_expansion},
                                                                                {"zips", deflate_expansion},
                                                                                {"pxr24", deflate_expansion}}};
    for (const auto& [name, bound] : bounds)
        if (name == compression) return bound;
    return 0;
}

}  // namespace

Probe probe(const std::string& path) {
    const File file = open_regular(path);
    std::array<unsigned char, 32> head{};
    const std::size_t size = std::fread(head.data(), 1, head.size(), file.get());
    if (size == 0) fail_file(path, "is empty; name an image file");

    Probe found;
    found.format = format_of(std::span(head).first(size), path);
    if (found.format.empty())
        fail_file(path, "is no image that can be read; PNG, JPEG, TIFF, EXR, HDR, PNM, PFM, WebP, BMP and TGA can");
    found.bytes = length_of(file);

    constexpr std::size_t png_interlace = 28;  // signature, chunk head, sizes, depth, colour type, two methods
    found.is_interlaced = found.format == "png" && size > png_interlace && head[png_interlace] != 0;
    if (found.format == "jpeg") found.memory_to_open = jpeg_memory(file.get());
    if (found.format == "png") check_png_chunks(file.get(), found.bytes, path);
    if (found.format == "openexr") check_exr_attributes(file.get(), found.bytes, path);
    if (found.format == "pnm") found.memory_to_open = found.bytes;
    return found;
}

std::uint64_t largest_expansion(const std::string& format, const std::string& compression, std::uint64_t row_bytes) {
    if (format == "png") return deflate_expansion * 8 * 4;           // one bit of a palette becomes four bytes
    if (format == "pnm") return 8;                                   // eight pixels in a byte
    if (format == "targa") return run_expansion * 4;                 // one byte of a palette becomes four
    if (format == "hdr") return row_bytes / 4 + 1;                   // a row takes four bytes, however wide it is
    if (format == "tiff") return expansion_of(compression) * 8 * 3;  // one bit of a palette becomes three bytes
    if (format == "openexr") return expansion_of(compression) * 4;   // half becomes float; pxr24 drops a byte of four
    return 0;
}

}  // namespace bandlimit
