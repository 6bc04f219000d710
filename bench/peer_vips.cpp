#include <vips/vips.h>

#include <memory>

#include "bandlimit/core/error.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

struct Unref {
    void operator()(VipsImage* image) const { g_object_unref(image); }
};
using Picture = std::unique_ptr<VipsImage, Unref>;

Picture picture(const Case& c, const std::byte* bytes, int width, int height) {
    const VipsBandFormat format = c.channels == 1 ? VIPS_FORMAT_FLOAT : VIPS_FORMAT_UCHAR;
    const std::size_t size = c.sample_bytes() * static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                             static_cast<std::size_t>(c.channels);
    Picture image(vips_image_new_from_memory(bytes, size, width, height, c.channels, format));
    if (image && c.linear) image->Type = VIPS_INTERPRETATION_sRGB;
    return image;
}

/// The next picture of a pipeline: `operation` makes it from the last one.
template <class Operation>
void then(Picture& last, Operation operation) {
    VipsImage* next = nullptr;
    if (operation(last.get(), &next)) fail("libvips: ", vips_error_buffer());
    last.reset(next);
}

void resize(Picture& image, const Case& c, int width, int height, int new_width, int new_height) {
    then(image, [&](VipsImage* in, VipsImage** out) {
        const double x = static_cast<double>(new_width) / width, y = static_cast<double>(new_height) / height;
        if (c.filter == Filter::box) return vips_shrink(in, out, 1 / x, 1 / y, nullptr);
        return vips_resize(in, out, x, "vscale", y, "kernel", VIPS_KERNEL_LANCZOS3, nullptr);
    });
}

void linear_light(Picture& image, const Case& c) {
    then(image,
         [](VipsImage* in, VipsImage** out) { return vips_colourspace(in, out, VIPS_INTERPRETATION_scRGB, nullptr); });
    then(image, [](VipsImage* in, VipsImage** out) { return vips_premultiply(in, out, "max_alpha", 255.0, nullptr); });
    resize(image, c, c.width, c.height, c.new_width, c.new_height);
    then(image,
         [](VipsImage* in, VipsImage** out) { return vips_unpremultiply(in, out, "max_alpha", 255.0, nullptr); });
    then(image,
         [](VipsImage* in, VipsImage** out) { return vips_colourspace(in, out, VIPS_INTERPRETATION_sRGB, nullptr); });
    then(image, [](VipsImage* in, VipsImage** out) { return vips_cast_uchar(in, out, nullptr); });
}

void run(const Case& c, const Buffers& buffers, std::size_t k) {
    const std::byte* from = buffers.sources[k].data();
    int width = c.width, height = c.height;
    for (const Level& level : levels_of(c)) {
        std::byte* to = buffers.targets[k].data() + level.offset;
        Picture image = picture(c, from, width, height), target = picture(c, to, level.width, level.height);
        if (c.linear) linear_light(image, c);
        else resize(image, c, width, height, level.width, level.height);
        if (vips_image_write(image.get(), target.get())) fail("libvips: ", vips_error_buffer());
        from = to, width = level.width, height = level.height;
    }
}

}  // namespace

std::vector<Peer> vips_peers() {
    if (VIPS_INIT("bench")) return {};
    vips_cache_set_max(0);
    const auto prepare = [](const Case& c, const Buffers& buffers, int threads) {
        Task task = timed([=, &buffers](int k) {
            vips_concurrency_set(threads);
            run(c, buffers, static_cast<std::size_t>(k));
        });
        task.other = c.new_width > c.width;
        return std::optional(task);
    };
    return {{.name = std::string("libvips ") + vips_version_string(),
             .note = "from memory to memory, no cache of operations; its kernels are for reducing: enlarging is "
                     "bicubic, and half an output sample off",
             .prepare = prepare}};
}

}  // namespace bandlimit::bench
