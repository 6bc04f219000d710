#include "bandlimit/job/texture_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>

#include "bandlimit/core/error.h"
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/io/regular_file.h"

namespace bandlimit::job {
namespace {

/// The first `length` bytes of a file, or as many as there are when it is opened.
struct Content {
    std::unique_ptr<std::byte[]> bytes;  // not a vector, which would write zeros first
    std::uint64_t length = 0, file_length = 0;

    std::span<const std::byte> span() const { return {bytes.get(), length}; }
};

/// `copies` is how many times the length of what is read will be in memory.
Content read_content(const std::string& path, std::uint64_t most, std::uint64_t copies) {
    const File file = open_regular(path);
    Content content;
    content.file_length = length_of(file);
    content.length = std::min(most, content.file_length);
    require_memory(content.length * copies, path);
    content.bytes = std::make_unique_for_overwrite<std::byte[]>(content.length);
    if (std::fread(content.bytes.get(), 1, content.length, file.get()) != content.length)
        fail_file(path, "ends earlier than it did when it was opened; wait until it is written");
    return content;
}

}  // namespace

std::optional<Container> container_of_file(const std::string& path) {
    File file;
    try {
        file = open_regular(path);
    } catch (const std::runtime_error&) {
        return {};  // whoever reads it as an image says why
    }
    std::array<std::byte, 16> start{};
    const std::size_t length = std::fread(start.data(), 1, start.size(), file.get());
    return container_of_bytes(std::span(start).first(length));
}

ContainerInfo texture_info(const std::string& path) {
    const Content content = read_content(path, most_header_bytes, 1);
    return container_info(content.span(), content.file_length, path);
}

Texture read_texture(const std::string& path) {
    const Content content = read_content(path, std::numeric_limits<std::uint64_t>::max(), 3);
    return read_container(content.span(), path);
}

void write_texture(const std::string& path, const Texture& texture) {
    const std::optional<Container> container = container_of_path(path);
    if (!container) fail(path, ": is neither called .ktx2 nor .dds; choose one of these");
    check_texture(texture);
    check_container(*container, texture.format);
    AtomicFile file(path);
    write_container(texture, *container,
                    [&](std::span<const std::byte> part) { file.write(part.data(), part.size()); });
    file.commit();
}

}  // namespace bandlimit::job
