#include "bandlimit/job/level_images.h"

#include <filesystem>

#include "bandlimit/core/error.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/channels.h"

namespace bandlimit::job {
namespace {

constexpr std::string_view number_mark = "%d";

/// The channels of texels that an image of `channels` holds: the first ones, or grey and alpha out of RGBA.
AnyConstView channels_of(const AnyImage& image, const LevelFormat& format) {
    return std::visit(
        [&](const auto& i) -> AnyConstView {
            auto view = i.view();
            if (format.channels == 2 && view.channels == 4 && !format.is_data) view.dc *= 3;
            view.channels = format.channels;
            return view;
        },
        image);
}

/// What those channels mean.
Encoding encoding_of_channels(const TexelFormat& texels, const LevelFormat& format) {
    Encoding encoding = encoding_of(texels, format.is_data);
    encoding.alpha = format.is_data ? -1 : job::alpha_among(format.channels);
    return encoding;
}

ImageTarget target_of(const LevelFormat& format, int width, int height) {
    ImageTarget target;
    target.width = width, target.height = height;
    target.channel_names = job::channel_names(format.channels);
    target.depth = format.depth;
    target.alpha = format.is_data ? -1 : job::alpha_among(format.channels);
    target.transfer = format.transfer;
    target.is_data = format.is_data;
    return target;
}

bool are_alike(const Encoding& a, const Encoding& b) {
    return a.transfer == b.transfer && a.alpha == b.alpha && (a.alpha < 0 || a.associated == b.associated);
}

/// Writes all rows of `view`, whose samples mean `from`, as the file's samples are meant.
void write_rows(ImageWriter& writer, const AnyConstView& view, const Encoding& from, Depth depth) {
    if (depth_of(view) == depth && are_alike(from, writer.encoding())) return writer.write_rows(view);
    const auto [width, height, channels] = std::visit(
        [](const auto& v) {
            return std::array{v.width, v.height, v.channels};
        },
        view);
    AnyImage stored = make_image(depth, width, 1, channels);
    std::vector<float> row(static_cast<std::size_t>(width) * static_cast<std::size_t>(channels));
    for (int y = 0; y < height; ++y) {
        decode_row(view, y, from, from.associated, row);
        encode_row(row, from.associated, view_of(stored), 0, writer.encoding());
        writer.write_rows(const_view(view_of(stored)));
    }
}

/// Gives all files their names, or takes back those that got it before one failed.
void finish(std::vector<ImageWriter>& writers, const std::string& pattern) {
    std::size_t done = 0;
    try {
        for (; done < writers.size(); ++done) writers[done].finish();
    } catch (...) {
        std::error_code ignored;
        for (std::size_t level = 0; level < done; ++level)
            std::filesystem::remove(path_of_level(pattern, static_cast<int>(level)), ignored);
        throw;
    }
}

}  // namespace

std::string path_of_level(const std::string& pattern, int level) {
    std::string path = pattern;
    return path.replace(path.find(number_mark), number_mark.size(), std::to_string(level));
}

void check_level_pattern(const std::string& pattern) {
    const std::size_t first = pattern.find(number_mark);
    if (first == std::string::npos)
        fail(pattern,
             ": every level is an image, and their names are one; write %d where the number of the level goes, "
             "as name_%d.png, or name a .ktx2 or .dds file");
    if (pattern.find(number_mark, first + 1) != std::string::npos)
        fail(pattern, ": holds %d twice; write it once, as name_%d.png");
    abilities_of(pattern);
}

void write_level_images(const std::string& pattern, const Texture& texture, const LevelFormat& format, int threads) {
    const Encoding from = encoding_of_channels(texture.format, format);
    std::vector<ImageWriter> writers;
    for (std::size_t level = 0; level < texture.levels.size(); ++level) {
        const AnyImage& image = texture.image(static_cast<int>(level));
        const auto [width, height] = std::visit([](const auto& i) { return std::array{i.width(), i.height()}; }, image);
        writers.emplace_back(path_of_level(pattern, static_cast<int>(level)), target_of(format, width, height),
                             threads);
        write_rows(writers.back(), channels_of(image, format), from, format.depth);
    }
    finish(writers, pattern);
}

}  // namespace bandlimit::job
