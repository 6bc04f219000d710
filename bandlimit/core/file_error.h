// Errors of files.
// Stability: inner.
#pragma once
#include <stdexcept>
#include <string>

#include "bandlimit/core/error.h"

namespace bandlimit {

/// Throws std::runtime_error "PATH: the joined parts", which say what is wrong and, after a semicolon, what to do.
template <class... Parts>
[[noreturn]] void fail_file(const std::string& path, const Parts&... parts) {
    throw std::runtime_error(message(path, ": ", parts...));
}

}  // namespace bandlimit
