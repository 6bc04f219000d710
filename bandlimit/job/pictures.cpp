#include "bandlimit/job/pictures.h"

#include <algorithm>

namespace bandlimit::job {
namespace {

constexpr int block_rows = 64;

ImageTarget target_of(View<const float> image, Depth depth) {
    ImageTarget target;
    target.width = image.width, target.height = image.height;
    target.channel_names = channel_names(image.channels);
    target.depth = depth;
    return target;
}

Image<float> read_whole(ImageReader& reader, const Encoding& encoding, const Parallel& parallel) {
    const ImageInfo& info = reader.info();
    Image<float> image(info.width, info.height, info.channels(), Layout::interleaved);
    PictureRows rows(reader, encoding, false, block_rows);
    for (int y = 0; y < info.height; y += block_rows)
        rows.read(y, cropped(image.view(), 0, y, info.width, std::min(block_rows, info.height - y)), parallel);
    return image;
}

void divide_by_alpha(View<float> image, int alpha) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < image.channels; ++c)
                if (const float a = image(x, y, alpha); c != alpha && a > 0) image(x, y, c) /= a;
}

void write(const std::string& path, const ImageTarget& target, View<const float> image, bool keeps_codes, int threads) {
    PictureWriter writer(path, target, keeps_codes, threads);
    writer.write(image);
    writer.finish();
}

}  // namespace

Image<float> read_picture(const std::string& path, Space space, const Parallel& parallel) {
    ImageReader reader(path, parallel.threads);
    return read_whole(reader, reader.info().encoding(space), parallel);
}

Image<float> read_codes(const std::string& path, const Parallel& parallel) {
    ImageReader reader(path, parallel.threads);
    Image<float> image = read_whole(reader, {}, parallel);
    if (reader.info().alpha >= 0 && reader.info().associated) divide_by_alpha(image.view(), reader.info().alpha);
    return image;
}

void write_picture(const std::string& path, View<const float> linear, Depth depth) {
    const bool is_linear = abilities_of(path).is_linear || !is_integer(depth);
    ImageTarget target = target_of(linear, depth);
    target.alpha = alpha_among(linear.channels);
    target.transfer = is_linear ? Transfer::linear : Transfer::srgb;
    write(path, target, linear, false, 0);
}

void write_codes(const std::string& path, const ImageTarget& target, View<const float> codes, int threads) {
    write(path, target, codes, true, threads);
}

void write_data(const std::string& path, View<const float> values) {
    ImageTarget target = target_of(values, Depth::u8);
    target.transfer = Transfer::linear;
    target.is_data = true;
    write_codes(path, target, values);
}

double mean_of(View<const float> image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image(x, y, channel));
    return sum / image.width / image.height;
}

PictureRows::PictureRows(ImageReader& reader, const Encoding& encoding, bool premultiplied, int most_rows)
    : reader_(reader), encoding_(encoding), premultiplied_(premultiplied) {
    const ImageInfo& info = reader.info();
    stored_ = make_image(info.depth, info.width, std::min(most_rows, info.height), info.channels());
}

void PictureRows::read(int y, View<float> to, const Parallel& parallel) {
    const AnyView stored = rows_of(view_of(stored_), 0, to.height);
    reader_.read_rows(y, stored);
    const auto length = static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.channels);
    parallel_for(to.height, 4, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int row = static_cast<int>(begin); row < end; ++row)
            decode_row(const_view(stored), row, encoding_, premultiplied_, {&to(0, row), length});
    });
}

PictureWriter::PictureWriter(const std::string& path, const ImageTarget& target, bool keeps_codes, int threads)
    : writer_(path, target, threads),
      encoding_(writer_.encoding()),
      stored_(make_image(target.depth, target.width, 1, static_cast<int>(target.channel_names.size()))) {
    if (keeps_codes) encoding_.transfer = Transfer::linear;
}

void PictureWriter::write(View<const float> values, bool premultiplied) {
    for (int y = 0; y < values.height; ++y) {
        row_.clear();
        for (int x = 0; x < values.width; ++x)
            for (int c = 0; c < values.channels; ++c) row_.push_back(values(x, y, c));
        encode_row(row_, premultiplied, view_of(stored_), 0, encoding_);
        writer_.write_rows(const_view(view_of(stored_)));
    }
}

}  // namespace bandlimit::job
