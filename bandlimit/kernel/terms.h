// Weights in two dimensions as sums of separable products, and phasors that expand to such sums.
// Stability: stable.
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

/// The number of weights along each axis.
struct WeightSize {
    int width = 0, height = 0;

    double count() const { return double(width) * height; }
};

/// The size of the grid that `terms` expand to. Throws Error for no terms, empty ones, or lengths that differ.
WeightSize size_of(const Terms& terms);

/// The weights that `terms` sum to. Throws Error as size_of().
/// cost     memory of width * height numbers, though terms have width + height
WeightGrid expanded(const Terms& terms);

/// The sum of all weights of `terms`: their gain for constants. Cost: linear in the weights of columns and rows.
double sum(const Terms& terms);

/// The magnitudes of the products' weights, added up: no less than those of the weights that they sum to.
double magnitude(const Terms& terms);

/// `terms` divided by their sum, so that constants are preserved. Throws Error where they cancel(), see kernel/taps.h.
Terms with_unit_sum(Terms terms);

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

/// What `components` sum to at `r` radii from the centre.
///
/// throws   Error for no components, one that is not finite, or one with a <= 0; so do all below
double value_at(const Components& components, double r);

/// The integral of that over the plane, in square radii; pi is what the disc has.
double integral(const Components& components);

/// How far from the centre weights must go, in whole samples, so that those left out sum, without their signs, to at
/// most `share` of the integral: what is cut then changes no output by more than that share of the largest input.
///
/// units    radius in samples
/// error    the bound takes each component by itself: near twice what is cut where that is 1/100
/// throws   Error unless radius > 0 and 0 < share < 1; for components whose integral is not positive
int reach_for(const Components& components, double radius, double share = 0.01);

/// `components` on the samples as real products, two a component: with f = g + ih = exp((-a + ib) x^2),
/// Re (A - iB) f(x) f(y) = g(x) (A g(y) + B h(y)) + h(x) (B g(y) - A h(y)).
///
/// shapes   2 components.size() terms of 2 reach + 1 weights in columns and rows, centred
/// units    radius and reach in samples. The weights are as high as the kernel, 1 within a disc, and so sum to about
///          pi radius^2: with_unit_sum() for a blur
/// throws   Error unless radius > 0 and 0 <= reach <= 1000000
/// source   Niemitalo 2011, as above
/// example  with_unit_sum(separable_terms(components, 25, reach_for(components, 25)))
Terms separable_terms(const Components& components, double radius, int reach);

}  // namespace bandlimit
