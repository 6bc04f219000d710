// The pictures that a texture is made of, from whatever files hold them.
// Stability: inner.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/texture/container.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit::job {

/// A picture in memory, and what its samples mean.
struct TexturePicture {
    AnyImage image;
    Encoding encoding;
};

/// What the header of an input says.
struct TexturePictureInfo {
    int width = 0, height = 0, channels = 0;
    bool has_alpha = false;
    Depth depth = Depth::u8;
    int images = 1;                        ///< layers times faces
    std::optional<ContainerInfo> texture;  ///< where it is one
    bool has_foreign_profile = false;

    bool is_cube() const { return texture && texture->is_cube; }
    bool is_array() const { return texture && texture->is_array; }
};
/// throws  std::runtime_error with the path
TexturePictureInfo picture_info(const std::string& path);

/// What the codes of an image mean: what `space` says, or else the role together with the file.
Encoding encoding_of_image(const ImageInfo& info, Role role, Space space);

/// Appends the pictures of `path`: one of an image, level 0 of every layer and face of a texture. What codes mean is
/// what `space` says, or else the role together with the file.
/// throws  std::runtime_error with the path
void read_texture_pictures(const std::string& path, Role role, Space space, int threads,
                           std::vector<TexturePicture>& pictures);

}  // namespace bandlimit::job
