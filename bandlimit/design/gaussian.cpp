#include "bandlimit/design/gaussian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/analysis/response.h"
#include "bandlimit/core/error.h"
#include "bandlimit/design/fold.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

using std::numbers::pi;
using Form = GaussianOptions::Form;
using Half = std::vector<double>;  ///< the weights at 0, 1, ..., reach; the others are their mirror image

double sum_of(const Half& half) {
    double sum = half[0];
    for (std::size_t k = 1; k < half.size(); ++k) sum += 2 * half[k];
    return sum;
}

/// The integral of a function times cos(2 pi k f) over |f| < 1/2, where G falls to nothing near 0 for a large sigma.
template <class Function>
double cosine_integral(const GaussianOptions& options, int k, Function function) {
    const int panels = 4 + k / 2 + static_cast<int>(2 * options.sigma);
    return 2 * integrate([&](double f) { return function(f) * std::cos(2 * pi * k * f); }, 0, 0.5, panels);
}

/// The weight at k of an infinite kernel.
double weight_at(const GaussianOptions& options, int k) {
    const double sigma = options.sigma, scale = 1 / (sigma * std::numbers::sqrt2);
    switch (options.form) {
        case Form::sampled: return std::exp(-k * k * scale * scale);
        case Form::integrated: return (std::erfc((k - 0.5) * scale) - std::erfc((k + 0.5) * scale)) / 2;
        case Form::discrete:
            // Far out it is the rounding of the integral, of either sign.
            return std::max(0.0, cosine_integral(options, k, [&](double f) {
                                return std::exp(sigma * sigma * (std::cos(2 * pi * f) - 1));
                            }));
        case Form::least_squares: break;
    }
    return cosine_integral(options, k, [&](double f) { return gaussian_response(sigma, f); });
}

/// The nearest weights that are not negative and sum to 1: the projection onto a simplex.
Half projected(const Half& g) {
    Half sorted = g;
    // The middle counts once, all others twice; in descending order the threshold is that of the last one kept.
    std::sort(sorted.begin(), sorted.end(), std::greater{});
    double sum = -1, count = 0, threshold = 0;
    bool has_middle = false;
    for (const double value : sorted) {
        const bool is_middle = !has_middle && value == g[0];
        has_middle = has_middle || is_middle;
        const double times = is_middle ? 1 : 2;
        if (count > 0 && value <= (sum + times * value) / (count + times)) break;
        sum += times * value;
        count += times;
        threshold = sum / count;
    }
    Half result;
    for (const double value : g) result.push_back(std::max(value - threshold, 0.0));
    return result;
}

/// Pairs of neighbours from the outer end inwards; half of the middle weight belongs to either side.
std::vector<LinearRead> symmetric_reads(const Half& half) {
    // With an odd number of weights on this side the middle one stays alone.
    const bool is_alone = half.size() % 2 == 1;
    Taps right{is_alone ? 1 : 0, {half.begin() + (is_alone ? 1 : 0), half.end()}, 1};
    if (!is_alone) right.weights[0] /= 2;
    std::vector<LinearRead> reads;
    const std::vector<LinearRead> right_reads = right.weights.empty() ? reads : fold(right);
    for (auto read = right_reads.rbegin(); read != right_reads.rend(); ++read)
        reads.push_back({-read->offset, read->weight});
    if (is_alone) reads.push_back({0, half[0]});
    reads.insert(reads.end(), right_reads.begin(), right_reads.end());
    return reads;
}

void check(const GaussianOptions& options) {
    if (!(options.sigma >= 0.1 && options.sigma <= 250))
        fail("design_gaussian: sigma = ", options.sigma, "; pass 0.1 to 250 samples");
    if (options.fetches && (*options.fetches < 1 || *options.fetches > 2048))
        fail("design_gaussian: ", *options.fetches, " fetches; pass 1 to 2048");
}

}  // namespace

double gaussian_response(double sigma, double f) { return std::exp(-2 * pi * pi * sigma * sigma * f * f); }

GaussianDesign design_gaussian(const GaussianOptions& options) {
    check(options);
    const int reach = options.fetches.value_or(1 + static_cast<int>(std::ceil(3 * options.sigma))) - 1;
    Half half;
    for (int k = 0; k <= reach; ++k) half.push_back(weight_at(options, k));
    if (options.form == Form::least_squares) half = projected(half);
    const double sum = sum_of(half);
    for (double& weight : half) weight /= sum;

    GaussianDesign design{{-reach, {half.rbegin(), half.rend()}, 1}, symmetric_reads(half), 0, 0};
    design.taps.weights.insert(design.taps.weights.end(), half.begin() + 1, half.end());
    for (int k = 1; k <= reach; ++k) design.variance += 2.0 * k * k * half[static_cast<std::size_t>(k)];
    double energy = 0;
    const Quadrature points = quadrature(0, 0.5, 4 + reach / 2 + static_cast<int>(2 * options.sigma));
    for (std::size_t i = 0; i < points.at.size(); ++i) {
        const double g = gaussian_response(options.sigma, points.at[i]);
        design.error += points.weights[i] * std::norm(response(design.taps, points.at[i]) - g);
        energy += points.weights[i] * g * g;
    }
    design.error /= energy;
    return design;
}

}  // namespace bandlimit
