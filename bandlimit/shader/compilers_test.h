// Compilers of shaders, as far as this machine has them, and files they work on.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bandlimit/shader/dialect.h"

namespace bandlimit::test {

/// A folder that is removed with what it holds.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

/// Runs a command line of the shell; what it printed, and throws std::runtime_error with that where it fails.
std::string run_command(const std::string& command);

/// Whether there is a program of that name on PATH.
bool on_path(const std::string& program);

/// What makes SPIR-V of compute shaders.
enum class Compiler { glslang, naga, slang };

/// What is missing, with how to get it; empty if the compiler is there.
std::string missing(Compiler compiler);

/// SPIR-V of the compute shader `entry`; glslang and slang read two dialects each. Slang calls all entries "main".
/// throws   std::runtime_error with what the compiler says
std::vector<std::uint32_t> compile(Compiler compiler, Dialect dialect, const std::string& source,
                                   const std::string& entry);

}  // namespace bandlimit::test
