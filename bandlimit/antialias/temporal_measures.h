// How well pictures over time hold still, follow motion and stay sharp.
//
//     TemporalMeter meter(960, 540);
//     for (...) {
//         accumulate(history, frame, options, out, {}, {.motion = motion, .disocclusion = disocclusion});
//         if (is_settled) meter.add({.shown = out, .truth = truth, .motion = motion, .disocclusion = disocclusion});
//     }
//     meter.measures().flicker;
//
// Codes are sRGB, from 0 to 1, clamped: what a display shows. 1/255 is one code of 8 bits.
// Stability: evolving.
#pragma once
#include <optional>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

/// A frame that was made, and what is known of it. Views that are empty are not known.
struct ShownFrame {
    View<const float> shown = {};         ///< [w x h x 3 or more] linear light; what is beyond RGB is ignored
    View<const float> truth = {};         ///< the same, as it should be
    View<const float> motion = {};        ///< [w x h x 2] to where it was in the frame before; none: nothing moves
    View<const float> disocclusion = {};  ///< [w x h] 1 where the frame before showed something else; none: nowhere
};

/// None: cannot be known of the frames there were.
struct TemporalMeasures {
    /// In codes: the standard deviation over the frames, mean over the pixels that never moved and their channels.
    std::optional<double> flicker;
    double still = 0;  ///< the share of such pixels
    /// In codes: mean |difference| of each pixel to where it was in the frame before, but for what was not seen then.
    std::optional<double> warped_difference;
    /// Root mean square error against the truth, in linear light clamped to [0, 1]: of pixels that the frame before did
    /// not see, where what was there before shows through, and of all others.
    std::optional<double> error_disoccluded, error_elsewhere;
};

/// Measures frames that follow each other, and that should start when history has filled.
/// memory   11 floats per pixel
class TemporalMeter {
public:
    /// Throws Error for sizes below 1.
    TemporalMeter(int width, int height);
    /// Takes the next frame. Results have the same bits for any number of threads.
    /// throws   Error for shapes that do not fit
    void add(const ShownFrame& frame, const Parallel& parallel = {});
    TemporalMeasures measures() const;
    int frames() const { return frames_; }

private:
    friend class TemporalState;
    struct RowSums;
    void add_row(const ShownFrame& frame, int y, RowSums& sums);
    void compare_to_before(const ShownFrame& frame, int y, RowSums& sums) const;

    Image<float> mean_, spread_;  ///< of the codes so far, and the sum of squares about it [w x h x 3]
    Image<float> before_, now_;   ///< codes of the last two frames [w x h x 3]
    Image<float> moved_;          ///< 1 where anything ever moved [w x h]
    int frames_ = 0;
    /// Sums of squares and differences, and of how many samples.
    double warped_ = 0, warped_count_ = 0, disoccluded_ = 0, disoccluded_count_ = 0, elsewhere_ = 0,
           elsewhere_count_ = 0;
};

/// The share of a picture's energy, its mean left out, that lies above half of Nyquist's frequency: 0.25 cycles per
/// pixel, clamped to [0, 1] in linear light. That of the truth divides it for a measure of sharpness: below 1 is blur,
/// above 1 sharpening or noise.
/// throws   Error for an empty picture
double energy_above_half_nyquist(View<const float> linear);

}  // namespace bandlimit
