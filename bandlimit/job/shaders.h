// Designs and kernels as shader source.
// Stability: evolving.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/io/taps_json.h"
#include "bandlimit/shader/shader.h"

namespace bandlimit::job {

/// Radius in pixels of the disc that phasors stand for, unless the caller gives one.
constexpr double usual_disk_radius = 25;

/// The files of `design` in one dialect: functions first, then whole compute shaders. Terms are scaled to a sum of 1;
/// phasors without terms are expanded to terms for usual_disk_radius.
///
/// throws   Error for a design that no shader can run
/// example  emit_shaders(read_taps("blur.json"), {.name = "blur"}, Dialect::glsl).front().text
std::vector<ShaderFile> emit_shaders(const TapsFile& design, const ShaderInfo& info, Dialect dialect);

/// Writes the files of `design` in these dialects to `directory`, each whole or not at all.
///
/// returns  their names
/// throws   as emit_shaders(), and std::runtime_error if `directory` is not a directory or cannot be written to
std::vector<std::string> write_shaders(const TapsFile& design, const ShaderInfo& info,
                                       const std::vector<Dialect>& dialects, const std::string& directory);

/// The shader functions for `name`, a kernel or one of kernel_shaders(): names that kernel_shader() takes.
///
/// throws   Error as parse_kernel(), and for a kernel without shaders
std::vector<std::string_view> kernel_shader_names(const std::string& name);

}  // namespace bandlimit::job
