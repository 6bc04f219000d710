// Pictures in memory to and from files.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/color/depth.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/io/image_file.h"

namespace bandlimit::app {

/// What 1 to 4 channels are called: grey, grey and alpha, RGB, RGBA.
std::vector<std::string> channel_names(int channels);
/// The channel among so many that is alpha, or -1.
constexpr int alpha_among(int channels) { return channels == 2 || channels == 4 ? channels - 1 : -1; }

/// Writes linear light to a file of the given depth, encoded as the format and depth ask; 1, 3 or 4 channels.
void write_picture(const std::string& path, View<const float> linear, Depth depth = Depth::u8);

/// Writes values as they are, codes or what is no colour, to a file of 8 bits: 1 becomes the largest code.
void write_data(const std::string& path, View<const float> values);

/// The mean of a channel.
double mean_of(View<const float> image, int channel = 0);

/// Reads a whole file as linear light, alpha not multiplied.
Image<float> read_picture(const std::string& path, Space space = Space::automatic, Parallel parallel = {});

}  // namespace bandlimit::app
