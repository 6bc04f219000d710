// Antialiasing and upscaling over time, from a folder of frames or a scene to a folder of frames.
//
//     job::TemporalJob taa{.input = "render", .out = "smooth"};
//     taa.sequence.meta = "render/meta.json";
//     taa.reference = "truth";
//     job::temporal(taa).frames.back().psnr;
// Stability: evolving.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/job/context.h"
#include "bandlimit/job/frame_sequence.h"
#include "bandlimit/sampling/sequence.h"

namespace bandlimit::job {

struct TemporalJob {
    std::string input;  ///< a folder of EXR files, or a name of scene_names()
    std::string out;    ///< a folder, which is made if it does not exist; files are named like those of the input
    double scale = 1;   ///< of the output against the input, 1 to 4
    std::string preset = "balanced";  ///< names `options`, for reports
    TemporalOptions options = {};
    int frames = 0;  ///< 0: all of a folder, one period of the jitter of a scene, and at least 16

    SequenceJob sequence = {};               ///< how to read a folder, whose name may be left empty here
    int width = 0, height = 0;               ///< of a scene: the input's size
    JitterKind jitter = JitterKind::halton;  ///< of a scene

    /// A folder of EXR files of the output's size, in pairs with the frames by the numbers in their names; empty: none.
    /// The truth of a scene is supersampled.
    std::string reference = {};
    bool measures = false;  ///< measure against the truth: for a folder where there is a reference
};

/// One frame of the output, against the truth: both in linear light, clamped to [0, 1].
struct TemporalFrameReport {
    int number = 0;
    std::string file;
    std::optional<double> psnr, ssim;  ///< none without a truth
    double ms = 0;                     ///< of accumulate() alone
};

struct TemporalReport {
    int in_width = 0, in_height = 0, width = 0, height = 0;
    std::string conventions;  ///< "blender"; "scene" for scenes
    int jitter_length = 0;    ///< after how many frames it repeats; 0 if unknown
    double mip_bias = 0;      ///< that textures should have been sampled with: -log2(scale)
    std::vector<TemporalFrameReport> frames;
    double seconds = 0;
};

/// Throws OptionError or Error for what the options alone show to be wrong.
void check(const TemporalJob& job);

/// Reads or renders frame after frame, accumulates, and writes what the history shows.
///
/// memory   the history, one frame of input and output, and the truth
/// throws   OptionError as check(); std::runtime_error for files; Stopped. Each file appears whole or not at all
TemporalReport temporal(const TemporalJob& job, const Context& context = {});

}  // namespace bandlimit::job
