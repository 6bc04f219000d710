// Antialiasing and upscaling over time: samples of many frames, gathered about each output pixel.
//
//     TemporalHistory history(960, 540);                        // of the output; the input may be smaller
//     for (const Rendered& f : frames)
//         accumulate(history, {.color = f.color, .depth = f.depth, .motion = f.motion, .jitter = f.jitter}, options, out);
//
// Conventions, everywhere
//   positions   in pixels, y down; pixel (i, j) of the input holds what the scene shows at
//               (i + 1/2 + jitter.x, j + 1/2 + jitter.y) of the input
//   motion      where a point was in the frame before, minus where it is, in pixels of the input, y down, without the
//               jitter; what is far away (sky) moves too when the camera turns
//   depth       linear, larger is farther
//   colour      linear light; highlights may be far above 1
// Stability: evolving.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// One frame as a renderer makes it. Views may have any strides; an empty one (width 0) is a buffer that there is none
/// of.
struct TemporalFrame {
    View<const float> color = {};   ///< [w x h x 3 or 4]: RGB, and alpha that colour is multiplied by
    View<const float> depth = {};   ///< [w x h]; none: nothing is found to be disoccluded
    View<const float> motion = {};  ///< [w x h x 2]; none: nothing moves
    View<const float> reactive =
        {};  ///< [w x h], 0 to 1: how much history is to be forgotten, as of particles; none: 0
    Point jitter{};
    double exposure = 1;  ///< that `color` was multiplied by; history follows its changes
    bool is_cut = false;  ///< nothing of the frames before is to be used
};

/// How samples and history become the next history.
enum class Accumulation {
    /// h' = h + (r - K h) / W', W' = min(W, most) + K: r is the sum of samples times weights, K that of the weights.
    /// Until W reaches `most` it is the mean over all frames, equal to supersampling by the same kernel; then it is an
    /// exponential mean in which each frame counts as much as it has samples.
    weighted,
    /// h' = h + alpha (r / K - h): every frame is normalised by itself. The limit is wrong, but for equal K.
    per_frame,
    /// h' = h + alpha w (r / K - h), w the largest weight of a sample, and the kernel sized to the input. It blurs.
    input_sized
};
std::string_view name_of(Accumulation rule);

/// How the history is read where it was.
enum class HistoryKernel { bilinear, catmull_rom, catmull_rom5, lanczos2, bspline };
std::string_view name_of(HistoryKernel kernel);

/// What becomes of history that is unlike the samples about the pixel.
enum class Rectification {
    none,
    clamp,     ///< each channel into the range of the 3 x 3 samples
    clip,      ///< towards their mean, until it is inside that range
    variance,  ///< each channel to within `box_size` standard deviations of their mean
};
std::string_view name_of(Rectification rectification);

struct TemporalOptions {
    /// In pixels of the output. Any separable one.
    Kernel kernel = gaussian(0.4385);
    Accumulation rule = Accumulation::weighted;
    double alpha = 0.1;  ///< of the plain rules

    /// How many frames a pixel remembers while it is still: 1 or more. What it brings along is at most that many times
    /// the mean of K.
    double still_frames = 128;
    /// At v output pixels of motion per frame that is divided by 1 + forget_by_motion v: every reprojection blurs.
    double forget_by_motion = 20;

    HistoryKernel history_kernel = HistoryKernel::catmull_rom;
    bool dilates_motion = true;  ///< take the motion of the nearest of 3 x 3 samples: edges move with what is in front

    double depth_tolerance = 0.1;    ///< relative; a history of another depth is of something else
    double disocclusion_keep = 0.5;  ///< the share of its memory that such a history keeps: it may be an edge only

    Rectification rectification = Rectification::variance;
    bool rectifies_ycocg = false;  ///< in luma and chroma rather than RGB
    double box_size = 1.25;        ///< in standard deviations, for `variance`
    /// Of the way into the box, per frame, of what moves and has the right depth; else all of it. What is still is left
    /// alone: of a line that is thinner than a pixel, the samples of a frame about it know nothing.
    double rectify_share = 0.2;
    /// Locks: a sample that is brighter or darker than all about it, as of a thin line, keeps its history from being moved
    /// into the box; where it goes, for about so many frames. 0: none.
    double lock_frames = 0;
    double doubt = 0.02;  ///< how much memory history loses, per standard deviation beyond the box

    /// Compress values v above 1 to 1 + log(v) before they are averaged, and expand the result: otherwise one sample of a
    /// highlight outweighs all others. Values up to 1 do not change; means of brighter ones come out too dark.
    bool compresses_highlights = true;

    /// Anti-flicker: a frame weighs 1 / (1 + anti_flicker d), d the difference of its luma and the history's, divided by
    /// the larger one and 0.2. It steadies what the samples of few frames hit, and pulls the limit towards the history.
    double anti_flicker = 0;
    /// While history is of less than so many frames, the result is held within the range of the four samples about it,
    /// the less the more there is: kernels with negative weights ring until then. The limit is not changed.
    double deringing_frames = 0;
    double sharpening = 0;  ///< 0 to 1, of the result only: history is not sharpened
};

/// Throws Error for a number out of range, as accumulate() does.
void check_options(const TemporalOptions& options);

/// "fast", "balanced", "sharp", "reference" (supersampling over time: remembers all, rejects nothing), and the plain
/// rules "per-frame" and "input-sized", which are there to compare with. Throws Error for another name, listing them.
TemporalOptions temporal_preset(std::string_view name);
std::span<const std::string_view> temporal_presets();

/// What frames before left at each output pixel.
class TemporalHistory {
public:
    /// Throws Error for sizes below 1.
    TemporalHistory(int width, int height);

    int width() const { return now_.sums.width(); }
    int height() const { return now_.sums.height(); }
    /// A copy, which goes its own way: to try what one frame does under several options.
    TemporalHistory clone() const;
    /// Forgets everything.
    void reset() { frames_ = 0; }
    /// How many frames it holds.
    int frames() const { return frames_; }

    /// Red, green, blue and 1, each times the weight of what was gathered: [width x height x 4], interleaved. Highlights
    /// are compressed where the options say so.
    View<const float> sums() const { return now_.sums.view(); }

private:
    friend class TemporalStep;
    friend class TemporalState;  ///< temporal_state.h: what of this is stored

    struct State {
        Image<float> sums;
        Image<float> transparency;  ///< 1 - alpha, times weight; empty while all is opaque
        Image<float> locks;         ///< 0 to 1; empty while the options have none
        Image<float> surface;  ///< depth and motion of the last frame, as rendered [w x h x 4]; empty without depth
    };
    State now_, next_;  ///< the latter is what the former was before, to be written over
    Point jitter_{};
    double exposure_ = 1;
    int frames_ = 0;
};

/// What a step found out, as pictures of the output's size; views that are empty are not filled.
struct TemporalDebug {
    View<float> frame_weight = {};  ///< K: the weights of this frame's samples
    View<float> memory = {};        ///< W after this frame
    View<float> rejection = {};     ///< how far history was moved by rectification, in its units
    View<float> motion = {};        ///< [w x h x 2] that was used, in output pixels
    View<float> disocclusion = {};  ///< 1 where depth says that history is of something else, or it lies outside
};

/// Takes one frame into the history, and writes what it shows then.
///
/// shapes   frame.color of any size up to the output's; `out` [width x height x 3 or 4]
/// range    any; samples that are not finite are left out
/// memory   besides the history: a few rows per thread
/// cost     docs/temporal.md
/// throws   Error for shapes that do not fit, jitter beyond a pixel, and options out of range; Stopped, after which the
///          history is as before
void accumulate(TemporalHistory& history, const TemporalFrame& frame, const TemporalOptions& options, View<float> out,
                const Parallel& parallel = {}, const TemporalDebug& debug = {});

}  // namespace bandlimit
