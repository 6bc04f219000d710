// Functions as tables.
// Stability: inner.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace bandlimit {

/// Four neighbours of a position in a table of `cells` + 1 values, and their weights: the cubic through them.
struct CubicStencil {
    int first;
    std::array<double, 4> weights;

    /// `position` in steps of the table, 0 to `cells` >= 3; positions outside take the value at that end.
    CubicStencil(double position, int cells) {
        position = std::clamp(position, 0.0, double(cells));
        first = std::clamp(static_cast<int>(position) - 1, 0, cells - 3);
        const double t = position - first, a = t - 1, b = t - 2, c = t - 3;
        weights = {-a * b * c / 6, t * b * c / 2, -t * a * c / 2, t * a * b / 6};
    }
};

/// A function of one argument on [begin, end], by its values at equal steps; constant outside.
///
/// error  (3 / 128) step^4 times its fourth derivative inside; step^2 / 8 times the jump of its slope beside a knot
class CubicTable {
public:
    CubicTable() = default;
    template <class F>
    CubicTable(double begin, double end, int cells, const F& f)
        : begin_(begin), per_unit_(cells / (end - begin)), cells_(cells) {
        for (int i = 0; i <= cells; ++i) values_.push_back(f(i == cells ? end : begin + i / per_unit_));
    }

    double operator()(double x) const {
        const CubicStencil s((x - begin_) * per_unit_, cells_);
        const double* v = values_.data() + s.first;
        return s.weights[0] * v[0] + s.weights[1] * v[1] + s.weights[2] * v[2] + s.weights[3] * v[3];
    }

private:
    double begin_ = 0, per_unit_ = 1;
    int cells_ = 0;
    std::vector<double> values_;
};

}  // namespace bandlimit
