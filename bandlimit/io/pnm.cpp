#include "bandlimit/io/pnm.h"

#include <bit>
#include <string>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// PGM and PPM keep the high byte first.
void append(std::vector<unsigned char>& bytes, std::uint8_t v) { bytes.push_back(v); }
void append(std::vector<unsigned char>& bytes, std::uint16_t v) {
    bytes.push_back(static_cast<unsigned char>(v >> 8));
    bytes.push_back(static_cast<unsigned char>(v & 0xff));
}
/// PFM says itself which byte comes first; we write the low one.
void append(std::vector<unsigned char>& bytes, float v) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(bits >> shift & 0xff));
}
void append(std::vector<unsigned char>&, Half) { fail("write_pnm_rows: depth f16; pass u8, u16 or f32"); }

}  // namespace

PnmLayout write_pnm_header(AtomicFile& file, int width, int height, int channels, Depth depth) {
    const bool is_float = depth == Depth::f32;
    const std::string header =
        message(is_float ? (channels == 1 ? "Pf" : "PF") : (channels == 1 ? "P5" : "P6"), '\n', width, ' ', height, '\n',
                is_float ? "-1.0" : depth == Depth::u8 ? "255" : "65535", '\n');
    file.write(header.data(), header.size());
    return {width, height, channels, depth, static_cast<std::int64_t>(header.size())};
}

void write_pnm_rows(AtomicFile& file, const PnmLayout& layout, int y, const AnyConstView& view) {
    const auto row_bytes = static_cast<std::int64_t>(layout.width) * layout.channels *
                           static_cast<std::int64_t>(size_of(layout.depth));
    std::vector<unsigned char> bytes;
    std::visit(
        [&](const auto& rows) {
            for (int i = 0; i < rows.height; ++i) {
                bytes.clear();
                for (int x = 0; x < rows.width; ++x)
                    for (int c = 0; c < rows.channels; ++c) append(bytes, rows(x, i, c));
                const int row = layout.depth == Depth::f32 ? layout.height - 1 - (y + i) : y + i;
                if (layout.depth == Depth::f32) file.seek(layout.start + row * row_bytes);
                file.write(bytes.data(), bytes.size());
            }
        },
        view);
}

}  // namespace bandlimit
