#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "bandlimit/core/error.h"
#include "bench/peer.h"

namespace bandlimit::bench {
namespace {

using OIIO::ImageBuf;
namespace Algo = OIIO::ImageBufAlgo;

ImageBuf picture(const Case& c, std::byte* bytes, int width, int height) {
    OIIO::ImageSpec spec(width, height, c.channels, c.channels == 1 ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    if (c.linear) spec.alpha_channel = 3;
    return ImageBuf(spec, bytes);
}

void check(bool good, const ImageBuf& image) {
    if (!good) fail("OpenImageIO: ", image.geterror());
}

void resize(ImageBuf& to, const ImageBuf& from, const Case& c, int threads) {
    // A width of 0: the filter's own, made wider where the picture is reduced.
    check(Algo::resize(to, from, c.filter == Filter::box ? "box" : "lanczos3", 0.0f, to.roi(), threads), to);
}

void linear_light(ImageBuf& to, const ImageBuf& from, const Case& c, int threads) {
    ImageBuf linear(OIIO::ImageSpec(c.width, c.height, 4, OIIO::TypeDesc::FLOAT));
    ImageBuf small(OIIO::ImageSpec(c.new_width, c.new_height, 4, OIIO::TypeDesc::FLOAT));
    check(Algo::colorconvert(linear, from, "sRGB", "linear", false, "", "", nullptr, {}, threads), linear);
    check(Algo::premult(linear, linear, {}, threads), linear);
    resize(small, linear, c, threads);
    check(Algo::unpremult(small, small, {}, threads), small);
    check(Algo::colorconvert(to, small, "linear", "sRGB", false, "", "", nullptr, {}, threads), to);
}

void run(const Case& c, const Buffers& buffers, std::size_t k, int threads) {
    ImageBuf from = picture(c, const_cast<std::byte*>(buffers.sources[k].data()), c.width, c.height);
    for (const Level& level : levels_of(c)) {
        ImageBuf to = picture(c, buffers.targets[k].data() + level.offset, level.width, level.height);
        if (c.linear) linear_light(to, from, c, threads);
        else resize(to, from, c, threads);
        from = picture(c, buffers.targets[k].data() + level.offset, level.width, level.height);
    }
}

}  // namespace

std::vector<Peer> oiio_peers() {
    const auto prepare = [](const Case& c, const Buffers& buffers, int threads) {
        return std::optional(timed([=, &buffers](int k) {
            OIIO::attribute("threads", threads);
            run(c, buffers, static_cast<std::size_t>(k), threads);
        }));
    };
    return {{.name = "OpenImageIO " OIIO_VERSION_STRING,
             .note = "ImageBufAlgo; g: colorconvert, premult, resize, unpremult, colorconvert",
             .prepare = prepare}};
}

}  // namespace bandlimit::bench
