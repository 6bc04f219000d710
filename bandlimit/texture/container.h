// Textures in files that graphics interfaces load: KTX2 and DDS, uncompressed. What others read: docs/containers.md.
// Stability: stable.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
    std::string format;   ///< the interface's own name: "VK_FORMAT_R8G8B8A8_SRGB", "DXGI_FORMAT_R8G8B8A8_UNORM_SRGB"
    TexelFormat texels;   ///< as they are read
    int texel_bytes = 0;  ///< as they are stored
    int width = 0, height = 0, levels = 1, layers = 1;
    bool is_cube = false, is_array = false;
};

/// Throws Error, naming what it holds instead, for texels that such a file cannot have: DDS has no sRGB of 1 or 2
/// channels.
void check_container(Container container, const TexelFormat& format);

/// How much of the beginning of a file holds its header; what lies further back is texels.
inline constexpr std::uint64_t most_header_bytes = 1 << 20;

/// Reads the header of a file, and checks that the file is long enough for what it claims.
///
/// shapes   start: the first most_header_bytes of the file, or the whole; length of the file in bytes
/// range    uncompressed texels of 8 and 16 bits, halves and floats, as ktx2_layout() and dds_layout() list them
/// throws   std::runtime_error "NAME: what is wrong; what to do" for what is damaged, truncated, or of a kind that is
///          not read (compressed formats, volumes)
ContainerInfo container_info(std::span<const std::byte> start, std::uint64_t length, const std::string& name);
/// The same for a file that is in memory.
ContainerInfo container_info(std::span<const std::byte> file, const std::string& name);

/// Reads the whole. Blue first becomes red first, and three channels four with alpha 1.
///
/// cost     memory of less than twice the file's length, and some 150 bytes an image
/// throws   as container_info
Texture read_container(std::span<const std::byte> file, const std::string& name);

/// Where a file keeps the images of a level: image i begins at start + i * stride.
struct LevelPlace {
    std::uint64_t start = 0, stride = 0;
};

/// A file to be written: what stands before the first texel, and where the images go. What lies between is zeros.
struct ContainerPlan {
    std::vector<std::byte> header;
    std::vector<LevelPlace> levels;
    std::uint64_t bytes = 0;  ///< of the file
};
/// The file that will hold a texture of this shape, for those who write level by level, or row by row.
///
/// DDS does not tell an array of one layer from a texture without layers, nor whether 1 or 2 channels are sRGB.
/// throws   Error as check_container, and for a DDS whose rows take 4 GiB or more
ContainerPlan plan_container(const TextureShape& shape, Container container);

/// The samples of an interleaved image, as a file stores them.
std::span<const std::byte> bytes_of(const AnyImage& image);

/// Takes the bytes of a file, in order.
using ByteSink = std::function<void(std::span<const std::byte>)>;
/// Writes `texture` to `sink`, as plan_container() has it.
///
/// cost     copies no texel
/// throws   Error as check_texture and plan_container; what `sink` throws
void write_container(const Texture& texture, Container container, const ByteSink& sink);

}  // namespace bandlimit
