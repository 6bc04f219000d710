// The weights that turn the samples of a pattern into pixels.
//
//     ResolveTable table = resolve_table(parse_pattern("d3d:8"), mitchell());
//     table.weight(-1, 0, 3)   // of sample 3 of the pixel to the left
//
// Supersampling over-samples a scene, reconstructs a continuous function from the samples, band-limits it to the rate of
// the pixels and samples the result at their centres. All but the first step are linear, and alike in each pixel: one
// table of weights, which are the values of a single filter, reconstruction convolved with band limit, at the samples.
// Stability: evolving.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/sampling/pattern.h"

namespace bandlimit {

/// `reconstruction`, `pitch` wide, convolved with `band_limit`: the filter of both steps. Separable, area 1.
///
/// units   the argument of value() in pitches of `band_limit`, the output's; those of the reconstruction are `pitch` of
///         them
/// throws  Error for radial kernels and nearest, and for a pitch that is not above 0
/// cost    a value is an integral: some microseconds
Kernel combined_kernel(const Kernel& reconstruction, double pitch, const Kernel& band_limit);

/// What each sample of a pixel, and of its neighbours up to `reach` away, weighs in the pixel. The same for each pixel.
struct ResolveTable {
    int reach = 0, samples = 0;
    std::vector<double> weights;  ///< by row, column and sample

    int side() const { return 2 * reach + 1; }
    std::size_t index(int dx, int dy, int sample) const {
        return (static_cast<std::size_t>(dy + reach) * static_cast<std::size_t>(side()) +
                static_cast<std::size_t>(dx + reach)) *
                   static_cast<std::size_t>(samples) +
               static_cast<std::size_t>(sample);
    }
    /// Of sample `sample` of the pixel dx to the right and dy below.
    double weight(int dx, int dy, int sample) const { return weights[index(dx, dy, sample)]; }
};

/// The table of a pattern that is the same in every pixel. Weights sum to 1.
///
/// The kernel is as wide as stated in output pixels, whatever the pattern. box takes the samples of its own pixel, those
/// on its left and upper borders included. With `reconstruction`, whose pitch is that of the over-sampled grid,
/// 1 / sqrt(count), the filter is combined_kernel(); without, the kernel alone: samples are then taken for points.
///
/// throws  Error for nearest, for kernels that reach no sample or whose weights cancel, and as combined_kernel()
ResolveTable resolve_table(const SamplePattern& pattern, const Kernel& kernel,
                           const std::optional<Kernel>& reconstruction = {});

/// The same before it is divided by the sum: for patterns that differ from pixel to pixel, whose weights meet in one sum.
ResolveTable unnormalised_table(const SamplePattern& pattern, const Kernel& kernel,
                                const std::optional<Kernel>& reconstruction = {});

}  // namespace bandlimit
