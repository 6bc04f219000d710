#include "bandlimit/math/fft.h"

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

void transform(ComplexGrid& grid, Direction direction) {
    Transform plan;
    std::vector<Complex> line, out;
    line.resize(static_cast<std::size_t>(grid.width));
    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) line[static_cast<std::size_t>(x)] = grid.at(x, y);
        transform(plan, out, line, direction);
        for (int x = 0; x < grid.width; ++x) grid.at(x, y) = out[static_cast<std::size_t>(x)];
    }
    line.resize(static_cast<std::size_t>(grid.height));
    for (int x = 0; x < grid.width; ++x) {
        for (int y = 0; y < grid.height; ++y) line[static_cast<std::size_t>(y)] = grid.at(x, y);
        transform(plan, out, line, direction);
        for (int y = 0; y < grid.height; ++y) grid.at(x, y) = out[static_cast<std::size_t>(y)];
    }
}

}  // namespace

std::vector<Complex> fft(std::span<const Complex> x) { return transform(x, Direction::forward); }
std::vector<Complex> inverse_fft(std::span<const Complex> x) { return transform(x, Direction::inverse); }
void fft(ComplexGrid& grid) { transform(grid, Direction::forward); }
void inverse_fft(ComplexGrid& grid) { transform(grid, Direction::inverse); }

double bin_frequency(int k, int count) { return static_cast<double>(2 * k < count ? k : k - count) / count; }

}  // namespace bandlimit
