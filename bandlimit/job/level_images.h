// The levels of a texture as images, a file each.
// Stability: inner.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/color/encoding.h"
#include "bandlimit/texture/texture.h"

namespace bandlimit::job {

/// What the images are to hold.
struct LevelFormat {
    int channels = 4;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA; of data: the first so many
    Depth depth = Depth::u8;
    Transfer transfer = Transfer::srgb;
    bool is_data = false;  ///< codes are copied, and alpha is a channel like the others
};

/// `pattern` with `level` in the place of its one "%d".
std::string path_of_level(const std::string& pattern, int level);
/// Throws Error unless `pattern` holds "%d" once and its extension is that of an image.
void check_level_pattern(const std::string& pattern);

/// Writes the one image of every level of `texture`: all files appear, or none that was not there before.
void write_level_images(const std::string& pattern, const Texture& texture, const LevelFormat& format, int threads);

}  // namespace bandlimit::job
