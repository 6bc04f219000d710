// Shading languages, and the one form in which the shaders of this room are written.
// Stability: evolving.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace bandlimit {

/// GLSL (Vulkan, OpenGL and ES 3), HLSL (shader model 5 and later), WGSL, Metal, Slang, and C++ for a CPU.
enum class Dialect { glsl, hlsl, wgsl, msl, slang, cpp };

/// All six, in the order of the enum.
std::span<const Dialect> all_dialects();

/// "glsl", "hlsl", ...
std::string_view name_of(Dialect dialect);

/// The dialect called `name`. Throws Error, listing the names, if there is none.
Dialect parse_dialect(std::string_view name);

/// What files of it end in: ".glsl", ".hlsl", ".wgsl", ".metal", ".slang", ".h".
std::string_view extension_of(Dialect dialect);

/// `source`, which is written in the neutral form, as text of `dialect`.
///
/// The neutral form is an expression language like HLSL, with these words in place of what differs:
///
///     types          float float2 float3 float4 int int2; each is its own constructor, with all arguments given
///     declarations   let(float2, t) = ...;   var(float4, sum) = ...;   declare(TYPE, NAME);
///                    table(float, NAME, COUNT, value, ...)             a constant array, at the outermost level
///                    structure(NAME) { field(float4, part) ... };
///                    function(TYPE, NAME, texture(t), sampler(s), in(float2, uv), ...) { ... }
///     control        loop(i, FROM, TO, STEP) { ... }, choose(CONDITION, IF_TRUE, IF_FALSE)
///     textures       sample(t, s, uv) and load(t, int2), both of level 0
///     compute        input_binding(0, t), sampler_binding(1, s), result_binding(2, image), tile(NAME, COUNT),
///                    kernel(NAME, THREADS_X, THREADS_Y) { tile_here(NAME, COUNT) ... }, group_position and
///                    thread_position, texture_size(NAME, t), image_size(NAME, image), barrier(), store(image, at,
///                    value)
///
/// Functions that all languages have (floor, dot, min, max, clamp, abs, sqrt, exp, log, pow) keep their names, as do
/// if, else and return. There are no swizzles.
///
/// throws   Error for a word without its parentheses, or too few arguments: the neutral form is ours
std::string translate(std::string_view source, Dialect dialect);

/// What code of `dialect` needs around it so that it compiles where it is pasted: C++ has its types, in a namespace.
std::string in_context(std::string code, Dialect dialect);

}  // namespace bandlimit
