// Whole pictures from files and to files, as floats.
//
//     Image<float> photo = job::read_picture("photo.jpg");
//     job::write_picture("half.png", resample(photo.view(), photo.width() / 2, photo.height() / 2).view());
//
// What files themselves are like is in io/image_file.h, whose errors all of these throw.
// Stability: evolving.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/color/depth.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/job/channels.h"

namespace bandlimit::job {

/// A whole file in linear light, channels interleaved. Colour is not multiplied by alpha, unless the file stores it so.
/// memory   the picture, and a few of its rows
/// throws   std::runtime_error for what cannot be read; Stopped
Image<float> read_picture(const std::string& path, Space space = Space::automatic, const Parallel& parallel = {});

/// A whole file with its codes as they are, 1 for the largest, whatever they mean. Colour that the file stores
/// multiplied by alpha is divided by it. Else as read_picture().
Image<float> read_codes(const std::string& path, const Parallel& parallel = {});

/// Writes linear light, encoded as the format and the depth ask: 1 to 4 channels, of which the last of two or four is
/// alpha, and colour is not multiplied by it.
/// throws   std::runtime_error for what cannot be written, Error for what the format cannot hold. The file appears
///          whole or not at all
void write_picture(const std::string& path, View<const float> linear, Depth depth = Depth::u8);

/// Writes codes as they are to a file that is like `target`: 1 becomes the largest code. Else as write_picture().
void write_codes(const std::string& path, const ImageTarget& target, View<const float> codes, int threads = 0);

/// Writes what is not colour, as normals or masks, to a file of 8 bits. Else as write_codes().
void write_data(const std::string& path, View<const float> values);

/// The mean of a channel.
double mean_of(View<const float> image, int channel = 0);

/// The rows of a file as floats, a block at a time: for pictures that need not be in memory whole.
class PictureRows {
public:
    /// No block has more than `most_rows`. `encoding` and `premultiplied` are those of decode_row().
    PictureRows(ImageReader& reader, const Encoding& encoding, bool premultiplied, int most_rows);
    /// Reads rows [y, y + to.height) into `to`, whose channels are interleaved. From top to bottom costs least.
    void read(int y, View<float> to, const Parallel& parallel = {});

private:
    ImageReader& reader_;
    Encoding encoding_;
    bool premultiplied_;
    AnyImage stored_;
};

/// The rows of a new file, from floats, from top to bottom.
class PictureWriter {
public:
    /// As ImageWriter. Where `keeps_codes`, values are codes and not linear light.
    PictureWriter(const std::string& path, const ImageTarget& target, bool keeps_codes, int threads = 0);
    /// Appends the rows of `values`; `premultiplied`: their colour is multiplied by alpha.
    void write(View<const float> values, bool premultiplied = false);
    /// As ImageWriter::finish.
    void finish() { writer_.finish(); }

private:
    ImageWriter writer_;
    Encoding encoding_;
    AnyImage stored_;
    std::vector<float> row_;
};

}  // namespace bandlimit::job
