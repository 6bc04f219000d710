// Debian installs version 0.97 as a header alone.
#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <stb/stb_image_resize.h>
#pragma GCC diagnostic pop

#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

Task resize(const Case& c, const Buffers& buffers) {
    return timed([=, &buffers](int k) {
        const auto i = static_cast<std::size_t>(k);
        const std::byte* from = buffers.sources[i].data();
        int width = c.width, height = c.height;
        for (const Level& level : levels_of(c)) {
            std::byte* to = buffers.targets[i].data() + level.offset;
            const stbir_filter filter = c.filter == Filter::box ? STBIR_FILTER_BOX : STBIR_FILTER_CATMULLROM;
            stbir_resize(from, width, height, 0, to, level.width, level.height, 0,
                         c.channels == 1 ? STBIR_TYPE_FLOAT : STBIR_TYPE_UINT8, c.channels,
                         c.linear ? 3 : STBIR_ALPHA_CHANNEL_NONE, 0, STBIR_EDGE_CLAMP, STBIR_EDGE_CLAMP, filter, filter,
                         c.linear ? STBIR_COLORSPACE_SRGB : STBIR_COLORSPACE_LINEAR, nullptr);
            from = to, width = level.width, height = level.height;
        }
    });
}

}  // namespace

std::vector<Peer> stb_peers() {
    const auto prepare = [](const Case& c, const Buffers& buffers, int) {
        Task task = resize(c, buffers);
        task.other = c.filter != Filter::box;
        return std::optional(task);
    };
    return {{.name = "stb_image_resize 0.97",
             .note = "has no Lanczos: Catmull-Rom in its place; no threads",
             .threads = 1,
             .prepare = prepare}};
}

}  // namespace bandlimit::bench
