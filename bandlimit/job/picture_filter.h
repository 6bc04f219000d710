// From a picture file to a picture file: what resize, convolve and bokeh share.
// Stability: evolving.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/job/row_stream.h"

namespace bandlimit::job {

/// The files of a job, and how they are read and written.
struct PictureFiles {
    std::string in, out;                ///< the extension of `out` names its format
    Space space = Space::automatic;     ///< what the codes of both mean
    std::optional<bool> premultiply{};  ///< transparent texels do not bleed; default: true, but for Space::data
    std::optional<Depth> depth{};       ///< default: that of the input, or the nearest that the format holds
    int tile = 0;                       ///< as ImageTarget

    bool premultiplies() const { return premultiply.value_or(space != Space::data); }
};

/// One of the two pictures.
struct PictureSummary {
    int width = 0, height = 0, channels = 0;
    Depth depth = Depth::u8;
};

/// What became of a job.
struct PictureReport {
    PictureSummary input, output;
    bool lost_non_finite = false;  ///< NaN or infinity became 0

    /// How long each stage worked. Stages overlap: their sum may exceed `total`.
    struct Seconds {
        double plan = 0, read = 0, filter = 0, write = 0, total = 0;
    } seconds;
};

/// Reads, filters and writes. `make` sees what is to be filtered. `lies_over` says that a picture with alpha gets a background, or
/// channels of its own.
///
/// notes    a profile that is not sRGB; values that were not finite
/// throws   std::runtime_error for files, and where the output cannot hold alpha; what `make` throws; Stopped. The
///          output appears whole or not at all
PictureReport filter_picture(const PictureFiles& files, bool lies_over, const Context& context,
                             const std::function<PictureFilter(const ImageInfo& in)>& make);

}  // namespace bandlimit::job
