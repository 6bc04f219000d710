#include "bandlimit/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit {
namespace {

namespace fs = std::filesystem;

/// The unfinished files, where a signal handler can reach them: no allocation, no lock, nothing that can be half moved.
struct Slot {
    std::atomic<bool> taken{false};
    std::atomic<bool> exists{false};
    std::array<char, PATH_MAX> path{};
};
std::array<Slot, 256> slots;

int take_slot(const std::string& path) {
    if (path.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        if (slots[i].taken.exchange(true)) continue;
        std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
        slots[i].exists.store(true);
        return static_cast<int>(i);
    }
    return -1;
}

void free_slot(int i) {
    Slot& slot = slots[static_cast<std::size_t>(i)];
    slot.exists.store(false);
    slot.taken.store(false);
}

std::string text_of(int error) { return std::generic_category().message(error); }

/// What `path` names after all links, also where the last one leads to nothing yet.
fs::path behind_links(fs::path path) {
    constexpr int most_links = 40;  // as the kernel follows
    std::error_code error;
    for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
        const fs::path next = fs::read_symlink(path, error);
        if (error) break;
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return path;
}

fs::path parent_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

std::string_view kind_of(fs::file_type type) {
    switch (type) {
        case fs::file_type::directory: return "a directory";
        case fs::file_type::block:
        case fs::file_type::character: return "a device";
        case fs::file_type::fifo: return "a pipe";
        case fs::file_type::socket: return "a socket";
        default: return "no regular file";
    }
}

bool may(const fs::path& path, int mode) { return ::faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0; }

}  // namespace

void check_output_path(const std::string& path) {
    if (path.empty()) fail_file("\"\"", "is no file name; name the output");
    std::error_code error;
    const fs::path target = behind_links(path);
    const fs::file_status status = fs::status(target, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail_file(path, "is ", kind_of(status.type()), "; name a file to write");
    if (fs::exists(status) && !may(target, W_OK)) fail_file(path, "is write-protected; choose another name");

    const fs::path parent = parent_of(target);
    const fs::file_status parent_status = fs::status(parent, error);
    if (!fs::exists(parent_status))
        fail_file(path, "the directory ", parent.string(), " does not exist or cannot be entered; create it first");
    if (!fs::is_directory(parent_status)) fail_file(path, parent.string(), " is no directory; choose another place");
    if (!may(parent, W_OK | X_OK))
        fail_file(path, "the directory ", parent.string(), " is not writable; choose another place");
}

void remove_unfinished_files() noexcept {
    for (Slot& slot : slots)
        if (slot.exists.load()) ::unlink(slot.path.data());
}

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
    check_output_path(path);
    const fs::path target = behind_links(path);
    target_ = target.string();

    static std::atomic<unsigned> number{0};
    const std::string name = message(".bandlimit-", ::getpid(), "-", number++, target.extension().string());
    unfinished_ = (parent_of(target) / name).string();
    slot_ = take_slot(unfinished_);
    if (slot_ < 0)
        fail_file(path, "the path is too long or ", slots.size(), " files are open for writing; write fewer");

    const int descriptor = ::open(unfinished_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        const int error = errno;
        free_slot(slot_);
        fail_file(path, "no file can be created there: ", text_of(error), "; choose another place");
    }
    struct stat replaced {};
    // Permissions are a courtesy: a file system without them is no reason to fail.
    if (::stat(target_.c_str(), &replaced) == 0) (void)!::fchmod(descriptor, replaced.st_mode & 07777);
    file_ = ::fdopen(descriptor, "w+b");
    if (file_ == nullptr) {
        ::close(descriptor);
        ::unlink(unfinished_.c_str());
        free_slot(slot_);
        throw std::bad_alloc();
    }
}

AtomicFile::~AtomicFile() {
    if (slot_ < 0) return;
    close();
    ::unlink(unfinished_.c_str());
    free_slot(slot_);
}

void AtomicFile::remember_failure() noexcept {
    if (failure_ == 0) failure_ = errno != 0 ? errno : EIO;
}

void AtomicFile::close() noexcept {
    if (file_ != nullptr && std::fclose(file_) != 0) remember_failure();
    file_ = nullptr;
}

std::size_t AtomicFile::write(const void* data, std::size_t size) noexcept {
    if (size == 0) return 0;  // codecs pass a null pointer with it
    errno = 0;
    const std::size_t done = std::fwrite(data, 1, size, file_);
    if (done != size) remember_failure();
    return done;
}

std::size_t AtomicFile::read(void* data, std::size_t size) noexcept { return std::fread(data, 1, size, file_); }

bool AtomicFile::seek(std::int64_t offset) noexcept {
    errno = 0;
    if (::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) == 0) return true;
    remember_failure();
    return false;
}

std::int64_t AtomicFile::tell() noexcept { return ::ftello(file_); }

std::int64_t AtomicFile::size() noexcept {
    struct stat status {};
    errno = 0;
    if (std::fflush(file_) != 0 || ::fstat(::fileno(file_), &status) != 0) remember_failure();
    return status.st_size;
}

void AtomicFile::check() const {
    if (failure_ == 0) return;
    const bool is_full = failure_ == ENOSPC || failure_ == EDQUOT || failure_ == EFBIG;
    fail_file(path_, "cannot be written: ", text_of(failure_), "; ",
              is_full ? "free some space or choose another place" : "check the disk or choose another place");
}

void AtomicFile::commit() {
    errno = 0;
    close();
    check();
    if (::rename(unfinished_.c_str(), target_.c_str()) != 0) {
        remember_failure();
        check();
    }
    free_slot(slot_);
    slot_ = -1;
}

}  // namespace bandlimit
