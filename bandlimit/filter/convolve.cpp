#include "bandlimit/filter/convolve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"

namespace bandlimit {
namespace {

constexpr int largest_for_svd = 512;  // weights a side: half a minute of decomposition takes longer than any picture

// The time of a multiply-add of products, and of a butterfly of a transform, in multiply-adds of the direct method, as
// filter/convolve_bench.cpp measures them.
constexpr double product_time = 1.6, butterfly_time = 260;

double magnitude(const WeightGrid& grid) {
    return std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0,
                           [](double s, double w) { return s + std::abs(w); });
}

/// The products that `grid` is, but for what rounding its weights to floats changes anyway; empty where to find them
/// is not worth the time.
Terms exact_terms(const WeightGrid& grid, Method method) {
    const bool is_asked = method == Method::low_rank || method == Method::separable;
    const bool is_small = std::max(grid.width, grid.height) <= largest_for_svd && method == Method::automatic;
    if (!is_asked && !is_small) return {};
    const Svd found = svd_of(grid);
    // An output changes by at most the sum of magnitudes of what is left away, which its energy bounds.
    const double allowed = 0x1p-24 * magnitude(grid) / std::sqrt(double(grid.width) * grid.height);
    double energy = 0;
    std::size_t rank = found.values.size();
    for (; rank > 1; --rank) {
        energy += found.values[rank - 1] * found.values[rank - 1];
        if (energy > allowed * allowed) break;
    }
    return low_rank(found, static_cast<int>(rank));
}

MethodCost cost_of_direct(const WeightGrid& grid) {
    int columns = 0;
    for (int x = 0; x < grid.width; ++x) {
        bool is_used = false;
        for (int y = 0; y < grid.height; ++y) is_used |= grid.at(x, y) != 0;
        columns += is_used;
    }
    const double weights = double(std::max(columns, 1)) * grid.height;
    return {Method::direct, 0, weights, weights};
}

MethodCost cost_of_terms(const Terms& terms) {
    const double each = static_cast<double>(terms[0].column.size() + terms[0].row.size());
    const double weights = each * static_cast<double>(terms.size());
    return {terms.size() == 1 ? Method::separable : Method::low_rank, static_cast<int>(terms.size()), weights,
            product_time * weights};
}

/// There and back; two channels share a transform of complex numbers, whose butterfly are four multiply-adds.
MethodCost cost_of_fft(const WeightGrid& grid, int width, int height) {
    const FftTiles x = fft_tiles(grid.width, width), y = fft_tiles(grid.height, height);
    const double samples = double(x.size) * y.size, tiles = double(x.count) * y.count;
    const double butterflies = samples * std::log2(samples + 1) / 2 * tiles / (double(width) * height);
    return {Method::fft, 0, 4 * butterflies, butterfly_time * butterflies};
}

bool is_of(const MethodCost& cost, Method method) {
    // One product is a sum of products too.
    return method == Method::automatic || cost.method == method ||
           (method == Method::low_rank && cost.method == Method::separable);
}

}  // namespace

std::string_view name_of(Method method) {
    switch (method) {
        case Method::automatic: return "auto";
        case Method::direct: return "direct";
        case Method::separable: return "separable";
        case Method::low_rank: return "low-rank";
        case Method::fft: return "fft";
    }
    return "";
}

WeightGrid grid_of(const ConvolutionWeights& weights) {
    if (const auto* terms = std::get_if<Terms>(&weights.weights)) return expanded(*terms);
    const auto& grid = std::get<WeightGrid>(weights.weights);
    if (grid.width < 1 || grid.height < 1)
        fail("grid_of: ", grid.width, " x ", grid.height, " weights; pass at least one");
    return grid;
}

ConvolutionWeights centred(std::variant<WeightGrid, Terms> weights) {
    ConvolutionWeights result{std::move(weights), 0, 0};
    const WeightGrid grid = grid_of(result);
    result.first_x = centred_first(grid.width);
    result.first_y = centred_first(grid.height);
    return result;
}

double sum_of(const ConvolutionWeights& weights) {
    const WeightGrid grid = grid_of(weights);
    return std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
}

ConvolutionWeights turned(ConvolutionWeights weights) {
    const WeightGrid size = grid_of(weights);
    if (auto* grid = std::get_if<WeightGrid>(&weights.weights))
        std::reverse(grid->weights.begin(), grid->weights.end());
    else
        for (Term& term : std::get<Terms>(weights.weights)) {
            std::reverse(term.column.begin(), term.column.end());
            std::reverse(term.row.begin(), term.row.end());
        }
    weights.first_x = 1 - size.width - weights.first_x;
    weights.first_y = 1 - size.height - weights.first_y;
    return weights;
}

ConvolutionWeights with_unit_sum(ConvolutionWeights weights) {
    const WeightGrid grid = grid_of(weights);
    const double sum = sum_of(weights);
    if (!(std::abs(sum) > 1e-9 * magnitude(grid)))
        fail("with_unit_sum: weights that sum to ", sum, " cannot be divided by it; keep their sum");
    if (auto* of_grid = std::get_if<WeightGrid>(&weights.weights))
        for (double& w : of_grid->weights) w /= sum;
    else
        for (Term& term : std::get<Terms>(weights.weights))
            for (double& w : term.column) w /= sum;
    return weights;
}

Convolution::Convolution(const ConvolutionWeights& weights, int width, int height, const ConvolveOptions& options) {
    if (width < 1 || height < 1) fail("Convolution: ", width, " x ", height, " samples; pass at least one");
    const WeightGrid grid = grid_of(weights);
    const auto* given = std::get_if<Terms>(&weights.weights);
    const Terms terms = given ? *given : exact_terms(grid, options.method);
    candidates_ = {cost_of_direct(grid), cost_of_fft(grid, width, height)};
    if (!terms.empty()) candidates_.push_back(cost_of_terms(terms));
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const MethodCost& a, const MethodCost& b) { return a.time < b.time; });
    const auto chosen = std::find_if(candidates_.begin(), candidates_.end(),
                                     [&](const MethodCost& c) { return is_of(c, options.method); });
    if (chosen == candidates_.end())
        fail("Convolution: weights of rank ", terms.size(), " are no single product; choose low-rank, direct or fft");
    chosen_ = *chosen;
    if (chosen_.method == Method::fft)
        filter_.emplace(FftFilter(grid, weights.first_x, weights.first_y, width, height, options.edge_x, options.edge_y,
                                  options.premultiply));
    else
        filter_.emplace(TermFilter(chosen_.method == Method::direct ? direct_terms(grid) : terms, weights.first_x,
                                   weights.first_y, width, height, options.edge_x, options.edge_y,
                                   options.premultiply));
}

std::uint64_t Convolution::bytes(int channels, Parallel parallel) const {
    return std::visit([&](const auto& f) { return f.bytes(channels, parallel); }, *filter_);
}

IndexRange Convolution::rows_needed(int first, int last) const {
    return std::visit([&](const auto& f) { return f.rows_needed(first, last); }, *filter_);
}

bool Convolution::run(const SourceRows& source, const TargetRows& target, Parallel parallel) const {
    return std::visit([&](const auto& f) { return f.run(source, target, parallel); }, *filter_);
}

}  // namespace bandlimit
