// The members of TemporalOptions by name, for command lines, reports and user interfaces.
//
//     TemporalOptions options = temporal_preset("balanced");
//     set_option(options, "history-kernel", "lanczos2");
// Stability: evolving.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "bandlimit/antialias/temporal.h"

namespace bandlimit {

/// A member of TemporalOptions.
struct TemporalOptionInfo {
    std::string_view name;     ///< "still-frames"
    std::string_view values;   ///< "a number from 1", "yes or no", "none, clamp, clip or variance"
    std::string_view meaning;  ///< half a sentence
};
std::span<const TemporalOptionInfo> temporal_option_infos();

/// The value of a member as set_option() reads it: "128", "inf", "yes", "catmull-rom".
/// throws   Error for an unknown name, listing all
std::string option_value(const TemporalOptions& options, std::string_view name);

/// Sets a member from text.
/// throws   Error for an unknown name, listing all, and for a value that it cannot have
void set_option(TemporalOptions& options, std::string_view name, std::string_view value);

}  // namespace bandlimit
