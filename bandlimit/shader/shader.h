// Designs as shader source to paste without editing.
//
// Every text begins with a comment: what it computes, the lines that its maker passed, its cost, the command that made
// it, and its parameters. What follows are functions that any stage may call (they read level 0 explicitly), or one
// whole compute shader. Their parameters are
//
//     source    the texture to read, with a linear sampler; its edges are the sampler's
//     uv        where the output lies in it, from 0 to 1 between its outer edges: (i + 1/2) * factor * texel for the
//               output i of a filter that shrinks by `factor`
//     texel     1 / size of source
// Stability: evolving.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "bandlimit/kernel/fetches.h"
#include "bandlimit/kernel/piecewise.h"
#include "bandlimit/kernel/taps.h"
#include "bandlimit/kernel/terms.h"
#include "bandlimit/shader/dialect.h"

namespace bandlimit {

/// The name of a shader and the text of its comment.
struct ShaderInfo {
    std::string name = {};                ///< of the function, or what names of several begin with: [a-z][a-z0-9_]*
    std::string command = {};             ///< that made it; empty: not said
    std::vector<std::string> notes = {};  ///< lines: what it is, its error, its response
};

/// Throws Error for a name that is not an identifier in every dialect, as all functions below do.
void check_shader_name(const std::string& name);

/// A file of shader source.
struct ShaderFile {
    std::string name, text;
};

// All that follow throw Error for such a name, for no weights, and for weights and offsets that are not finite.

/// One pass: NAME(source, sampler, uv, texel), a sum of bilinear reads.
/// cost     reads.size() reads
std::string fetch_shader(const Fetches& reads, const ShaderInfo& info, Dialect dialect);

/// Two passes, NAME_horizontal and NAME_vertical, each a sum of linear reads along its axis; both work alone too. The
/// second reads what the first wrote, and its `texel` is that picture's.
std::string separable_shader(const std::vector<LinearRead>& reads, const ShaderInfo& info, Dialect dialect);

/// One pass without a sampler: NAME(source, uv, texel) loads texels and weights them by `weights`, centred on the texel
/// that holds uv as centred_first() has it. Texels outside are those at the edge.
/// cost     a load per weight
std::string load_shader(const WeightGrid& weights, const ShaderInfo& info, Dialect dialect);

/// Two passes of low rank: NAME_rows returns one value per term, each for a picture of its own; NAME_columns reads
/// these pictures and returns their sum, the result.
///
/// cost     a read per weight of a row; as many reads per term as a column has weights
/// throws   Error also for terms of different lengths
std::string low_rank_shader(const Terms& terms, const ShaderInfo& info, Dialect dialect);

/// How a compute shader goes along an axis.
enum class PassDirection { horizontal, vertical };

/// A whole compute shader, with its bindings, that applies `taps` along one axis: a workgroup reads each texel that it
/// needs once, into shared memory. One thread is one output; a picture of W x H outputs takes
/// ceil(W / threads) workgroups, as the comment says in numbers. Texels are read at their centres by the sampler, which
/// therefore decides about edges, and may be nearest or linear.
///
/// throws   Error also for Dialect::cpp, for factor < 1, and for more taps than shared memory holds, see compute_fits()
std::string compute_shader(const Taps& taps, PassDirection direction, const ShaderInfo& info, Dialect dialect);

/// Whether the texels under a row of threads fit the 16 KiB of shared memory that every device has.
bool compute_fits(const Taps& taps);

/// A design in all forms in which it can run. Empty parts are not emitted.
struct ShaderParts {
    Fetches fetches = {};                ///< fetch_shader
    std::vector<LinearRead> reads = {};  ///< separable_shader: the taps, folded
    Taps taps = {};                      ///< compute_shader, both ways, where it fits
    Terms terms = {};                    ///< low_rank_shader
    KernelPieces pieces = {};            ///< pieces_shader, see kernels.h
};

/// The files of `parts` in one dialect: NAME.glsl with the functions of one kind, NAME_compute_horizontal.glsl, ... A
/// design with both fetches and taps has NAME.glsl and NAME_separable.glsl, one with terms NAME_low_rank.glsl.
///
/// throws   Error if there is nothing to ship
/// example  shaders_of({.reads = fold(taps), .taps = taps}, {"blur", "bandlimit design gaussian"}, Dialect::wgsl)
std::vector<ShaderFile> shaders_of(const ShaderParts& parts, const ShaderInfo& info, Dialect dialect);

}  // namespace bandlimit
