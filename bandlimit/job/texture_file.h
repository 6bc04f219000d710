// Textures in files.
// Stability: evolving.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/texture/container.h"

namespace bandlimit::job {

/// What the first bytes of a file say it is; none for what is no texture, or cannot be read.
std::optional<Container> container_of_file(const std::string& path);

/// Reads what the header says, and no texel.
///
/// throws   std::runtime_error "PATH: what is wrong; what to do", as the next
ContainerInfo texture_info(const std::string& path);

/// Reads the whole.
///
/// cost     memory of less than three times the file's length
/// throws   std::runtime_error "PATH: what is wrong; what to do" for files that are missing, damaged, no textures, or
///          too large for this machine's memory
Texture read_texture(const std::string& path);

/// Writes what the extension of `path` names. The file appears whole or not at all.
///
/// throws   Error for an extension that is neither .ktx2 nor .dds, and as write_container; std::runtime_error with the
///          path for what cannot be written
void write_texture(const std::string& path, const Texture& texture);

}  // namespace bandlimit::job
