#include "bandlimit/texture/container.h"

#include <algorithm>
#include <cstring>
#include <map>

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

ContainerLayout layout_of(std::span<const std::byte> start, std::uint64_t length, const std::string& name) {
    const std::optional<Container> container = container_of_bytes(start);
    if (!container) fail_file(name, "is neither KTX2 nor DDS; name a file of one of these");
    const FileBytes file{start, length, name};
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
    const NumberedFormat* const named = container == Container::ktx2 ? ktx2_format(format) : dds_format(format);
    if (named != nullptr) return;
    fail("check_container: ", container == Container::ktx2 ? "KTX2" : "DDS", " has no ", format.channels,
         " channels of ", format.srgb ? "sRGB " : "", name_of(format.depth),
         "; it has 1, 2 or 4 of any depth, and sRGB in ", container == Container::ktx2 ? "u8" : "4 channels of u8");
}

ContainerInfo container_info(std::span<const std::byte> start, std::uint64_t length, const std::string& name) {
    return layout_of(start, length, name).info;
}

ContainerInfo container_info(std::span<const std::byte> file, const std::string& name) {
    return container_info(file, file.size(), name);
}

Texture read_container(std::span<const std::byte> file, const std::string& name) {
    return read_images(file, layout_of(file, file.size(), name));
}

std::span<const std::byte> bytes_of(const AnyImage& image) {
    return std::visit(
        [](const auto& i) {
            const auto samples = static_cast<std::size_t>(i.width()) * static_cast<std::size_t>(i.height()) *
                                 static_cast<std::size_t>(i.channels());
            return std::as_bytes(std::span(i.view().data, samples));
        },
        image);
}

ContainerPlan plan_container(const TextureShape& shape, Container container) {
    check_container(container, shape.format);
    return container == Container::ktx2 ? plan_ktx2(shape) : plan_dds(shape);
}

void write_container(const Texture& texture, Container container, const ByteSink& sink) {
    check_texture(texture);
    const ContainerPlan plan = plan_container(texture.shape(), container);
    std::map<std::uint64_t, const AnyImage*> images;
    for (std::size_t level = 0; level < plan.levels.size(); ++level)
        for (std::size_t i = 0; i < texture.levels[level].size(); ++i)
            images[plan.levels[level].start + i * plan.levels[level].stride] = &texture.levels[level][i];
    sink(plan.header);
    std::uint64_t position = plan.header.size();
    for (const auto& [start, image] : images) {
        const std::vector<std::byte> padding(start - position);
        const std::span<const std::byte> texels = bytes_of(*image);
        sink(padding), sink(texels);
        position = start + texels.size();
    }
}

}  // namespace bandlimit
