// Supersampling: many samples of a scene in each pixel, resolved by a kernel.
//
//     Image<float> truth = supersample(make_scene("plane", 480, 270), 480, 270, 0,
//                                      {.pattern = sobol_pattern(256), .kernel = mitchell()});
//
// A resolve is one weighted sum per pixel: see antialias/resolve_table.h. Scenes continue outside the image, so that no
// kernel meets an edge. All in linear light.
// Stability: evolving.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/sampling/pattern.h"
#include "bandlimit/scene/scene.h"

namespace bandlimit {

/// What a point of a scene shows, in the channels of `value`. Colour is multiplied by alpha. Called from several threads
/// at once.
///
/// units   positions in pixels of the image: pixel (i, j) covers [i, i + 1] x [j, j + 1]
using PointValue = std::function<void(double x, double y, std::span<float> value)>;

/// How samples far brighter than white are kept from making edges rough. A pixel that a light L covers by half, on
/// black, ought to be L / 2, which a display clips to white for any L > 2: its edges look as if they were not
/// antialiased. Weights that fall with brightness make it L / (2 + L) instead: smooth, and wrong by that much. Both are
/// the identity on constant areas, and nearly so where all is dark.
enum class ToneWeight {
    none,
    karis,  ///< each sample weighs 1 / (1 + luma) (Karis 2014)
    lottes  ///< colours are divided by 1 + their largest channel, filtered, and divided by 1 - that (Lottes 2016)
};

/// "none", "karis" or "lottes". Throws Error, listing them, for others.
ToneWeight parse_tone_weight(std::string_view name);
std::string_view name_of(ToneWeight tone);

struct SupersampleOptions {
    SamplePattern pattern = sobol_pattern(16);
    Kernel kernel = blackman_harris();             ///< in pixels of the output
    std::optional<Kernel> reconstruction = {};     ///< as resolve_table()
    ToneWeight tone = ToneWeight::none;            ///< of colour, not alpha
    std::optional<std::uint64_t> pixel_seed = {};  ///< given: another pattern in each pixel, see below
};

/// Pixels [x, x + width) x [y, y + height) of an image.
struct PixelArea {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Takes rows of the result: those from `y` of the area on, channels interleaved. Called from one thread, in order.
using ResolvedRows = std::function<void(int y, View<const float> rows)>;

/// Supersamples an area of `value` with 1 to 4 channels, a few rows at a time. The last of 2 or 4 channels is alpha.
///
/// With pixel_seed, each pixel has one of 64 patterns, chosen by the hash of its indices and the seed: the pattern
/// wrapped() by 64 offsets, which are spread evenly themselves. Errors turn from regular ones, which the eye follows, to
/// noise. They depend on nothing else, so that they are the same in every frame, and in any part of the image. Weights
/// are then divided by the sum of each pixel; where this is not above a fifth of what it is in the mean, negative ones
/// are left out, and where nothing is left, the pixel is the mean of its own samples.
///
/// error    sums are in double; the result is the nearest float. Without tone, what is constant stays so to the bit
/// tone     where negative weights let the sum of weights fall below that of the brightest sample alone, it is raised to
///          that
/// cost     one call of `value` per sample of the area and of the kernel's reach around it, each once; and
///          side()^2 * count products. Same bits for any number of threads
/// memory   about 32 MB, more if 2 reach + 2 rows of samples take more
/// throws   Error as resolve_table(), and for sizes and numbers of channels out of range; what `value` and `rows` throw
void supersample_rows(const PointValue& value, int channels, const PixelArea& area, const SupersampleOptions& options,
                      const ResolvedRows& rows, const Parallel& parallel = {});

/// Throws the Error with which supersample_rows() would refuse these options.
void check_supersampling(const SupersampleOptions& options);

/// About how many bytes supersample_rows() takes for rows of so many pixels.
std::uint64_t supersampling_bytes(int width, int channels, const SupersampleOptions& options);

/// The same as an image of the area.
Image<float> supersample(const PointValue& value, int channels, const PixelArea& area,
                         const SupersampleOptions& options = {}, const Parallel& parallel = {});

/// A frame of a scene as RGBA, colour multiplied by alpha: for supersample_rows(). From scene.color() if there is one,
/// which is opaque, or else scene.at().
PointValue colors_of(const Scene& scene, int frame);

/// The image of a scene: RGBA, interleaved, colour not multiplied by alpha.
Image<float> supersample(const Scene& scene, int width, int height, int frame = 0,
                         const SupersampleOptions& options = {}, const Parallel& parallel = {});

/// Divides colour by alpha, the last of 2 or 4 channels; where alpha is 0, colour stays.
void divide_by_alpha(View<float> rows);

}  // namespace bandlimit
