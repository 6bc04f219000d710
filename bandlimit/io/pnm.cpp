#include "bandlimit/io/pnm.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <fstream>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "bandlimit/core/file_error.h"

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

/// The next number of a header, behind blanks and comments; -1 if there is none.
int read_number(std::istream& in) {
    constexpr auto all = std::numeric_limits<std::streamsize>::max();
    while ((in >> std::ws).peek() == '#') in.ignore(all, '\n');
    int value = -1;
    if (std::isdigit(in.peek()) == 0 || !(in >> value)) return -1;
    return value;
}

/// Reads the rows of `view`, the first of which is row `y` of the picture; false if the file is too short.
bool read_rows(const std::string& path, const PnmLayout& layout, int y, const View<std::uint16_t>& view) {
    const std::size_t row_bytes =
        static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.channels) * 2;
    std::vector<unsigned char> bytes(row_bytes);
    std::ifstream in(path, std::ios::binary);
    in.seekg(layout.start + static_cast<std::int64_t>(row_bytes) * y);
    const unsigned white = static_cast<unsigned>(layout.largest_code);
    for (int i = 0; i < view.height; ++i) {
        if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(row_bytes))) return false;
        const unsigned char* from = bytes.data();
        for (int x = 0; x < view.width; ++x)
            for (int c = 0; c < view.channels; ++c, from += 2) {
                const unsigned code = std::min(white, from[0] * 256u + from[1]);
                view(x, i, c) = static_cast<std::uint16_t>((code * 65535u + white / 2) / white);
            }
    }
    return true;
}

}  // namespace

std::optional<PnmLayout> find_pnm_of_16_bits(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    char magic = 0, kind = 0;
    if (!in.get(magic).get(kind) || magic != 'P' || (kind != '5' && kind != '6')) return {};
    PnmLayout layout;
    layout.channels = kind == '5' ? 1 : 3;
    layout.depth = Depth::u16;
    layout.width = read_number(in);
    layout.height = read_number(in);
    layout.largest_code = read_number(in);
    if (layout.width < 1 || layout.height < 1 || layout.largest_code < 256 || layout.largest_code > 65535) return {};
    in.get();  // one blank
    layout.start = in ? static_cast<std::int64_t>(in.tellg()) : 0;
    return layout;
}

Decoder decode_pnm(const std::string& path, const PnmLayout& layout) {
    StoredPicture picture;
    picture.info.format = "pnm";
    picture.info.width = layout.width, picture.info.height = layout.height;
    picture.info.depth = layout.depth;
    picture.info.transfer = Transfer::srgb;
    picture.info.color_hint = "Rec709";  // so netpbm; what programs write is sRGB
    if (layout.channels == 1) picture.info.channel_names = {"Y"};
    else picture.info.channel_names = {"R", "G", "B"};
    return {.picture = picture,
            .read =
                [path, layout](int y, const AnyView& rows) {
                    const auto& view = std::get<View<std::uint16_t>>(rows);
                    if (!read_rows(path, layout, y, view))
                        fail_file(path, "rows ", y, " to ", y + view.height - 1, " are missing; the file is cut short");
                },
            .count_parts = [] { return Parts{}; }};
}

PnmLayout write_pnm_header(AtomicFile& file, int width, int height, int channels, Depth depth) {
    const bool is_float = depth == Depth::f32;
    const std::string header = message(is_float ? (channels == 1 ? "Pf" : "PF") : (channels == 1 ? "P5" : "P6"), '\n',
                                       width, ' ', height, '\n',
                                       is_float             ? "-1.0"
                                       : depth == Depth::u8 ? "255"
                                                            : "65535",
                                       '\n');
    file.write(header.data(), header.size());
    return {width, height, channels, depth, static_cast<std::int64_t>(header.size()), 65535};
}

void write_pnm_rows(AtomicFile& file, const PnmLayout& layout, int y, const AnyConstView& view) {
    const auto row_bytes =
        static_cast<std::int64_t>(layout.width) * layout.channels * static_cast<std::int64_t>(size_of(layout.depth));
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
