#include "bandlimit/design/passband.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

struct Placed {
    double x, y, weight;
};

std::vector<Placed> placed(const PlacedWeights& w) {
    std::vector<Placed> points;
    for (std::size_t j = 0; j < w.weights.size(); ++j)
        points.push_back({w.first + static_cast<double>(j), 0, w.weights[j]});
    return points;
}

std::vector<Placed> placed(const PlacedWeights2D& w) {
    std::vector<Placed> points;
    const auto width = static_cast<std::size_t>(w.width);
    for (std::size_t i = 0; i < w.weights.size(); ++i)
        points.push_back(
            {w.first_x + static_cast<double>(i % width), w.first_y + static_cast<double>(i / width), w.weights[i]});
    return points;
}

/// The errors of points, where `ideal(x, y)` is the ideal filter's weight and the part `share` of the band passes.
template <class Ideal>
BandError error_of(const std::vector<Placed>& points, double share, Ideal ideal) {
    double squares = 0, cross = 0, passed = 0;
    for (const Placed& p : points) {
        squares += p.weight * p.weight;
        cross += p.weight * ideal(p.x, p.y);
        for (const Placed& q : points) passed += p.weight * q.weight * ideal(p.x - q.x, p.y - q.y);
    }
    const double whole = squares - 2 * cross + share, pass = passed - 2 * cross + share;
    return {std::max(0.0, whole), std::max(0.0, pass / share), std::max(0.0, (whole - pass) / (1 - share))};
}

void check_factor(int factor) {
    if (factor < 2) fail("band_error: factor = ", factor, "; pass 2 or more");
}

}  // namespace

BandError band_error(const PlacedWeights& weights, int factor) {
    check_factor(factor);
    return error_of(placed(weights), 1.0 / factor, [factor](double x, double) { return sinc(x / factor) / factor; });
}

BandError band_error(const PlacedWeights2D& weights, int factor) {
    check_factor(factor);
    const double share = 1.0 / factor / factor;
    return error_of(placed(weights), share,
                    [=](double x, double y) { return share * sinc(x / factor) * sinc(y / factor); });
}

PlacedWeights2D weights_of(const Fetches& fetches, double texel) {
    constexpr double farthest = 1000;
    const bool is_valid = !fetches.empty() && std::all_of(fetches.begin(), fetches.end(), [](const Fetch& f) {
        return std::abs(f.x) <= farthest && std::abs(f.y) <= farthest && std::isfinite(f.weight);
    });
    if (!is_valid || !std::isfinite(texel))
        fail("weights_of: ", fetches.size(), " fetches; pass at least one, all finite and within ", farthest,
             " texels");
    // Texel i lies at i - texel from the output.
    const auto [left, right] =
        std::minmax_element(fetches.begin(), fetches.end(), [](const Fetch& a, const Fetch& b) { return a.x < b.x; });
    const auto [top, bottom] =
        std::minmax_element(fetches.begin(), fetches.end(), [](const Fetch& a, const Fetch& b) { return a.y < b.y; });
    const auto whole = [texel](double at) { return static_cast<int>(std::floor(at + texel)); };
    const int first_x = whole(left->x), first_y = whole(top->y);
    const int width = whole(right->x) + 2 - first_x, height = whole(bottom->y) + 2 - first_y;
    PlacedWeights2D result(first_x - texel, first_y - texel, width,
                           std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)));
    for (const Fetch& f : fetches) {
        const double u = f.x + texel - first_x, v = f.y + texel - first_y, tx = u - std::floor(u),
                     ty = v - std::floor(v);
        const std::size_t at = static_cast<std::size_t>(std::floor(v)) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(std::floor(u));
        const std::size_t below = at + static_cast<std::size_t>(width);
        result.weights[at] += f.weight * (1 - tx) * (1 - ty);
        if (tx > 0) result.weights[at + 1] += f.weight * tx * (1 - ty);
        if (ty > 0) result.weights[below] += f.weight * (1 - tx) * ty;
        if (tx > 0 && ty > 0) result.weights[below + 1] += f.weight * tx * ty;
    }
    return result;
}

double max_gain(const PlacedWeights& weights) {
    const int samples = 16 * static_cast<int>(weights.weights.size() + 1);
    return largest_value([&](double f) { return gain(weights, f); }, 0, 0.5, samples);
}

double max_gain(const PlacedWeights2D& weights) {
    const auto count = static_cast<int>(weights.weights.size());
    if (count == 0) fail("max_gain: no weights; pass at least one");
    const int height = count / weights.width;
    const int nx = 4 * weights.width + 1, ny = 8 * height + 1;
    // |H| is the same at -f. Positions are centres of cells: this axis begins half a cell before 0.
    const Axis fx{nx, -0.25 / (nx - 1), 0.5 + 0.25 / (nx - 1)}, fy{ny, -0.5 - 0.5 / (ny - 1), 0.5 + 0.5 / (ny - 1)};
    const ComplexGrid grid = response_grid(weights, fx, fy);
    double best = -1, x = 0, y = 0;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
            if (const double g = std::abs(grid.at(i, j)); g > best) best = g, x = fx.position(i), y = fy.position(j);
    // Climb from the best sample, by steps that halve where none of eight leads up.
    constexpr std::array<std::pair<int, int>, 8> ways{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
    for (double step = 0.5; step > 1e-4;) {
        bool is_higher = false;
        for (const auto& [dx, dy] : ways) {
            const double to_x = x + dx * step * fx.pitch(), to_y = y + dy * step * fy.pitch();
            const double g = std::abs(response(weights, to_x, to_y));
            if (g > best) best = g, x = to_x, y = to_y, is_higher = true;
        }
        if (!is_higher) step /= 2;
    }
    return best;
}

}  // namespace bandlimit
