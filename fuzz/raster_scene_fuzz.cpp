// Any bytes as a scene of shapes: it is drawn, or one std::runtime_error says why not.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "bandlimit/core/image.h"
#include "bandlimit/job/raster_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandlimit;
    try {
        const job::RasterScene scene = job::parse_raster_scene({reinterpret_cast<const char*>(data), size}, "fuzz");
        static const RasterFilter cone = raster_filter("cone:1"), spline = raster_filter("bspline");
        for (const RasterFilter& filter : {cone, spline}) {
            Image<float> image(std::min(scene.width, 16), std::min(scene.height, 16), 4);
            const Rasterizer rasterizer(scene.shapes, filter);
            rasterizer.draw(image.view(), 0, {1});
            rasterizer.draw_supersampled(image.view(), 2, 0, {1});
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x)
                    if (!(std::abs(image.view()(x, y, 3)) <= 2e9f)) std::abort();
        }
    } catch (const std::runtime_error&) {
    }
    return 0;
}
