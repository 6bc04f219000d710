// Designs as shader source.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/io/taps_json.h"
#include "bandlimit/shader/shader.h"

namespace bandlimit::app {

/// Of the disc that phasors stand for, in pixels, where nobody says otherwise.
constexpr double usual_disk_radius = 25;

/// The files of `design` in one dialect: functions first, then whole compute shaders. Terms are scaled
/// to a sum of 1; phasors without terms become those of usual_disk_radius.
///
/// throws   UsageError for a design without anything that a shader could run
std::vector<ShaderFile> shaders_of(const TapsFile& design, const ShaderInfo& info, Dialect dialect);

/// Writes the files of `design` in these dialects to `directory`, each whole or not at all.
///
/// returns  their names
/// throws   as above, and std::runtime_error for a directory that is none or cannot be written
std::vector<std::string> write_shaders(const TapsFile& design, const ShaderInfo& info,
                                       const std::vector<Dialect>& dialects, const std::string& directory);

}  // namespace bandlimit::app
