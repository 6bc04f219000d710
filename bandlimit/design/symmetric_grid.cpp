#include "bandlimit/design/symmetric_grid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/design/quadratic_program.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// All images of a point, each once.
std::vector<std::pair<double, double>> images_of(double x, double y, int dimensions) {
    std::vector<std::pair<double, double>> images;
    for (int k = 0; k < (dimensions == 1 ? 2 : 8); ++k) {
        std::pair<double, double> image = k & 4 ? std::pair{y, x} : std::pair{x, y};
        if (k & 1) image.first = -image.first;
        if (k & 2) image.second = -image.second;
        if (std::find(images.begin(), images.end(), image) == images.end()) images.push_back(image);
    }
    return images;
}

}  // namespace

void check_goal(const char* function, const RateGoal& goal) {
    if (goal.factor < 2 || goal.factor > 16) fail(function, ": factor = ", goal.factor, "; pass 2 to 16");
    if (goal.upsample && goal.factor != 2)
        fail(function, ": factor = ", goal.factor, "; pass 2, the only one that upsampling has");
    if (!(goal.pass_weight > 0 && goal.stop_weight > 0 && goal.pass_weight <= 1e3 * goal.stop_weight &&
          goal.stop_weight <= 1e3 * goal.pass_weight))
        fail(function, ": weights of pass band and stop band ", goal.pass_weight, " and ", goal.stop_weight,
             "; pass positive ones, within 1000 of each other");
    if (goal.max_gain && !(*goal.max_gain >= 1)) fail(function, ": max_gain = ", *goal.max_gain, "; pass 1 or more");
}

SymmetricGrid::SymmetricGrid(int dimensions, double origin, int count, const RateGoal& goal)
    : dimensions_(dimensions), count_(count), origin_(origin), is_diagonal_(goal.pass_weight == goal.stop_weight) {
    const double f = goal.factor;
    const auto ideal = [&](double x, double y) {
        return dimensions == 1 ? sinc(x / f) / f : sinc(x / f) / f * sinc(y / f) / f;
    };
    std::vector<std::vector<std::pair<double, double>>> all;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j <= (dimensions == 1 ? 0 : i); ++j) {
            points_.emplace_back(i, j);
            all.push_back(images_of(origin + i, dimensions == 1 ? 0 : origin + j, dimensions));
        }
    for (const auto& images : all) {
        images_.push_back(static_cast<double>(images.size()));
        target_.push_back(goal.pass_weight * images_.back() * ideal(images[0].first, images[0].second));
    }
    const double share = ideal(0, 0);
    constant_ = goal.pass_weight * share;
    const std::size_t n = size();
    form_.assign(is_diagonal_ ? n : n * n, 0);
    for (std::size_t u = 0; u < n; ++u) {
        form_[is_diagonal_ ? u : u * n + u] = goal.stop_weight * images_[u];
        for (std::size_t v = 0; v < n && !is_diagonal_; ++v)
            for (const auto& [x, y] : all[v])
                form_[u * n + v] += (goal.pass_weight - goal.stop_weight) * images_[u] *
                                    ideal(all[u][0].first - x, all[u][0].second - y);
    }
    if (!goal.max_gain) return;
    // In the half of a quarter of the band that all others mirror.
    const int steps = static_cast<int>(std::lround(0.5 / sample_pitch()));
    for (int j = 0; j <= (dimensions == 1 ? 0 : steps); ++j)
        for (int i = j; i <= steps; ++i) {
            const double fx = 0.5 * i / steps, fy = 0.5 * j / steps;
            samples_.push_back({fx, fy, 0});
        }
    sample_rows_.resize(n * samples_.size());
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        const std::vector<double> row = response_row(samples_[k].fx, samples_[k].fy);
        for (std::size_t u = 0; u < n; ++u) sample_rows_[u * samples_.size() + k] = row[u];
    }
}

std::size_t SymmetricGrid::index(int i, int j) const {
    if (dimensions_ == 1) return static_cast<std::size_t>(i);
    if (j > i) std::swap(i, j);
    return static_cast<std::size_t>(i * (i + 1) / 2 + j);
}

std::vector<double> SymmetricGrid::times_form(const std::vector<double>& weights) const {
    std::vector<double> result(size());
    for (std::size_t u = 0; u < size(); ++u) {
        if (is_diagonal_) result[u] = form_[u] * weights[u];
        else
            result[u] = std::inner_product(weights.begin(), weights.end(),
                                           form_.begin() + static_cast<std::ptrdiff_t>(u * size()), 0.0);
    }
    return result;
}

double SymmetricGrid::error(const std::vector<double>& weights) const {
    return std::max(0.0, dot(times_form(weights), weights) - 2 * dot(target_, weights) + constant_);
}

std::vector<double> SymmetricGrid::response_row(double fx, double fy) const {
    // Mirrored points add cos cos; those on an axis are their own mirror images.
    std::vector<double> at_x, at_y, row;
    for (int i = 0; i < count_; ++i) {
        at_x.push_back(std::cos(two_pi * fx * (origin_ + i)));
        at_y.push_back(std::cos(two_pi * fy * (origin_ + i)));
    }
    for (std::size_t u = 0; u < size(); ++u) {
        const auto i = static_cast<std::size_t>(points_[u].first), j = static_cast<std::size_t>(points_[u].second);
        row.push_back(images_[u] * (dimensions_ == 1 ? at_x[i] : (at_x[i] * at_y[j] + at_x[j] * at_y[i]) / 2));
    }
    return row;
}

SymmetricGrid::Peak SymmetricGrid::highest(const std::vector<double>& weights, bool exact) const {
    std::vector<Peak> peaks = samples_;
    const auto count = static_cast<Eigen::Index>(peaks.size());
    Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
    for (std::size_t u = 0; u < size(); ++u)  // most weights of fetches are 0
        if (weights[u] != 0 && count > 0)
            values += weights[u] * Eigen::Map<const Eigen::VectorXd>(&sample_rows_[u * peaks.size()], count);
    for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k].value = values[static_cast<Eigen::Index>(k)];
    const auto is_higher = [](const Peak& a, const Peak& b) { return std::abs(a.value) > std::abs(b.value); };
    if (!exact || peaks.empty())
        return peaks.empty() ? Peak{} : *std::min_element(peaks.begin(), peaks.end(), is_higher);
    // The highest samples that are not beside a higher one.
    constexpr std::size_t starts = 6;
    std::stable_sort(peaks.begin(), peaks.end(), is_higher);
    const double apart = 1.6 * sample_pitch();
    std::vector<Peak> tops;
    for (const Peak& peak : peaks) {
        const bool is_beside = std::any_of(tops.begin(), tops.end(), [&](const Peak& top) {
            return std::max(std::abs(top.fx - peak.fx), std::abs(top.fy - peak.fy)) < apart;
        });
        if (!is_beside && tops.size() < starts) tops.push_back(peak);
    }
    for (Peak& top : tops) top = climbed(top, weights);
    return *std::min_element(tops.begin(), tops.end(), is_higher);
}

SymmetricGrid::Peak SymmetricGrid::climbed(Peak peak, const std::vector<double>& weights) const {
    constexpr std::array<std::pair<int, int>, 4> ways{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (double step = sample_pitch() / 2; step > 1e-7;) {  // halves where no way leads up
        bool is_higher = false;
        for (const auto& [dx, dy] : ways) {
            if (dimensions_ == 1 && dy != 0) continue;
            const double fx = peak.fx + dx * step, fy = peak.fy + dy * step, value = dot(response_row(fx, fy), weights);
            if (std::abs(value) > std::abs(peak.value)) peak = {fx, fy, value}, is_higher = true;
        }
        if (!is_higher) step /= 2;
    }
    return peak;
}

namespace {

QuadraticProgram program_of(const SymmetricGrid& grid, const std::vector<Unknown>& unknowns) {
    const std::size_t n = unknowns.size();
    QuadraticProgram program{std::vector<double>(n * n), {}, {{}, 1}, {}};
    const std::vector<double> nothing(grid.size());
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::vector<double> formed = grid.times_form(unknowns[i].column);
        for (std::size_t j = 0; j < n; ++j) program.hessian[i * n + j] = dot(formed, unknowns[j].column);
        trace += program.hessian[i * n + i];
        program.gradient.push_back(dot(grid.target(), unknowns[i].column));
        double sum = 0;
        for (std::size_t u = 0; u < grid.size(); ++u) sum += grid.images(u) * unknowns[i].column[u];
        program.plane.factors.push_back(sum);
        const auto limit = [&](double sign, double bound) {
            if (std::isinf(bound)) return;
            std::vector<double> factors(n);
            factors[i] = sign;
            program.limits.push_back({std::move(factors), sign * bound});
        };
        limit(1, unknowns[i].least);
        limit(-1, unknowns[i].most);
    }
    // What two unknowns do alike is shared out between them.
    for (std::size_t i = 0; i < n; ++i) program.hessian[i * n + i] += unknowns[i].damping + 1e-13 * trace;
    return program;
}

}  // namespace

GridFit fit(const SymmetricGrid& grid, const std::vector<Unknown>& unknowns, GainLimit* limit) {
    QuadraticProgram program = program_of(grid, unknowns);
    const auto add_row = [&](const std::vector<double>& row) {
        std::vector<double> up, down;
        for (const Unknown& unknown : unknowns) {
            up.push_back(-dot(row, unknown.column));
            down.push_back(-up.back());
        }
        program.limits.push_back({std::move(up), -limit->most});
        program.limits.push_back({std::move(down), -limit->most});
    };
    if (limit)
        for (const std::vector<double>& row : limit->rows) add_row(row);
    for (int round = 0; round < 100; ++round) {
        const std::optional<std::vector<double>> values = solve(program);
        if (!values) return {};
        GridFit result{*values, std::vector<double>(grid.size()), 0};
        for (std::size_t k = 0; k < unknowns.size(); ++k)
            for (std::size_t u = 0; u < grid.size(); ++u) result.weights[u] += result.values[k] * unknowns[k].column[u];
        result.error = grid.error(result.weights);
        for (std::size_t k = 0; k < unknowns.size(); ++k)
            result.error += unknowns[k].damping * result.values[k] * result.values[k];
        if (!limit) return result;
        const SymmetricGrid::Peak peak = grid.highest(result.weights, limit->exact);
        if (std::abs(peak.value) <= limit->most + 1e-9) return result;
        limit->rows.push_back(grid.response_row(peak.fx, peak.fy));
        add_row(limit->rows.back());
    }
    return {};
}

}  // namespace bandlimit
