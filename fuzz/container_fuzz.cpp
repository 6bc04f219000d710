// Any bytes as a KTX2 or DDS file: a texture that is the same once written and read again, or one std::runtime_error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <vector>

#include "bandlimit/texture/container.h"

namespace {

using namespace bandlimit;

std::vector<std::byte> written(const Texture& texture, Container container) {
    std::vector<std::byte> file;
    write_container(texture, container,
                    [&](std::span<const std::byte> part) { file.insert(file.end(), part.begin(), part.end()); });
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // Exactly as long as the input: what reads past its end is seen.
    const std::vector<std::byte> file(reinterpret_cast<const std::byte*>(data),
                                      reinterpret_cast<const std::byte*>(data) + size);
    Texture texture;
    try {
        texture = read_container(file, "fuzz");
    } catch (const std::runtime_error&) {
        return 0;
    }
    check_texture(texture);
    const std::vector<std::byte> once = written(texture, Container::ktx2);
    if (written(read_container(once, "fuzz"), Container::ktx2) != once) std::abort();
    if (texture.format.srgb && texture.format.channels < 4) return 0;
    const std::vector<std::byte> dds = written(texture, Container::dds);
    if (written(read_container(dds, "fuzz"), Container::dds) != dds) std::abort();
    return 0;
}
