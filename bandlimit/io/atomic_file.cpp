#include "bandlimit/io/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <climits>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>
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

// How many threads are making a file at this moment, and whether the process ends, so that no more may be made.
std::atomic<int> makers{0};
std::atomic<bool> process_ends{false};

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

constexpr std::string_view unfinished_prefix = ".bandlimit-";
constexpr std::size_t unfinished_digits = 16;

/// A name that no other process takes, whatever its number and wherever it runs.
std::string unfinished_name(const std::string& extension) {
    std::uint64_t number = 0;
    if (::getrandom(&number, sizeof number, 0) != sizeof number) {
        static std::atomic<std::uint64_t> count{0};
        const auto now = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
        number = (now << 24) ^ (static_cast<std::uint64_t>(::getpid()) << 8) ^ count++;
    }
    std::array<char, unfinished_digits + 1> digits{};
    std::snprintf(digits.data(), digits.size(), "%016" PRIx64, number);
    return message(unfinished_prefix, digits.data(), extension);
}

bool is_unfinished_name(std::string_view name) {
    if (!name.starts_with(unfinished_prefix)) return false;
    name.remove_prefix(unfinished_prefix.size());
    const std::size_t digits = std::min(name.find_first_not_of("0123456789abcdef"), name.size());
    return digits == unfinished_digits && (name.size() == digits || name[digits] == '.');
}

/// Whether this process is the one to hold the lock. Where there are no locks, it is.
bool take_lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

/// Removes `name` from the folder if no process works on it any more.
void remove_if_abandoned(int folder, const char* name) noexcept {
    constexpr std::time_t seconds = 600;
    const int file = ::openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return;
    struct stat status {};
    const bool is_old =
        ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_mtime <= std::time(nullptr) - seconds;
    if (is_old && ::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlinkat(folder, name, 0);
    ::close(file);
}

/// remove_abandoned_files(), the first time that this process meets the folder.
void clean_once(const std::string& folder) {
    static std::mutex mutex;
    static std::set<std::string> cleaned;
    {
        const std::lock_guard lock(mutex);
        if (!cleaned.insert(folder).second) return;
    }
    remove_abandoned_files(folder);
}

std::string text_of(int error) { return std::generic_category().message(error); }

/// What `path` names after all links, also where the last one leads to nothing yet.
fs::path behind_links(const std::string& path) {
    constexpr int most_links = 40;  // as the kernel follows
    fs::path target = path;
    std::error_code error;
    for (int i = 0; i <= most_links; ++i) {
        if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
        const fs::path next = fs::read_symlink(target, error);
        if (error) break;
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    fail_file(path, "is a link that ", error ? "cannot be followed" : "leads in circles",
              "; remove it, or choose another name");
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
    if (path.empty()) fail_file("\"\"", "is not a file name; name the output");
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
    if (!fs::is_directory(parent_status)) fail_file(path, parent.string(), " is not a directory; choose another place");
    if (!may(parent, W_OK | X_OK))
        fail_file(path, "the directory ", parent.string(), " is not writable; choose another place");
}

FileMaking::FileMaking() noexcept {
    ++makers;
    if (!process_ends) return;
    --makers;
    for (;;) ::pause();
}

FileMaking::~FileMaking() { --makers; }

void remove_unfinished_files() noexcept {
    process_ends = true;
    constexpr timespec pause{0, 1'000'000};
    constexpr int most_pauses = 1000;  // a second: longer only where the file system hangs
    for (int i = 0; makers > 0 && i < most_pauses; ++i) ::nanosleep(&pause, nullptr);
    for (Slot& slot : slots)
        if (slot.exists.load()) ::unlink(slot.path.data());
}

void remove_abandoned_files(const std::string& folder) noexcept {
    DIR* const entries = ::opendir(folder.c_str());
    if (entries == nullptr) return;
    while (const dirent* entry = ::readdir(entries))
        if (is_unfinished_name(entry->d_name)) remove_if_abandoned(::dirfd(entries), entry->d_name);
    ::closedir(entries);
}

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
    check_output_path(path);
    const fs::path target = behind_links(path);
    target_ = target.string();
    clean_once(parent_of(target).string());

    constexpr std::size_t longest = 16;  // codecs know no longer extension, and names have a limit
    const std::string extension = target.extension().string();
    create(extension.size() <= longest ? extension : "");
    struct stat replaced {};
    // Permissions are a courtesy: a file system without them is no reason to fail.
    if (::stat(target_.c_str(), &replaced) == 0) (void)!::fchmod(lock_, replaced.st_mode & 07777);
    const int descriptor = ::fcntl(lock_, F_DUPFD_CLOEXEC, 0);  // shares the lock
    if (descriptor >= 0) file_ = ::fdopen(descriptor, "w+b");
    if (file_ == nullptr) {
        const int error = errno;
        if (descriptor >= 0) ::close(descriptor);
        discard();
        fail_file(path, "no file can be opened: ", text_of(error), "; close other files or programs");
    }
}

/// Makes an unfinished file that this process has locked, under a name that none had.
void AtomicFile::create(const std::string& extension) {
    constexpr int attempts = 100;
    int error = EEXIST;
    for (int i = 0; i < attempts && error == EEXIST; ++i) {
        unfinished_ = (parent_of(target_) / unfinished_name(extension)).string();
        const FileMaking making;
        slot_ = take_slot(unfinished_);
        if (slot_ < 0)
            fail_file(path_, "the path is too long or ", slots.size(), " files are open for writing; write fewer");
        lock_ = ::open(unfinished_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        error = lock_ < 0 ? errno : 0;
        // Where clocks differ, another process may take what is new for old and abandoned.
        struct stat status {};
        if (lock_ >= 0 && take_lock(lock_) && ::fstat(lock_, &status) == 0 && status.st_nlink > 0) return;
        if (lock_ >= 0) error = EEXIST;
        discard();
    }
    fail_file(path_, "no file can be created there: ", text_of(error), "; choose another place");
}

/// Removes the unfinished file, or what there is of it.
void AtomicFile::discard() noexcept {
    if (lock_ >= 0) {
        ::unlink(unfinished_.c_str());
        ::close(lock_);
    }
    lock_ = -1;
    free_slot(slot_);
    slot_ = -1;
}

AtomicFile::~AtomicFile() {
    if (slot_ < 0) return;
    close();
    discard();
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
    const FileMaking making;  // else what a signal handler removed would be missed here
    if (::rename(unfinished_.c_str(), target_.c_str()) != 0) {
        remember_failure();
        check();
    }
    ::close(lock_);
    lock_ = -1;
    free_slot(slot_);
    slot_ = -1;
}

}  // namespace bandlimit
