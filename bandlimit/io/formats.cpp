// Which file holds what.
#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/io/codecs.h"
#include "bandlimit/io/probe.h"

namespace bandlimit {
namespace {

/// A format that we write, and its extensions.
struct Format {
    std::initializer_list<std::string_view> extensions;
    FormatAbilities abilities;
};

const std::array<Format, 12>& formats() {
    using enum Depth;
    // 65500 is the limit of libjpeg, 16383 of WebP, 65535 of the 16-bit sizes of TGA, 1000000 what libpng accepts.
    // OpenImageIO 2.4 multiplies alpha into the codes of WebP, whatever it is asked: without alpha it cannot.
    static const std::array<Format, 12> table{{
        {{"png"},
         {.name = "png",
          .depths = {u16, u8},
          .alpha = true,
          .notes_space = true,
          .channels = {1, 2, 3, 4},
          .largest_side = 1000000}},
        {{"jpg", "jpeg", "jpe"},
         {.name = "jpeg", .depths = {u8}, .channels = {1, 3}, .largest_channels = 3, .largest_side = 65500}},
        {{"tif", "tiff"},
         {.name = "tiff", .depths = {f32, u16, u8}, .alpha = true, .tiles = true, .largest_channels = 1024}},
        {{"exr"},
         {.name = "openexr",
          .depths = {f32, f16},
          .alpha = true,
          .associated = true,
          .is_linear = true,
          .tiles = true,
          .largest_channels = 1024}},
        {{"hdr", "rgbe"}, {.name = "hdr", .depths = {f32}, .is_linear = true, .channels = {3}, .largest_channels = 3}},
        {{"ppm"}, {.name = "pnm", .depths = {u16, u8}, .channels = {3}, .largest_channels = 3}},
        {{"pgm"}, {.name = "pnm", .depths = {u16, u8}, .channels = {1}, .largest_channels = 1}},
        {{"pnm"}, {.name = "pnm", .depths = {u16, u8}, .channels = {1, 3}, .largest_channels = 3}},
        {{"pfm"}, {.name = "pnm", .depths = {f32}, .is_linear = true, .channels = {1, 3}, .largest_channels = 3}},
        {{"webp"}, {.name = "webp", .depths = {u8}, .channels = {3}, .largest_channels = 3, .largest_side = 16383}},
        {{"tga"}, {.name = "targa", .depths = {u8}, .alpha = true, .channels = {1, 3, 4}, .largest_side = 65535}},
        {{"bmp"}, {.name = "bmp", .depths = {u8}, .channels = {1, 3}, .largest_channels = 3}},
    }};
    return table;
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    return lower_case(std::move(extension));
}

std::string known_extensions() {
    std::string text;
    for (const Format& format : formats()) text += message(text.empty() ? "" : ", ", *format.extensions.begin());
    return text;
}

/// The first bytes of a format.
struct Signature {
    std::string_view format, bytes;
};
using namespace std::string_view_literals;
constexpr std::array signatures{
    Signature{"png", "\x89PNG\r\n\x1a\n"sv},
    Signature{"jpeg", "\xff\xd8\xff"sv},
    Signature{"tiff", "II\x2a\0"sv},
    Signature{"tiff", "MM\0\x2a"sv},
    Signature{"tiff", "II\x2b\0"sv},
    Signature{"tiff", "MM\0\x2b"sv},
    Signature{"openexr", "v/1\x01"sv},
    Signature{"hdr", "#?"sv},
    Signature{"bmp", "BM"sv},
};

}  // namespace

FormatAbilities abilities_of(const std::string& path) {
    const std::string extension = extension_of(path);
    for (const Format& format : formats())
        for (const std::string_view known : format.extensions)
            if (known == extension) return format.abilities;
    fail(path, ": extension \"", extension, "\" names no format that is written; use one of: ", known_extensions());
}

Depth nearest_depth(const FormatAbilities& format, Depth wanted) {
    // What holds every value of `wanted`, smallest first, then what comes closest.
    using enum Depth;
    constexpr std::array<std::array<Depth, 4>, 4> preferences{{
        {u8, u16, f16, f32},  // f16 holds every u8 code to better than half a code
        {u16, f32, f16, u8},
        {f16, f32, u16, u8},
        {f32, f16, u16, u8},
    }};
    for (const Depth depth : preferences[static_cast<std::size_t>(wanted)])
        if (std::find(format.depths.begin(), format.depths.end(), depth) != format.depths.end()) return depth;
    return format.depths.front();
}

void check_tile(const FormatAbilities& format, int tile) {
    constexpr int multiple = 16, largest = 4096;  // TIFF asks for the first; the second bounds a row of tiles
    if (tile == 0) return;
    if (!format.tiles) fail("tiles of ", tile, ": ", format.name, " files store rows; choose TIFF or EXR");
    if (tile < multiple || tile > largest || tile % multiple != 0)
        fail("tiles of ", tile, " pixels do not exist; pass a multiple of ", multiple, " from ", multiple, " to ",
             largest, ", e.g. 256, or 0 for none");
}

std::string format_of(std::span<const unsigned char> head, const std::string& path) {
    const std::string_view start(reinterpret_cast<const char*>(head.data()), head.size());
    for (const Signature& signature : signatures)
        if (start.starts_with(signature.bytes)) return std::string(signature.format);
    if (start.size() >= 3 && start[0] == 'P' && "123456Ff"sv.find(start[1]) != start.npos &&
        (start[2] == '#' || " \t\r\n"sv.find(start[2]) != start.npos))
        return "pnm";
    if (start.size() >= 12 && start.starts_with("RIFF") && start.substr(8, 4) == "WEBP") return "webp";
    return extension_of(path) == "tga" ? "targa" : "";
}

}  // namespace bandlimit
