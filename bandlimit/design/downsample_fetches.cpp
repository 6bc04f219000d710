// The search for fetches: which cells between texels they read in. Grows small patterns into larger ones and keeps the
// best few of each size, then exchanges rings as long as that helps.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bandlimit/core/error.h"
#include "bandlimit/design/downsample.h"
#include "bandlimit/design/fetch_pattern.h"

namespace bandlimit {
namespace {

constexpr int most_fetches = 64, most_side = 32;

/// A ring and the cells that it reads in, one per axis.
struct Candidate {
    Ring kind;  ///< on_axis where it is; else any numbers, equal where both coordinates are
    int x = 0, y = 0;
};

/// The pattern with one more ring, in the middle of its cells.
FetchPattern grown(const FetchPattern& pattern, const Candidate& c) {
    FetchPattern next = pattern;
    const auto add = [&](int kind, int cell) {
        if (kind == Ring::on_axis) return Ring::on_axis;
        next.reaches.push_back({cell, 0.5});
        return static_cast<int>(next.reaches.size()) - 1;
    };
    const int x = add(c.kind.x, c.x), y = c.kind.y == c.kind.x ? x : add(c.kind.y, c.y);
    next.rings.push_back({x, y});
    return next;
}

/// The pattern without ring k, whose reaches no other ring has.
FetchPattern without(const FetchPattern& pattern, std::size_t k) {
    FetchPattern next;
    for (std::size_t r = 0; r < pattern.rings.size(); ++r) {
        if (r == k) continue;
        const Ring& ring = pattern.rings[r];
        const auto copy = [&](int reach) {
            if (reach == Ring::on_axis) return Ring::on_axis;
            next.reaches.push_back(pattern.reaches[static_cast<std::size_t>(reach)]);
            return static_cast<int>(next.reaches.size()) - 1;
        };
        const int x = copy(ring.x), y = ring.y == ring.x ? x : copy(ring.y);
        next.rings.push_back({x, y});
    }
    return next;
}

/// What tells patterns apart whose reads move within their cells only.
using Key = std::vector<std::pair<int, int>>;

Key key_of(const FetchPattern& pattern) {
    constexpr int axis = -1000, same = 1000;
    const auto cell = [&](int reach) {
        return reach == Ring::on_axis ? axis : pattern.reaches[static_cast<std::size_t>(reach)].cell;
    };
    Key key;
    for (const Ring& ring : pattern.rings)
        key.emplace_back(cell(ring.x), ring.x == ring.y && ring.x != Ring::on_axis ? same : cell(ring.y));
    std::sort(key.begin(), key.end());
    return key;
}

bool is_better(const FetchPattern& a, const FetchPattern& b) { return a.error < b.error; }

class Search {
public:
    Search(const RateGoal& goal, const FetchOptions& options)
        : goal_(goal), lattice_(lattice_of(goal)), grid_(2, lattice_.origin, points_of(goal, options), goal) {
        kept_.assign(grid_.size(), true);
        if (options.threshold > 0) keep_large(options);
        const int cells = grid_.count() / lattice_.step + 1;
        for (int c = lattice_.is_shrinking() ? 0 : -cells; c < cells; ++c) cells_.push_back(c);
        if (options.layout != FetchLayout::square) collect(options.layout);
        is_cross_ = options.layout == FetchLayout::cross;
        // Far fewer miss the best 20 fetches that halve; five times as many find nothing better.
        if (lattice_.is_shrinking() && !goal.max_gain) refined_ = 100, width_ = 30;
    }

    /// The best patterns of up to `most` fetches that grow from each other.
    std::map<int, FetchPattern> grow(int most) {
        std::map<int, std::vector<FetchPattern>> best{{0, {{}}}};
        std::map<int, FetchPattern> result;
        for (int count = 1; count <= most; ++count) {
            std::vector<FetchPattern> found = refine(weighed(offspring(best, count)), refined_);
            if (found.empty()) continue;
            found.resize(std::min(found.size(), width_));
            exchange(found.front());
            result[count] = found.front();
            best[count] = std::move(found);
        }
        return result;
    }

    /// The best pattern of n x n fetches; none if the grid is too small.
    std::vector<FetchPattern> square(int n) {
        std::vector<FetchPattern> patterns;
        const bool has_middle = lattice_.is_shrinking() && n % 2 == 1;
        choose_cells(lattice_.is_shrinking() ? n / 2 : n, 0, {}, [&](const std::vector<Reach>& reaches) {
            FetchPattern pattern{reaches, {}};
            const int middle = has_middle ? Ring::on_axis : 0;
            for (int x = middle; x < static_cast<int>(reaches.size()); ++x)
                for (int y = middle; y <= x; ++y) pattern.rings.push_back({x, y});
            if (may_read(pattern)) patterns.push_back(std::move(pattern));
        });
        std::vector<FetchPattern> found = refine(weighed(std::move(patterns)), refined_);
        found.resize(std::min<std::size_t>(found.size(), 1));
        return found;
    }

    /// Rings that cover all `weights` but those of 0: the one first that takes most of them with each fetch.
    FetchPattern fold(const PlacedWeights2D& weights) const {
        std::vector<double> left(grid_.size());
        for (int i = 0; i < grid_.count(); ++i)
            for (int j = 0; j <= i; ++j) left[grid_.index(i, j)] = weights.weights[place(weights.width, i, j)];
        FetchPattern pattern;
        for (;;) {
            const Candidate* best = nullptr;
            Cover most;
            for (const Candidate& c : candidates_)
                if (const Cover cover = cover_of(c, left); cover > most) best = &c, most = cover;
            if (!best) break;
            pattern = grown(pattern, *best);
            for (const std::size_t u : points_read(pattern, pattern.rings.back(), grid_, lattice_)) left[u] = 0;
        }
        optimize(pattern, grid_, goal_);
        return pattern;
    }

    FetchDesign design_of(FetchPattern pattern) const {
        weigh(pattern, grid_, goal_, true);
        if (pattern.weights.empty()) return {};
        Fetches fetches = fetches_of(pattern, lattice_);
        std::erase_if(fetches, [](const Fetch& f) { return std::abs(f.weight) < 1e-7; });
        const double error = band_error(whole_filter(fetches, goal_), goal_.factor).whole;
        return {std::move(fetches), error};
    }

private:
    static int points_of(const RateGoal& goal, const FetchOptions& options) {
        const bool is_odd = goal.factor % 2 == 1;
        if (goal.upsample) return options.taps == 0 ? 8 : options.taps;
        if (options.taps == 0) return goal.factor == 2 ? 12 : 4 * goal.factor + is_odd;
        return (options.taps + is_odd) / 2;
    }

    void keep_large(const FetchOptions& options) {
        const PlacedWeights2D kept = downsample_weights(options.taps, options.threshold, goal_).dropped;
        for (int i = 0; i < grid_.count(); ++i)
            for (int j = 0; j <= i; ++j) {
                kept_[grid_.index(i, j)] = kept.weights[place(kept.width, i, j)] != 0;
            }
    }

    /// Where the point (i, j) lies among the weights of a square, in its quarter right and below.
    static std::size_t place(int side, int i, int j) {
        return static_cast<std::size_t>((side / 2 + j) * side + side / 2 + i);
    }

    /// What of `left` a ring would take: how many weights per fetch, and their magnitude. None of different signs.
    using Cover = std::pair<double, double>;
    Cover cover_of(const Candidate& c, const std::vector<double>& left) const {
        const FetchPattern alone = grown({}, c);
        const std::vector<std::size_t> points = points_read(alone, alone.rings.front(), grid_, lattice_);
        double count = 0, sum = 0, magnitude = 0;
        for (const std::size_t u : std::set<std::size_t>(points.begin(), points.end())) {
            if (left[u] == 0) continue;
            count += grid_.images(u);
            sum += grid_.images(u) * left[u];
            magnitude += grid_.images(u) * std::abs(left[u]);
        }
        if (std::abs(sum) < magnitude * (1 - 1e-12)) return {};
        return {count / fetch_count(alone, lattice_), magnitude};
    }

    /// Does it read only points of the grid, and only such as are kept?
    bool may_read(const FetchPattern& pattern) const {
        for (const Ring& ring : pattern.rings) {
            for (const std::size_t u : points_read(pattern, ring, grid_, lattice_))
                if (u >= grid_.size() || !kept_[u]) return false;
        }
        return true;
    }

    void collect(FetchLayout layout) {
        const auto add = [&](const Candidate& c) {
            if (may_read(grown({}, c))) candidates_.push_back(c);
        };
        constexpr int axis = Ring::on_axis;
        if (lattice_.is_shrinking()) add({{axis, axis}});
        for (const int c : cells_) {
            add({{0, 0}, c, c});
            if (lattice_.is_shrinking()) add({{0, axis}, c, 0});
            for (const int d : cells_)
                if (layout == FetchLayout::free && d < c) add({{0, 1}, c, d});
        }
    }

    /// Is there no ring of that kind in those cells yet?
    bool may_add(const FetchPattern& pattern, const Candidate& c) const {
        const Key had = key_of(pattern), added = key_of(grown({}, c));
        const bool is_diagonal = c.kind.x == c.kind.y && c.kind.x != Ring::on_axis;
        if (is_cross_ && is_diagonal)
            for (const Ring& ring : pattern.rings)
                if (ring.x == ring.y && ring.x != Ring::on_axis) return false;
        return std::find(had.begin(), had.end(), added.front()) == had.end();
    }

    std::vector<FetchPattern> offspring(const std::map<int, std::vector<FetchPattern>>& best, int count) const {
        std::vector<FetchPattern> patterns;
        for (const Candidate& c : candidates_) {
            const FetchPattern alone = grown({}, c);
            const auto parents = best.find(count - fetch_count(alone, lattice_));
            if (parents == best.end()) continue;
            for (const FetchPattern& parent : parents->second)
                if (may_add(parent, c)) patterns.push_back(grown(parent, c));
        }
        spread_middle(best, count, patterns);
        return patterns;
    }

    /// One fetch on the output is also four around it: so that three more never do worse.
    void spread_middle(const std::map<int, std::vector<FetchPattern>>& best, int count,
                       std::vector<FetchPattern>& patterns) const {
        const auto parents = best.find(count - 3);
        if (!lattice_.is_shrinking() || parents == best.end()) return;
        const Candidate diagonal{{0, 0}, 0, 0};
        for (const FetchPattern& parent : parents->second)
            for (std::size_t k = 0; k < parent.rings.size(); ++k) {
                const FetchPattern rest = without(parent, k);
                if (parent.rings[k].x != Ring::on_axis || !may_add(rest, diagonal)) continue;
                patterns.push_back(grown(rest, diagonal));
                patterns.back().reaches.back().part = 0;
            }
    }

    std::vector<FetchPattern> weighed(std::vector<FetchPattern> patterns) const {
        for (FetchPattern& pattern : patterns) weigh(pattern, grid_, goal_, false);
        std::stable_sort(patterns.begin(), patterns.end(), is_better);
        return patterns;
    }

    /// The `count` first, optimised, the best first, each once.
    std::vector<FetchPattern> refine(std::vector<FetchPattern> patterns, std::size_t count) const {
        std::set<Key> seen;
        std::vector<FetchPattern> result;
        for (FetchPattern& pattern : patterns) {
            if (pattern.weights.empty() || result.size() == count) break;
            if (!seen.insert(key_of(pattern)).second) continue;
            optimize(pattern, grid_, goal_);
            result.push_back(std::move(pattern));
        }
        std::stable_sort(result.begin(), result.end(), is_better);
        return result;
    }

    /// Replaces rings by others of their size as long as that lowers the error.
    void exchange(FetchPattern& pattern) const {
        for (bool is_lower = true; is_lower;) {
            is_lower = false;
            for (std::size_t k = 0; k < pattern.rings.size(); ++k) {
                const FetchPattern rest = without(pattern, k);
                const int size = fetch_count(pattern.rings[k], lattice_);
                std::vector<FetchPattern> others;
                for (const Candidate& c : candidates_)
                    if (fetch_count(grown({}, c), lattice_) == size && may_add(rest, c))
                        others.push_back(grown(rest, c));
                std::vector<FetchPattern> found = refine(weighed(std::move(others)), refined_ / 10);
                if (found.empty() || found.front().error > pattern.error - 1e-9) continue;
                pattern = std::move(found.front());
                is_lower = true;
            }
        }
    }

    template <class Found>
    void choose_cells(int count, std::size_t from, std::vector<Reach> chosen, const Found& found) const {
        if (count == 0) return found(chosen);
        for (std::size_t i = from; i < cells_.size(); ++i) {
            std::vector<Reach> more = chosen;
            more.push_back({cells_[i], 0.5});
            choose_cells(count - 1, i + 1, std::move(more), found);
        }
    }

    RateGoal goal_;
    TexelLattice lattice_;
    SymmetricGrid grid_;
    std::vector<bool> kept_;  ///< which points may be read
    std::vector<int> cells_;
    std::vector<Candidate> candidates_;
    bool is_cross_ = false;
    std::size_t refined_ = 40, width_ = 12;  ///< how many patterns of a size are optimised, and then kept
};

}  // namespace

namespace {

void check_curve(const char* function, int most, const RateGoal& goal, const FetchOptions& options) {
    check_goal(function, goal);
    if (most < 1 || most > most_fetches) fail(function, ": ", most, " fetches; pass 1 to ", most_fetches);
    if (options.taps < 0 || options.taps > most_side)
        fail(function, ": taps = ", options.taps, "; pass 1 to ", most_side, ", or 0 for enough");
    if (options.taps > 0 && !goal.upsample && options.taps % 2 != goal.factor % 2)
        fail(function, ": ", options.taps, " taps are not symmetric about the output of a factor of ", goal.factor,
             "; pass ", options.taps + 1);
    if (!(options.threshold >= 0) || (options.threshold > 0 && options.taps == 0))
        fail(function, ": threshold = ", options.threshold,
             "; pass 0, or with taps what is the least weight that they keep, e.g. 0.02");
    if (goal.upsample && (options.layout == FetchLayout::cross || options.threshold > 0))
        fail(function, ": filters that enlarge have no ",
             options.threshold > 0 ? "threshold; pass 0" : "cross; pass free or square");
}

/// The error that the goal minimises.
double goal_error(const FetchDesign& design, const RateGoal& goal) {
    const BandError e = band_error(whole_filter(design.fetches, goal), goal.factor);
    const double share = 1.0 / goal.factor / goal.factor;
    return goal.pass_weight * share * e.pass + goal.stop_weight * (1 - share) * e.stop;
}

/// Is it worth more fetches than the last one has?
bool is_worth_it(const FetchDesign& design, const std::vector<FetchDesign>& curve, const RateGoal& goal) {
    constexpr double least_gain = 1e-4;
    if (design.fetches.empty()) return false;
    return curve.empty() || goal_error(design, goal) < (1 - least_gain) * goal_error(curve.back(), goal);
}

[[noreturn]] void fail_gain(const char* function, const RateGoal& goal) {
    fail(function, ": no filter of these fetches keeps below a gain of ", goal.max_gain.value_or(1),
         "; allow more gain or fetches");
}

}  // namespace

std::vector<FetchDesign> downsample_curve(int most, const RateGoal& goal, const FetchOptions& options) {
    check_curve("downsample_curve", most, goal, options);
    Search search(goal, options);
    std::vector<FetchPattern> patterns;
    if (options.layout == FetchLayout::square) {
        for (int n = 1; n * n <= most; ++n)
            for (FetchPattern& pattern : search.square(n)) patterns.push_back(std::move(pattern));
    } else {
        for (auto& [count, pattern] : search.grow(most)) patterns.push_back(std::move(pattern));
    }
    std::vector<FetchDesign> curve;
    for (const FetchPattern& pattern : patterns)
        if (FetchDesign design = search.design_of(pattern); is_worth_it(design, curve, goal))
            curve.push_back(std::move(design));
    if (curve.empty()) fail_gain("downsample_curve", goal);
    return curve;
}

void check_fetches(const char* function, int count, const RateGoal& goal, const FetchOptions& options) {
    check_curve(function, count, goal, options);
    const bool is_square = options.layout == FetchLayout::square;
    const int side = static_cast<int>(std::lround(std::sqrt(count)));
    if (is_square && side * side != count) fail(function, ": ", count, " fetches are no square; pass ", side * side);
    if (!is_square && !goal.upsample && count % 4 > 1)
        fail(function, ": ", count, " fetches; symmetric ones come in fours, with one more in the middle or not: pass ",
             count / 4 * 4 + 4);
}

FetchDesign downsample_fetches(int count, const RateGoal& goal, const FetchOptions& options) {
    check_fetches("downsample_fetches", count, goal, options);
    return downsample_curve(count, goal, options).back();
}

FetchDesign downsample_folded(int count, double threshold, const RateGoal& goal) {
    const SparseWeights weights = downsample_weights(count, threshold, goal);
    const Search search(goal, {.taps = count});
    FetchDesign design = search.design_of(search.fold(weights.optimized));
    if (design.fetches.empty()) fail_gain("downsample_folded", goal);
    return design;
}

}  // namespace bandlimit
