#include "bandlimit/texture/ktx2.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "bandlimit/core/file_error.h"
#include "bandlimit/texture/format_names.h"

namespace bandlimit {
namespace {

// What is written has red first, so where two formats lie alike the name that says so comes first.
constexpr std::array formats{
    NumberedFormat{9, "R", Depth::u8},      NumberedFormat{15, "R", Depth::u8, true},
    NumberedFormat{16, "RG", Depth::u8},    NumberedFormat{22, "RG", Depth::u8, true},
    NumberedFormat{23, "RGB", Depth::u8},   NumberedFormat{29, "RGB", Depth::u8, true},
    NumberedFormat{30, "BGR", Depth::u8},   NumberedFormat{36, "BGR", Depth::u8, true},
    NumberedFormat{37, "RGBA", Depth::u8},  NumberedFormat{43, "RGBA", Depth::u8, true},
    NumberedFormat{44, "BGRA", Depth::u8},  NumberedFormat{50, "BGRA", Depth::u8, true},
    NumberedFormat{51, "RGBA", Depth::u8},  NumberedFormat{57, "RGBA", Depth::u8, true},
    NumberedFormat{70, "R", Depth::u16},    NumberedFormat{76, "R", Depth::f16},
    NumberedFormat{77, "RG", Depth::u16},   NumberedFormat{83, "RG", Depth::f16},
    NumberedFormat{84, "RGB", Depth::u16},  NumberedFormat{90, "RGB", Depth::f16},
    NumberedFormat{91, "RGBA", Depth::u16}, NumberedFormat{97, "RGBA", Depth::f16},
    NumberedFormat{100, "R", Depth::f32},   NumberedFormat{103, "RG", Depth::f32},
    NumberedFormat{106, "RGB", Depth::f32}, NumberedFormat{109, "RGBA", Depth::f32},
};

// Offsets in the header.
constexpr std::uint64_t at_format = 12, at_width = 20, at_height = 24, at_depth = 28, at_layers = 32, at_faces = 36,
                        at_levels = 40, at_supercompression = 44, at_descriptor = 48, at_keys = 56, header_bytes = 80,
                        level_bytes = 24;

// The basic block of the data format descriptor, which its own length precedes.
constexpr std::uint64_t total_bytes = 4, block_bytes = 24, sample_bytes = 16, at_flags = total_bytes + 8;
constexpr std::uint32_t descriptor_version = 2, model_rgbsda = 1, primaries_bt709 = 1, transfer_linear = 1,
                        transfer_srgb = 2, alpha_premultiplied = 1;
constexpr std::uint32_t sample_is_linear = 0x10, sample_is_signed = 0x40, sample_is_float = 0x80;

constexpr std::string_view orientation_key = "KTXorientation", top_first = "rd", bottom_first = "ru";

// ---- reading

const NumberedFormat& format_of(const FileBytes& file) {
    const std::uint32_t supercompression = file.u32(at_supercompression), number = file.u32(at_format);
    constexpr std::array schemes{"none", "BasisLZ", "Zstandard", "ZLIB"};
    if (supercompression != 0)
        fail_file(file.name, "is supercompressed (",
                  supercompression < schemes.size() ? schemes[supercompression] : "an unknown scheme",
                  "), which is not read; unpack it first");
    const NumberedFormat* const found = find_format(formats, number);
    if (found == nullptr) fail_file(file.name, "has texels of ", vulkan_format_name(number), ", ", advice_for_texels);
    return *found;
}

bool is_premultiplied(const FileBytes& file) {
    const std::uint64_t offset = file.u32(at_descriptor), length = file.u32(at_descriptor + 4);
    file.require(offset, length, "the data format descriptor");
    if (length < total_bytes + block_bytes)
        fail_file(file.name, "has a data format descriptor of ", length, " bytes, which must be ",
                  total_bytes + block_bytes, " or more; the file is damaged");
    const bool is_basic = file.u32(offset + total_bytes) == 0;  // of Khronos, type 0
    return is_basic && (file.u32(offset + at_flags) >> 24 & alpha_premultiplied) != 0;
}

/// The value of `key`, up to a zero byte if it holds one; empty where there is no such key.
std::string_view value_of(const FileBytes& file, std::string_view key) {
    std::uint64_t offset = file.u32(at_keys), left = file.u32(at_keys + 4);
    file.require(offset, left, "the key/value data");
    while (left > 0) {
        const std::uint64_t length = file.u32(offset), padded = (length + 3) / 4 * 4;
        if (left < 4 || padded > left - 4)
            fail_file(file.name, "has an entry of ", length, " bytes that runs out of the key/value data at byte ",
                      offset, "; the file is damaged");
        const std::string_view text = file.text(offset + 4, length);
        if (const std::size_t end = text.find('\0'); end != text.npos && text.substr(0, end) == key)
            return text.substr(end + 1).substr(0, text.substr(end + 1).find('\0'));
        offset += 4 + padded, left -= 4 + padded;
    }
    return {};
}

bool goes_up(const FileBytes& file) {
    const std::string_view orientation = value_of(file, orientation_key);
    if (orientation.empty() || orientation == top_first) return false;
    if (orientation != bottom_first || file.u32(at_faces) == 6)
        fail_file(file.name, "has an orientation that is not read; store it from the top left, \"rd\"");
    return true;
}

void place_levels(const FileBytes& file, ContainerLayout& layout) {
    for (int level = 0; level < layout.info.levels; ++level) {
        const std::uint64_t entry = header_bytes + level_bytes * static_cast<std::uint64_t>(level);
        const std::uint64_t start = file.u64(entry), length = file.u64(entry + 8), stride = layout.image_bytes(level);
        file.require(start, length, message("level ", level));
        if (length != stride * layout.images())
            fail_file(file.name, "has a level ", level, " of ", length, " bytes, which must be ",
                      stride * layout.images(), "; the file is damaged");
        layout.levels.push_back({start, stride});
    }
}

// ---- writing

/// The key/value data: keys in order, each entry padded to 4 bytes.
HeaderBytes keys_and_values() {
    using namespace std::string_view_literals;
    constexpr std::array<std::array<std::string_view, 2>, 2> entries{
        {{orientation_key, top_first}, {"KTXwriter", "bandlimit " BANDLIMIT_VERSION}}};
    HeaderBytes out;
    for (const auto& [key, value] : entries) {
        out.u32(key.size() + value.size() + 2);
        for (const std::string_view text : {key, "\0"sv, value, "\0"sv}) out.text(text);
        out.zeros((4 - out.size() % 4) % 4);
    }
    return out;
}

struct SampleRange {
    std::uint32_t qualifiers, lower, upper;
};
SampleRange range_of(Depth depth) {
    switch (depth) {
        case Depth::u8: return {0, 0, 0xff};
        case Depth::u16: return {0, 0, 0xffff};
        case Depth::f16:
        case Depth::f32: break;
    }
    return {sample_is_signed | sample_is_float, 0xbf800000, 0x3f800000};  // -1 and 1 as float, for halves too
}

HeaderBytes data_format_descriptor(const TexelFormat& format) {
    const auto channels = static_cast<std::uint32_t>(format.channels);
    const std::uint64_t block = block_bytes + sample_bytes * channels, bytes = size_of(format.depth);
    HeaderBytes out;
    out.u32(total_bytes + block);
    out.u32(0);  // of Khronos, basic
    out.u32(descriptor_version | block << 16);
    out.u32(model_rgbsda | primaries_bt709 << 8 | (format.srgb ? transfer_srgb : transfer_linear) << 16 |
            (format.premultiplied ? alpha_premultiplied : 0) << 24);
    out.u32(0);                 // blocks of 1 x 1 texel
    out.u32(channels * bytes);  // one plane
    out.u32(0);
    constexpr std::array<std::uint32_t, 4> channel_ids{0, 1, 2, 15};
    const SampleRange range = range_of(format.depth);
    for (std::uint32_t c = 0; c < channels; ++c) {
        const bool is_linear_alpha = format.srgb && c == 3;
        const std::uint64_t first_bit = c * bytes * 8, last_bit = bytes * 8 - 1;
        out.u32(first_bit | last_bit << 16 |
                (channel_ids[c] | range.qualifiers | (is_linear_alpha ? sample_is_linear : 0)) << 24);
        out.u32(0);  // at the texel's origin
        out.u32(range.lower);
        out.u32(range.upper);
    }
    return out;
}

std::uint64_t round_up(std::uint64_t value, std::uint64_t step) { return (value + step - 1) / step * step; }

std::uint64_t level_length(const TextureShape& shape, int level) {
    return shape.image_bytes(level) * static_cast<std::uint64_t>(shape.layers * shape.faces());
}

/// Gives every level its place: the smallest is first, and none before `offset`.
void place_levels(const TextureShape& shape, std::uint64_t offset, std::uint64_t alignment, ContainerPlan& plan) {
    plan.levels.resize(static_cast<std::size_t>(shape.levels));
    for (int level = shape.levels; level-- > 0;) {
        const std::uint64_t start = round_up(offset, alignment);
        plan.levels[static_cast<std::size_t>(level)] = {start, shape.image_bytes(level)};
        offset = start + level_length(shape, level);
    }
    plan.bytes = offset;
}

}  // namespace

const NumberedFormat* ktx2_format(const TexelFormat& format) { return find_format(formats, format); }

ContainerLayout ktx2_layout(const FileBytes& file) {
    file.require(0, header_bytes, "its header");
    const NumberedFormat& format = format_of(file);
    constexpr int longest = std::numeric_limits<int>::max();
    if (file.u32(at_depth) != 0) fail_file(file.name, "is a volume, which is not read; store its slices as layers");
    if (file.u32(at_height) == 0) fail_file(file.name, "has one dimension, which is not read; give it a height of 1");
    const std::uint32_t layers = file.u32(at_layers), faces = file.u32(at_faces), levels = file.u32(at_levels);
    if (faces != 1 && faces != 6)
        fail_file(file.name, "has ", faces, " faces, which must be 1 or 6; the file is damaged");

    ContainerLayout layout;
    layout.stored = stored_texels(format.order, format.depth, format.srgb);
    layout.stored.format.premultiplied = layout.stored.format.channels == 4 && is_premultiplied(file);
    layout.is_bottom_first = goes_up(file);
    layout.info = {.container = Container::ktx2,
                   .format = vulkan_format_name(format.number),
                   .texels = layout.stored.format,
                   .texel_bytes = static_cast<int>(layout.stored.bytes()),
                   .width = checked_count(file, file.u32(at_width), "columns", longest),
                   .height = checked_count(file, file.u32(at_height), "rows", longest),
                   .levels = checked_count(file, std::max(levels, 1u), "levels", longest),
                   .layers = checked_count(file, std::max(layers, 1u), "layers", most_layers),
                   .is_cube = faces == 6,
                   .is_array = layers > 0};
    check_claims(file, layout);
    place_levels(file, layout);
    return layout;
}

ContainerPlan plan_ktx2(const TextureShape& shape) {
    const TexelFormat& format = shape.format;
    const std::uint64_t sample = size_of(format.depth), texel = sample * static_cast<std::uint64_t>(format.channels);
    const HeaderBytes descriptor = data_format_descriptor(format), keys = keys_and_values();
    const std::uint64_t descriptor_start = header_bytes + level_bytes * static_cast<std::uint64_t>(shape.levels);
    const std::uint64_t keys_start = descriptor_start + descriptor.size();
    ContainerPlan plan;
    place_levels(shape, keys_start + keys.size(), std::lcm(texel, std::uint64_t{4}), plan);

    HeaderBytes header;
    header.text(ktx2_identifier);
    header.u32(ktx2_format(format)->number);
    header.u32(sample);
    header.u32(static_cast<std::uint64_t>(shape.width));
    header.u32(static_cast<std::uint64_t>(shape.height));
    header.u32(0);  // depth
    header.u32(shape.is_array ? static_cast<std::uint64_t>(shape.layers) : 0);
    header.u32(static_cast<std::uint64_t>(shape.faces()));
    header.u32(static_cast<std::uint64_t>(shape.levels));
    header.u32(0);  // supercompression
    for (const std::uint64_t number :
         {descriptor_start, std::uint64_t{descriptor.size()}, keys_start, std::uint64_t{keys.size()}})
        header.u32(number);
    header.u64(0), header.u64(0);  // data of supercompression
    for (int level = 0; level < shape.levels; ++level) {
        const std::uint64_t length = level_length(shape, level);
        for (const std::uint64_t number : {plan.levels[static_cast<std::size_t>(level)].start, length, length})
            header.u64(number);
    }
    header.append(descriptor), header.append(keys);
    plan.header = header.take();
    return plan;
}

}  // namespace bandlimit
