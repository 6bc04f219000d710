// taps.json: taps on their way between programs.
//
//     { "version": 1,
//       "kind": "downsample",                               what made them
//       "factor": 2,                                        input samples under one output sample, 1 to 4096
//       "error": 0.0123,                                    optional: what the design minimised, as its maker defines
//       it "cost": 4,                                          optional: reads per output sample "taps": { "first": -1,
//       "weights": [ ... ] } }       out[i] = sum_j weights[j] * in[i * factor + first + j]
//
// Other keys are allowed and ignored. Limits: 65536 weights, |first| <= 1000000, 16 MB of text.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "bandlimit/kernel/taps.h"

namespace bandlimit {

/// The content of a taps.json.
struct TapsFile {
    std::string kind;
    int factor = 1;
    std::optional<double> error;
    std::optional<double> cost;
    std::optional<Taps> taps;  ///< none in files of 2D filters; their factor is the file's
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

/// Writes `file` to `path`, whole or not at all; reading it again gives the same numbers, bit for bit.
/// throws   std::runtime_error for what cannot be written; Error for content that parse_taps would refuse
void write_taps(const std::string& path, const TapsFile& file);

}  // namespace bandlimit
