// Guided filters on picture files.
//
//     job::GuidedJob job;
//     job.files = {"occlusion.exr", "smooth.exr", Space::data};
//     job.guide = "depth.exr";
//     job.options = {.radius = 8, .epsilon = 1e-3};
//     job::guided(job);
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/filter/local_models.h"
#include "bandlimit/job/picture_filter.h"

namespace bandlimit::job {

struct GuidedJob {
    PictureFiles files;
    std::string guide;             ///< a file of the size of the input; decoded as files.space says
    std::string full_guide = {};   ///< of any size, which the output gets: models are applied to it. Empty: `guide`
    std::string save_models = {};  ///< an EXR file for the models, as local_models_file.h has them; empty: none
    LocalModelOptions options = {};
};

struct GuidedReport : PictureReport {
    int guide_channels = 0;  ///< but alpha, which guides where files.space is data alone
    int terms = 0;           ///< of the models of each channel
};

/// Throws OptionError for what the options alone show to be wrong.
void check(const GuidedJob& job);

/// Filters a file into another.
///
/// memory   the pictures as floats, and with another guide, averages or saved models, the coefficients
/// notes    as filter_picture()
/// throws   OptionError as check(), and for more guides than models can have; std::runtime_error for files, and guides of
///          another size or other channels than each other; Stopped. The output appears whole or not at all
GuidedReport guided(const GuidedJob& job, const Context& context = {});

}  // namespace bandlimit::job
