// What the tests of this room share: textures of any kind, and files in memory.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "bandlimit/math/random.h"
#include "bandlimit/texture/container.h"
#include "bandlimit/texture/texture.h"

namespace bandlimit {

using FileContent = std::vector<std::byte>;

/// Any code; floats are multiples of 1/64, which halves hold too.
inline void set_random(std::uint8_t& to, Random& random) { to = static_cast<std::uint8_t>(random.integer(0, 0xff)); }
inline void set_random(std::uint16_t& to, Random& random) {
    to = static_cast<std::uint16_t>(random.integer(0, 0xffff));
}
inline void set_random(float& to, Random& random) { to = static_cast<float>(random.integer(-64, 64)) / 64; }
inline void set_random(Half& to, Random& random) { to = to_half(static_cast<float>(random.integer(-64, 64)) / 64); }

/// What a test varies of a texture.
struct Shape {
    int width = 1, height = 1, levels = 1;
    bool is_cube = false;
    int layers = 0;  ///< 0: no array
};

inline Texture noise_texture(const TexelFormat& format, const Shape& shape, std::uint64_t seed = 1) {
    Texture texture{.format = format, .is_cube = shape.is_cube, .is_array = shape.layers > 0};
    texture.layers = shape.layers > 0 ? shape.layers : 1;
    Random random(seed);
    for (int level = 0; level < shape.levels; ++level) {
        std::vector<AnyImage>& images = texture.levels.emplace_back();
        for (int i = 0; i < texture.layers * texture.faces(); ++i) {
            images.push_back(make_image(format.depth, mip_length(shape.width, level), mip_length(shape.height, level),
                                        format.channels));
            std::visit(
                [&](const auto& v) {
                    for (int y = 0; y < v.height; ++y)
                        for (int x = 0; x < v.width; ++x)
                            for (int c = 0; c < v.channels; ++c) set_random(v(x, y, c), random);
                },
                view_of(images.back()));
        }
    }
    return texture;
}

/// Whether both are the same texture, sample by sample.
[[nodiscard]] inline ::testing::AssertionResult same_texture(const Texture& a, const Texture& b) {
    if (!(a.format == b.format)) return ::testing::AssertionFailure() << "other formats";
    if (a.is_cube != b.is_cube || a.is_array != b.is_array || a.layers != b.layers ||
        a.levels.size() != b.levels.size())
        return ::testing::AssertionFailure() << "other layers, faces or levels";
    for (std::size_t level = 0; level < a.levels.size(); ++level) {
        if (a.levels[level].size() != b.levels[level].size())
            return ::testing::AssertionFailure() << "other numbers of images at level " << level;
        for (std::size_t i = 0; i < a.levels[level].size(); ++i) {
            const bool is_same = std::visit(
                [&](const auto& left) {
                    const auto* right = std::get_if<std::decay_t<decltype(left)>>(&b.levels[level][i]);
                    if (right == nullptr || !same_shape(left.view(), right->view())) return false;
                    const auto v = left.view();
                    const std::size_t samples = static_cast<std::size_t>(v.width) * static_cast<std::size_t>(v.height) *
                                                static_cast<std::size_t>(v.channels);
                    return std::equal(v.data, v.data + samples, right->view().data);
                },
                a.levels[level][i]);
            if (!is_same) return ::testing::AssertionFailure() << "other samples at level " << level << ", image " << i;
        }
    }
    return ::testing::AssertionSuccess();
}

inline FileContent written(const Texture& texture, Container container) {
    FileContent file;
    write_container(texture, container,
                    [&](std::span<const std::byte> part) { file.insert(file.end(), part.begin(), part.end()); });
    return file;
}

inline std::uint32_t word(const FileContent& file, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(file.at(offset + i));
    return value;
}
inline std::vector<std::uint32_t> words(const FileContent& file, std::size_t offset, std::size_t count) {
    std::vector<std::uint32_t> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(word(file, offset + 4 * i));
    return values;
}
inline FileContent patched(FileContent file, std::size_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) file.at(offset + i) = static_cast<std::byte>(value >> 8 * i & 0xff);
    return file;
}

/// All formats that a texture can have.
inline std::vector<TexelFormat> all_texel_formats() {
    std::vector<TexelFormat> formats;
    for (const Depth depth : all_depths())
        for (const int channels : {1, 2, 4})
            for (const bool srgb : {false, true})
                for (const bool premultiplied : {false, true})
                    if ((!srgb || depth == Depth::u8) && (!premultiplied || channels == 4))
                        formats.push_back({channels, depth, srgb, premultiplied});
    return formats;
}

inline std::ostream& operator<<(std::ostream& to, const TexelFormat& f) {
    return to << f.channels << " channels of " << name_of(f.depth) << (f.srgb ? " sRGB" : "")
              << (f.premultiplied ? " premultiplied" : "");
}

/// Whether reading fails with one line that names the file, says what to do, and holds `word`.
[[nodiscard]] inline ::testing::AssertionResult is_refused(const FileContent& file, const std::string& word) {
    try {
        read_container(file, "a file");
    } catch (const std::runtime_error& e) {
        const std::string what = e.what();
        const bool is_right = what.starts_with("a file: ") && what.find("; ") != what.npos &&
                              what.find('\n') == what.npos && what.find(word) != what.npos;
        return (is_right ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << what;
    }
    return ::testing::AssertionFailure() << "no error, where one with \"" << word << "\" is due";
}

}  // namespace bandlimit
