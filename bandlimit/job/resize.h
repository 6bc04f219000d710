// A picture file in another size.
//
//     job::ResizeJob half;
//     half.files = {"photo.jpg", "half.png"};
//     half.scale = 0.5;
//     job::resize(half);
// Stability: evolving.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "bandlimit/job/picture_filter.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::job {

/// Part of a picture, in its pixels; fractions are allowed.
struct Region {
    double x = 0, y = 0, width = 0, height = 0;
};

/// What two pictures of different sizes share.
enum class Align {
    corners,
    centers  ///< those of their first and last samples; other libraries call it align_corners
};

struct ResizeJob {
    PictureFiles files;

    // The new size: `scale`, or `width` and `height`, of which one follows from the other where it is 0.
    double scale = 0;  ///< a multiple of the old size, or of the region's
    int width = 0, height = 0;

    std::optional<Region> region{};  ///< default: all. What lies around it contributes at its borders
    Align align = Align::corners;
    std::string kernel = "auto";  ///< as parse_kernel(), a taps.json, or "auto" as Auto
    /// Default: what ResizeOptions has; for taps that sum to 0, which cannot be renormalized, Edge::reflect.
    std::optional<Edge> edge{};
    double antiring = 0;  ///< as ResizeOptions
    /// An opaque colour, as codes of the input from 0 to 1, to lay a picture with alpha over. Drops alpha.
    std::optional<std::array<double, 3>> background{};
};

struct ResizeReport : PictureReport {
    std::string kernel_x, kernel_y;  ///< the names of the kernels that ran
    Edge edge = Edge::renormalize;
};

/// Resizes a file into another, a band of rows at a time.
///
/// memory   that of Resizer and of stream_rows(), whatever the size of the pictures
/// notes    as filter_picture()
/// throws   OptionError for a size that is missing, given twice or too large, and for taps that do not fit this
///          resampling; Error as Resizer; std::runtime_error for files, for a region that reaches outside, and for a
///          background that the channels cannot show; Stopped. The output appears whole or not at all
ResizeReport resize(const ResizeJob& job, const Context& context = {});

}  // namespace bandlimit::job
