// What the numbers of motion buffers and jitter mean: renderers agree on nothing.
//
//     MotionConvention unity = convention_called("unity");
//     Point motion = unity.motion_of({0.01, -0.02}, 1920, 1080);  // previous minus current, in pixels, y down
// Stability: evolving.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/core/point.h"

namespace bandlimit::job {

/// How files say where things were, and where a frame was sampled. The conventions of antialias/temporal.h are the
/// default ones.
struct MotionConvention {
    enum class Units {
        pixels,
        uv,  ///< 1 is the width or height of the picture
        ndc  ///< 2 is
    };
    enum class JitterSign {
        plus,   ///< pixels show the scene at their middle plus the jitter
        minus,  ///< minus the jitter: it moves the picture, not the samples
        none    ///< pixels show the scene at their middle
    };
    Units units = Units::pixels;
    bool is_previous_minus_current = true;  ///< else current minus previous
    bool is_y_up = false;
    bool are_axes_swapped = false;  ///< the first channel is the motion along y
    bool includes_jitter = false;   ///< a point that rests moves by the difference of two frames' jitter
    JitterSign jitter_sign = JitterSign::plus;
    bool is_jitter_y_up = false;

    friend bool operator==(const MotionConvention&, const MotionConvention&) = default;

    /// A stored vector in pixels of width x height, previous minus current, y down; with the jitter, where it includes
    /// that.
    Point motion_of(Point stored, int width, int height) const;
    /// A stored jitter as where pixels are sampled: from their middle, in pixels, y down.
    Point jitter_of(Point stored) const;
};

/// "auto", which stands for a choice by the names of channels, and the names of conventions.
std::vector<std::string_view> convention_names();

/// A convention by its name, and the layer in which files by it have the motion.
struct NamedConvention {
    std::string_view name;
    MotionConvention motion;
    std::string_view motion_channel;
};
/// throws   OptionError for an unknown name, listing the others
const NamedConvention& convention_called(std::string_view name);

/// An option of `bandlimit temporal` and its value: "motion-y" and "down".
struct ConventionSetting {
    std::string_view option, value;
};
/// All that a convention says.
std::vector<ConventionSetting> settings_of(const MotionConvention& convention);
/// The options that turn one reading into another, as "--motion-y down".
std::vector<std::string> flags_between(const MotionConvention& from, const MotionConvention& to);

}  // namespace bandlimit::job
