#include "bandlimit/texture/container_layout.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "bandlimit/core/file_error.h"

namespace bandlimit {
namespace {

static_assert(std::endian::native == std::endian::little,
              "samples are copied as they lie, and files have the low byte first");

constexpr std::string_view channel_letters = "RGBA";

/// What alpha is where a file has none.
void set_opaque(std::uint8_t& alpha) { alpha = 0xff; }
void set_opaque(std::uint16_t& alpha) { alpha = 0xffff; }
void set_opaque(Half& alpha) { alpha = to_half(1.0f); }
void set_opaque(float& alpha) { alpha = 1.0f; }

/// Copies texels whose channels lie in `order` to texels that have red first.
template <class T>
void reorder(const std::byte* from, std::string_view order, std::span<T> to, std::size_t channels) {
    const std::size_t texel_bytes = order.size() * sizeof(T);
    for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t stored = order.find(channel_letters[c]);
        if (stored == order.npos) {
            for (std::size_t i = c; i < to.size(); i += channels) set_opaque(to[i]);
            continue;
        }
        const std::byte* sample = from + stored * sizeof(T);
        for (std::size_t i = c; i < to.size(); i += channels, sample += texel_bytes)
            std::memcpy(&to[i], sample, sizeof(T));
    }
}

template <class T>
void read_rows(const std::byte* from, const ContainerLayout& layout, Image<T>& image) {
    const View<T> view = image.view();
    const std::string_view order = layout.stored.order;
    const auto width = static_cast<std::size_t>(view.width), channels = static_cast<std::size_t>(view.channels);
    const std::size_t row_bytes = width * order.size() * sizeof(T);
    const bool is_in_order = order == channel_letters.substr(0, channels);
    for (int y = 0; y < view.height; ++y, from += row_bytes) {
        T* const row = &view(0, layout.is_bottom_first ? view.height - 1 - y : y);
        if (is_in_order) std::memcpy(row, from, row_bytes);
        else reorder(from, order, std::span(row, width * channels), channels);
    }
}

template <class Predicate>
const NumberedFormat* find_if(std::span<const NumberedFormat> formats, Predicate is_it) {
    const auto found = std::find_if(formats.begin(), formats.end(), is_it);
    return found == formats.end() ? nullptr : &*found;
}

}  // namespace

StoredTexels stored_texels(std::string_view order, Depth depth, bool srgb) {
    const auto has = [&](char channel) { return order.find(channel) != order.npos; };
    const int channels = has('B') ? 4 : has('G') ? 2 : 1;
    return {{.channels = channels, .depth = depth, .srgb = srgb}, std::string(order)};
}

const NumberedFormat* find_format(std::span<const NumberedFormat> formats, std::uint32_t number) {
    return find_if(formats, [&](const NumberedFormat& f) { return f.number == number; });
}

const NumberedFormat* find_format(std::span<const NumberedFormat> formats, const StoredTexels& stored) {
    return find_if(formats, [&](const NumberedFormat& f) {
        return f.order == stored.order && f.depth == stored.format.depth && f.srgb == stored.format.srgb;
    });
}

const NumberedFormat* find_format(std::span<const NumberedFormat> formats, const TexelFormat& format) {
    const std::string_view order = channel_letters.substr(0, static_cast<std::size_t>(format.channels));
    return find_format(formats, stored_texels(order, format.depth, format.srgb));
}

std::uint64_t ContainerLayout::images() const {
    return static_cast<std::uint64_t>(info.layers) * (info.is_cube ? 6 : 1);
}

std::uint64_t ContainerLayout::image_bytes(int level) const {
    return static_cast<std::uint64_t>(mip_length(info.width, level)) *
           static_cast<std::uint64_t>(mip_length(info.height, level)) * stored.bytes();
}

std::uint32_t FileBytes::u32(std::uint64_t offset) const {
    std::uint32_t value = 0;
    std::memcpy(&value, text(offset, sizeof value).data(), sizeof value);
    return value;
}

std::uint64_t FileBytes::u64(std::uint64_t offset) const {
    return u32(offset) | static_cast<std::uint64_t>(u32(offset + 4)) << 32;
}

std::string_view FileBytes::text(std::uint64_t offset, std::uint64_t bytes) const {
    require(offset, bytes, "a part of its header");
    if (offset + bytes > std::min<std::uint64_t>(start.size(), most_header_bytes))
        fail_file(name, "has a part of its header at byte ", offset, ", and only the first ", most_header_bytes,
                  " are looked at; leave out what the texture does not need");
    const auto part = start.subspan(offset, bytes);
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

void FileBytes::require(std::uint64_t offset, std::uint64_t bytes, std::string_view what) const {
    if (offset > length || bytes > length - offset)
        fail_file(name, "ends at byte ", length, ", and ", what, " at byte ", offset, " is ", bytes,
                  " bytes long; the file is damaged or was cut short");
}

int checked_count(const FileBytes& file, std::uint32_t value, std::string_view what, int most) {
    if (value < 1 || value > static_cast<std::uint32_t>(most))
        fail_file(file.name, "has ", value, " ", what, ", which must be 1 to ", most, "; the file is damaged");
    return static_cast<int>(value);
}

void check_claims(const FileBytes& file, const ContainerLayout& layout) {
    const ContainerInfo& info = layout.info;
    if (info.is_cube && info.width != info.height)
        fail_file(file.name, "has cube faces of ", info.width, " x ", info.height,
                  ", which must be squares; the file is damaged");
    if (info.levels > mip_count(info.width, info.height))
        fail_file(file.name, "has ", info.levels, " levels, and ", info.width, " x ", info.height, " has at most ",
                  mip_count(info.width, info.height), "; the file is damaged");
    const std::uint64_t most_texels = file.length / (layout.images() * layout.stored.bytes());
    if (static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height) > most_texels)
        fail_file(file.name, "claims ", layout.images(), " images of ", info.width, " x ", info.height, " texels of ",
                  layout.stored.bytes(), " bytes, and is ", file.length,
                  " bytes long; the file is damaged or was cut short");
}

Texture read_images(std::span<const std::byte> file, const ContainerLayout& layout) {
    const ContainerInfo& info = layout.info;
    Texture texture{.format = info.texels, .is_cube = info.is_cube, .is_array = info.is_array, .layers = info.layers};
    for (int level = 0; level < info.levels; ++level) {
        const LevelPlace& place = layout.levels[static_cast<std::size_t>(level)];
        std::vector<AnyImage>& images = texture.levels.emplace_back();
        images.reserve(layout.images());
        for (std::uint64_t i = 0; i < layout.images(); ++i) {
            images.push_back(make_image(info.texels.depth, mip_length(info.width, level),
                                        mip_length(info.height, level), info.texels.channels));
            const std::byte* const from = file.data() + place.start + i * place.stride;
            std::visit([&](auto& image) { read_rows(from, layout, image); }, images.back());
        }
    }
    return texture;
}

void HeaderBytes::u32(std::uint64_t value) {
    if (value > std::numeric_limits<std::uint32_t>::max())
        fail("write_container: a length of ", value, " bytes does not fit into 32 bits; pass a smaller texture");
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

void HeaderBytes::u64(std::uint64_t value) {
    u32(value & 0xffffffff);
    u32(value >> 32);
}

void HeaderBytes::text(std::string_view text) {
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
}

}  // namespace bandlimit
