// Antialiasing and upscaling over time, from a folder of frames or a scene to a folder of frames.
//
//     job::TemporalJob taa{.input = "render", .out = "smooth"};
//     taa.sequence.meta = "render/meta.json";
//     taa.reference = "truth";
//     job::temporal(taa).frames.back().psnr;
// Stability: evolving.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/antialias/temporal_measures.h"
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
    /// Measure against the truth (for a folder, where there is a reference), and keep what shows how it went: the
    /// members of TemporalReport from `measured_frames` on.
    bool measures = false;
};

/// One frame of the output, against the truth: both in linear light, clamped to [0, 1].
struct TemporalFrameReport {
    int number = 0;
    std::string file;
    std::optional<double> psnr, ssim;  ///< none without a truth
    double ms = 0;                     ///< of accumulate() alone
};

/// What the last frame found out, of the output's size: TemporalDebug.
struct TemporalViews {
    Image<float> frame_weight, memory, rejection, motion, disocclusion;
};

struct TemporalReport {
    int in_width = 0, in_height = 0, width = 0, height = 0;
    std::string conventions;  ///< "blender"; "scene" for scenes
    int jitter_length = 0;    ///< after how many frames it repeats; 0 if unknown
    double mip_bias = 0;      ///< that textures should have been sampled with: -log2(scale)
    std::vector<TemporalFrameReport> frames;
    double seconds = 0;
    /// How many frames were there already, made by a run with the same options that ended before its time.
    int continued_at = 0;

    /// The last frames, after which the others had filled the history: those of the last period of the jitter, at most
    /// half of all. `measured` is of these, without a truth of what needs none.
    int measured_frames = 0;
    TemporalMeasures measured;
    /// energy_above_half_nyquist() of the last frame and its truth.
    std::optional<double> high_frequencies, high_frequencies_of_truth;
    TemporalViews views;
    /// 8-bit sRGB codes, input, output and truth beside each other: frames in motion, and some of all, one below the
    /// other, in columns for the frames `sheet_frames`.
    std::vector<Image<std::uint8_t>> animation;
    Image<std::uint8_t> sheet;
    std::vector<int> sheet_frames;
};

/// Throws OptionError or Error for what the options alone show to be wrong.
void check(const TemporalJob& job);

/// Reads or renders frame after frame, accumulates, and writes what the history shows.
///
/// A file .bandlimit-temporal in `out` holds where the run is, until it is complete: however it ends before, by an
/// error, a signal or Stopped, the next run with the same options goes on after the last frame that was written, with
/// the same results. Files that changed since, options or another version make it begin again.
/// memory   the history, one frame of input and output, and the truth; for measures a third more, and up to 64 MB
/// throws   OptionError as check(); std::runtime_error for files; Stopped. Each file appears whole or not at all
TemporalReport temporal(const TemporalJob& job, const Context& context = {});

}  // namespace bandlimit::job
