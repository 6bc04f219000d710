#include "bandlimit/filter/convolve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"
#include "bandlimit/kernel/taps.h"

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

/// How many columns of weights are not all 0.
int used_columns(const WeightGrid& grid) {
    int columns = 0;
    for (int x = 0; x < grid.width; ++x) {
        bool is_used = false;
        for (int y = 0; y < grid.height; ++y) is_used |= grid.at(x, y) != 0;
        columns += is_used;
    }
    return columns;
}

int used_columns(const Terms& terms) {
    int columns = 0;
    for (std::size_t x = 0; x < terms[0].row.size(); ++x)
        columns += std::any_of(terms.begin(), terms.end(), [x](const Term& term) { return term.row[x] != 0; });
    return columns;
}

constexpr double number_bytes = sizeof(double);

MethodCost cost_of_direct(const ConvolutionWeights& given, WeightSize size) {
    const double columns = std::max(1, std::visit([](const auto& w) { return used_columns(w); }, given.weights));
    const double weights = columns * size.height;
    // A term per column (direct_terms()), and columns once more on their way to banks.
    return {Method::direct, 0, weights, weights,
            number_bytes * (size.count() + columns * (size.width + 3.0 * size.height))};
}

MethodCost cost_of_terms(const Terms& terms) {
    const double each = static_cast<double>(terms[0].column.size() + terms[0].row.size());
    const double weights = each * static_cast<double>(terms.size());
    return {terms.size() == 1 ? Method::separable : Method::low_rank, static_cast<int>(terms.size()), weights,
            product_time * weights, 3 * number_bytes * weights};
}

/// There and back; two channels share a transform of complex numbers, whose butterfly are four multiply-adds.
MethodCost cost_of_fft(WeightSize size, int width, int height) {
    const FftTiles x = fft_tiles(size.width, width), y = fft_tiles(size.height, height);
    const double samples = double(x.size) * y.size, tiles = double(x.count) * y.count;
    const double butterflies = samples * std::log2(samples + 1) / 2 * tiles / (double(width) * height);
    return {Method::fft, 0, 4 * butterflies, butterfly_time * butterflies,
            number_bytes * (2 * samples + 2 * size.count())};
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

WeightSize size_of(const ConvolutionWeights& weights) {
    if (const auto* terms = std::get_if<Terms>(&weights.weights)) return size_of(*terms);
    const auto& grid = std::get<WeightGrid>(weights.weights);
    if (grid.width < 1 || grid.height < 1)
        fail("ConvolutionWeights: ", grid.width, " x ", grid.height, " weights; pass at least one");
    return {grid.width, grid.height};
}

WeightGrid grid_of(const ConvolutionWeights& weights) {
    size_of(weights);
    if (const auto* terms = std::get_if<Terms>(&weights.weights)) return expanded(*terms);
    return std::get<WeightGrid>(weights.weights);
}

ConvolutionWeights centred(std::variant<WeightGrid, Terms> weights) {
    ConvolutionWeights result{std::move(weights), 0, 0};
    const WeightSize size = size_of(result);
    result.first_x = centred_first(size.width);
    result.first_y = centred_first(size.height);
    return result;
}

double sum_of(const ConvolutionWeights& weights) {
    size_of(weights);
    if (const auto* terms = std::get_if<Terms>(&weights.weights)) return sum(*terms);
    const auto& grid = std::get<WeightGrid>(weights.weights);
    return std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
}

bool cancel(const ConvolutionWeights& weights) {
    return cancels(sum_of(weights), std::visit([](const auto& w) { return magnitude(w); }, weights.weights));
}

ConvolutionWeights turned(ConvolutionWeights weights) {
    const WeightSize size = size_of(weights);
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
    if (auto* terms = std::get_if<Terms>(&weights.weights)) {
        *terms = with_unit_sum(std::move(*terms));
        return weights;
    }
    const double sum = sum_of(weights);
    if (cancel(weights)) fail("with_unit_sum: weights that sum to ", sum, " cannot be divided by it; keep their sum");
    for (double& w : std::get<WeightGrid>(weights.weights).weights) w /= sum;
    return weights;
}

Convolution::Convolution(const ConvolutionWeights& weights, int width, int height, const ConvolveOptions& options) {
    if (width < 1 || height < 1) fail("Convolution: ", width, " x ", height, " samples; pass at least one");
    const WeightSize size = size_of(weights);
    const auto* given = std::get_if<Terms>(&weights.weights);
    const Terms found = given ? Terms{} : exact_terms(std::get<WeightGrid>(weights.weights), options.method);
    const Terms& terms = given ? *given : found;
    candidates_ = {cost_of_direct(weights, size), cost_of_fft(size, width, height)};
    if (!terms.empty()) candidates_.push_back(cost_of_terms(terms));
    // What renormalizing takes: a number for each way in which outputs see the border.
    const double scales = sizeof(float) * double(std::min(width, size.width)) * std::min(height, size.height);
    for (MethodCost& cost : candidates_) cost.bytes += scales;
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const MethodCost& a, const MethodCost& b) { return a.time < b.time; });
    const auto chosen = std::find_if(candidates_.begin(), candidates_.end(),
                                     [&](const MethodCost& c) { return is_of(c, options.method); });
    if (chosen == candidates_.end())
        fail("Convolution: weights of rank ", terms.size(), " are no single product; choose low-rank, direct or fft");
    chosen_ = *chosen;
    if (chosen_.bytes > double(options.most_bytes))
        fail("Convolution: ", size.width, " x ", size.height, " weights by the method ", name_of(chosen_.method),
             " take ", chosen_.bytes / 1e9, " GB of memory, and ", double(options.most_bytes) / 1e9,
             " may be taken; pass fewer weights, or another method");
    const FilterDomain domain{width, height, options.edge_x, options.edge_y, options.premultiply};
    if (chosen_.method == Method::fft) rows_ = fft_filter(grid_of(weights), weights.first_x, weights.first_y, domain);
    else if (chosen_.method == Method::direct)
        rows_ = term_filter(direct_terms(grid_of(weights)), weights.first_x, weights.first_y, domain);
    else rows_ = term_filter(terms, weights.first_x, weights.first_y, domain);
}

}  // namespace bandlimit
