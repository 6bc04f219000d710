// Kernels in two dimensions, as users name them: shapes, and pictures of kernels.
#pragma once
#include <string>

#include "bandlimit/io/image_file.h"
#include "bandlimit/kernel/terms.h"

namespace bandlimit::app {

/// Whether `text` names a shape of shape_list(), or something that has the form of one: with colons, or without the dot
/// and slash that files have. What is neither is the path of an image.
bool is_shape_name(const std::string& text);

/// The weights that `text` names: those of the shape, or the image's samples with 1 for the largest code. Of colours
/// the mean of the channels.
///
/// throws   Error as parse_shape; std::runtime_error for files that cannot be read, that have alpha, or that are larger
///          than `largest_side`
WeightGrid read_weights(const std::string& text, Space space, int largest_side);

/// All shapes with what they are, a line each.
std::string shape_lines();

}  // namespace bandlimit::app
