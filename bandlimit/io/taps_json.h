// taps.json: taps on their way between programs.
//
//     { "version": 1,
//       "kind": "downsample",             what made them
//       "factor": 2,                      input samples under one output sample, 1 to 4096
//       "error": 0.0123,                  optional: how far they are from the ideal, as their maker defines it
//       "cost": 4,                        optional: reads per output sample
//       "multiply_adds": 4,               optional: per output sample and channel
//       "taps": { "first": -1,
//                 "weights": [ ... ] },   out[i] = sum_j weights[j] * in[i * factor + first + j]
//       "fetches": [ { "x": 0.5, "y": 0, "weight": 1 } ],
//                                         bilinear reads, in source texels relative to the output's position
//       "terms": [ { "column": [...], "row": [...] } ],
//                                         weight(x, y) = sum of column[y] * row[x], centred on the output
//       "components": [ { "a":, "b":, "A":, "B": } ],
//                                         weight(x, y) = sum of Re (A - iB) exp((-a + ib)(x^2 + y^2)), in radii
//       "pieces": [ { "begin": 0, "end": 1, "coefficients": [ ... ] } ],
//                                         a kernel: on begin <= |x| < end the sum of coefficients[n] (|x| - begin)^n
//       "loss": 0.02, "singular_values": [ ... ], "radius": 1 }
//                                         optional: what was minimised, of the shape given, of the disc in samples
//
// What applies of the five lists is there; all that are there describe one filter. Other keys are allowed and ignored.
// Limits: 65536 numbers in a list, |first| <= 1000000, 64 terms of equal lengths, 16 components, 64 pieces
// of 16 coefficients, 16 MB of text.
// Stability: stable.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bandlimit/kernel/fetches.h"
#include "bandlimit/kernel/piecewise.h"
#include "bandlimit/kernel/taps.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// The content of a taps.json.
struct TapsFile {
    std::string kind = {};
    int factor = 1;
    std::optional<double> error = {};
    std::optional<double> cost = {};
    std::optional<double> multiply_adds = {};
    std::optional<Taps> taps = {};  ///< their factor is the file's
    Fetches fetches = {};           ///< these and the next three: empty where there are none
    Terms terms = {};
    Components components = {};
    KernelPieces pieces = {};
    std::optional<double> loss = {};
    std::vector<double> singular_values = {};
    std::optional<double> radius = {};
};

/// The content of `text`; `name` is what errors call it.
/// throws   std::runtime_error "NAME: what is wrong; what to do"
TapsFile parse_taps(std::string_view text, const std::string& name);

/// The content of the file `path`.
/// throws   std::runtime_error as parse_taps, and for what cannot be read
TapsFile read_taps(const std::string& path);

/// The 1D taps of `file`, which came from `name`.
/// throws   std::runtime_error if it has none
const Taps& taps_of(const TapsFile& file, const std::string& name);

/// Whether `file` is a kernel: it has pieces and no taps.
inline bool is_kernel(const TapsFile& file) { return !file.taps && !file.pieces.empty(); }

/// The kernel of `file`, which came from `name`, and is called so.
/// throws   std::runtime_error if it has none
Kernel kernel_of(const TapsFile& file, const std::string& name);

/// The text of `file`; parsing it again gives the same numbers, bit for bit.
/// throws   Error for content that parse_taps would refuse
std::string taps_text(const TapsFile& file);

/// Writes `file` to `path`, whole or not at all.
/// throws   std::runtime_error for what cannot be written; Error as taps_text
void write_taps(const std::string& path, const TapsFile& file);

}  // namespace bandlimit
