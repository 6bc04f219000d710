// Discrete Fourier transforms of any length.
// Stability: evolving.
#pragma once
#include <complex>
#include <span>
#include <vector>

#include "bandlimit/core/view.h"

namespace bandlimit {

/// X[k] = sum_n x[n] exp(-2 pi i k n / N), not scaled. Any N >= 1; fast for products of small primes.
std::vector<std::complex<double>> fft(std::span<const std::complex<double>> x);

/// The inverse of fft(), scaled by 1/N.
std::vector<std::complex<double>> inverse_fft(std::span<const std::complex<double>> x);

/// Complex values on a grid: row y, column x is at(x, y).
struct ComplexGrid {
    int width = 0, height = 0;
    std::vector<std::complex<double>> values;

    ComplexGrid() = default;
    ComplexGrid(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    std::complex<double>& at(int x, int y) {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    const std::complex<double>& at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

/// Transforms rows and columns in place; forward not scaled, inverse scaled by 1/(width * height).
void fft(ComplexGrid& grid);
void inverse_fft(ComplexGrid& grid);

/// The frequency of bin k of N, in cycles per sample, in [-1/2, 1/2).
double bin_frequency(int k, int count);

}  // namespace bandlimit
