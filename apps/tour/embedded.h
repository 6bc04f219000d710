// Files that the program carries in itself.
#pragma once
#include <cstddef>
#include <vector>

namespace bandlimit::app {

struct EmbeddedFile {
    const char* name;
    const unsigned char* bytes;
    std::size_t size;
};

/// The photographs of examples/, a PNG file each.
std::vector<EmbeddedFile> embedded_photographs();

}  // namespace bandlimit::app
