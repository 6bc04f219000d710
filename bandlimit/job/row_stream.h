// Filters from file to file, by bands of rows.
// Stability: evolving.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/resample/row_filter.h"

namespace bandlimit::job {

/// Seconds that each stage worked, and what happened on the way. Stages overlap: their sum may exceed the time that
/// passed.
struct StreamReport {
    double read = 0, filter = 0, write = 0;
    bool lost_non_finite = false;  ///< NaN or infinity became the code 0
};

/// A filter of pictures, ready to run.
struct PictureFilter {
    RowFilter rows;
    std::string doing;                   ///< "resizing": for progress and errors
    std::vector<float> background = {};  ///< in linear light; if not empty, the picture is laid over it and loses alpha
    /// Of a band, where memory allows it: each band does anew what its first rows share with the last.
    int least_rows = 64;
    /// Of the output, where they are not those of the input; none of them is alpha.
    std::vector<std::string> channel_names = {};
    bool makes_data = false;  ///< what comes out is no colour: it is stored as it is
};

/// Takes all rows of `reader`, whose codes mean `from`, through `filter` into `writer`, where they shall mean `to`.
/// While one band is filtered, the next is read and the last one written, unless `stages`, the threads for it, is one.
/// Tells `context` how many rows are written.
///
/// memory   two bands of source and two of target rows, each 32 MiB or, if that is more, what filter.least_rows output
///          rows take, but at most 192 MiB or what one output row takes; beside them what `filter`, `reader` and
///          `writer` say. Under Edge::wrap the whole source, once
/// throws   what `reader`, `filter` or `writer` throw, after all stages stopped; Stopped
void stream_rows(const PictureFilter& filter, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                 const Encoding& to, const ImageTarget& target, const Parallel& stages, const Context& context,
                 StreamReport& report);

}  // namespace bandlimit::job
