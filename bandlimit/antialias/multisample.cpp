#include "bandlimit/antialias/multisample.h"

#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

/// Means over the samples of each pixel, shaded at `shaded(centre, sample)`.
template <class ShadedAt>
Image<float> means(const ShadedSurfaces& surfaces, int width, int height, const SamplePattern& pattern,
                   double footprint, const Parallel& parallel, const ShadedAt& shaded_at) {
    if (width < 1 || height < 1) fail("multisample: ", width, " x ", height, " pixels; pass at least 1 x 1");
    if (pattern.points.empty()) fail("multisample: the pattern has no points; pass at least one");
    if (!(footprint >= 0)) fail("multisample: footprint = ", footprint, "; pass 0 or more pixels");
    Image<float> image(width, height);
    const View<float> out = image.view();
    const Axis pixels{1, 0, 1};
    parallel_for(height, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < width; ++x) {
                const Point centre{pixels.position(x), pixels.position(y)};
                double sum = 0;
                for (const Point& p : pattern.points) {
                    const Point sample{centre.x + p.x, centre.y + p.y}, at = shaded_at(centre, sample);
                    sum += surfaces.shade(surfaces.visible(sample.x, sample.y), at.x, at.y, footprint);
                }
                out(x, y) = static_cast<float>(sum / pattern.count());
            }
    });
    return image;
}

}  // namespace

Image<float> multisample(const ShadedSurfaces& surfaces, int width, int height, const SamplePattern& pattern,
                         double footprint, const Parallel& parallel) {
    return means(surfaces, width, height, pattern, footprint, parallel,
                 [](const Point& centre, const Point&) { return centre; });
}

Image<float> supersample(const ShadedSurfaces& surfaces, int width, int height, const SamplePattern& pattern,
                         double footprint, const Parallel& parallel) {
    return means(surfaces, width, height, pattern, footprint, parallel,
                 [](const Point&, const Point& sample) { return sample; });
}

}  // namespace bandlimit
