// How much two images differ.
//
// Values are scaled so that white is 1, encoded or linear as the caller chooses, both images alike. Samples that are not
// finite count as 0 (finite.h). All sums are in double and in an order that only the size decides, so that results have
// the same bits for any number of threads and any blocks of rows.
// Stability: evolving.
#pragma once
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"

namespace bandlimit {

/// What is measured, per channel, and its mean (or maximum) over the channels.
struct Measures {
    double mse = 0;      ///< mean of (a - b)^2
    double max_abs = 0;  ///< largest |a - b|
    double ssim = 1;     ///< mean structural similarity, at most 1

    /// Peak signal to noise ratio in dB, -10 log10(mse); infinite for identical images.
    double psnr() const;
};
struct Metrics : Measures {
    std::vector<Measures> per_channel;
};

/// Mean squared and largest error of two images that arrive in blocks of rows.
class ErrorMeter {
public:
    /// Ignores samples nearer than `border` to an edge. Throws Error for sizes below 1, or if nothing is left.
    ErrorMeter(int width, int height, int channels, int border = 0, Parallel parallel = {});
    /// Takes the next rows of both. Throws Error for a different shape or more rows than `height`.
    void add_rows(View<const float> a, View<const float> b);
    /// Fills mse and max_abs, one entry per channel. Throws Error before the last row.
    void fill(std::vector<Measures>& per_channel) const;

private:
    int width_, height_, border_, rows_ = 0;
    Parallel parallel_;
    std::vector<double> square_, largest_;  ///< per channel
};

/// Structural similarity of two images that arrive in blocks of rows; at most 64 rows and the window are kept.
///
/// Wang, Bovik, Sheikh & Simoncelli 2004, eq. 13: an 11 x 11 Gaussian window of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 1,
/// variances of the population; the mean over all positions where the window lies inside the image (less its border).
/// If fewer than 11 samples are left along an axis, borders are reflected instead and all positions count.
///
/// range   |sample| < 1e9
/// error   moments are sums in float: about 1e-6 of the mean for values in [0, 1]; identical images give exactly 1
/// cost    44 multiply-adds per direction and sample, by the one engine
/// memory  per column and channel 74 times 8 bytes, and 2 MB per thread
class SsimMeter {
public:
    /// As ErrorMeter.
    SsimMeter(int width, int height, int channels, int border = 0, Parallel parallel = {});
    void add_rows(View<const float> a, View<const float> b);
    void fill(std::vector<Measures>& per_channel) const;

private:
    void hold_row(View<const float> a, View<const float> b, int y);
    void measure_held();

    int width_, height_, border_, rows_ = 0;
    Parallel parallel_;
    bool small_;                 ///< no window fits: all rows are held, and measured at the end
    Image<float> planes_;        ///< of the rows held: sum and difference, per channel
    int held_ = 0;               ///< rows in planes_
    std::vector<double> total_;  ///< sum of the similarities so far, per channel
    double positions_ = 0;       ///< how many
};

/// Means and maximum over at least one channel.
Metrics summarize(std::vector<Measures> per_channel);

/// All measures, for images in memory.
///
/// shapes   equal, at least 1 x 1
/// throws   Error for other shapes, or a border that leaves nothing
Metrics compare(View<const float> a, View<const float> b, int border = 0, Parallel parallel = {});

/// One of the measures.
double mse(View<const float> a, View<const float> b, int border = 0);
double psnr(View<const float> a, View<const float> b, int border = 0);
double max_abs(View<const float> a, View<const float> b, int border = 0);
double ssim(View<const float> a, View<const float> b, int border = 0);

}  // namespace bandlimit
