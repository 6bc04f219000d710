#include "bandlimit/job/texture_pictures.h"

#include "bandlimit/core/file_error.h"
#include "bandlimit/job/mips_recipe.h"
#include "bandlimit/job/texture_file.h"

namespace bandlimit::job {
namespace {

Encoding encoding_of_texture(const TexelFormat& format, Role role, Space space) {
    Encoding encoding = encoding_of(format, !traits_of(role).is_light || space == Space::data);
    if (space == Space::srgb) encoding.transfer = Transfer::srgb;
    if (space == Space::linear || space == Space::data) encoding.transfer = Transfer::linear;
    return encoding;
}

}  // namespace

Encoding encoding_of_image(const ImageInfo& info, Role role, Space space) {
    if (space == Space::automatic && !traits_of(role).is_light) space = Space::data;
    if (space == Space::automatic && role == Role::color_linear) space = Space::linear;
    Encoding encoding = info.encoding(space);
    if (!traits_of(role).is_light) encoding.alpha = -1;
    return encoding;
}

TexturePictureInfo picture_info(const std::string& path) {
    TexturePictureInfo info;
    if (container_of_file(path)) {
        info.texture = texture_info(path);
        info.width = info.texture->width, info.height = info.texture->height;
        info.channels = info.texture->texels.channels;
        info.has_alpha = info.channels == 4;
        info.depth = info.texture->texels.depth;
        info.images = info.texture->layers * (info.is_cube() ? 6 : 1);
        return info;
    }
    const ImageReader reader(path, 1);
    const ImageInfo& image = reader.info();
    constexpr int most_channels = 4;
    if (image.channels() > most_channels)
        fail_file(path, "has ", image.channels(), " channels, and a texel holds ", most_channels,
                  "; write those that are needed to a file of their own");
    info.width = image.width, info.height = image.height;
    info.channels = image.channels();
    info.has_alpha = image.alpha >= 0;
    info.depth = image.depth;
    info.has_foreign_profile = image.has_foreign_profile;
    return info;
}

void read_texture_pictures(const std::string& path, Role role, Space space, int threads,
                           std::vector<TexturePicture>& pictures) {
    if (container_of_file(path)) {
        Texture texture = read_texture(path);
        const Encoding encoding = encoding_of_texture(texture.format, role, space);
        for (AnyImage& image : texture.levels.front()) pictures.push_back({std::move(image), encoding});
        return;
    }
    ImageReader reader(path, threads);
    const ImageInfo& info = reader.info();
    AnyImage image = make_image(info.depth, info.width, info.height, info.channels());
    reader.read_rows(0, view_of(image));
    pictures.push_back({std::move(image), encoding_of_image(info, role, space)});
}

}  // namespace bandlimit::job
