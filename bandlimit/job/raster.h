// Scenes of shapes as picture files.
//
//     job::RasterJob wheel{.scene = "wheel.json", .out = "wheel.png"};
//     job::raster(wheel);
// Stability: evolving.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bandlimit/color/depth.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/context.h"

namespace bandlimit::job {

struct RasterJob {
    std::string scene;     ///< a JSON file, as in raster_scene.h
    std::string out;       ///< the extension names the format
    std::string filter{};  ///< instead of the scene's, as raster_filter() reads it
    /// Above 0, draws the truth by so many samples per axis of each pixel, 1 to 64, through the same filter.
    int truth = 0;
    /// Above 0, draws both, writes the prefiltered picture, and measures how far it is from that truth.
    int compare = 0;
    std::optional<Depth> depth{};    ///< default: f32 for formats of linear light, else u8
    Space space = Space::automatic;  ///< what codes shall mean
    int tile = 0;                    ///< as ImageTarget
};

struct RasterReport {
    int width = 0, height = 0, channels = 0;
    std::size_t shapes = 0;
    std::string filter;
    Depth depth = Depth::u8;
    Transfer transfer = Transfer::linear;
    std::optional<double> rms{}, max_abs{};  ///< from the truth in linear light, over all channels, where compared
    double seconds_reading = 0, seconds_preparing = 0, seconds_drawing = 0, seconds_truth = 0, seconds_writing = 0;
};

/// Throws Error for what the options alone show to be wrong.
void check(const RasterJob& job);

/// Draws a scene into a file, a band of rows at a time.
///
/// memory   some 300 bytes per shape and point; bands of a million pixels; what Rasterizer takes
/// throws   OptionError for options; std::runtime_error for files, with the line of the scene that is wrong; Stopped.
///          The file appears whole or not at all
RasterReport raster(const RasterJob& job, const Context& context = {});

}  // namespace bandlimit::job
