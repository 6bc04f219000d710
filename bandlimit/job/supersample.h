// Scenes, supersampled into picture files, and what a pattern and a kernel do to edges, aliases and noise.
//
//     job::supersample({.scene = "plane", .width = 480, .height = 270, .out = "plane.exr"});
// Stability: evolving.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/antialias/mixed_resolution.h"
#include "bandlimit/antialias/supersample.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"
#include "bandlimit/sampling/pattern_analysis.h"

namespace bandlimit::job {

struct SupersampleJob {
    std::string scene;  ///< of scene_names()
    int width = 0, height = 0;
    int frame = 0;
    std::string out{};  ///< the extension names the format; RGBA, or RGB where there is no alpha
    SupersampleOptions options = {};
    std::optional<MixedMode> mixed = {};  ///< instead of the pattern: half of the samples, rebuilt by the kernel
    std::optional<Depth> depth = {};      ///< default: f32 for formats of linear light, else u8
};

struct SupersampleSummary {
    double samples_per_pixel = 0;
    double mean_luma = 0;  ///< of the result, linear
    double seconds = 0;    ///< rendering, resolving and writing
};

/// Throws what the options alone show to be wrong.
void check(const SupersampleJob& job);

/// Draws a frame of a scene into a file, a few rows at a time; of mixed resolutions, the whole image.
/// throws   Error for options as check(); std::runtime_error for files; Stopped. The file appears whole or not at all
SupersampleSummary supersample(const SupersampleJob& job, const Context& context = {});

// ---- What patterns and kernels do

/// The PSNR in dB, 1 for white, of a few parts of the image against 256 samples of a grid with the same kernel, and
/// without tone weights.
struct PsnrOfCount {
    int samples = 0;
    double psnr = 0;  ///< infinite if nothing differs
};

/// The RMS error of half of the samples on a zone plate of 64 x 64 pixels, whose centre is that of a pixel, where its
/// frequency is below .35 cycles per pixel.
struct MixedError {
    MixedMode mode = MixedMode::full;
    std::string kernel;
    double rmse = 0;
};

/// The RMS error of a slanted outline with fine stripes inside, against 1024 samples a pixel, box.
struct ShadingError {
    std::string shading;       ///< "multisample" or "supersample"
    bool is_filtered = false;  ///< shading averages its footprint first, as mip maps do
    double rmse = 0;
};

struct ResolveReport {
    std::vector<EdgeSweep> edges;  ///< of the pattern, every 5 degrees from -90 to 85
    double alias_energy = 0;       ///< see alias_energy()
    std::vector<PsnrOfCount> counts;
    std::optional<double> tone_bias;  ///< with a tone weight: how much darker it makes these parts; -0.1 is 10 %
    std::vector<MixedError> mixed;
    std::vector<ShadingError> shading;
};

/// Of the energy of a zone plate beyond Nyquist's frequency, the share that a resolve leaves as aliases: the mean square
/// around 1/2 where the plate's frequency along x or y is 1/2 to 2 cycles per pixel, divided by that of the plate, 1/8.
/// 1 for one sample and no filter.
double alias_energy(const SupersampleOptions& options, const Parallel& parallel = {});

/// Each way of leaving out half of the samples, with tent, catmull-rom and lanczos3, and with `kernel` if it is another.
std::vector<MixedError> mixed_errors(const Kernel& kernel = tent(), const Parallel& parallel = {});

/// Multisampling and supersampling by a pattern, each as it is and filtered first.
std::vector<ShadingError> shading_errors(const SamplePattern& pattern, const Parallel& parallel = {});

/// All of the above for a job's pattern, kernel and scene. A few seconds for slow scenes.
/// throws   as supersample()
ResolveReport report_on(const SupersampleJob& job, const Context& context = {});

}  // namespace bandlimit::job
