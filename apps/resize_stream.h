// Resizing from file to file, by bands of rows.
#pragma once
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {

/// Seconds that each stage worked, and what happened on the way. Stages overlap: their sum may exceed the time that
/// passed.
struct StreamReport {
    double read = 0, filter = 0, write = 0;
    bool lost_non_finite = false;  ///< NaN or infinity became the code 0
};

/// Resizes all rows of `reader`, whose codes mean `from`, into `writer`, where they shall mean `to`. While one band is
/// filtered, the next is read and the last one written, unless `parallel` is one thread.
///
/// memory   two bands of source and two of target rows, each 32 MiB or, if that is more, what 64 output rows take,
///          but at most 192 MiB or what one output row takes; beside them what `resizer`, `reader` and `writer` say.
///          Under Edge::wrap the whole source, once
/// throws   what `reader`, `resizer` or `writer` throw, after all stages stopped
void stream_resize(const Resizer& resizer, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                   const Encoding& to, const ImageTarget& target, const std::vector<float>& background,
                   Parallel parallel, StreamReport& report);

}  // namespace bandlimit::app
