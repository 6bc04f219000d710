#include "bandlimit/io/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "bandlimit/core/file_error.h"

namespace bandlimit {
namespace {

std::string text_of(int error) { return std::generic_category().message(error); }

void check_regular(const struct stat& status, const std::string& path, std::string_view wanted) {
    if (S_ISREG(status.st_mode)) return;
    const std::string_view kind = S_ISDIR(status.st_mode)    ? "a directory"
                                  : S_ISFIFO(status.st_mode) ? "a pipe"
                                  : S_ISSOCK(status.st_mode) ? "a socket"
                                                             : "a device";
    fail_file(path, "is ", kind, "; name ", wanted);
}

}  // namespace

File open_regular(const std::string& path, std::string_view wanted) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        if (errno == ENOENT) fail_file(path, "does not exist; check the path");
        fail_file(path, "cannot be read: ", text_of(errno), "; check the path and its permissions");
    }
    check_regular(status, path, wanted);  // before it is opened: some devices do something then
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) fail_file(path, "cannot be read: ", text_of(errno), "; check its permissions");
    File file(::fdopen(descriptor, "rb"));
    if (!file) {
        ::close(descriptor);
        throw std::bad_alloc();
    }
    // Another file may have come there meanwhile.
    if (::fstat(descriptor, &status) != 0) fail_file(path, "cannot be read: ", text_of(errno), "; check the disk");
    check_regular(status, path, wanted);
    return file;
}

std::uint64_t length_of(const File& file) {
    struct stat status {};
    return ::fstat(::fileno(file.get()), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

std::string read_text(const std::string& path, std::uint64_t most, std::string_view wanted) {
    const File file = open_regular(path, wanted);
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
        text.append(block.data(), count);
        if (text.size() > most) fail_file(path, "has more than ", most >> 20, " MB; name ", wanted);
    }
    if (std::ferror(file.get()) != 0) fail_file(path, "cannot be read: ", text_of(errno), "; check the disk");
    return text;
}

}  // namespace bandlimit
