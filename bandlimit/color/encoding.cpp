#include "bandlimit/color/encoding.h"

#include "bandlimit/color/encoding_rows.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

void check_row(std::size_t samples, const AnyConstView& image, const char* function) {
    std::visit(
        [&](const auto& view) {
            if (samples != static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.channels))
                fail(function, ": the row holds ", samples, " samples; ", view.width, " pixels of ", view.channels,
                     " channels are needed");
        },
        image);
}

}  // namespace

void check_encoding(const char* function, const Encoding& encoding, int channels) {
    if (encoding.alpha < -1 || encoding.alpha >= channels)
        fail(function, ": alpha = ", encoding.alpha, " of ", channels, " channels; pass one of 0 to ", channels - 1,
             ", or -1 for none");
}

void decode_row(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row) {
    check_row(row.size(), image, "decode_row");
    check_encoding("decode_row", stored, shape_of(image).channels);
    decode_row_simd(image, y, stored, premultiplied, row);
}

bool encode_row(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored) {
    check_row(row.size(), const_view(image), "encode_row");
    check_encoding("encode_row", stored, shape_of(image).channels);
    return encode_row_simd(row, premultiplied, image, y, stored);
}

void composite_row(std::span<const float> row, bool premultiplied, int channels, int alpha,
                   std::span<const float> background, std::span<float> out) {
    if (alpha < 0 || alpha >= channels)
        fail("composite_row: alpha = ", alpha, "; pass one of the ", channels, " channels");
    composite_row_simd(row, premultiplied, channels, alpha, background, out);
}

}  // namespace bandlimit
