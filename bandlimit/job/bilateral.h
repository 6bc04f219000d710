// Bilateral filters on picture files.
//
//     job::BilateralJob job;
//     job.files = {"noisy.exr", "smooth.exr"};
//     job.guide = "depth.exr";
//     job.options = {.sigma_space = 2, .sigma_range = {0.02}};
//     job::bilateral(job);
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/filter/bilateral_upsample.h"
#include "bandlimit/job/picture_filter.h"

namespace bandlimit::job {

struct BilateralJob {
    PictureFiles files;
    std::string guide;  ///< a file of the size of the input; empty: the input itself
    std::string
        full_guide;  ///< a file of the size of the output, onto which the input is upsampled; empty: of its own size
    BilateralOptions options{};                        ///< but for premultiply, which `files` says
    UpsampleWindow window = UpsampleWindow::gaussian;  ///< with full_guide
};

struct BilateralReport : PictureReport {
    int radius = 0;          ///< that was used; 0 for a bilinear window
    int guide_channels = 0;  ///< of the guide
    double weights = 0;      ///< per output
};

/// Throws OptionError for what the options alone show to be wrong.
void check(const BilateralJob& job);

/// Filters a file into another, a band of rows at a time. Guides are decoded as files.space says, and kept in memory.
///
/// memory   guides, as floats; beside them that of the filter and of stream_rows()
/// notes    as filter_picture()
/// throws   OptionError as check(), and for a number of sigmas that the guide does not have; std::runtime_error for
///          files, and guides of another size or other channels than each other; Stopped. The output appears whole or
///          not at all
BilateralReport bilateral(const BilateralJob& job, const Context& context = {});

}  // namespace bandlimit::job
