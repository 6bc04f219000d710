// Textures in files that graphics interfaces load: KTX2 and DDS, uncompressed.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bandlimit/texture/texture.h"

namespace bandlimit {

enum class Container { ktx2, dds };
/// What the extension of `path` names, ".ktx2" or ".dds"; none for others.
std::optional<Container> container_of_path(std::string_view path);
/// What the first bytes of a file say it is.
std::optional<Container> container_of_bytes(std::span<const std::byte> bytes);

/// What a header says, before any texel is read.
struct ContainerInfo {
    Container container;
    std::string format;  ///< the interface's own name: "VK_FORMAT_R8G8B8A8_SRGB", "DXGI_FORMAT_R8G8B8A8_UNORM_SRGB"
    TexelFormat texels;
    int width = 0, height = 0, levels = 1, layers = 1;
    bool is_cube = false, is_array = false;
};

/// Throws Error, naming what it holds instead, for texels that such a file cannot have: DDS has no sRGB of 1 or 2
/// channels.
void check_container(Container container, const TexelFormat& format);

/// Reads the header of a file whose bytes are all in `bytes`, and checks that it holds what it claims.
///
/// `name` is what errors call the file.
/// range    uncompressed texels of 8 and 16 bits, halves and floats, as ktx2_layout() and dds_layout() list them
/// throws   std::runtime_error "NAME: what is wrong; what to do" for what is damaged, truncated, or of a kind that is
///          not read (compressed formats, volumes)
ContainerInfo container_info(std::span<const std::byte> bytes, const std::string& name);

/// Reads the whole. Blue first becomes red first, and three channels four with alpha 1.
///
/// cost     memory of less than twice the file's length, and some 150 bytes an image
/// throws   as container_info
Texture read_container(std::span<const std::byte> bytes, const std::string& name);

/// Takes the bytes of a file, in order.
using ByteSink = std::function<void(std::span<const std::byte>)>;
/// Writes `texture` to `sink`.
///
/// DDS does not tell an array of one layer from a texture without layers, nor whether 1 or 2 channels are sRGB.
/// cost     copies no texel; a header of at most 1 KiB is made
/// throws   Error as check_texture and check_container, and for a DDS whose rows take 4 GiB or more; what `sink` throws
void write_container(const Texture& texture, Container container, const ByteSink& sink);

}  // namespace bandlimit
