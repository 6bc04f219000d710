#include "bandlimit/design/fetch_pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bandlimit {
namespace {

/// A texel along an axis that a read covers: its point on the grid, the share of the read, and how that grows with the
/// part of the reach.
struct Share {
    int point = 0;
    double amount = 0, slope = 0;
};

std::vector<Share> shares(const std::vector<Reach>& reaches, int reach, const TexelLattice& lattice) {
    if (reach == Ring::on_axis) return {{0, 1, 0}};  // at most two texels, each the other's image
    const Reach& r = reaches[static_cast<std::size_t>(reach)];
    const auto point = [&](int cell) {
        return static_cast<int>(std::lround(std::abs(lattice.origin + lattice.step * cell) - lattice.origin));
    };
    return {{point(r.cell), 1 - r.part, -1}, {point(r.cell + 1), r.part, 1}};
}

/// In how many places of the whole plane a ring reads, with those of mirrored outputs where pictures grow.
int places(const Ring& ring) {
    if (ring.x == Ring::on_axis && ring.y == Ring::on_axis) return 1;
    return ring.x == ring.y || ring.x == Ring::on_axis || ring.y == Ring::on_axis ? 4 : 8;
}

/// What a fetch of weight 1 at each place of a ring comes to, and its derivatives.
struct RingColumns {
    std::vector<double> value, by_x, by_y;
};

RingColumns columns_of(const FetchPattern& pattern, const Ring& ring, const SymmetricGrid& grid,
                       const TexelLattice& lattice) {
    const std::vector<double> zero(grid.size());
    RingColumns columns{zero, zero, zero};
    for (const Share& x : shares(pattern.reaches, ring.x, lattice))
        for (const Share& y : shares(pattern.reaches, ring.y, lattice)) {
            const std::size_t u = grid.index(x.point, y.point);
            const double scale = places(ring) / grid.images(u);
            columns.value[u] += scale * x.amount * y.amount;
            columns.by_x[u] += scale * x.slope * y.amount;
            columns.by_y[u] += scale * x.amount * y.slope;
        }
    return columns;
}

/// What a fetch of weight 1 adds to the mean squared error of white noise if its position is rounded to 1/64 texel:
/// the variance of the rounding along two axes, times that of a difference of neighbours. It keeps designs
/// from large weights of both signs side by side.
constexpr double rounding_error = 2 * 2 / (12.0 * 64 * 64);

/// The pattern as linear in its weights, for where it reads now.
std::vector<Unknown> weight_unknowns(const FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal) {
    std::vector<Unknown> unknowns;
    for (const Ring& ring : pattern.rings) {
        unknowns.push_back({columns_of(pattern, ring, grid, lattice_of(goal)).value});
        if (goal.non_negative) unknowns.back().least = 0;
        unknowns.back().damping = rounding_error * places(ring);
    }
    return unknowns;
}

/// And in how far each reach is to grow.
std::vector<Unknown> move_unknowns(const FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal,
                                   double damping) {
    std::vector<Unknown> moves;
    for (const Reach& reach : pattern.reaches)
        moves.push_back({std::vector<double>(grid.size()), -reach.part, 1 - reach.part, damping});
    for (std::size_t k = 0; k < pattern.rings.size(); ++k) {
        const Ring& ring = pattern.rings[k];
        const RingColumns columns = columns_of(pattern, ring, grid, lattice_of(goal));
        for (const auto& [reach, slope] : {std::pair{ring.x, &columns.by_x}, {ring.y, &columns.by_y}}) {
            if (reach == Ring::on_axis) continue;
            std::vector<double>& column = moves[static_cast<std::size_t>(reach)].column;
            for (std::size_t u = 0; u < grid.size(); ++u) column[u] += pattern.weights[k] * (*slope)[u];
        }
    }
    return moves;
}

void weigh(FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal, GainLimit* limit) {
    GridFit best = fit(grid, weight_unknowns(pattern, grid, goal), limit);
    pattern.weights = std::move(best.values);
    pattern.error = best.error;
}

std::optional<GainLimit> limit_of(const RateGoal& goal, bool exact) {
    if (!goal.max_gain) return std::nullopt;
    return GainLimit{*goal.max_gain, exact};
}

/// The pattern after one step; its error may be larger.
FetchPattern stepped(const FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal, GainLimit* limit,
                     double damping) {
    std::vector<Unknown> unknowns = move_unknowns(pattern, grid, goal, damping);
    for (Unknown& weight : weight_unknowns(pattern, grid, goal)) unknowns.push_back(std::move(weight));
    const GridFit step = fit(grid, unknowns, limit);
    FetchPattern next = pattern;
    if (step.values.empty()) return next;
    for (std::size_t k = 0; k < next.reaches.size(); ++k)
        next.reaches[k].part = std::clamp(next.reaches[k].part + step.values[k], 0.0, 1.0);
    weigh(next, grid, goal, limit);
    return next;
}

}  // namespace

TexelLattice lattice_of(const RateGoal& goal) {
    if (goal.upsample) return {0.5, 2};
    return {goal.factor % 2 == 0 ? 0.5 : 0.0, 1};
}

int fetch_count(const Ring& ring, const TexelLattice& lattice) {
    return lattice.is_shrinking() ? places(ring) : places(ring) / 4;
}

int fetch_count(const FetchPattern& pattern, const TexelLattice& lattice) {
    int count = 0;
    for (const Ring& ring : pattern.rings) count += fetch_count(ring, lattice);
    return count;
}

std::vector<std::size_t> points_read(const FetchPattern& pattern, const Ring& ring, const SymmetricGrid& grid,
                                     const TexelLattice& lattice) {
    std::vector<std::size_t> points;
    for (const Share& x : shares(pattern.reaches, ring.x, lattice))
        for (const Share& y : shares(pattern.reaches, ring.y, lattice)) points.push_back(grid.index(x.point, y.point));
    return points;
}

void weigh(FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal, bool exact) {
    std::optional<GainLimit> limit = limit_of(goal, exact);
    weigh(pattern, grid, goal, limit ? &*limit : nullptr);
}

void optimize(FetchPattern& pattern, const SymmetricGrid& grid, const RateGoal& goal) {
    constexpr int most_steps = 60;
    constexpr double too_small = 1e-12;  // improvement of the error
    std::optional<GainLimit> limit = limit_of(goal, false);
    GainLimit* const held = limit ? &*limit : nullptr;
    weigh(pattern, grid, goal, held);
    if (pattern.weights.empty()) return;
    double damping = 1e-3;
    for (int step = 0; step < most_steps && damping < 1e3; ++step) {
        FetchPattern next = stepped(pattern, grid, goal, held, damping);
        const double gained = pattern.error - next.error;
        if (gained > 0) pattern = std::move(next);
        if (gained >= 0 && gained < too_small) return;
        damping *= gained > 0 ? 0.2 : 8;
    }
}

Fetches fetches_of(const FetchPattern& pattern, const TexelLattice& lattice) {
    const auto mirrored = [&](int reach) -> std::vector<double> {
        if (reach == Ring::on_axis) return {0};
        const Reach& r = pattern.reaches[static_cast<std::size_t>(reach)];
        const double distance = lattice.origin / lattice.step + r.cell + r.part;
        // Of the four outputs of a texel that grow from it, ours lies right of it: its texels are left by the origin.
        if (!lattice.is_shrinking()) return {-distance};
        return {-distance, distance};
    };
    Fetches fetches;
    for (std::size_t k = 0; k < pattern.rings.size(); ++k) {
        const Ring& ring = pattern.rings[k];
        const double weight = pattern.weights[k] * (lattice.is_shrinking() ? 1 : 4);
        const auto add = [&](const std::vector<double>& at_x, const std::vector<double>& at_y) {
            for (const double y : at_y)
                for (const double x : at_x) fetches.push_back({x, y, weight});
        };
        add(mirrored(ring.x), mirrored(ring.y));
        if (ring.x != ring.y) add(mirrored(ring.y), mirrored(ring.x));
    }
    return fetches;
}

}  // namespace bandlimit
