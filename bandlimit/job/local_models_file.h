// Local models in files: EXR, of 32-bit floats, that other programs can look at.
//
// Signal i has the channels "signal<i>.constant", "signal<i>.u0", .. and for order 2 "signal<i>.u0u0", "signal<i>.u0u1", ..;
// "offset.u0", .., the same everywhere, is what guides are taken less of.
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/filter/local_models.h"

namespace bandlimit::job {

/// Writes a file, whole or not at all; reading it gives the same numbers, bit for bit.
/// throws   std::runtime_error for what cannot be written; Error for another extension than .exr
void write_local_models(const std::string& path, const LocalModels& models);

/// throws   std::runtime_error "PATH: what is wrong; what to do" for what cannot be read, and for other pictures
LocalModels read_local_models(const std::string& path);

}  // namespace bandlimit::job
