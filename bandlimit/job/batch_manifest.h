// What a batch has made, so that it need not be made again.
// Stability: inner.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace bandlimit::job {

/// What a texture was made of, and how it looked when it was done.
struct MadeFile {
    std::map<std::string, std::string> inputs;  ///< relative path and hash of the content of all that was read
    std::string options;                        ///< all that decided how it was made
    std::uint64_t size = 0;                     ///< bytes
    std::int64_t modified = 0;                  ///< nanoseconds, as the file system counts
};

/// Names of files are bytes, and JSON is UTF-8: what is not ASCII is written as in an address, %C3%A4. And back.
std::string text_of_name(std::string_view name);
std::string name_of_text(std::string_view text);

/// The 128-bit XXH3 hash of a file's bytes, in hexadecimal.
/// throws  std::runtime_error with the path
std::string hash_of_file(const std::string& path);

/// The file .bandlimit-mips.json of a directory.
class Manifest {
public:
    /// Reads it. A file that is missing, damaged or of another version holds nothing.
    explicit Manifest(const std::string& directory);

    /// Whether the texture `output`, relative to the directory, is there, untouched since it was made of the same
    /// inputs by the same options.
    bool is_current(const std::string& output, const std::map<std::string, std::string>& inputs,
                    const std::string& options) const;
    /// Notes that `output` was just made so.
    void add(const std::string& output, std::map<std::string, std::string> inputs, std::string options);
    /// Writes the file, whole or not at all.
    void save() const;

private:
    std::string directory_;
    std::map<std::string, MadeFile> made_;
};

}  // namespace bandlimit::job
