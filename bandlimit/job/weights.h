// Weights in two dimensions as users name them: shapes, images, and files of taps.
//
//     WeightGrid star = job::read_weights("star.png");
//     ConvolutionWeights soft = job::weights_of(read_taps("binomial.json"), "binomial.json");
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/filter/convolve.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit::job {

/// Whether `text` names a shape of shape_list(), or something that has the form of one: with colons, or without the dot
/// and slash that files have. What is neither is the path of an image.
bool is_shape_name(const std::string& text);

/// An image as weights: the mean of its colours times alpha, with 1 for the largest code. Space::data takes codes as
/// they are; the others decode them.
///
/// memory   the weights as doubles, and a row of the image
/// throws   std::runtime_error for files that cannot be read, for sides above `largest_side` (where that is not 0), and
///          for weights that are not finite
WeightGrid read_weights(const std::string& path, Space space = Space::data, int largest_side = 0);

/// Those of the shape that `text` names, or else of the image.
/// throws   Error as parse_shape, and for a larger shape; else as read_weights()
WeightGrid shape_or_image(const std::string& text, Space space, int largest_side);

/// Along which axes taps of one axis run.
enum class TapsAxis { x, y, both };

/// The weights of a taps.json, which came from `name`: of taps, terms, fetches (bilinear reads: four weights each) or
/// components, whatever it has first.
///
/// units    `radius` in pixels, for components without terms, which fit any; 0 for files that have weights
/// throws   OptionError for an axis or a radius that the file has no use for, and for files without weights that could
///          run over a picture of the same size; std::runtime_error for fetches more than 2048 texels apart
ConvolutionWeights weights_of(const TapsFile& file, const std::string& name, TapsAxis axis = TapsAxis::both,
                              double radius = 0);

}  // namespace bandlimit::job
