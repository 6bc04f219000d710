// Any bytes as an image file: they are read row by row, or one std::runtime_error says why not.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>

#include "bandlimit/core/image.h"
#include "bandlimit/io/image_file.h"

namespace {

using namespace bandlimit;

template <class T>
void read_all(ImageReader& reader) {
    const ImageInfo& info = reader.info();
    Image<T> row(info.width, 1, info.channels(), Layout::interleaved);
    for (int y = 0; y < info.height; ++y) reader.read_rows(y, row.view());
}

void read(const std::string& path) {
    constexpr std::int64_t most_samples = 1 << 22;  // enough for every branch, and small enough to be fast
    ImageReader reader(path, 1);
    const ImageInfo& info = reader.info();
    if (static_cast<std::int64_t>(info.width) * info.height > most_samples / info.channels()) return;
    switch (info.depth) {
        case Depth::u8: return read_all<std::uint8_t>(reader);
        case Depth::u16: return read_all<std::uint16_t>(reader);
        case Depth::f16: return read_all<Half>(reader);
        case Depth::f32: return read_all<float>(reader);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = ::memfd_create("image", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) return 0;
    try {
        read(path);
    } catch (const std::runtime_error&) {
    }
    return 0;
}
