// Filters from file to file, by bands of rows.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/console.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::app {

/// Seconds that each stage worked, and what happened on the way. Stages overlap: their sum may exceed the time that
/// passed.
struct StreamReport {
    double read = 0, filter = 0, write = 0;
    bool lost_non_finite = false;  ///< NaN or infinity became the code 0
};

/// What makes blocks of output rows of source rows, as a Resizer does.
struct RowFilter {
    std::string verb, doing;  ///< "resize", "resizing"
    std::function<IndexRange(int first, int last)> rows_needed;
    std::function<bool(const SourceRows&, const TargetRows&, Parallel)> run;
    /// Of a band, where memory allows it: each band does anew what its first rows share with the last.
    int least_rows = 64;
};

/// Takes all rows of `reader`, whose codes mean `from`, through `filter` into `writer`, where they shall mean `to`.
/// While one band is filtered, the next is read and the last one written, unless `parallel` is one thread. Shows its
/// progress on `console`.
///
/// memory   two bands of source and two of target rows, each 32 MiB or, if that is more, what filter.least_rows output
///          rows take, but at most 192 MiB or what one output row takes; beside them what `filter`, `reader` and
///          `writer` say. Under Edge::wrap the whole source, once
/// throws   what `reader`, `filter` or `writer` throw, after all stages stopped
void stream_rows(const RowFilter& filter, ImageReader& reader, const Encoding& from, ImageWriter& writer,
                 const Encoding& to, const ImageTarget& target, const std::vector<float>& background, Parallel parallel,
                 const Console& console, StreamReport& report);

}  // namespace bandlimit::app
