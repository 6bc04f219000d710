// Files that appear whole or not at all.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace bandlimit {

/// A new file beside `path`, which takes its name only in commit().
///
/// If `path` is a link to a file, that file is replaced and the link stays. The file that is replaced hands its
/// permissions down. Until commit() the data are in a file called .bandlimit-PROCESS-NUMBER and the extension of
/// `path`; remove_unfinished_files() removes it, and so does the destructor.
///
/// read(), write() and seek() report failure as fread, fwrite and fseek do, because codecs call them; the first failure
/// is remembered, and check() and commit() throw it.
/// throws   std::runtime_error, with the path, from the constructor, check() and commit()
class AtomicFile {
public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    std::size_t write(const void* data, std::size_t size) noexcept;
    std::size_t read(void* data, std::size_t size) noexcept;
    bool seek(std::int64_t offset) noexcept;
    std::int64_t tell() noexcept;
    std::int64_t size() noexcept;

    /// Where the data are until commit(), for codecs that must open a file themselves.
    const std::string& unfinished() const { return unfinished_; }
    /// Throws if anything failed so far.
    void check() const;
    /// Closes and renames.
    void commit();

private:
    void remember_failure() noexcept;
    void close() noexcept;

    std::string path_, target_, unfinished_;
    std::FILE* file_ = nullptr;
    int slot_ = -1;
    int failure_ = 0;  ///< errno of the first failure
};

}  // namespace bandlimit
