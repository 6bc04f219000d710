// Making a texture of one picture row by row, from file to file.
// Stability: inner.
#pragma once
#include <functional>
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/texture/container.h"
#include "bandlimit/texture/mips.h"

namespace bandlimit::job {

/// Seconds that each stage worked, which overlap, and what happened on the way.
struct MipsStreamReport {
    double read = 0, filter = 0, write = 0;
    bool lost_non_finite = false;  ///< NaN or infinity became the code 0
};

/// Makes the levels of the picture in `reader`, whose codes mean `stored`, where MipStream::is_possible(), and writes
/// them to `path` as `container`, an array of one layer or none, and reports its progress
/// as "mips". While rows are filtered, the next are read, unless `parallel` is one thread.
///
/// memory   some 500 rows of the picture and 200 of each level as floats: 200 MB where it is 65536 texels wide; all
///          rows of all levels under Edge::wrap along y
/// throws   what reader, MipStream and AtomicFile throw. The file appears whole or not at all
MipsStreamReport stream_texture(ImageReader& reader, const Encoding& stored, const TexelFormat& texels,
                                const MipOptions& options, bool is_array, const std::string& path, Container container,
                                const Parallel& parallel, const std::function<void(const Progress&)>& progress);

}  // namespace bandlimit::job
