// The blur of a lens on a picture file.
//
//     job::BokehJob blur;
//     blur.files = {"night.jpg", "bokeh.png"};
//     blur.shape = "polygon:6:0.9:15";
//     blur.radius = 12;
//     blur.gamma = 7;
//     job::bokeh(blur);
// Stability: evolving.
#pragma once
#include <string>

#include "bandlimit/job/convolve.h"

namespace bandlimit::job {

struct BokehJob {
    PictureFiles files;
    std::string shape = "disc";  ///< an image file, or as aperture() takes it; "disc" alone is "disc:1"
    double radius = 0;           ///< 0.5 to 1000 pixels, fractions allowed
    double gamma = 1;            ///< 0.1 to 16: as boosted()
    int components = 0;          ///< above 0: so many phasors fitted to the disc instead, an approximation
    WeightOptions options{};
};

/// Throws Error for what the options alone show to be wrong.
void check(const BokehJob& job);

/// Blurs a file into another: every light becomes a picture of the aperture, as it is drawn.
///
/// throws   as check() and convolve()
ConvolveReport bokeh(const BokehJob& job, const Context& context = {});

}  // namespace bandlimit::job
