// One frame of temporal antialiasing as shader source to paste: what accumulate() does, by the same options.
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/shader/shader.h"

namespace bandlimit {

/// Functions for a pass over the pixels of the result, none of which needs a sampler:
///
///     NAME_step(color, surface, history, surface_before, frame, at)   the next history at pixel `at`, to be stored as
///                                                                     32-bit floats
///     NAME_show(color, frame, sums, at)                               the pixel that such sums show, linear light
///     NAME_sharpen(shown, frame, at)                                  the shown picture sharpened, in a pass of its own
///
/// `frame` is a structure of sizes, jitter, exposure and whether there is a history. The text says what each of its
/// members and each texture holds. What the options do not ask for is left out of it: surface_before is a parameter only
/// if depths are compared, NAME_sharpen is there only if the options sharpen.
///
/// range    opaque frames of finite values: alpha is not read, and nothing replaces what is not finite
/// error    against accumulate(): roundings, those of exp and log on the device, and of the kernel's weights 1e-7 of
///          their peak, since a kernel that is not a Gaussian becomes polynomials
/// cost     reads, as the comment says: of `balanced` at 1x about 12 + 9 of the frame, 9 + 5 of surfaces, 16 of the
///          history
/// throws   Error for rules other than Accumulation::weighted, as accumulate() for options and kernels, for a kernel
///          that is rougher than polynomials can follow, and for names as all shaders
/// example  temporal_shader(temporal_preset("balanced"), {.name = "temporal"}, Dialect::glsl)
std::string temporal_shader(const TemporalOptions& options, const ShaderInfo& info, Dialect dialect);

}  // namespace bandlimit
