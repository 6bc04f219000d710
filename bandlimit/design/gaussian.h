// Gaussian blurs for the bilinear sampler of a GPU.
// Stability: evolving.
#pragma once
#include <optional>
#include <vector>

#include "bandlimit/kernel/fetches.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {

struct GaussianOptions {
    enum class Form {
        least_squares,  ///< the smallest error, of weights that are not negative
        sampled,        ///< samples of the Gaussian
        integrated,     ///< its integrals over the samples' cells: wider, by a variance of 1/12
        discrete        ///< exp(-sigma^2) I_n(sigma^2), whose variance is exactly sigma^2, apart from truncation
    };

    double sigma = 1;                 ///< samples, 0.1 to 250
    std::optional<int> fetches = {};  ///< linear reads, 1 to 2048; default 1 + ceil(3 sigma), which reach 3 sigma
    Form form = Form::least_squares;
};

/// A blur along one axis; along both, one after the other, it is the round one.
struct GaussianDesign {
    Taps taps;                      ///< symmetric, sum 1: as many as the reads can hold, 2 fetches - 1
    std::vector<LinearRead> reads;  ///< exactly `taps`, symmetric
    double error = 0;               ///< mean of |H - G|^2 over |f| < 1/2 relative to that of G^2
    double variance = 0;            ///< what the taps have for sigma^2, in squared samples
};

/// The response of the ideal blur, G(f) = exp(-2 (pi sigma f)^2); f in cycles per sample.
double gaussian_response(double sigma, double f);

/// The best blur of so many linear reads.
///
/// n reads hold any 2n - 1 symmetric weights that are not negative: neighbours share a read, and where that leaves a
/// pair across the middle, both halves read half of the middle sample. So the best reads are the best taps, folded.
/// By Parseval the error of taps is their squared distance from the samples g of G's inverse transform over |f| < 1/2,
/// and the nearest ones that are not negative and sum to 1 are max(g - t, 0) with the t that makes the sum 1.
///
/// cost     32 sigma + 8 points of quadrature per weight
/// throws   Error for options out of range
/// example  design_gaussian({.sigma = 2, .fetches = 5})
GaussianDesign design_gaussian(const GaussianOptions& options);

}  // namespace bandlimit
