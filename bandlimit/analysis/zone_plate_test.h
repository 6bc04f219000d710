// The zone plate that resamplers are compared by, and what an ideal one makes of it.
#pragma once
#include <cmath>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/resample/resize.h"
#include "bandlimit/signal/render.h"

namespace bandlimit::plate {

inline constexpr int size = 1024;

/// sin(pi r^2 / size), amplitude 0.45 about 1/2: Nyquist at the borders. Pixels are means of 8 x 8 points, as a
/// camera's would be: point samples hold more of what is hard, and give 2 dB less.
inline const Image<float>& image() {
    static const Image<float> plate = render(with_range(zone_plate({size, size}, {.phase = -0.25}), 0.05, 0.95), size,
                                             size, Sampling::supersampled(box(), 8));
    return plate;
}
inline constexpr double power = 0.45 * 0.45 / 2;  ///< of the signal

struct Case {
    const char* name;
    int size;
    double source;  ///< the first so many source samples along each axis become `size`

    double step() const { return source / size; }
    /// 5 % of the picture.
    int border() const { return static_cast<int>(std::lround(size * 0.05)); }
};
inline constexpr Case halve{"/ 2", size / 2, size}, by_3_7{"/ 3.7", 276, 276 * 3.7}, twice{"x 2", 2 * size, size};

/// Resamples stored samples that mean themselves into `to`.
inline void resize(const AnyConstView& from, const AnyView& to, const Case& c, const Kernel& kernel) {
    const Axis src{size, 0, size}, dst{c.size, 0, c.source};
    const Resizer resizer({src, src}, {dst, dst}, 1, {.reconstruction = kernel, .edge = Edge::reflect});
    resizer.run({from, 0, {}}, {to, 0, {}, {}});
}

inline Image<float> resized(const Case& c, const Kernel& kernel) {
    Image<float> out(c.size, c.size);
    resize(image().view(), out.view(), c, kernel);
    return out;
}

/// An ideal low-pass, near enough: a sinc of 40 lobes a side.
inline Kernel brick_wall() { return kaiser(40, 10); }

/// What the plate holds below the Nyquist frequency of both grids, and nothing else.
inline Image<float> ideal(const Case& c) { return resized(c, brick_wall()); }

}  // namespace bandlimit::plate
