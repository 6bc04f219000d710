// How far two picture files are apart, and by how much they are shifted.
//
//     const job::CompareReport report = job::compare({.a = "before.png", .b = "after.png"});
//     report.metrics.psnr();
// Stability: evolving.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/analysis/shift.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"

namespace bandlimit::job {

/// What is compared. White is 1.
enum class Measure {
    encoded,  ///< codes, divided by the largest; linear floats are sRGB-encoded for it
    linear    ///< linear light
};

struct CompareJob {
    std::string a, b;
    std::string diff{};  ///< if not empty: a file to write |A - B| to, as linear codes, without alpha
    int border = 0;      ///< pixels to leave out on every side
    Space space = Space::automatic;
    std::optional<Measure> measure{};  ///< default: encoded where both files hold integers, else linear
};

struct CompareReport {
    ImageInfo info;  ///< of A; B has the same size and number of channels
    Measure measure = Measure::encoded;
    Metrics metrics;
    Shift shift;  ///< above 0 where the content of B lies right of or below A's
};

/// Compares two files, a few rows at a time.
///
/// The shift of sRGB files is estimated from codes and from linear light: filters move edges if one looks at their
/// results through another transfer function than they ran in, since bright sides grow. The estimate that leaves less
/// unexplained counts.
///
/// memory   a few rows, and the window of estimate_shift()
/// throws   std::runtime_error for files, for sizes or channels that differ, and for a border that leaves nothing;
///          Stopped
CompareReport compare(const CompareJob& job, const Context& context = {});

}  // namespace bandlimit::job
