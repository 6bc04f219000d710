#include "bandlimit/job/animated_png.h"

#include <array>
#include <string_view>

#include "bandlimit/core/error.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/io/regular_file.h"
#include "bandlimit/job/command.h"

namespace bandlimit::job {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 31;

/// The polynomial of ISO 3309, bits reversed, as PNG asks for.
std::uint32_t crc_of(std::string_view bytes) {
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> entries{};
        for (std::uint32_t n = 0; n < 256; ++n) {
            std::uint32_t c = n;
            for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
            entries[n] = c;
        }
        return entries;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) crc = table[(crc ^ static_cast<unsigned char>(byte)) & 0xff] ^ (crc >> 8);
    return ~crc;
}

std::string big_endian(std::uint32_t value, int bytes) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>((value >> shift) & 0xff);
    return text;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

std::string chunk(std::string_view type, std::string_view data) {
    std::string typed(type);
    typed += data;
    return big_endian(static_cast<std::uint32_t>(data.size()), 4) + typed + big_endian(crc_of(typed), 4);
}

/// What of a PNG file an animation needs.
struct Parts {
    std::string before;             ///< chunks in front of the first data, as they are
    std::vector<std::string> data;  ///< of the chunks IDAT
};

Parts parts_of(const std::string& path) {
    const std::string file = read_text(path, most_bytes, "a PNG file");
    Parts parts;
    for (std::size_t at = signature.size(); file.size() - at >= 12;) {
        const std::size_t length = number_at(file, at);
        if (file.size() - at - 12 < length) fail_file(path, "was cut short; try again");
        const std::string_view type = std::string_view(file).substr(at + 4, 4);
        if (type == "IDAT") parts.data.push_back(file.substr(at + 8, length));
        else if (parts.data.empty()) parts.before += file.substr(at, length + 12);
        at += length + 12;
    }
    return parts;
}

void write_png(const std::string& path, const Image<std::uint8_t>& picture) {
    ImageTarget target;
    target.width = picture.width(), target.height = picture.height();
    target.channel_names = {"R", "G", "B"};
    ImageWriter writer(path, target, 1);
    writer.write_rows(picture.view());
    writer.finish();
}

/// How a frame is shown: all of the picture, in place of what was there.
std::string control(std::uint32_t number, const Image<std::uint8_t>& picture, int milliseconds) {
    return chunk("fcTL", big_endian(number, 4) + big_endian(static_cast<std::uint32_t>(picture.width()), 4) +
                             big_endian(static_cast<std::uint32_t>(picture.height()), 4) + big_endian(0, 4) +
                             big_endian(0, 4) + big_endian(static_cast<std::uint32_t>(milliseconds), 2) +
                             big_endian(1000, 2) + big_endian(0, 2));
}

}  // namespace

void write_animated_png(const std::string& path, std::span<const Image<std::uint8_t>> frames, int milliseconds) {
    if (frames.empty()) fail("write_animated_png: no frames; pass at least one");
    if (milliseconds < 1 || milliseconds > 65535)
        fail("write_animated_png: ", milliseconds, " milliseconds; pass 1 to 65535");
    for (const Image<std::uint8_t>& frame : frames)
        if (frame.channels() != 3 || !same_shape(frame.view(), frames[0].view()))
            fail("write_animated_png: frames of different shapes, or not of 3 channels; pass RGB of one size");
    const TemporaryFolder folder;
    AtomicFile file(path);
    const auto write = [&](std::string_view bytes) { file.write(bytes.data(), bytes.size()); };
    std::uint32_t number = 0;  // of the chunks fcTL and fdAT together
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string png = folder.path() + "/frame.png";
        write_png(png, frames[i]);
        const Parts parts = parts_of(png);
        if (i == 0) {
            write(signature);
            write(parts.before);
            write(chunk("acTL", big_endian(static_cast<std::uint32_t>(frames.size()), 4) + big_endian(0, 4)));
        }
        write(control(number++, frames[i], milliseconds));
        for (const std::string& data : parts.data)
            write(i == 0 ? chunk("IDAT", data) : chunk("fdAT", big_endian(number++, 4) + data));
    }
    write(chunk("IEND", ""));
    file.commit();
}

}  // namespace bandlimit::job
