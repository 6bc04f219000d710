#include "bandlimit/resample/border_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double negligible = 1e-6;  // of the sum of magnitudes: the rounding of weights to floats

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

double magnitude_of(const std::vector<double>& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0, [](double s, double w) { return s + std::abs(w); });
}

/// Sums of the first 0, 1, 2, ... weights.
std::vector<double> sums_from_first(const std::vector<double>& weights) {
    std::vector<double> sums(weights.size() + 1);
    std::partial_sum(weights.begin(), weights.end(), sums.begin() + 1);
    return sums;
}

/// Sums over rectangles that begin at the first weight.
std::vector<double> area_sums(const WeightGrid& weights) {
    const auto pitch = static_cast<std::size_t>(weights.width) + 1;
    std::vector<double> sums(pitch * (static_cast<std::size_t>(weights.height) + 1));
    for (int y = 0; y < weights.height; ++y) {
        double row = 0;
        const std::size_t at = (static_cast<std::size_t>(y) + 1) * pitch + 1;
        for (int x = 0; x < weights.width; ++x) {
            row += weights.at(x, y);
            const std::size_t i = at + static_cast<std::size_t>(x);
            sums[i] = sums[i - pitch] + row;
        }
    }
    return sums;
}

}  // namespace

template <class Sum>
void BorderScale::fill(double whole, double magnitude, const std::vector<int>& example_x,
                       const std::vector<int>& example_y, Sum sum) {
    kinds_x_ = static_cast<int>(example_x.size());
    if (example_x.size() == 1 && example_y.size() == 1) return static_cast<void>(kind_x_ = kind_y_ = {});
    const double least = negligible * magnitude;
    if (!(std::abs(whole) > least))
        fail("Edge::renormalize: weights that sum to ", whole, " cannot be renormalized; use Edge::reflect");
    for (const int y : example_y)
        for (const int x : example_x) {
            const double inside = x < 0 || y < 0 ? whole : sum(x, y);
            if (!(std::abs(inside) > least))
                fail("Edge::renormalize: output (", x, ", ", y,
                     ") has no weight inside the image; use Edge::clamp or Edge::reflect");
            scale_.push_back(static_cast<float>(whole / inside));
        }
}

BorderScale::BorderScale(const WeightGrid& weights, int first_x, int first_y, int width, int height, Edge edge_x,
                         Edge edge_y) {
    const auto inside_x = parts_inside(first_x, weights.width, width, edge_x);
    const auto inside_y = parts_inside(first_y, weights.height, height, edge_y);
    std::vector<int> example_x, example_y;
    kind_x_ = numbered(inside_x, {0, weights.width}, example_x);
    kind_y_ = numbered(inside_y, {0, weights.height}, example_y);
    const std::vector<double> sums = area_sums(weights);
    const auto corner = [&](int x, int y) {
        return sums[static_cast<std::size_t>(y) * (static_cast<std::size_t>(weights.width) + 1) +
                    static_cast<std::size_t>(x)];
    };
    fill(sums.back(), magnitude_of(weights.weights), example_x, example_y, [&](int x, int y) {
        const auto [x0, x1] = inside_x[static_cast<std::size_t>(x)];
        const auto [y0, y1] = inside_y[static_cast<std::size_t>(y)];
        return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
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
    std::vector<std::vector<double>> sums_x, sums_y;
    double whole = 0, magnitude = 0;
    for (const Term& term : terms) {
        sums_x.push_back(sums_from_first(term.row));
        sums_y.push_back(sums_from_first(term.column));
        whole += sums_x.back().back() * sums_y.back().back();
        magnitude += magnitude_of(term.row) * magnitude_of(term.column);
    }
    const auto sum_of = [](const std::vector<double>& sums, std::pair<int, int> part) {
        return sums[static_cast<std::size_t>(part.second)] - sums[static_cast<std::size_t>(part.first)];
    };
    fill(whole, magnitude, example_x, example_y, [&](int x, int y) {
        double sum = 0;
        for (std::size_t t = 0; t < terms.size(); ++t)
            sum += sum_of(sums_x[t], inside_x[static_cast<std::size_t>(x)]) *
                   sum_of(sums_y[t], inside_y[static_cast<std::size_t>(y)]);
        return sum;
    });
}

BorderScale::BorderScale(std::span<const std::pair<double, double>> whole,
                         const std::vector<std::vector<double>>& inside_x,
                         const std::vector<std::vector<double>>& inside_y) {
    std::vector<double> whole_x, whole_y;
    double sum = 0, magnitude = 0;
    for (const auto& [x, y] : whole) {
        whole_x.push_back(x);
        whole_y.push_back(y);
        sum += x * y;
        magnitude += std::abs(x * y);
    }
    std::vector<int> example_x, example_y;
    kind_x_ = numbered(inside_x, whole_x, example_x);
    kind_y_ = numbered(inside_y, whole_y, example_y);
    fill(sum, magnitude, example_x, example_y, [&](int x, int y) {
        const std::vector<double>&of_x = inside_x[static_cast<std::size_t>(x)],
              &of_y = inside_y[static_cast<std::size_t>(y)];
        return std::inner_product(of_x.begin(), of_x.end(), of_y.begin(), 0.0);
    });
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
