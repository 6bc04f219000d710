#include "bandlimit/math/fft.h"

#include <algorithm>
#include <unsupported/Eigen/FFT>

namespace bandlimit {
namespace {

using Complex = std::complex<double>;
using Transform = Eigen::FFT<double>;

enum class Direction { forward, inverse };

void transform(Transform& plan, std::vector<Complex>& out, const std::vector<Complex>& in, Direction direction) {
    // The plan of length 1 is the identity; Eigen's factoring would loop on it.
    if (in.size() <= 1) out = in;
    else if (direction == Direction::forward) plan.fwd(out, in);
    else plan.inv(out, in);
}

std::vector<Complex> transform(std::span<const Complex> x, Direction direction) {
    Transform plan;
    std::vector<Complex> out;
    transform(plan, out, {x.begin(), x.end()}, direction);
    return out;
}

/// Columns that are moved together: two lines of a cache of 64 bytes.
constexpr int columns_moved = 8;

void transform(ComplexGrid& grid, Direction direction) {
    Transform plan;
    std::vector<Complex> line(static_cast<std::size_t>(grid.width)), out;
    for (int y = 0; y < grid.height; ++y) {
        Complex* const row = &grid.at(0, y);
        std::copy_n(row, grid.width, line.data());
        transform(plan, out, line, direction);
        std::copy_n(out.data(), grid.width, row);
    }
    std::vector<std::vector<Complex>> columns(columns_moved,
                                              std::vector<Complex>(static_cast<std::size_t>(grid.height)));
    for (int x = 0; x < grid.width; x += columns_moved) {
        const auto count = static_cast<std::size_t>(std::min(columns_moved, grid.width - x));
        for (int y = 0; y < grid.height; ++y)
            for (std::size_t i = 0; i < count; ++i) columns[i][static_cast<std::size_t>(y)] = (&grid.at(x, y))[i];
        for (std::size_t i = 0; i < count; ++i) {
            transform(plan, out, columns[i], direction);
            columns[i].swap(out);
        }
        for (int y = 0; y < grid.height; ++y)
            for (std::size_t i = 0; i < count; ++i) (&grid.at(x, y))[i] = columns[i][static_cast<std::size_t>(y)];
    }
}

}  // namespace

std::vector<Complex> fft(std::span<const Complex> x) { return transform(x, Direction::forward); }
std::vector<Complex> inverse_fft(std::span<const Complex> x) { return transform(x, Direction::inverse); }
void fft(ComplexGrid& grid) { transform(grid, Direction::forward); }
void inverse_fft(ComplexGrid& grid) { transform(grid, Direction::inverse); }

double bin_frequency(int k, int count) { return static_cast<double>(2 * k < count ? k : k - count) / count; }

}  // namespace bandlimit
