#include "bandlimit/kernel/low_rank.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

std::vector<double> scaled(const std::vector<double>& values, double factor) {
    std::vector<double> result(values);
    for (double& v : result) v *= factor;
    return result;
}

/// What part of the sum of parts(value) the first 1, 2, ... values hold.
template <class Part>
std::vector<double> cumulative_share(std::span<const double> values, Part part) {
    std::vector<double> shares;
    double sum = 0;
    for (const double v : values) shares.push_back(sum += part(v));
    for (double& share : shares) share = sum > 0 ? share / sum : 1;
    return shares;
}

}  // namespace

Svd svd_of(const WeightGrid& grid) { return svd(grid.weights, grid.height, grid.width); }

int numerical_rank(std::span<const double> values, int rows, int columns) {
    if (values.empty()) return 0;
    const double rounding = std::max(rows, columns) * std::numeric_limits<double>::epsilon() * values[0];
    return static_cast<int>(std::count_if(values.begin(), values.end(), [&](double v) { return v > rounding; }));
}

Terms low_rank(const Svd& decomposition, int rank) {
    const int count = static_cast<int>(decomposition.values.size());
    if (rank < 1 || rank > count)
        fail("low_rank: rank = ", rank, "; pass 1 to ", count, ", as many as singular values");
    const int exact = numerical_rank(decomposition.values, static_cast<int>(decomposition.left[0].size()),
                                     static_cast<int>(decomposition.right[0].size()));
    Terms terms;
    for (int k = 0; k < std::min(rank, std::max(exact, 1)); ++k) {
        const auto i = static_cast<std::size_t>(k);
        const double root = std::sqrt(decomposition.values[i]);
        terms.push_back({scaled(decomposition.left[i], root), scaled(decomposition.right[i], root)});
    }
    return terms;
}

Terms low_rank(const WeightGrid& grid, int rank) { return low_rank(svd_of(grid), rank); }

std::vector<double> cumulative_energy(std::span<const double> values) {
    return cumulative_share(values, [](double v) { return v * v; });
}

std::vector<double> cumulative_sum(std::span<const double> values) {
    return cumulative_share(values, [](double v) { return v; });
}

int rank_for_energy(std::span<const double> values, double share) {
    if (!(share > 0 && share < 1) || values.empty())
        fail("rank_for_energy: a share of ", share, " of ", values.size(), " values; pass a share between 0 and 1");
    const std::vector<double> held = cumulative_energy(values);
    return 1 + static_cast<int>(std::find_if(held.begin(), held.end(), [&](double h) { return h >= share; }) -
                                held.begin());
}

}  // namespace bandlimit
