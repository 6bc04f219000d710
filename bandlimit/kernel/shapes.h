// Shapes on a grid: kernels in two dimensions, to blur with or to decompose into separable ones.
// Stability: evolving.
#pragma once
#include <span>
#include <string_view>

#include "bandlimit/kernel/terms.h"

namespace bandlimit {

/// One line of documentation.
struct ShapeInfo {
    std::string_view name;     ///< with its parameters, as "disc:SIZE:LIMIT"
    std::string_view example;  ///< a text that parse_shape() takes
    std::string_view summary;
};

/// All shapes. Angles go from x towards y, which is down in a picture.
std::span<const ShapeInfo> shape_list();

/// The shape that `text` describes, as "disc:50:0.8", on SIZE x SIZE points: x and y go in equal steps from -1 to 1,
/// both included. Sharp shapes are 1 inside and 0 outside, where what lies on the border (within 1e-12) is outside.
///
/// range    SIZE 2 to 4096; the weights are as the list says, not scaled to a sum of 1
/// throws   Error for an unknown name (listing the names), for parameters that are missing, extra, not numbers or out
///          of range, and where no point of the grid has a weight other than 0
/// source   Wronski 2020, "Separate your filters! Separability, SVD and low-rank approximation of 2D image processing
///          filters", for disc, box, exponential, gaussian, difference-of-gaussians and polygon:50:8:0.9:0 (called
///          "hexagon" there)
WeightGrid parse_shape(std::string_view text);

/// The shape that `text` describes without its size, as "disc:0.8", on size x size points. Else as above.
WeightGrid parse_shape(std::string_view text, int size);

}  // namespace bandlimit
