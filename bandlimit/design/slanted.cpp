#include "bandlimit/design/slanted.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/low_rank.h"

namespace bandlimit {
namespace {

constexpr int max_side = 128;
constexpr double max_step = 8;

/// Whole offsets from the output: those of a grid are where terms put it.
struct Region {
    int left = 0, top = 0, width = 0, height = 0;

    bool contains(int x, int y) const { return x >= left && y >= top && x < left + width && y < top + height; }
    int index(int x, int y) const { return (y - top) * width + (x - left); }
};

Region region_of(int width, int height) { return {centred_first(width), centred_first(height), width, height}; }

/// What a linear read at a point is made of.
struct Stencil {
    struct Sample {
        int x, y;
        double weight;
    };
    std::array<Sample, 4> samples;
    std::size_t count = 0;
};

Stencil stencil_at(double x, double y) {
    constexpr double whole = 1e-9;  // nearer to a sample than this is on it
    const double left = std::floor(x + whole), top = std::floor(y + whole);
    const double fx = x - left < whole ? 0 : x - left, fy = y - top < whole ? 0 : y - top;
    Stencil stencil;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1})
            if (const double w = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy); w != 0)
                stencil.samples[stencil.count++] = {static_cast<int>(left) + dx, static_cast<int>(top) + dy, w};
    return stencil;
}

std::vector<Stencil> stencils_of(const Step& step, int first, std::size_t count) {
    std::vector<Stencil> stencils;
    for (std::size_t j = 0; j < count; ++j) {
        const double at = first + static_cast<double>(j);
        stencils.push_back(stencil_at(at * step.x, at * step.y));
    }
    return stencils;
}

/// What the read of one pass of what a read of the other pass made takes from each sample.
template <class Use>
void for_each_sample(const Stencil& a, const Stencil& b, Use use) {
    for (std::size_t i = 0; i < a.count; ++i)
        for (std::size_t j = 0; j < b.count; ++j)
            use(a.samples[i].x + b.samples[j].x, a.samples[i].y + b.samples[j].y,
                a.samples[i].weight * b.samples[j].weight);
}

std::vector<double> weights_on(const Region& region, const SlantedPasses& passes) {
    const Taps &a = passes.first.taps, &b = passes.second.taps;
    const auto reads = stencils_of(passes.first.step, a.first, a.weights.size());
    const auto others = stencils_of(passes.second.step, b.first, b.weights.size());
    std::vector<double> grid(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
    for (std::size_t i = 0; i < reads.size(); ++i)
        for (std::size_t j = 0; j < others.size(); ++j)
            for_each_sample(reads[i], others[j], [&](int x, int y, double w) {
                if (region.contains(x, y))
                    grid[static_cast<std::size_t>(region.index(x, y))] += w * a.weights[i] * b.weights[j];
            });
    return grid;
}

double cross(const Step& a, const Step& b) { return a.x * b.y - a.y * b.x; }

/// Passes without weights yet, whose steps together reach every corner of `grid`.
SlantedPasses empty_passes(const Region& grid, const Step& first, const Step& second) {
    const double area = cross(first, second);
    double low[2] = {0, 0}, high[2] = {0, 0};
    for (const int x : {grid.left, grid.left + grid.width - 1}) {
        for (const int y : {grid.top, grid.top + grid.height - 1}) {
            const Step corner{static_cast<double>(x), static_cast<double>(y)};
            const double at[2] = {cross(corner, second) / area, cross(first, corner) / area};
            for (const int i : {0, 1}) {
                low[i] = std::min(low[i], std::floor(at[i]));
                high[i] = std::max(high[i], std::ceil(at[i]));
            }
        }
    }
    const auto taps = [&](int i) {
        return Taps{static_cast<int>(low[i]), std::vector<double>(static_cast<std::size_t>(high[i] - low[i] + 1))};
    };
    return {{first, taps(0)}, {second, taps(1)}};
}

/// Where the passes can have weights.
Region reach(const SlantedPasses& passes) {
    double left = 0, right = 0, top = 0, bottom = 0;
    const auto ends = [](const Taps& taps) {
        return std::array{taps.first, taps.first + static_cast<int>(taps.weights.size()) - 1};
    };
    for (const int i : ends(passes.first.taps)) {
        for (const int j : ends(passes.second.taps)) {
            const double x = i * passes.first.step.x + j * passes.second.step.x;
            const double y = i * passes.first.step.y + j * passes.second.step.y;
            left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
        }
    }
    // Two stencils reach less than 2 samples further.
    const int x = static_cast<int>(std::floor(left)) - 1, y = static_cast<int>(std::floor(top)) - 1;
    return {x, y, static_cast<int>(std::ceil(right)) + 3 - x, static_cast<int>(std::ceil(bottom)) + 3 - y};
}

/// `kernel` on a larger grid.
Eigen::VectorXd on_region(const WeightGrid& kernel, const Region& region) {
    const Region own = region_of(kernel.width, kernel.height);
    Eigen::VectorXd padded = Eigen::VectorXd::Zero(region.width * region.height);
    for (int y = 0; y < kernel.height; ++y)
        for (int x = 0; x < kernel.width; ++x)
            if (region.contains(own.left + x, own.top + y))
                padded[region.index(own.left + x, own.top + y)] = kernel.at(x, y);
    return padded;
}

/// `kernel`, read linearly where the steps of both passes lead: one row per tap of the second.
WeightGrid along_steps(const WeightGrid& kernel, const SlantedPasses& passes) {
    const Taps &a = passes.first.taps, &b = passes.second.taps;
    const Region own = region_of(kernel.width, kernel.height);
    WeightGrid grid(static_cast<int>(a.weights.size()), static_cast<int>(b.weights.size()));
    for (int j = 0; j < grid.height; ++j) {
        for (int i = 0; i < grid.width; ++i) {
            const double along = a.first + i, across = b.first + j;
            const Stencil read = stencil_at(along * passes.first.step.x + across * passes.second.step.x,
                                            along * passes.first.step.y + across * passes.second.step.y);
            for (std::size_t k = 0; k < read.count; ++k)
                if (own.contains(read.samples[k].x, read.samples[k].y))
                    grid.at(i, j) +=
                        read.samples[k].weight * kernel.at(read.samples[k].x - own.left, read.samples[k].y - own.top);
        }
    }
    return grid;
}

/// The weights of `pass` that come nearest to `target` with those of `other` as they are.
void solve_pass(SlantedPass& pass, const SlantedPass& other, const Region& region, const Eigen::VectorXd& target) {
    const auto reads = stencils_of(pass.step, pass.taps.first, pass.taps.weights.size());
    const auto others = stencils_of(other.step, other.taps.first, other.taps.weights.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < reads.size(); ++i)
        for (std::size_t j = 0; j < others.size(); ++j)
            for_each_sample(reads[i], others[j], [&](int x, int y, double w) {
                entries.emplace_back(region.index(x, y), static_cast<int>(i), w * other.taps.weights[j]);
            });
    Eigen::SparseMatrix<double> matrix(target.size(), static_cast<Eigen::Index>(reads.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::MatrixXd normal = Eigen::MatrixXd(matrix.transpose() * matrix);
    // Taps that meet nothing stay 0.
    normal.diagonal().array() += 1e-9 * normal.trace() / static_cast<double>(normal.rows());
    const Eigen::VectorXd found = normal.ldlt().solve(matrix.transpose() * target);
    std::copy(found.begin(), found.end(), pass.taps.weights.begin());
}

double relative_error(const SlantedPasses& passes, const Region& region, const Eigen::VectorXd& target) {
    const std::vector<double> weights = weights_on(region, passes);
    const Eigen::Map<const Eigen::VectorXd> found(weights.data(), target.size());
    return (found - target).squaredNorm() / target.squaredNorm();
}

/// Drops weights at both ends that are below a thousandth of the largest.
void trim(Taps& taps) {
    double largest = 0;
    for (const double w : taps.weights) largest = std::max(largest, std::abs(w));
    const auto matters = [&](double w) { return std::abs(w) > 1e-3 * largest; };
    const auto begin = std::find_if(taps.weights.begin(), taps.weights.end(), matters);
    if (begin == taps.weights.end()) return;
    const auto end = std::find_if(taps.weights.rbegin(), taps.weights.rend(), matters).base();
    taps.first += static_cast<int>(begin - taps.weights.begin());
    taps.weights = std::vector<double>(begin, end);
}

void check_steps(const Step& first, const Step& second) {
    for (const double v : {first.x, first.y, second.x, second.y})
        if (!(std::abs(v) <= max_step)) fail("fit_slanted: a step of ", v, "; pass at most ", max_step, " samples");
    if (const double area = std::abs(cross(first, second)); area < 0.5)
        fail("fit_slanted: steps that span ", area, " samples; pass two that span at least 1/2");
}

}  // namespace

WeightGrid expanded(const SlantedPasses& passes, int width, int height) {
    if (width < 1 || height < 1) fail("expanded: ", width, " x ", height, "; pass at least 1 x 1");
    WeightGrid grid(width, height);
    grid.weights = weights_on(region_of(width, height), passes);
    return grid;
}

PrincipalAxes principal_axes(const WeightGrid& kernel) {
    double sum = 0, x_sum = 0, y_sum = 0;
    const auto for_each = [&](auto use) {
        for (int y = 0; y < kernel.height; ++y)
            for (int x = 0; x < kernel.width; ++x) use(x, y, kernel.at(x, y) * kernel.at(x, y));
    };
    for_each([&](int x, int y, double square) {
        sum += square;
        x_sum += square * x;
        y_sum += square * y;
    });
    if (!(sum > 0 && std::isfinite(sum)))
        fail("principal_axes: squares that sum to ", sum, "; pass a kernel that is not 0");
    PrincipalAxes axes{x_sum / sum, y_sum / sum};
    for_each([&](int x, int y, double square) {
        const double dx = x - axes.x, dy = y - axes.y;
        axes.xx += square * dx * dx / sum;
        axes.xy += square * dx * dy / sum;
        axes.yy += square * dy * dy / sum;
    });
    const double middle = (axes.xx + axes.yy) / 2, half = std::hypot((axes.xx - axes.yy) / 2, axes.xy);
    axes.along = std::sqrt(middle + half);
    axes.across = std::sqrt(std::max(0.0, middle - half));
    // Of round kernels only rounding would tell an axis.
    if (half > 1e-9 * middle) axes.degrees = std::atan2(2 * axes.xy, axes.xx - axes.yy) * 90 / std::numbers::pi;
    return axes;
}

SlantedFit fit_slanted(const WeightGrid& kernel, const Step& first, const Step& second) {
    check_steps(first, second);
    if (kernel.width > max_side || kernel.height > max_side)
        fail("fit_slanted: a kernel of ", kernel.width, " x ", kernel.height, "; pass at most ", max_side, " x ",
             max_side);
    principal_axes(kernel);  // checks the weights

    SlantedFit fit{empty_passes(region_of(kernel.width, kernel.height), first, second)};
    auto& [a, b] = fit.passes;
    const Region region = reach(fit.passes);
    const Eigen::VectorXd target = on_region(kernel, region);
    const Svd sampled = svd_of(along_steps(kernel, fit.passes));
    fit.rank = rank_for_energy(sampled.values, 0.999);
    b.taps.weights = low_rank(sampled, 1)[0].column;
    double before = 0;
    fit.error = 1;
    do {
        before = fit.error;
        solve_pass(a, b, region, target);
        solve_pass(b, a, region, target);
        fit.error = relative_error(fit.passes, region, target);
    } while (fit.error < before - std::max(1e-6, 0.01 * before));
    trim(a.taps);
    trim(b.taps);
    fit.error = relative_error(fit.passes, region, target);
    return fit;
}

SlantedFit fit_slanted(const WeightGrid& kernel) {
    const PrincipalAxes axes = principal_axes(kernel);
    const double angle = axes.degrees * std::numbers::pi / 180;
    std::vector<std::pair<Step, Step>> pairs{
        {{std::cos(angle), std::sin(angle)}, {0 - std::sin(angle), std::cos(angle)}}};
    if (std::abs(axes.xy) <= max_step * axes.yy && axes.yy > 0) pairs.push_back({{1, 0}, {axes.xy / axes.yy, 1}});
    if (std::abs(axes.xy) <= max_step * axes.xx && axes.xx > 0) pairs.push_back({{0, 1}, {1, axes.xy / axes.xx}});
    std::optional<SlantedFit> best;
    for (const auto& pair : pairs)
        if (SlantedFit fit = fit_slanted(kernel, pair.first, pair.second); !best || fit.error < best->error)
            best = std::move(fit);
    return *best;
}

}  // namespace bandlimit
