#include <cmath>
#include <type_traits>

#include "bandlimit/color/encoding_rows.h"
#include "bandlimit/color/srgb_codes.h"

namespace bandlimit {
namespace {

float load(std::uint8_t v) { return from_code(v); }
float load(std::uint16_t v) { return from_code(v); }
float load(Half v) { return to_float(v); }
float load(float v) { return v; }

template <class T>
float load_srgb(T v) {
    if constexpr (std::is_integral_v<T>) return srgb_light<T>()[v];
    else return static_cast<float>(srgb_to_linear(static_cast<double>(load(v))));
}

void store(std::uint8_t& to, float v) { to = to_code<std::uint8_t>(static_cast<double>(v)); }
void store(std::uint16_t& to, float v) { to = to_code<std::uint16_t>(static_cast<double>(v)); }
void store(Half& to, float v) { to = to_half(v); }
void store(float& to, float v) { to = v; }

template <class T>
void store_srgb(T& to, float v) {
    if constexpr (std::is_integral_v<T>) to = srgb_code<T>(v);
    else store(to, static_cast<float>(linear_to_srgb(static_cast<double>(v))));
}

float by_alpha(ByAlpha step, float colour, float alpha) {
    switch (step) {
        case ByAlpha::none: break;
        case ByAlpha::multiply: return alpha == 0 ? 0 : colour * alpha;
        case ByAlpha::divide: return alpha > 0 ? colour / alpha : 0;
    }
    return colour;
}

template <class T>
void decode(View<const T> image, int y, const Encoding& stored, ByAlpha step, float* pixel) {
    for (int x = 0; x < image.width; ++x, pixel += image.channels) {
        for (int c = 0; c < image.channels; ++c) {
            const bool curved = stored.transfer == Transfer::srgb && c != stored.alpha;
            pixel[c] = curved ? load_srgb(image(x, y, c)) : load(image(x, y, c));
        }
        for (int c = 0; c < image.channels && step != ByAlpha::none; ++c)
            if (c != stored.alpha) pixel[c] = by_alpha(step, pixel[c], pixel[stored.alpha]);
    }
}

template <class T>
bool encode(const float* pixel, ByAlpha step, View<T> image, int y, const Encoding& stored) {
    bool lost = false;
    for (int x = 0; x < image.width; ++x, pixel += image.channels)
        for (int c = 0; c < image.channels; ++c) {
            const bool colour = c != stored.alpha;
            const float v = colour && step != ByAlpha::none ? by_alpha(step, pixel[c], pixel[stored.alpha]) : pixel[c];
            if (colour && stored.transfer == Transfer::srgb) store_srgb(image(x, y, c), v);
            else store(image(x, y, c), v);
            if (std::is_integral_v<T> && !std::isfinite(v)) lost = true;
        }
    return lost;
}

}  // namespace

void decode_row_scalar(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied,
                       std::span<float> row) {
    std::visit([&](auto view) { decode(view, y, stored, decoding_step(stored, premultiplied), row.data()); }, image);
}

bool encode_row_scalar(std::span<const float> row, bool premultiplied, const AnyView& image, int y,
                       const Encoding& stored) {
    const ByAlpha step = encoding_step(stored, premultiplied);
    return std::visit([&](auto view) { return encode(row.data(), step, view, y, stored); }, image);
}

void composite_row_scalar(std::span<const float> row, bool premultiplied, int channels, int alpha,
                          std::span<const float> background, std::span<float> out) {
    const auto from = static_cast<std::size_t>(channels), to = from - 1, a = static_cast<std::size_t>(alpha);
    const ByAlpha step = premultiplied ? ByAlpha::none : ByAlpha::multiply;
    for (std::size_t x = 0; x * from < row.size(); ++x) {
        const float* pixel = row.data() + x * from;
        for (std::size_t c = 0; c < to; ++c)
            out[x * to + c] = by_alpha(step, pixel[c < a ? c : c + 1], pixel[a]) + (1 - pixel[a]) * background[c];
    }
}

}  // namespace bandlimit
