#include "apps/pictures.h"

namespace bandlimit::app {
namespace {

/// Row y of any view, channels interleaved.
void gather(View<const float> from, int y, std::vector<float>& row) {
    row.clear();
    for (int x = 0; x < from.width; ++x)
        for (int c = 0; c < from.channels; ++c) row.push_back(from(x, y, c));
}

ImageTarget target_of(View<const float> image, Depth depth) {
    ImageTarget target;
    target.width = image.width, target.height = image.height;
    target.channel_names = channel_names(image.channels);
    target.depth = depth;
    return target;
}

void write(const std::string& path, const ImageTarget& target, View<const float> image) {
    ImageWriter writer(path, target);
    AnyImage stored = make_image(target.depth, image.width, 1, image.channels);
    std::vector<float> row;
    for (int y = 0; y < image.height; ++y) {
        gather(image, y, row);
        encode_row(row, false, view_of(stored), 0, writer.encoding());
        writer.write_rows(const_view(view_of(stored)));
    }
    writer.finish();
}

}  // namespace

std::vector<std::string> channel_names(int channels) {
    switch (channels) {
        case 1: return {"Y"};
        case 2: return {"Y", "A"};
        case 3: return {"R", "G", "B"};
        default: return {"R", "G", "B", "A"};
    }
}

void write_picture(const std::string& path, View<const float> linear, Depth depth) {
    const bool is_linear = abilities_of(path).is_linear || !is_integer(depth);
    ImageTarget target = target_of(linear, depth);
    target.alpha = alpha_among(linear.channels);
    target.transfer = is_linear ? Transfer::linear : Transfer::srgb;
    write(path, target, linear);
}

void write_data(const std::string& path, View<const float> values) {
    ImageTarget target = target_of(values, Depth::u8);
    target.transfer = Transfer::linear;
    target.is_data = true;
    write(path, target, values);
}

double mean_of(View<const float> image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image(x, y, channel));
    return sum / image.width / image.height;
}

Image<float> read_picture(const std::string& path, Space space, Parallel parallel) {
    ImageReader reader(path, parallel.threads);
    const ImageInfo& info = reader.info();
    const Encoding encoding = info.encoding(space);
    Image<float> image(info.width, info.height, info.channels(), Layout::interleaved);
    AnyImage stored = make_image(info.depth, info.width, 1, info.channels());
    const auto row_length = static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels());
    for (int y = 0; y < info.height; ++y) {
        reader.read_rows(y, view_of(stored));
        decode_row(const_view(view_of(stored)), 0, encoding, false, {&image.view()(0, y), row_length});
    }
    return image;
}

}  // namespace bandlimit::app
