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

void decode_row(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row) {
    check_row(row.size(), image, "decode_row");
    decode_row_simd(image, y, stored, premultiplied, row);
}

bool encode_row(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored) {
    check_row(row.size(), const_view(image), "encode_row");
    return encode_row_simd(row, premultiplied, image, y, stored);
}

void composite_row(std::span<const float> row, bool premultiplied, int channels, int alpha,
                   std::span<const float> background, std::span<float> out) {
    composite_row_simd(row, premultiplied, channels, alpha, background, out);
}

}  // namespace bandlimit
