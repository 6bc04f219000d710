// Input files, which are regular: what waits for a writer, or never ends, is not read.
// Stability: inner.
#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace bandlimit {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Opens for reading what exists, is a regular file behind all links, and may be read. Never waits. `wanted` is what
/// the user should name instead.
///
/// throws   std::runtime_error "PATH: what is wrong; what to do" for anything else
File open_regular(const std::string& path, std::string_view wanted = "an image file");

/// How long an open file is, in bytes.
std::uint64_t length_of(const File& file);

/// The content of a file of at most `most` bytes.
///
/// throws   as open_regular, and for one that is longer or cannot be read to its end
std::string read_text(const std::string& path, std::uint64_t most, std::string_view wanted);

}  // namespace bandlimit
