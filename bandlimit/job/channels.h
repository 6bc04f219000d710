// What the channels of pictures are called.
// Stability: evolving.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/core/image.h"

namespace bandlimit::job {

/// What 1 to 4 channels are called: grey, grey and alpha, RGB, RGBA.
std::vector<std::string> channel_names(int channels);
/// The channel among so many that is alpha, or -1.
constexpr int alpha_among(int channels) { return channels == 2 || channels == 4 ? channels - 1 : -1; }
/// Channels first, first + 1, ... of a picture, interleaved.
Image<float> channels_copied(View<const float> all, int first, int count);

}  // namespace bandlimit::job
