// Any bytes as an image file: they are read by blocks of rows, or one std::runtime_error says why not.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "bandlimit/core/image.h"
#include "bandlimit/io/image_file.h"

namespace {

using namespace bandlimit;

/// A file in memory, by a name that ends in .tga: for what has no other signature, that decides.
class MemoryFile {
public:
    MemoryFile() : file_(::memfd_create("image", 0)) {
        const std::string name = "bandlimit-fuzz-" + std::to_string(::getpid()) + ".tga";
        path_ = (std::filesystem::temp_directory_path() / name).string();
        ::unlink(path_.c_str());
        if (::symlink(("/proc/self/fd/" + std::to_string(file_)).c_str(), path_.c_str()) != 0) std::abort();
    }
    ~MemoryFile() { ::unlink(path_.c_str()); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    const std::string& path() const { return path_; }
    bool hold(const std::uint8_t* data, std::size_t size) const {
        return ::ftruncate(file_, 0) == 0 && ::pwrite(file_, data, size, 0) == static_cast<ssize_t>(size);
    }

private:
    int file_;
    std::string path_;
};

void read(const std::string& path) {
    constexpr std::int64_t most_samples = 1 << 16;  // enough for every branch, and small enough to be fast
    constexpr int block = 7;
    ImageReader reader(path, 1);
    const ImageInfo& info = reader.info();
    if (static_cast<std::int64_t>(info.width) * info.height > most_samples / info.channels()) return;
    AnyImage rows = make_image(info.depth, info.width, std::min(block, info.height), info.channels());
    for (int y = 0; y < info.height; y += block)
        reader.read_rows(y, rows_of(view_of(rows), 0, std::min(block, info.height - y)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const MemoryFile file;
    if (!file.hold(data, size)) return 0;
    try {
        read(file.path());
    } catch (const std::runtime_error&) {
    }
    return 0;
}
