// Resampling of whole images, from stored samples to stored samples.
// Stability: stable.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/kernel/taps.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit {

/// Picks a kernel per axis: shrink3 where the image shrinks, grow3 where it grows or keeps its size.
struct Auto {};

/// What makes the weights.
using Reconstruction = std::variant<Auto, Kernel, Taps>;

/// The kernel that Auto means for this pair of axes.
Kernel auto_kernel(const Axis& src, const Axis& dst);

struct ResizeOptions {
    Reconstruction reconstruction = Auto{};
    Edge edge = Edge::renormalize;
    std::optional<Edge> edge_y = {};  ///< above and below, where that is another
    /// Deringing, 0 to 1: how much of what overshoots the range of the nearest input samples (those within one pitch of
    /// the coarser grid) is taken away. Not linear; 0 is off.
    double antiring = 0;
    /// Work on colour multiplied by alpha, so that transparent texels do not bleed. Has no effect without alpha.
    bool premultiply = true;
};

/// A resampling ready to run on blocks of rows, so that neither image need be in memory.
///
/// Rows are decoded to linear float, filtered along both axes, and encoded, a few at a time, by contiguous runs of
/// output rows per thread. Which axis is filtered first depends on the scale factors alone: parts of an image have the
/// bits of the whole. Radial kernels filter both at once. Codes of 8 bits that need no decoding (linear, no alpha to
/// multiply by, no antiring) run in integers on x86, with the same result on all targets.
///
/// memory   per thread about 2 MiB, more where one output reads more: images are worked on in strips of columns
/// error    as combine(), once per axis; u8 and u16 are the nearest codes of the float result. In integers: at most one
///          code from them; 1 code in 200 differs (resize_bytes_scalar() has the definition)
/// cost     of 4 bytes per pixel to half by 12 taps, about 1.8 times that of reading and writing memory; in linear
///          light 8 times. docs/performance.md has the table
class Resizer {
public:
    /// throws  Error as make_bank and Mapping, for antiring outside 0..1, and for channels < 1
    Resizer(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options = {});
    /// About how much memory such a Resizer takes, its runs by so many threads included, in bytes: known before
    /// anything is allocated. Throws Error as Mapping.
    static std::uint64_t bytes(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options,
                               const Parallel& parallel);

    /// The names of the kernels used along x and y; "taps" for taps.
    const std::string& kernel_x() const { return kernel_x_; }
    const std::string& kernel_y() const { return kernel_y_; }

    /// What runs, for code that takes any filter.
    const RowFilter& rows() const { return rows_; }
    /// As those of RowFilter.
    IndexRange rows_needed(int first, int last) const { return rows_.rows_needed(first, last); }
    RunReport run(const SourceRows& source, const TargetRows& target, const Parallel& parallel = {},
                  const RowProgress& progress = {}) const {
        return rows_.run(source, target, parallel, progress);
    }

private:
    std::string kernel_x_, kernel_y_;
    RowFilter rows_;
};

/// Resamples linear light to width x height on the same interval: images share their corners.
///
/// shapes   src [w x h x c] with any strides; the result is laid out like `layout`
/// example  resample(view, 64, 64, {.reconstruction = mitchell()})
Image<float> resample(View<const float> src, int width, int height, const ResizeOptions& options = {},
                      const Parallel& parallel = {}, Layout layout = Layout::planar);

/// Resizes a whole picture as most programs hold it: sRGB codes of 8 or 16 bits (or floats of them), grey or RGB, with
/// alpha as the last of 2 or 4 channels, not multiplied into the colours. In linear light, without bleeding.
///
/// shapes   src and dst of 1 to 4 channels each, equally many, any strides, also padded rows; dst is the caller's memory
/// throws   Error as Resizer and its run()
/// example  resize_srgb(interleaved(photo, 1920, 1080, 4, pitch), interleaved(thumbnail, 480, 270, 4));
RunReport resize_srgb(const AnyConstView& src, const AnyView& dst, const ResizeOptions& options = {},
                      const Parallel& parallel = {});

}  // namespace bandlimit
