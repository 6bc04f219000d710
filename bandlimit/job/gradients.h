// Derivatives of a picture file.
//
//     job::GradientJob edges;
//     edges.files = {"photo.jpg", "edges.png"};
//     edges.derivative = "sobel";
//     job::gradients(edges);
// Stability: evolving.
#pragma once
#include <optional>
#include <string>

#include "bandlimit/filter/corners.h"
#include "bandlimit/filter/gradients.h"
#include "bandlimit/job/picture_filter.h"

namespace bandlimit::job {

struct GradientJob {
    /// The depth is by default f32 where the format of the output has it, else that of the input or the nearest. Heights
    /// for normals are mostly Space::data.
    PictureFiles files = {};
    std::string derivative = "scharr";  ///< as parse_derivative(), or "taps:FILE", weights of a taps.json
    GradientOptions options = {};       ///< premultiply is what `files` say
    std::string corners = {};           ///< if not empty: a file to write the corners of the input to, .csv or .json
    CornerOptions of_corners = {};
};

struct GradientReport : PictureReport {
    DerivativeOperator derivative;
    std::optional<int> corners = {};  ///< how many were written
};

/// Throws OptionError for an edge, a result or an operator that does not fit, as far as no file needs to be read.
void check(const GradientJob& job);

/// Differentiates a file into another, a band of rows at a time.
///
/// memory   a few bands of rows; for corners the picture and its gradients, whole
/// notes    as filter_picture(); values below 0 that the output cannot hold; taps that change the slope of ramps
/// throws   what check() throws, also for taps; std::runtime_error for files; Stopped. The output appears whole or not at all
GradientReport gradients(const GradientJob& job, const Context& context = {});

}  // namespace bandlimit::job
