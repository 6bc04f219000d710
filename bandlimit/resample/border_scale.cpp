#include "bandlimit/resample/border_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {
namespace {

constexpr double least_inside = 1e-9;  // of all weights: differences of sums leave too few digits of less

/// Numbers equal keys from 0 on; `ordinary` is the key of number 0. Examples hold an index of each number, -1 for an
/// ordinary one that does not occur.
template <class Key>
std::vector<int> numbered(const std::vector<Key>& keys, const Key& ordinary, std::vector<int>& examples) {
    std::map<Key, int> known{{ordinary, 0}};
    examples = {-1};
    std::vector<int> numbers;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto [at, is_new] = known.try_emplace(keys[i], static_cast<int>(known.size()));
        if (is_new) examples.push_back(static_cast<int>(i));
        else if (at->second == 0) examples[0] = static_cast<int>(i);
        numbers.push_back(at->second);
    }
    return numbers;
}

/// The weights of each of `count` outputs that are inside, as indices.
std::vector<std::pair<int, int>> parts_inside(int first, int weights, int count, Edge edge) {
    std::vector<std::pair<int, int>> parts;
    for (int x = 0; x < count; ++x) {
        const bool drops = edge == Edge::renormalize;
        const int begin = drops ? std::clamp(-(x + first), 0, weights) : 0;
        parts.emplace_back(begin, drops ? std::clamp(count - (x + first), begin, weights) : weights);
    }
    return parts;
}

std::vector<double> magnitudes_of(std::vector<double> weights) {
    for (double& w : weights) w = std::abs(w);
    return weights;
}

/// Sums of the first 0, 1, 2, ... weights.
std::vector<double> sums_from_first(const std::vector<double>& weights) {
    std::vector<double> sums(weights.size() + 1);
    std::partial_sum(weights.begin(), weights.end(), sums.begin() + 1);
    return sums;
}

/// Sums of weights from `part.first` to `part.second`, by sums_from_first().
double sum_of(const std::vector<double>& sums, std::pair<int, int> part) {
    return sums[static_cast<std::size_t>(part.second)] - sums[static_cast<std::size_t>(part.first)];
}

/// Sums over rectangles of a grid of weights.
class AreaSums {
public:
    explicit AreaSums(const WeightGrid& weights)
        : pitch_(static_cast<std::size_t>(weights.width) + 1),
          sums_(pitch_ * (static_cast<std::size_t>(weights.height) + 1)) {
        for (int y = 0; y < weights.height; ++y) {
            double row = 0;
            for (int x = 0; x < weights.width; ++x) {
                row += weights.at(x, y);
                sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
            }
        }
    }
    double whole() const { return sums_.back(); }
    double of(std::pair<int, int> x, std::pair<int, int> y) const {
        const auto corner = [&](int i, int j) { return sums_[index(i, j)]; };
        return corner(x.second, y.second) - corner(x.first, y.second) - corner(x.second, y.first) +
               corner(x.first, y.first);
    }

private:
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * pitch_ + static_cast<std::size_t>(x); }

    std::size_t pitch_;
    std::vector<double> sums_;
};

}  // namespace

template <class Inside>
void BorderScale::fill(const WeightSum& whole, const std::vector<int>& example_x, const std::vector<int>& example_y,
                       Inside inside) {
    kinds_x_ = static_cast<int>(example_x.size());
    if (example_x.size() == 1 && example_y.size() == 1) return static_cast<void>(kind_x_ = kind_y_ = {});
    if (cancels(whole.sum, whole.magnitude))
        fail("Edge::renormalize: weights that sum to ", whole.sum, " cannot be renormalized; use Edge::reflect");
    for (const int y : example_y)
        for (const int x : example_x) {
            const WeightSum part =
                x < 0 || y < 0 ? whole : inside(static_cast<std::size_t>(x), static_cast<std::size_t>(y));
            if (cancels(part.sum, part.magnitude) || part.magnitude <= least_inside * whole.magnitude)
                fail("Edge::renormalize: output (", x, ", ", y,
                     ") has no weight inside the image; use Edge::clamp or Edge::reflect");
            scale_.push_back(static_cast<float>(whole.sum / part.sum));
        }
}

BorderScale::BorderScale(const WeightGrid& weights, int first_x, int first_y, int width, int height, Edge edge_x,
                         Edge edge_y) {
    const auto inside_x = parts_inside(first_x, weights.width, width, edge_x);
    const auto inside_y = parts_inside(first_y, weights.height, height, edge_y);
    std::vector<int> example_x, example_y;
    kind_x_ = numbered(inside_x, {0, weights.width}, example_x);
    kind_y_ = numbered(inside_y, {0, weights.height}, example_y);
    WeightGrid magnitudes = weights;
    magnitudes.weights = magnitudes_of(weights.weights);
    const AreaSums sums(weights), sizes(magnitudes);
    fill({sums.whole(), sizes.whole()}, example_x, example_y, [&](std::size_t x, std::size_t y) {
        return WeightSum{sums.of(inside_x[x], inside_y[y]), sizes.of(inside_x[x], inside_y[y])};
    });
}

BorderScale::BorderScale(const Terms& terms, int first_x, int first_y, int width, int height, Edge edge_x,
                         Edge edge_y) {
    const WeightSize size = size_of(terms);
    const auto inside_x = parts_inside(first_x, size.width, width, edge_x);
    const auto inside_y = parts_inside(first_y, size.height, height, edge_y);
    std::vector<int> example_x, example_y;
    kind_x_ = numbered(inside_x, {0, size.width}, example_x);
    kind_y_ = numbered(inside_y, {0, size.height}, example_y);
    struct Sums {
        std::vector<double> x, y, size_x, size_y;
    };
    std::vector<Sums> sums;
    for (const Term& term : terms)
        sums.push_back({sums_from_first(term.row), sums_from_first(term.column),
                        sums_from_first(magnitudes_of(term.row)), sums_from_first(magnitudes_of(term.column))});
    const auto within = [&](std::pair<int, int> x, std::pair<int, int> y) {
        WeightSum all;
        for (const Sums& s : sums) {
            all.sum += sum_of(s.x, x) * sum_of(s.y, y);
            all.magnitude += sum_of(s.size_x, x) * sum_of(s.size_y, y);
        }
        return all;
    };
    fill(within({0, size.width}, {0, size.height}), example_x, example_y,
         [&](std::size_t x, std::size_t y) { return within(inside_x[x], inside_y[y]); });
}

BorderScale::BorderScale(std::span<const std::pair<double, double>> whole,
                         const std::vector<std::vector<double>>& inside_x,
                         const std::vector<std::vector<double>>& inside_y) {
    std::vector<double> whole_x, whole_y;
    for (const auto& [x, y] : whole) {
        whole_x.push_back(x);
        whole_y.push_back(y);
    }
    std::vector<int> example_x, example_y;
    kind_x_ = numbered(inside_x, whole_x, example_x);
    kind_y_ = numbered(inside_y, whole_y, example_y);
    const auto products = [](const std::vector<double>& x, const std::vector<double>& y) {
        WeightSum all;
        for (std::size_t t = 0; t < x.size(); ++t) {
            all.sum += x[t] * y[t];
            all.magnitude += std::abs(x[t] * y[t]);
        }
        return all;
    };
    fill(products(whole_x, whole_y), example_x, example_y,
         [&](std::size_t x, std::size_t y) { return products(inside_x[x], inside_y[y]); });
}

void BorderScale::apply(std::span<float> row, int first_x, int y, int channels) const {
    if (kind_x_.empty()) return;
    const auto count = static_cast<std::size_t>(channels);
    const float* const scales =
        scale_.data() + static_cast<std::ptrdiff_t>(kind_y_[static_cast<std::size_t>(y)]) * kinds_x_;
    const int* const kinds = kind_x_.data() + first_x;
    const bool is_ordinary = kind_y_[static_cast<std::size_t>(y)] == 0;
    for (std::size_t x = 0; x < row.size() / count; ++x) {
        if (is_ordinary && kinds[x] == 0) continue;
        const float scale = scales[kinds[x]];
        for (float& sample : row.subspan(x * count, count)) sample *= scale;
    }
}

}  // namespace bandlimit
