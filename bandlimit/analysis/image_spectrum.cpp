#include "bandlimit/analysis/image_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/analysis/finite.h"
#include "bandlimit/analysis/taper.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/fft.h"

namespace bandlimit {
namespace {

std::vector<double> window_of(Window window, int count) {
    std::vector<double> w =
        window == Window::hann ? hann(count) : std::vector<double>(static_cast<std::size_t>(count), 1.0);
    double square = 0;
    for (const double v : w) square += v * v;
    for (double& v : w) v /= std::sqrt(square / count);
    return w;
}

/// Channel c of the image, weighted, and with the mean removed that it has under the weights.
ComplexGrid windowed(View<const float> image, int c, const std::vector<double>& wx, const std::vector<double>& wy) {
    const auto weight = [&](int x, int y) { return wx[static_cast<std::size_t>(x)] * wy[static_cast<std::size_t>(y)]; };
    double total = 0, weights = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            total += weight(x, y) * double(finite_or_zero(image(x, y, c)));
            weights += weight(x, y);
        }
    const double mean = total / weights;
    ComplexGrid grid(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            grid.at(x, y) = weight(x, y) * (double(finite_or_zero(image(x, y, c))) - mean);
    return grid;
}

}  // namespace

RadialSpectrum radial_spectrum(View<const float> image, Window window) {
    if (image.width < 1 || image.height < 1 || image.channels < 1)
        fail("radial_spectrum: image of ", image.width, " x ", image.height, " x ", image.channels, "; pass samples");
    RadialSpectrum spectrum;
    spectrum.step = 1.0 / std::max(image.width, image.height);
    const auto bins = static_cast<std::size_t>(std::numbers::sqrt2 / 2 / spectrum.step + 0.5) + 1;
    spectrum.density.resize(bins);
    spectrum.power.resize(bins);
    spectrum.coefficients.resize(bins);

    const double samples = double(image.width) * image.height;
    const std::vector<double> wx = window_of(window, image.width), wy = window_of(window, image.height);
    for (int c = 0; c < image.channels; ++c) {
        ComplexGrid grid = windowed(image, c, wx, wy);
        fft(grid);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const double f = std::hypot(bin_frequency(x, image.width), bin_frequency(y, image.height));
                const auto bin = static_cast<std::size_t>(f / spectrum.step + 0.5);
                spectrum.power[bin] += std::norm(grid.at(x, y)) / (samples * samples * image.channels);
                if (c == 0) ++spectrum.coefficients[bin];
            }
    }
    for (std::size_t b = 0; b < bins; ++b)
        spectrum.density[b] = spectrum.power[b] * samples / std::max(1, spectrum.coefficients[b]);
    return spectrum;
}

}  // namespace bandlimit
