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

/// Throws Error, naming what it holds instead, for a texture that such a file cannot be: DDS has no sRGB of 1 or 2
/// channels.
void check_container(Container container, const TexelFormat& format);

/// Reads the header of a file whose bytes are `bytes`; `name` is what errors call it.
/// throws   std::runtime_error "NAME: what is wrong; what to do" for what is damaged, truncated, or of a kind that is
/// not
///          read (compressed formats, volumes)
ContainerInfo container_info(std::span<const std::byte> bytes, const std::string& name);
/// Reads the whole. Allocates no more than the file is long. Throws as container_info.
Texture read_container(std::span<const std::byte> bytes, const std::string& name);

/// Takes the bytes of a file, in order.
using ByteSink = std::function<void(std::span<const std::byte>)>;
/// Writes `texture` to `sink`. Throws Error as check_texture and check_container.
void write_container(const Texture& texture, Container container, const ByteSink& sink);

}  // namespace bandlimit
