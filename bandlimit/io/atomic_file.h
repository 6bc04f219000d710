// Files that appear whole or not at all.
// Stability: evolving.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "bandlimit/io/signals.h"

namespace bandlimit {

/// A new file beside `path`, which takes its name only in commit().
///
/// If `path` is a link to a file, that file is replaced and the link stays. The file that is replaced hands its
/// permissions down. Until commit() the data are in a file called .bandlimit-, 16 random digits and the extension of
/// `path`; remove_unfinished_files() removes it, and so does the destructor. What a process leaves that is killed is
/// removed by the next that writes to the folder: see remove_abandoned_files(), which runs once per folder and process.
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

    /// Where the data are until commit(), for codecs that must open a file themselves, which they do under FileMaking.
    const std::string& unfinished() const { return unfinished_; }
    /// Throws if anything failed so far.
    void check() const;
    /// Closes and renames.
    void commit();

private:
    void remember_failure() noexcept;
    void close() noexcept;

    void create(const std::string& extension);
    void discard() noexcept;

    std::string path_, target_, unfinished_;
    std::FILE* file_ = nullptr;
    int lock_ = -1;  ///< a descriptor that holds the lock on the file until it has its name or is gone
    int slot_ = -1;
    int failure_ = 0;  ///< errno of the first failure
};

/// A file comes to be, and so does the note of it that remove_unfinished_files() goes by. No signal handler runs in
/// this thread meanwhile, and that function, in another thread, waits. Once it has begun nothing more is made: the
/// thread that tries waits for the end of the process.
class FileMaking {
public:
    FileMaking() noexcept;
    ~FileMaking();
    FileMaking(const FileMaking&) = delete;
    FileMaking& operator=(const FileMaking&) = delete;

private:
    BlockedSignals blocked_;
};

/// Removes from `folder` the unfinished files of processes that are gone: those called as above that were last written
/// ten minutes ago or earlier and on which no process holds a lock (flock), as a living one does. Where that cannot be
/// told, as on file systems without such locks, files stay.
///
/// cost     reads the names in the folder once: some 50 ms for 100,000
void remove_abandoned_files(const std::string& folder) noexcept;

}  // namespace bandlimit
