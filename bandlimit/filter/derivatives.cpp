#include "bandlimit/filter/derivatives.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/name_parts.h"

namespace bandlimit {
namespace {

constexpr double least_sigma = 0.1, largest_sigma = 250;

double moment(const std::vector<double>& weights, int first, int power) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * std::pow(first + static_cast<int>(i), power);
    return sum;
}

double centre_of(const Taps& taps) { return taps.first + (static_cast<double>(taps.weights.size()) - 1) / 2; }

Taps scaled(Taps taps, double factor) {
    for (double& w : taps.weights) w *= factor;
    return taps;
}

/// Minus the derivative of the Gaussian, as weights that are multiplied with what lies under them.
Taps gaussian_slope(double sigma) {
    Taps taps = gaussian_taps(sigma);
    for (std::size_t i = 0; i < taps.weights.size(); ++i) taps.weights[i] *= taps.first + static_cast<int>(i);
    return scaled(taps, 1 / moment(taps.weights, taps.first, 1));
}

/// The second derivative of the Gaussian: sum 0, and 1 for the parabola x^2 / 2.
Taps gaussian_curvature(double sigma) {
    const Taps gaussian = gaussian_taps(sigma);
    const double variance = moment(gaussian.weights, gaussian.first, 2);
    Taps taps = gaussian;
    for (std::size_t i = 0; i < taps.weights.size(); ++i)
        taps.weights[i] *= std::pow(taps.first + static_cast<int>(i), 2) - variance;
    return scaled(taps, 2 / moment(taps.weights, taps.first, 2));
}

Terms sum_of_both(const Taps& curvature, const Taps& across) {
    return {{across.weights, curvature.weights}, {curvature.weights, across.weights}};
}

const Taps second_difference{-1, {1, -2, 1}, 1}, one{-1, {0, 1, 0}, 1};

/// All weights but that of the middle are 1/3: that of 4 plus a third of the second difference along both axes.
Terms laplacian8_terms() {
    constexpr double third = 1.0 / 3;
    return {{{third, third, third}, second_difference.weights}, {second_difference.weights, one.weights}};
}

std::optional<DerivativeOperator> named(std::string_view name) {
    const Taps central{-1, {-0.5, 0, 0.5}, 1}, forward{0, {-1, 1}, 1}, pair{0, {0.5, 0.5}, 1}, self{0, {1}, 1};
    const auto centred = [&](const char* text, double side, double middle) {
        return Gradient{text, central, {-1, {side, middle, side}, 1}};
    };
    if (name == "forward") return Gradient{"forward", forward, self};
    if (name == "central") return Gradient{"central", central, self};
    if (name == "sobel") return centred("sobel", 0.25, 0.5);
    if (name == "scharr") return centred("scharr", 3.0 / 16, 10.0 / 16);
    if (name == "prewitt") return centred("prewitt", 1.0 / 3, 1.0 / 3);
    // With d1 = (f(1, 1) - f(0, 0)) / sqrt 2 and d2 = (f(1, 0) - f(0, 1)) / sqrt 2 along (1, 1) and (1, -1):
    // dx = (d1 + d2) / sqrt 2 and dy = (d1 - d2) / sqrt 2, which are these products.
    if (name == "diagonal") return Gradient{"diagonal", forward, pair};
    if (name == "diagonal3") return Gradient{"diagonal3", forward, pair, {-1, {0.5, 0.5}, 1}};
    if (name == "laplacian4") return Laplacian{"laplacian4", sum_of_both(second_difference, one)};
    if (name == "laplacian8") return Laplacian{"laplacian8", laplacian8_terms()};
    return {};
}

/// S of "log:S".
double sigma_of(const NameParts& parts) {
    const double sigma = number_parameters(parts, "operator", 1, "log:1.5 or gaussian:1.5")[0];
    if (!(sigma >= least_sigma && sigma <= largest_sigma))
        fail("operator \"", parts.whole, "\": sigma is out of range; pass ", least_sigma, " to ", largest_sigma,
             " samples");
    return sigma;
}

}  // namespace

Taps gaussian_taps(double sigma) {
    if (!(sigma >= least_sigma && sigma <= largest_sigma))
        fail("gaussian_taps: sigma = ", sigma, "; pass ", least_sigma, " to ", largest_sigma, " samples");
    const int radius = static_cast<int>(std::ceil(4 * sigma));
    Taps taps{-radius, {}, 1};
    for (int i = -radius; i <= radius; ++i) taps.weights.push_back(std::exp(-i * i / (2 * sigma * sigma)));
    return scaled(taps, 1 / moment(taps.weights, taps.first, 0));
}

Taps box_taps(int radius) {
    if (radius < 0) fail("box_taps: radius = ", radius, "; pass 0 or more samples");
    const auto count = 2 * static_cast<std::size_t>(radius) + 1;
    return {-radius, std::vector<double>(count, 1 / static_cast<double>(count)), 1};
}

DerivativeOperator parse_derivative(std::string_view text) {
    if (const auto known = named(text)) return *known;
    const NameParts parts = split_name(text);
    if (parts.head == "log") {
        const double sigma = sigma_of(parts);
        return Laplacian{std::string(text), sum_of_both(gaussian_curvature(sigma), gaussian_taps(sigma))};
    }
    if (parts.head == "gaussian") {
        const double sigma = sigma_of(parts);
        return Gradient{std::string(text), gaussian_slope(sigma), gaussian_taps(sigma)};
    }
    fail("operator \"", text,
         "\" is unknown; choose forward, central, sobel, scharr, prewitt, diagonal, diagonal3, laplacian4, laplacian8, "
         "log:S, gaussian:S or taps:FILE");
}

Gradient gradient_by(const Taps& along, std::string name) {
    if (along.factor != 1) fail(name, ": taps of factor ", along.factor, " change the size; pass those of factor 1");
    if (along.weights.empty() || !cancels(along.weights))
        fail(name, ": the taps sum to ", std::accumulate(along.weights.begin(), along.weights.end(), 0.0),
             " and do not differentiate; pass such as design derivative makes, whose sum is 0");
    return {std::move(name), along, {0, {1}, 1}};
}

GradientPosition position_of_dx(const Gradient& g) {
    return {centre_of(g.along) + centre_of(g.mean), centre_of(g.across) + centre_of(g.mean)};
}

GradientPosition position_of_dy(const Gradient& g) {
    const GradientPosition dx = position_of_dx(g);
    return {dx.y, dx.x};
}

double ramp_gain(const Gradient& g) { return moment(g.along.weights, g.along.first, 1); }

Taps convolved(const Taps& a, const Taps& b) {
    Taps both{a.first + b.first, std::vector<double>(a.weights.size() + b.weights.size() - 1), 1};
    for (std::size_t i = 0; i < a.weights.size(); ++i)
        for (std::size_t j = 0; j < b.weights.size(); ++j) both.weights[i + j] += a.weights[i] * b.weights[j];
    return both;
}

}  // namespace bandlimit
