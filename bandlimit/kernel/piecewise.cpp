#include "bandlimit/kernel/piecewise.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr std::size_t most_pieces = 64, most_coefficients = 16;
constexpr double largest_radius = 1000;

double polynomial(const KernelPiece& piece, double x) {
    double sum = 0;
    for (std::size_t n = piece.coefficients.size(); n-- > 0;) sum = sum * (x - piece.begin) + piece.coefficients[n];
    return sum;
}

}  // namespace

double value_of(const KernelPieces& pieces, double x) {
    x = std::abs(x);
    for (const KernelPiece& piece : pieces)
        if (x < piece.end) return polynomial(piece, x);
    // At a jump the mean of both sides, as all kernels are.
    return !pieces.empty() && x == pieces.back().end ? polynomial(pieces.back(), x) / 2 : 0;
}

Kernel piecewise_kernel(KernelPieces pieces, std::string name) {
    if (pieces.empty() || pieces.size() > most_pieces)
        fail("piecewise_kernel: ", pieces.size(), " pieces; pass 1 to ", most_pieces);
    double begin = 0;
    std::vector<double> knots;
    for (const KernelPiece& piece : pieces) {
        if (piece.begin != begin)
            fail("piecewise_kernel: a piece begins at ", piece.begin, "; let it begin at ", begin,
                 ", where the one before ends");
        if (!(piece.end > piece.begin && piece.end <= largest_radius))
            fail("piecewise_kernel: a piece from ", piece.begin, " to ", piece.end,
                 "; let it end further out, at most at ", largest_radius);
        const auto is_finite = [](double c) { return std::isfinite(c); };
        if (piece.coefficients.empty() || piece.coefficients.size() > most_coefficients ||
            !std::all_of(piece.coefficients.begin(), piece.coefficients.end(), is_finite))
            fail("piecewise_kernel: ", piece.coefficients.size(), " coefficients, finite or not; pass 1 to ",
                 most_coefficients, " finite ones");
        begin = piece.end;
        knots.push_back(begin);
    }
    knots.pop_back();
    const auto value = [pieces = std::move(pieces)](double x) { return value_of(pieces, x); };
    return {std::move(name), begin, value, Kernel::Form::separable, std::move(knots)};
}

}  // namespace bandlimit
