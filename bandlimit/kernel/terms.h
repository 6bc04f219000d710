// Weights in two dimensions as sums of separable ones, and as sums of phasors that turn into such.
#pragma once
#include <cstddef>
#include <vector>

namespace bandlimit {

/// Weights on a grid, row after row: what a sum of terms stands for.
struct WeightGrid {
    int width = 0, height = 0;
    std::vector<double> weights;

    WeightGrid() = default;
    WeightGrid(int w, int h)
        : width(w), height(h), weights(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    double& at(int x, int y) { return weights[index(x, y)]; }
    double at(int x, int y) const { return weights[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// One separable product: weight(x, y) = column[y] * row[x].
struct Term {
    std::vector<double> column, row;
};

/// A kernel of rank at most terms.size(): weight(x, y) = sum_t column_t[y] * row_t[x].
///
/// shapes   all columns have one length, all rows have one length; both >= 1
/// units    out(i, j) = sum_xy weight(x, y) in(i + first_x + x, j + first_y + y)
using Terms = std::vector<Term>;

/// The weights that `terms` are the sum of. Throws Error for no terms, empty ones, or lengths that differ.
WeightGrid expanded(const Terms& terms);

/// Where the first of `count` weights lies that are centred on their output: -(count / 2). An even count has no middle
/// sample: it moves what it filters by half a sample to the right and down, as -count / 2 + 1/2 is the centre's offset.
inline int centred_first(int count) { return -(count / 2); }

/// A complex phasor times a Gaussian, which is separable and circularly symmetric in magnitude (Niemitalo 2011,
/// "Circularly symmetric convolution and lens blur"): the real part of (A - iB) exp((-a + ib) (x^2 + y^2)).
///
/// units    x and y in radii of the disc that a sum of them stands for
struct Component {
    double a = 0, b = 0, A = 0, B = 0;
};
using Components = std::vector<Component>;

}  // namespace bandlimit
