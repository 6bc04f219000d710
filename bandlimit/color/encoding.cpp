#include "bandlimit/color/encoding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

template <class Code>
constexpr int largest_code = std::numeric_limits<Code>::max();

/// The linear light of every code.
template <class Code>
std::vector<float> srgb_decode_table() {
    std::vector<float> table;
    for (int code = 0; code <= largest_code<Code>; ++code)
        table.push_back(static_cast<float>(srgb_to_linear(static_cast<double>(code) / largest_code<Code>)));
    return table;
}

/// Finds the code nearest to the exact encoding of a float.
///
/// Encoding is monotonic, so a code is the number of thresholds that a value has reached; threshold k is the smallest
/// float whose exact encoding is at least k - 1/2 codes. The upper bits of the float narrow the search to a few codes.
template <class Code>
class SrgbEncoder {
public:
    SrgbEncoder() {
        for (int code = 1; code <= largest_code<Code>; ++code) thresholds_.push_back(threshold(code));
        first_bucket_ = bucket(thresholds_.front());
        for (std::uint32_t b = first_bucket_; b <= bucket(1.0f) + 1; ++b) {
            const float start = std::bit_cast<float>(b << bucket_shift);
            bucket_start_.push_back(static_cast<std::uint32_t>(reached(thresholds_.begin(), thresholds_.end(), start)));
        }
    }

    Code operator()(float x) const {
        if (!(x >= thresholds_.front())) return 0;  // NaN too
        if (x >= 1) return std::isfinite(x) ? largest_code<Code> : Code{0};
        const std::size_t b = bucket(x) - first_bucket_;
        const auto begin = thresholds_.begin();
        return static_cast<Code>(reached(begin + bucket_start_[b], begin + bucket_start_[b + 1], x));
    }

private:
    static constexpr int bucket_shift = 16;  // leaves sign, exponent and 7 bits of the mantissa
    static std::uint32_t bucket(float x) { return std::bit_cast<std::uint32_t>(x) >> bucket_shift; }

    static float threshold(int code) {
        const double boundary = (code - 0.5) / largest_code<Code>;
        const auto reaches = [&](float x) { return linear_to_srgb(static_cast<double>(x)) >= boundary; };
        float x = static_cast<float>(srgb_to_linear(boundary));
        while (!reaches(x)) x = std::nextafter(x, 2.0f);
        for (float below; reaches(below = std::nextafter(x, 0.0f));) x = below;
        return x;
    }

    using Iterator = std::vector<float>::const_iterator;
    std::ptrdiff_t reached(Iterator begin, Iterator end, float x) const {
        return std::upper_bound(begin, end, x) - thresholds_.begin();
    }

    std::vector<float> thresholds_;
    std::vector<std::uint32_t> bucket_start_;
    std::uint32_t first_bucket_ = 0;
};

template <class Code>
const std::vector<float>& srgb_decoded() {
    static const std::vector<float> table = srgb_decode_table<Code>();
    return table;
}

template <class Code>
const SrgbEncoder<Code>& srgb_encoder() {
    static const SrgbEncoder<Code> encoder;
    return encoder;
}

float load_linear(std::uint8_t v) { return from_code(v); }
float load_linear(std::uint16_t v) { return from_code(v); }
float load_linear(Half v) { return to_float(v); }
float load_linear(float v) { return v; }

/// How a sample of type T with a given transfer function is read: the table is looked up once, outside the loop.
template <class T>
struct SrgbLoader {
    float operator()(T v) const { return static_cast<float>(srgb_to_linear(static_cast<double>(load_linear(v)))); }
};
template <class T>
    requires std::is_integral_v<T>
struct SrgbLoader<T> {
    const float* table = srgb_decoded<T>().data();
    float operator()(T v) const { return table[v]; }
};

void store_linear(std::uint8_t& to, float v) { to = to_code<std::uint8_t>(static_cast<double>(v)); }
void store_linear(std::uint16_t& to, float v) { to = to_code<std::uint16_t>(static_cast<double>(v)); }
void store_linear(Half& to, float v) { to = to_half(v); }
void store_linear(float& to, float v) { to = v; }

template <class T>
struct SrgbStorer {
    void operator()(T& to, float v) const {
        store_linear(to, static_cast<float>(linear_to_srgb(static_cast<double>(v))));
    }
};
template <class T>
    requires std::is_integral_v<T>
struct SrgbStorer<T> {
    const SrgbEncoder<T>& encoder = srgb_encoder<T>();
    void operator()(T& to, float v) const { to = encoder(v); }
};

void check_row(std::size_t samples, int width, int channels, const char* function) {
    if (samples != static_cast<std::size_t>(width) * static_cast<std::size_t>(channels))
        fail(function, ": the row holds ", samples, " samples; ", width, " pixels of ", channels,
             " channels are needed");
}

/// Calls visit(stored sample, working sample) along row `y` of `image`: for the channels that `chosen` admits, or in
/// one go over everything where all are admitted and the samples lie side by side.
template <class T, class Working, class Chosen, class Visit>
void for_each_sample(View<T> image, int y, Working* row, Chosen chosen, Visit visit) {
    const std::ptrdiff_t width = image.width, channels = image.channels;
    bool all = image.dc == 1 && image.dx == channels;
    for (int c = 0; c < image.channels; ++c) all = all && chosen(c);
    if (all) {
        T* const stored = &image(0, y);
        for (std::ptrdiff_t i = 0; i < width * channels; ++i) visit(stored[i], row[i]);
        return;
    }
    for (int c = 0; c < image.channels; ++c) {
        if (!chosen(c)) continue;
        T* const stored = &image(0, y, c);
        for (std::ptrdiff_t x = 0; x < width; ++x) visit(stored[x * image.dx], row[x * channels + c]);
    }
}

/// Which channels are stored as they are, and which through the transfer function.
struct LinearChannels {
    const Encoding& stored;
    bool operator()(int c) const { return stored.transfer == Transfer::linear || c == stored.alpha; }
};
struct CurvedChannels {
    const Encoding& stored;
    bool operator()(int c) const { return !LinearChannels{stored}(c); }
};

template <class T>
void decode_typed(View<const T> image, int y, const Encoding& stored, std::span<float> row) {
    for_each_sample(image, y, row.data(), LinearChannels{stored}, [](T v, float& to) { to = load_linear(v); });
    if (stored.transfer == Transfer::linear) return;
    for_each_sample(image, y, row.data(), CurvedChannels{stored},
                    [load = SrgbLoader<T>{}](T v, float& to) { to = load(v); });
}

template <class T>
void encode_typed(std::span<const float> row, View<T> image, int y, const Encoding& stored) {
    for_each_sample(image, y, row.data(), LinearChannels{stored}, [](T& to, float v) { store_linear(to, v); });
    if (stored.transfer == Transfer::linear) return;
    for_each_sample(image, y, row.data(), CurvedChannels{stored},
                    [store = SrgbStorer<T>{}](T& to, float v) { store(to, v); });
}

/// Calls change(colour sample, alpha) for every colour sample of an interleaved row.
template <class Change>
void with_alpha(std::span<float> row, std::size_t channels, std::size_t alpha, Change change) {
    for (std::size_t pixel = 0; pixel < row.size(); pixel += channels)
        for (std::size_t c = 0; c < channels; ++c)
            if (c != alpha) row[pixel + c] = change(row[pixel + c], row[pixel + alpha]);
}

// Zero alpha takes the colour away, even one that is not finite.
float multiplied(float colour, float alpha) { return alpha == 0 ? 0 : colour * alpha; }
float divided(float colour, float alpha) { return alpha > 0 ? colour / alpha : 0; }

/// Writes a row whose alpha is as it is to be stored; returns whether a value that is not finite became a code.
template <class T>
bool encode_and_check(std::span<const float> row, View<T> image, int y, const Encoding& stored) {
    encode_typed(row, image, y, stored);
    return std::is_integral_v<T> && !std::all_of(row.begin(), row.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

void decode_row(const AnyConstView& image, int y, const Encoding& stored, bool premultiplied, std::span<float> row) {
    std::visit(
        [&](auto view) {
            check_row(row.size(), view.width, view.channels, "decode_row");
            decode_typed(view, y, stored, row);
            if (stored.alpha >= 0 && premultiplied && !stored.associated)
                with_alpha(row, static_cast<std::size_t>(view.channels), static_cast<std::size_t>(stored.alpha),
                           multiplied);
        },
        image);
}

bool encode_row(std::span<const float> row, bool premultiplied, const AnyView& image, int y, const Encoding& stored) {
    return std::visit(
        [&](auto view) {
            check_row(row.size(), view.width, view.channels, "encode_row");
            if (stored.alpha < 0 || premultiplied == stored.associated) return encode_and_check(row, view, y, stored);
            std::vector<float> changed(row.begin(), row.end());
            with_alpha(changed, static_cast<std::size_t>(view.channels), static_cast<std::size_t>(stored.alpha),
                       premultiplied ? divided : multiplied);
            return encode_and_check<std::remove_pointer_t<decltype(view.data)>>(changed, view, y, stored);
        },
        image);
}

void composite_row(std::span<const float> row, bool premultiplied, int channels, int alpha,
                   std::span<const float> background, std::span<float> out) {
    const auto from = static_cast<std::size_t>(channels), to = from - 1, a = static_cast<std::size_t>(alpha);
    for (std::size_t x = 0; x * from < row.size(); ++x) {
        const float* pixel = row.data() + x * from;
        for (std::size_t c = 0; c < to; ++c) {
            const float colour = pixel[c < a ? c : c + 1];
            out[x * to + c] = (premultiplied ? colour : multiplied(colour, pixel[a])) + (1 - pixel[a]) * background[c];
        }
    }
}

}  // namespace bandlimit
