// Pictures that are drawn into a file, a band of rows at a time.
// Stability: inner.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"

namespace bandlimit::job {

struct Drawing {
    std::string out;
    ImageTarget target = {};
    std::uint64_t bytes = 0;        ///< that drawing a band takes
    std::uint64_t band_pixels = 0;  ///< of a band, about: at least a row is drawn
    /// Draws rows [y, y + height of stored) into `stored`, in the encoding of the file.
    std::function<void(int y, const AnyView& stored, const Encoding& encoding, Parallel parallel)> draw = {};
};

struct DrawingSeconds {
    double rendering = 0, writing = 0;
};

/// Writes the file: one band is written while the next is drawn.
/// throws  std::runtime_error for files, and for memory that is not there; Stopped
DrawingSeconds draw_picture(const Drawing& drawing, const Context& context);

/// The height of its bands.
int band_rows(const Drawing& drawing);

}  // namespace bandlimit::job
