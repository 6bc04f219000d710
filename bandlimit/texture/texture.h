// A texture in memory: levels, layers and faces, as graphics interfaces know them.
// Stability: stable.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bandlimit/color/depth.h"
#include "bandlimit/color/encoding.h"

namespace bandlimit {

/// What the texels of a texture are.
struct TexelFormat {
    int channels = 4;  ///< 1, 2 or 4: red, red and green, red to alpha
    Depth depth = Depth::u8;
    bool srgb = false;           ///< codes of red, green and blue are sRGB; only with depth u8
    bool premultiplied = false;  ///< colour is stored multiplied by alpha; only with 4 channels

    friend bool operator==(const TexelFormat&, const TexelFormat&) = default;
};

/// How the texels of `format` are decoded: its fourth channel is coverage, unless `is_data`.
Encoding encoding_of(const TexelFormat& format, bool is_data);

/// The length of an axis of `length` texels at `level` of its mip chain: max(1, floor(length / 2^level)).
int mip_length(int length, int level);
/// The number of levels down to 1 x 1.
int mip_count(int width, int height);

/// Layers that a texture may have: more than graphics interfaces take.
inline constexpr int most_layers = 16384;

/// What images a texture has.
struct TextureShape {
    TexelFormat format;
    int width = 1, height = 1;  ///< of level 0
    int levels = 1, layers = 1;
    bool is_cube = false, is_array = false;

    int faces() const { return is_cube ? 6 : 1; }
    /// Bytes of one image of a level.
    std::uint64_t image_bytes(int level) const;
};

/// All images of a texture. They own their samples, interleaved.
struct Texture {
    TexelFormat format;
    bool is_cube = false;   ///< six faces per layer: +x -x +y -y +z -z
    bool is_array = false;  ///< an array, if only of one layer
    int layers = 1;
    /// [level][layer * faces() + face]; level l is mip_length(width, l) x mip_length(height, l)
    std::vector<std::vector<AnyImage>> levels = {};

    int faces() const { return is_cube ? 6 : 1; }
    int width() const;   ///< of level 0
    int height() const;  ///< of level 0
    const AnyImage& image(int level, int layer = 0, int face = 0) const;
    TextureShape shape() const;
};

/// Throws Error unless the images of `texture` have the format, number and sizes that it says, and are interleaved.
void check_texture(const Texture& texture);

}  // namespace bandlimit
