// What the signals check of their options.
// Stability: inner.
#pragma once
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// Throws Error unless low <= value <= high; `help` says what to pass.
inline void check_option(const char* function, const char* option, double value, double low, double high,
                         const char* help) {
    if (!(value >= low && value <= high)) fail(function, ": ", option, " = ", value, "; pass ", help);
}

constexpr double largest_position = 4e9;  ///< pixels; keeps phases within some 1e-6 of a period
constexpr double smallest_length = 1e-2;  ///< pixels; below it a pixel would hold too many periods to add up

inline void check_position(const char* function, const char* option, double value) {
    check_option(function, option, value, -largest_position, largest_position, "a number of at most 4e9");
}
inline void check_length(const char* function, const char* option, double value) {
    check_option(function, option, value, smallest_length, largest_position, "0.01 to 4e9 pixels");
}
inline void check_phase(const char* function, double phase) { check_position(function, "phase", phase); }
inline void check_angle(const char* function, double angle) { check_position(function, "angle", angle); }
inline void check_frame(const char* function, const Frame& frame) {
    check_length(function, "frame.width", frame.width);
    check_length(function, "frame.height", frame.height);
}

inline Point middle(const Frame& frame) { return {frame.width / 2, frame.height / 2}; }

inline Point center_of(const char* function, const std::optional<Point>& center, const Frame& frame) {
    check_frame(function, frame);
    const Point at = center.value_or(middle(frame));
    check_position(function, "center.x", at.x);
    check_position(function, "center.y", at.y);
    return at;
}

inline double radius_of(const char* function, const std::optional<double>& radius, double otherwise) {
    const double r = radius.value_or(otherwise);
    check_length(function, "radius", r);
    return r;
}

}  // namespace bandlimit
