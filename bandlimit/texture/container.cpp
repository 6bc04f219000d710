#include "bandlimit/texture/container.h"

#include <algorithm>
#include <cstring>

#include "bandlimit/core/file_error.h"
#include "bandlimit/texture/dds.h"
#include "bandlimit/texture/ktx2.h"

namespace bandlimit {
namespace {

bool starts_with(std::span<const std::byte> bytes, std::string_view text) {
    return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

bool ends_with_any_case(std::string_view path, std::string_view extension) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return path.size() > extension.size() &&
           std::equal(extension.begin(), extension.end(), path.end() - static_cast<std::ptrdiff_t>(extension.size()),
                      [&](char a, char b) { return a == lower(b); });
}

ContainerLayout layout_of(std::span<const std::byte> bytes, const std::string& name) {
    const std::optional<Container> container = container_of_bytes(bytes);
    if (!container) fail_file(name, "is neither KTX2 nor DDS; name a file of one of these");
    const FileBytes file{bytes, name};
    return *container == Container::ktx2 ? ktx2_layout(file) : dds_layout(file);
}

}  // namespace

std::optional<Container> container_of_path(std::string_view path) {
    if (ends_with_any_case(path, ".ktx2")) return Container::ktx2;
    if (ends_with_any_case(path, ".dds")) return Container::dds;
    return {};
}

std::optional<Container> container_of_bytes(std::span<const std::byte> bytes) {
    if (starts_with(bytes, ktx2_identifier)) return Container::ktx2;
    if (starts_with(bytes, dds_identifier)) return Container::dds;
    return {};
}

void check_container(Container container, const TexelFormat& format) {
    const NamedFormat* const named = container == Container::ktx2 ? ktx2_format(format) : dds_format(format);
    if (named != nullptr) return;
    fail("check_container: ", container == Container::ktx2 ? "KTX2" : "DDS", " has no ", format.channels,
         " channels of ", format.srgb ? "sRGB " : "", name_of(format.depth),
         "; it has 1, 2 or 4 of any depth, and sRGB in ", container == Container::ktx2 ? "u8" : "4 channels of u8");
}

ContainerInfo container_info(std::span<const std::byte> bytes, const std::string& name) {
    return layout_of(bytes, name).info;
}

Texture read_container(std::span<const std::byte> bytes, const std::string& name) {
    return read_images(bytes, layout_of(bytes, name));
}

void write_container(const Texture& texture, Container container, const ByteSink& sink) {
    check_texture(texture);
    check_container(container, texture.format);
    container == Container::ktx2 ? write_ktx2(texture, sink) : write_dds(texture, sink);
}

}  // namespace bandlimit
