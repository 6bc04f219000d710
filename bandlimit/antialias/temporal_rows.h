// The loops of temporal antialiasing over a row: what is known of the samples of a frame, and the step of the history.
// temporal.cpp decides which rows, and by which threads.
// Stability: inner.
#pragma once
#include <span>

#include "bandlimit/antialias/frame_gather.h"
#include "bandlimit/antialias/history_weights.h"
#include "bandlimit/antialias/temporal.h"

namespace bandlimit {

constexpr float velocity_tolerance = 0.5f;  ///< input pixels per frame
constexpr float still_motion = 0.01f;       ///< the same; less is no motion
constexpr float full_doubt_speed = 0.1f;    ///< output pixels per frame; what is slower is doubted less
constexpr float least_extent = 0.02f;       ///< of a box, when something is measured by it
constexpr float alike_luma = 1.1f;          ///< the ratio of lumas up to which samples are of the same thing,
constexpr float alike_noise = 0.02f;        ///< or this difference
constexpr float least_luma = 0.2f;          ///< when a difference of lumas is measured by one

/// A frame on its way into the history: all of it, for every row. Rows of four floats a pixel are [4 x width] floats.
struct TemporalPass {
    const TemporalFrame& frame;
    const TemporalOptions& options;
    const FrameGather& gather;
    std::span<const CubicPart> history_weights;

    /// Of the history, as it is and as it becomes; what there is none of has width 0. `transparency` is 1 - alpha, times
    /// weight; `surface` [w x h x 4] depth and motion as rendered, in input pixels.
    View<const float> sums = {}, transparency = {}, locks = {}, surface = {};
    View<float> next_sums = {}, next_transparency = {}, next_locks = {}, next_surface = {};
    Point surface_jitter{};
    double surface_exposure = 1;
    View<float> out = {};
    TemporalDebug debug = {};

    float least_weight = 0;   ///< what may be divided by
    float enough_weight = 0;  ///< what is shown alone
};

/// Rows of the frame, the first of which is `first`, made by finite_row().
struct FiniteRows {
    const float* samples = nullptr;
    int width = 0, first = 0, count = 0;
    const float* row(int y) const { return samples + std::ptrdiff_t(4) * width * (y - first); }
};

/// Row y of the frame: red, green, blue and transparency (0 in frames without alpha). Samples that are not finite become
/// the mean of the finite ones about them, or 0; highlights are compressed where the options say so.
void finite_row(const TemporalPass& pass, int y, float* to);

/// For every sample of row y: motion in input pixels and depth of the nearest of 3 x 3 samples, or of itself; then its
/// own depth.
void guide_row(const TemporalPass& pass, int y, float* to);

/// Depth and motion of row y, for the next frame.
void keep_surface_row(const TemporalPass& pass, int y);

/// For every sample of row y, of the colours of 3 x 3 samples, in YCoCg where the options say so: the centre, then the
/// half extent (of their range, or their mean and standard deviation). [8 x width]
void box_row(const TemporalPass& pass, const FiniteRows& rows, int y, float* to);

/// What step_row() reads of the frame.
struct TemporalLine {
    int y = 0;                        ///< of the output
    const float* gathered = nullptr;  ///< the weighted samples about each output pixel
    int near_y = 0;                   ///< the nearest input row
    const float* guide = nullptr;     ///< guide_row() of the nearest input row
    const float* box = nullptr;       ///< box_row() of it; none where nothing is rectified
    FiniteRows rows = {};             ///< at least those about it
};

/// Takes a row of samples into the history, and shows it.
void step_row(const TemporalPass& pass, const TemporalLine& line);

/// Compresses what is above 1, so that means of highlights and what is about them look like means of what a display
/// shows: the colour is scaled so that its largest channel v becomes 1 + log(v).
void compress_highlight(float* rgb);
/// The way back.
void restore_highlight(float* rgb);

}  // namespace bandlimit
