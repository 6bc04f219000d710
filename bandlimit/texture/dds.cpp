#include "bandlimit/texture/dds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "bandlimit/core/file_error.h"
#include "bandlimit/texture/format_names.h"

namespace bandlimit {
namespace {

// By DXGI_FORMAT.
constexpr std::array formats{
    NumberedFormat{2, "RGBA", Depth::f32},       NumberedFormat{6, "RGB", Depth::f32},
    NumberedFormat{10, "RGBA", Depth::f16},      NumberedFormat{11, "RGBA", Depth::u16},
    NumberedFormat{16, "RG", Depth::f32},        NumberedFormat{28, "RGBA", Depth::u8},
    NumberedFormat{29, "RGBA", Depth::u8, true}, NumberedFormat{34, "RG", Depth::f16},
    NumberedFormat{35, "RG", Depth::u16},        NumberedFormat{41, "R", Depth::f32},
    NumberedFormat{49, "RG", Depth::u8},         NumberedFormat{54, "R", Depth::f16},
    NumberedFormat{56, "R", Depth::u16},         NumberedFormat{61, "R", Depth::u8},
    NumberedFormat{87, "BGRA", Depth::u8},       NumberedFormat{88, "BGRX", Depth::u8},
    NumberedFormat{91, "BGRA", Depth::u8, true}, NumberedFormat{93, "BGRX", Depth::u8, true},
};

/// What Direct3D 9 writes in place of a four-character code, and the DXGI_FORMAT of the same texels.
struct OldNumber {
    std::uint32_t code, dxgi;
};
constexpr std::array old_numbers{OldNumber{36, 11},  OldNumber{111, 54}, OldNumber{112, 34}, OldNumber{113, 10},
                                 OldNumber{114, 41}, OldNumber{115, 16}, OldNumber{116, 2}};

// Offsets in the file.
constexpr std::uint64_t at_size = 4, at_height = 12, at_width = 16, at_levels = 28, at_pixel_flags = 80, at_code = 84,
                        at_bits = 88, at_masks = 92, at_caps2 = 112, at_dxgi = 128, header_end = 128, dx10_bytes = 20;
constexpr std::uint32_t header_size = 124, pixel_format_size = 32;

// Bits of the header's flags, of the pixel format's, of caps and of caps2, and what a DX10 header says.
constexpr std::uint32_t has_caps = 1, has_height = 2, has_width = 4, has_pitch = 8, has_pixel_format = 0x1000,
                        has_mipmap_count = 0x20000;
constexpr std::uint32_t has_alpha = 1, has_code = 4, has_colors = 0x40, has_luminance = 0x20000;
constexpr std::uint32_t caps_complex = 8, caps_texture = 0x1000, caps_mipmap = 0x400000;
constexpr std::uint32_t caps2_cube = 0x200, caps2_all_faces = 0xfc00, caps2_volume = 0x200000;
constexpr std::uint32_t texture_2d = 3, misc_cube = 4, alpha_mask = 7, alpha_straight = 1, alpha_premultiplied = 2;

constexpr std::uint32_t code_of(std::string_view text) {
    std::uint32_t code = 0;
    for (std::size_t i = 4; i-- > 0;) code = code << 8 | static_cast<unsigned char>(text[i]);
    return code;
}
constexpr std::uint32_t dx10 = code_of("DX10");

// ---- reading

StoredTexels texels_of(const NumberedFormat& format) { return stored_texels(format.order, format.depth, format.srgb); }

/// The letters of a four-character code; where it has none, what Direct3D 9 calls its number.
std::string written(std::uint32_t code) {
    if (code == 110) return "D3DFMT_Q16W16V16U16";
    if (code == 117) return "D3DFMT_CxV8U8";
    std::string text;
    for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(code >> shift & 0xff);
    const bool is_text = std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 127; });
    return is_text ? text : message(code);
}

/// What a four-character code means: a DX10 header behind it, or a wide format.
StoredTexels texels_by_code(const FileBytes& file, std::uint32_t code) {
    const auto old = std::find_if(old_numbers.begin(), old_numbers.end(), [&](OldNumber n) { return n.code == code; });
    const NumberedFormat* const format = code == dx10               ? find_format(formats, file.u32(at_dxgi))
                                         : old != old_numbers.end() ? find_format(formats, old->dxgi)
                                                                    : nullptr;
    if (format != nullptr) return texels_of(*format);
    if (code == dx10)
        fail_file(file.name, "has texels of ", dxgi_format_name(file.u32(at_dxgi)), ", ", advice_for_texels);
    fail_file(file.name, "has texels of kind ", written(code), ", ", advice_for_texels);
}

/// What masks mean, as long as each is all bits of a sample of 8 or 16.
std::optional<StoredTexels> texels_by_masks(std::uint32_t flags, std::uint32_t bits,
                                            const std::array<std::uint32_t, 4>& masks) {
    const int sample_bits = std::popcount(masks[0]);
    if ((sample_bits != 8 && sample_bits != 16) || bits > 32 || bits % static_cast<unsigned>(sample_bits) != 0)
        return {};
    std::string order(bits / static_cast<unsigned>(sample_bits), 'X');
    for (std::size_t c = 0; c < masks.size(); ++c) {
        const bool is_there = c == 0 || (c < 3 ? (flags & has_colors) != 0 : (flags & has_alpha) != 0);
        if (!is_there || masks[c] == 0) continue;
        const int shift = std::countr_zero(masks[c]);
        const auto place = static_cast<std::size_t>(shift / sample_bits);
        if (masks[c] >> shift != (1u << sample_bits) - 1 || shift % sample_bits != 0 || place >= order.size() ||
            order[place] != 'X')
            return {};
        order[place] = "RGBA"[c];
    }
    const auto has = [&](char channel) { return order.find(channel) != order.npos; };
    // Luminance has no green: its alpha takes that place.
    if ((flags & has_luminance) != 0) std::replace(order.begin(), order.end(), 'A', 'G');
    if ((has('B') || has('A')) && !(has('G') && has('B'))) return {};
    return stored_texels(order, sample_bits == 8 ? Depth::u8 : Depth::u16);
}

StoredTexels stored_in(const FileBytes& file) {
    const std::uint32_t flags = file.u32(at_pixel_flags), bits = file.u32(at_bits);
    if ((flags & has_code) != 0) return texels_by_code(file, file.u32(at_code));
    const std::array<std::uint32_t, 4> masks{file.u32(at_masks), file.u32(at_masks + 4), file.u32(at_masks + 8),
                                             file.u32(at_masks + 12)};
    if ((flags & (has_colors | has_luminance)) != 0)
        if (const auto texels = texels_by_masks(flags, bits, masks)) return *texels;
    fail_file(file.name, "has texels of ", bits, " bits with masks ", std::hex, masks[0], ' ', masks[1], ' ', masks[2],
              ' ', masks[3], std::dec, ", ", advice_for_texels);
}

std::string name_of(const StoredTexels& stored) {
    if (const NumberedFormat* format = find_format(formats, stored)) return dxgi_format_name(format->number);
    std::string name;
    for (const char channel : stored.order) name += message(channel, 8 * size_of(stored.format.depth));
    return name;
}

void place_levels(const FileBytes& file, ContainerLayout& layout, std::uint64_t start) {
    std::uint64_t chain = 0;
    for (int level = 0; level < layout.info.levels; ++level) {
        layout.levels.push_back({start + chain, 0});
        chain += layout.image_bytes(level);
    }
    for (LevelPlace& place : layout.levels) place.stride = chain;
    file.require(start, chain * layout.images(), "the data of all levels, layers and faces");
}

/// What a DX10 header says beside the format; without one, the older header alone counts.
void read_dx10(const FileBytes& file, ContainerLayout& layout) {
    const std::uint32_t dimension = file.u32(at_dxgi + 4), misc = file.u32(at_dxgi + 8), alpha = file.u32(at_dxgi + 16);
    if (dimension != texture_2d)
        fail_file(file.name, "has a resource dimension of ", dimension,
                  ", and only 3, two dimensions, is read; store slices as layers");
    ContainerInfo& info = layout.info;
    info.layers = checked_count(file, file.u32(at_dxgi + 12), "layers", most_layers);
    info.is_array = info.layers > 1;
    info.is_cube = (misc & misc_cube) != 0;
    layout.stored.format.premultiplied = info.texels.channels == 4 && (alpha & alpha_mask) == alpha_premultiplied;
    info.texels = layout.stored.format;
}

// ---- writing

/// Whether the older header tells all that there is to say. Luminance is R8; masks are RGBA8.
bool fits_old_header(const TextureShape& shape) {
    const TexelFormat& f = shape.format;
    return !shape.is_array && !f.srgb && !f.premultiplied && f.depth == Depth::u8 && f.channels != 2;
}

void append_pixel_format(HeaderBytes& header, const TextureShape& shape) {
    const bool is_old = fits_old_header(shape), has_color = shape.format.channels == 4;
    header.u32(pixel_format_size);
    header.u32(!is_old ? has_code : has_color ? has_colors | has_alpha : has_luminance);
    header.u32(is_old ? 0 : dx10);
    header.u32(!is_old ? 0 : has_color ? 32 : 8);
    for (const std::uint32_t mask : {0xffu, 0xff00u, 0xff0000u, 0xff000000u})
        header.u32(is_old && (has_color || mask == 0xff) ? mask : 0);
}

void append_dx10(HeaderBytes& header, const TextureShape& shape) {
    const TexelFormat& format = shape.format;
    header.u32(dds_format(format)->number);
    header.u32(texture_2d);
    header.u32(shape.is_cube ? misc_cube : 0);
    header.u32(static_cast<std::uint64_t>(shape.layers));
    header.u32(format.premultiplied ? alpha_premultiplied : format.channels == 4 ? alpha_straight : 0);
}

}  // namespace

const NumberedFormat* dds_format(const TexelFormat& format) { return find_format(formats, format); }

ContainerLayout dds_layout(const FileBytes& file) {
    file.require(0, header_end, "its header");
    if (file.u32(at_size) != header_size || file.u32(at_pixel_flags - 4) != pixel_format_size)
        fail_file(file.name, "has headers of ", file.u32(at_size), " and ", file.u32(at_pixel_flags - 4),
                  " bytes, which must be 124 and 32; the file is damaged");
    const std::uint32_t caps2 = file.u32(at_caps2), faces = caps2 & (caps2_cube | caps2_all_faces);
    if ((caps2 & caps2_volume) != 0) fail_file(file.name, "is a volume, which is not read; store its slices as layers");
    const bool is_cube = (caps2 & caps2_cube) != 0,
               is_dx10 = (file.u32(at_pixel_flags) & has_code) != 0 && file.u32(at_code) == dx10;
    if (is_cube && faces != (caps2_cube | caps2_all_faces))
        fail_file(file.name, "is a cube with some of its faces only; store all six");

    constexpr int longest = std::numeric_limits<int>::max();
    ContainerLayout layout;
    layout.stored = stored_in(file);
    layout.info = {.container = Container::dds,
                   .format = name_of(layout.stored),
                   .texels = layout.stored.format,
                   .texel_bytes = static_cast<int>(layout.stored.bytes()),
                   .width = checked_count(file, file.u32(at_width), "columns", longest),
                   .height = checked_count(file, file.u32(at_height), "rows", longest),
                   .levels = checked_count(file, std::max(file.u32(at_levels), 1u), "levels", longest),
                   .is_cube = is_cube};
    if (is_dx10) read_dx10(file, layout);
    check_claims(file, layout);
    place_levels(file, layout, header_end + (is_dx10 ? dx10_bytes : 0));
    return layout;
}

ContainerPlan plan_dds(const TextureShape& shape) {
    const auto levels = static_cast<std::uint64_t>(shape.levels), width = static_cast<std::uint64_t>(shape.width);
    HeaderBytes header;
    header.text(dds_identifier);
    header.u32(header_size);
    header.u32(has_caps | has_height | has_width | has_pitch | has_pixel_format | has_mipmap_count);
    header.u32(static_cast<std::uint64_t>(shape.height));
    header.u32(width);
    header.u32(width * static_cast<std::uint64_t>(shape.format.channels) * size_of(shape.format.depth));
    header.u32(0);  // depth
    header.u32(levels);
    header.zeros(44);
    append_pixel_format(header, shape);
    header.u32(caps_texture | (levels > 1 ? caps_complex | caps_mipmap : 0) | (shape.is_cube ? caps_complex : 0));
    header.u32(shape.is_cube ? caps2_cube | caps2_all_faces : 0);
    header.zeros(12);
    if (!fits_old_header(shape)) append_dx10(header, shape);

    ContainerPlan plan;
    std::uint64_t chain = 0;
    for (int level = 0; level < shape.levels; ++level) {
        plan.levels.push_back({header.size() + chain, 0});
        chain += shape.image_bytes(level);
    }
    for (LevelPlace& place : plan.levels) place.stride = chain;
    plan.bytes = header.size() + chain * static_cast<std::uint64_t>(shape.layers * shape.faces());
    plan.header = header.take();
    return plan;
}

}  // namespace bandlimit
