// Named kernels as shader functions that read a texture anywhere between its texels: for enlarging, turning, warping.
// Stability: evolving.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "bandlimit/kernel/piecewise.h"
#include "bandlimit/shader/shader.h"

namespace bandlimit {

/// A function that is emitted verbatim.
struct KernelShader {
    std::string_view name;     ///< of the function, and of its file
    std::string_view kernel;   ///< whose weights it has, as parse_kernel() reads it; none for functions of colours
    std::string_view summary;  ///< what it is, in a line
    std::string_view cost;
};

/// sample_bspline (4 reads) and sample_bspline_1d (2), sample_catmull_rom (9) and sample_catmull_rom_5,
/// sample_mitchell, sample_lanczos2, sample_quadratic (4), sample_quadratic_interp, sample_jinc2 by a table, and srgb.
std::span<const KernelShader> kernel_shaders();

/// The text of one of them, by its `name`; `command` made it.
///
/// The sampler must be linear. Weights are normalised to sum 1 wherever the kernel's own do not. Edges are the
/// sampler's. sample_bspline_1d has a parameter more, the axis along which it filters: (1, 0) or (0, 1). srgb is
/// srgb_from_linear(colour) and linear_from_srgb(colour), the exact curve in two pieces, which leave alpha as it is.
///
/// error    of the weights: 3e-7 from rounding; sample_jinc2 1e-4 of the largest from its table
/// throws   Error for another name
std::string kernel_shader(std::string_view name, const std::string& command, Dialect dialect);

/// A kernel of polynomial pieces: NAME(source, sampler, uv, texel), which weights the texels around uv by
/// NAME_weight(distance) along each axis, and divides by the sum of these weights.
///
/// error    of the weights: about 1e-6 from rounding
/// cost     a read per texel under the kernel, (2 ceil(radius))^2, and as many weights, of a polynomial per piece each
/// throws   Error as piecewise_kernel(), for a radius over 16, and for a name that is not an identifier
std::string pieces_shader(const KernelPieces& pieces, const ShaderInfo& info, Dialect dialect);

}  // namespace bandlimit
