#include "bandlimit/design/kernel_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "bandlimit/analysis/kernel_spectrum.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/least_squares.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

using std::numbers::pi;
using Use = KernelFitOptions::Use;
using Row = std::vector<double>;  ///< a linear function of all coefficients, those of the innermost piece first

constexpr int bands = 16;        ///< of half a cycle per pitch, that the loss covers
constexpr int step_phases = 64;  ///< per pitch, at which answers to a step are limited

/// Where the pieces lie, and linear functions of the kernel that they make.
class Space {
public:
    Space(double radius, int pieces, int degree) : degree_(degree), odd_(pieces % 2 == 1) {
        double begin = 0;
        for (int i = odd_ ? 1 : 2; i <= pieces; i += 2) {
            const double end = radius * i / pieces;
            pieces_.push_back({begin, end, {}});
            begin = end;
        }
    }

    std::size_t unknowns() const { return pieces_.size() * powers(); }
    const KernelPieces& pieces() const { return pieces_; }
    double radius() const { return pieces_.back().end; }
    /// The innermost piece and its mirror image are one polynomial.
    bool middle_is_one_piece() const { return odd_; }

    /// Adds `scale` times the m-th derivative of piece p at distance x from 0.
    void add_derivative(Row& row, std::size_t p, double x, int m, double scale) const {
        double* terms = row.data() + p * powers();
        for (int n = m; n <= degree_; ++n) {
            double factor = scale;
            for (int i = 0; i < m; ++i) factor *= n - i;
            terms[n] += factor * std::pow(x - pieces_[p].begin, n - m);
        }
    }

    void add_value(Row& row, double x, double scale = 1) const {
        x = std::abs(x);
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            if (x < pieces_[p].end) return add_derivative(row, p, x, 0, scale);
    }

    /// The integral of the kernel times `function` over 0 <= x <= end; `panels` for each piece.
    template <class Function>
    Row integral(double end, int panels, Function function) const {
        Row row(unknowns());
        for (std::size_t p = 0; p < pieces_.size() && pieces_[p].begin < end; ++p) {
            const Quadrature points = quadrature(pieces_[p].begin, std::min(end, pieces_[p].end), panels);
            for (std::size_t i = 0; i < points.at.size(); ++i)
                add_derivative(row, p, points.at[i], 0, points.weights[i] * function(points.at[i]));
        }
        return row;
    }

    Row spectrum_at(double f) const {
        const double length = pieces_.back().end - pieces_.back().begin;
        return integral(radius(), 1 + static_cast<int>(f * length / 2),
                        [f](double x) { return 2 * std::cos(2 * pi * f * x); });
    }

    KernelPieces filled(const std::vector<double>& coefficients) const {
        KernelPieces result = pieces_;
        auto at = coefficients.begin();
        for (KernelPiece& piece : result) {
            piece.coefficients.assign(at, at + static_cast<std::ptrdiff_t>(powers()));
            at += static_cast<std::ptrdiff_t>(powers());
        }
        return result;
    }

private:
    std::size_t powers() const { return static_cast<std::size_t>(degree_) + 1; }

    KernelPieces pieces_;
    int degree_;
    bool odd_;
};

double dot(const Row& row, const std::vector<double>& x) {
    double sum = 0;
    for (std::size_t i = 0; i < row.size(); ++i) sum += row[i] * x[i];
    return sum;
}

// ---- Conditions

void require_smoothness(LeastSquares& problem, const Space& space, int degree, int smoothness) {
    const std::size_t count = space.pieces().size();
    const auto require = [&](auto add) {
        Row row(space.unknowns());
        add(row);
        problem.equal(row, 0);
    };
    for (std::size_t p = 0; p < count; ++p) {
        const double end = space.pieces()[p].end;
        for (int m = 0; m <= smoothness; ++m)
            require([&](Row& row) {
                space.add_derivative(row, p, end, m, 1);
                if (p + 1 < count) space.add_derivative(row, p + 1, end, m, -1);
            });
    }
    // An even function: its odd derivatives at 0 are 0 where they are continuous.
    for (int m = 1; m <= (space.middle_is_one_piece() ? degree : smoothness); m += 2)
        require([&](Row& row) { space.add_derivative(row, 0, 0, m, 1); });
}

/// Between the knots and their shifted copies the sum is a polynomial: it is 1 where it is so at degree + 1 points.
void require_unity(LeastSquares& problem, const Space& space, int degree) {
    const int reach = static_cast<int>(std::ceil(space.radius()));
    std::vector<double> borders{0, 0.5};
    for (const KernelPiece& piece : space.pieces())
        for (const double knot : {piece.end, -piece.end}) borders.push_back(knot - std::floor(knot));
    std::sort(borders.begin(), borders.end());
    for (std::size_t i = 1; i < borders.size() && borders[i] <= 0.5; ++i) {
        const double length = borders[i] - borders[i - 1];
        if (length < 1e-9) continue;
        for (int n = 0; n <= degree; ++n) {
            const double x = borders[i - 1] + length * (n + 0.5) / (degree + 1);
            Row row(space.unknowns());
            for (int k = -reach - 1; k <= reach; ++k) space.add_value(row, x + k);
            problem.equal(row, 1);
        }
    }
}

void require_interpolation(LeastSquares& problem, const Space& space) {
    for (int n = 0; n < space.radius(); ++n) {
        Row row(space.unknowns());
        space.add_value(row, n);
        problem.equal(row, n == 0 ? 1 : 0);
    }
}

/// The answers to a unit step, as functions of the coefficients: where the answer lies, for all positions of the step.
std::vector<Row> step_answers(const Space& space, Use use) {
    std::vector<Row> rows;
    const int reach = static_cast<int>(std::ceil(space.radius()));
    if (use == Use::shrink) {
        const Row half = space.integral(space.radius(), 1, [](double) { return 1; });
        for (int i = 0; i < reach * step_phases; ++i) {
            Row row = space.integral(static_cast<double>(i) / step_phases, 1, [](double) { return 1; });
            for (std::size_t j = 0; j < row.size(); ++j) row[j] += half[j];
            rows.push_back(std::move(row));
        }
        return rows;
    }
    for (int i = 0; i < step_phases; ++i) {
        Row row(space.unknowns());
        for (int k = -reach; k < reach; ++k) {
            space.add_value(row, k + (i + 0.5) / step_phases);
            rows.push_back(row);
        }
    }
    return rows;
}

// ---- What is minimised

double target(const KernelFitOptions& options, double f) {
    if (options.like) return relative_spectrum(*options.like, f);
    return f < 0.5 ? 1 : 0;
}

double weight(const KernelFitOptions& options, double f) {
    const double distance = options.use == Use::grow ? std::abs(f - std::round(f)) : f;
    return std::pow(distance, -options.slope);
}

/// The spectrum at the points of the loss.
struct Samples {
    Quadrature points;
    std::vector<Row> spectra;
    std::vector<double> targets;
};

Samples samples_of(const KernelFitOptions& options, const Space& space) {
    Samples samples;
    // Borders at all multiples of 1/2, where the target jumps and the weight has its poles.
    samples.points = quadrature(0, bands / 2.0, bands * (1 + static_cast<int>(std::ceil(options.radius / 2))));
    for (const double f : samples.points.at) {
        samples.spectra.push_back(space.spectrum_at(f));
        samples.targets.push_back(target(options, f));
    }
    return samples;
}

void check(const KernelFitOptions& o) {
    if (!(o.radius >= 0.5 && o.radius <= 8)) fail("fit_kernel: radius = ", o.radius, "; pass 0.5 to 8 source pitches");
    if (o.pieces < 0 || o.pieces > 64) fail("fit_kernel: ", o.pieces, " pieces; pass 1 to 64, or 0 for one per pitch");
    if (o.degree < 0 || o.degree > 7) fail("fit_kernel: degree = ", o.degree, "; pass 0 to 7 (3 is usual)");
    if (o.smoothness < -1 || o.smoothness >= std::max(1, o.degree))
        fail("fit_kernel: smoothness = ", o.smoothness, " with degree ", o.degree, "; pass -1 to ",
             std::max(0, o.degree - 1));
    if (!(o.slope >= 0 && o.slope <= 2)) fail("fit_kernel: slope = ", o.slope, "; pass 0 to 2");
    if (!(o.max_overshoot >= 0)) fail("fit_kernel: max_overshoot = ", o.max_overshoot, "; pass 0 or more");
    if (o.like && is_radial(*o.like)) fail("fit_kernel: ", o.like->name, " is radial; pass a kernel along one axis");
}

std::vector<double> solve(const KernelFitOptions& options, const LeastSquares& problem, int pieces) {
    try {
        return problem.solve();
    } catch (const Error&) {
        fail("fit_kernel: no kernel of radius ", options.radius, " in ", pieces, " pieces of degree ", options.degree,
             " with smoothness ", options.smoothness, options.interpolating ? ", interpolating," : "", " sums to 1",
             std::isfinite(options.max_overshoot) ? " within its limit of overshoot" : "",
             "; pass another number of pieces (one per pitch is 2 radius), a higher degree, or ask for less");
    }
}

}  // namespace

KernelFit fit_kernel(const KernelFitOptions& options) {
    check(options);
    const int pieces = options.pieces > 0 ? options.pieces : static_cast<int>(std::ceil(2 * options.radius));
    const Space space(options.radius, pieces, options.degree);
    LeastSquares problem(static_cast<int>(space.unknowns()));
    require_unity(problem, space, options.degree);
    require_smoothness(problem, space, options.degree, options.smoothness);
    if (options.interpolating) require_interpolation(problem, space);
    const std::vector<Row> steps = step_answers(space, options.use);
    if (std::isfinite(options.max_overshoot))
        for (const Row& row : steps) problem.at_most(row, 1 + options.max_overshoot);
    const Samples samples = samples_of(options, space);
    const auto& [at, weights] = samples.points;
    for (std::size_t i = 0; i < at.size(); ++i)
        problem.minimise(samples.spectra[i], samples.targets[i], weights[i] * weight(options, at[i]));

    const std::vector<double> x = solve(options, problem, pieces);
    KernelFit fit{space.filled(x)};
    double energy = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double rest = dot(samples.spectra[i], x) - samples.targets[i];
        fit.loss += weights[i] * weight(options, at[i]) * rest * rest;
        fit.error += weights[i] * rest * rest;
        energy += weights[i] * samples.targets[i] * samples.targets[i];
    }
    fit.error /= energy;
    for (const Row& row : steps) fit.overshoot = std::max(fit.overshoot, dot(row, x) - 1);
    return fit;
}

}  // namespace bandlimit
