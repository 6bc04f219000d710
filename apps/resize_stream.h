// Resizing from file to file, by bands of rows.
#pragma once
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {

/// Seconds spent, and what happened on the way.
struct StreamReport {
    double read = 0, filter = 0, write = 0;
    bool lost_non_finite = false;  ///< NaN or infinity became the code 0
};

/// Resizes all rows of `reader`, whose codes mean `from`, into `writer`, where they shall mean `to`. Memory: a few tens
/// of MiB, or the rows that a few output rows need, if that is more; under Edge::wrap the whole source.
void stream_resize(const Resizer& resizer, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                   const Encoding& to, const ImageTarget& target, const std::vector<float>& background,
                   Parallel parallel, StreamReport& report);

}  // namespace bandlimit::app
