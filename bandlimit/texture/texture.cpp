#include "bandlimit/texture/texture.h"

#include <algorithm>
#include <bit>

namespace bandlimit {
namespace {

template <class... Parts>
void require(bool holds, const Parts&... parts) {
    if (!holds) fail("check_texture: ", parts...);
}

void check_image(const AnyImage& image, const TexelFormat& format, int width, int height) {
    std::visit(
        [&](const auto& i) {
            const auto v = i.view();
            require(depth_of(v) == format.depth && v.channels == format.channels,
                    "an image has another depth or number of channels than the texture; make all alike");
            require(v.width == width && v.height == height, "an image of ", v.width, " x ", v.height, " where ", width,
                    " x ", height, " is due; see mip_length()");
            require(v.dc == 1 && v.dx == v.channels, "channels are not interleaved; pass Layout::interleaved");
        },
        image);
}

}  // namespace

Encoding encoding_of(const TexelFormat& format, bool is_data) {
    Encoding encoding;
    encoding.transfer = format.srgb ? Transfer::srgb : Transfer::linear;
    encoding.alpha = format.channels == 4 && !is_data ? 3 : -1;
    encoding.associated = format.premultiplied;
    return encoding;
}

int mip_length(int length, int level) { return level < 31 ? std::max(1, length >> level) : 1; }

int mip_count(int width, int height) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(width, height))));
}

int Texture::width() const {
    return std::visit([](const auto& i) { return i.width(); }, image(0));
}
int Texture::height() const {
    return std::visit([](const auto& i) { return i.height(); }, image(0));
}
const AnyImage& Texture::image(int level, int layer, int face) const {
    return levels.at(static_cast<std::size_t>(level)).at(static_cast<std::size_t>(layer * faces() + face));
}

std::uint64_t TextureShape::image_bytes(int level) const {
    return static_cast<std::uint64_t>(mip_length(width, level)) *
           static_cast<std::uint64_t>(mip_length(height, level)) * static_cast<std::uint64_t>(format.channels) *
           size_of(format.depth);
}

TextureShape Texture::shape() const {
    return {format, width(), height(), static_cast<int>(levels.size()), layers, is_cube, is_array};
}

void check_texture(const Texture& texture) {
    const TexelFormat& f = texture.format;
    require(f.channels == 1 || f.channels == 2 || f.channels == 4, f.channels, " channels; need 1, 2 or 4");
    require(!f.srgb || f.depth == Depth::u8, "sRGB codes of ", name_of(f.depth), "; only u8 has them");
    require(!f.premultiplied || f.channels == 4, "premultiplied colour without alpha; need 4 channels");
    require(texture.layers >= 1 && texture.layers <= (texture.is_array ? most_layers : 1), texture.layers,
            " layers; need 1, or an array of 1 to ", most_layers);
    require(!texture.levels.empty() && !texture.levels[0].empty(), "no image; need level 0");
    const int width = texture.width(), height = texture.height();
    require(width >= 1 && height >= 1, "size ", width, " x ", height, "; need at least 1 x 1");
    require(!texture.is_cube || width == height, "cube faces of ", width, " x ", height, "; need squares");
    const int count = static_cast<int>(texture.levels.size());
    require(count <= mip_count(width, height), count, " levels; ", width, " x ", height, " has at most ",
            mip_count(width, height));
    for (int level = 0; level < count; ++level) {
        const auto& images = texture.levels[static_cast<std::size_t>(level)];
        require(images.size() == static_cast<std::size_t>(texture.layers) * static_cast<std::size_t>(texture.faces()),
                "level ", level, " has ", images.size(), " images; need layers times faces");
        for (const AnyImage& image : images) check_image(image, f, mip_length(width, level), mip_length(height, level));
    }
}

}  // namespace bandlimit
