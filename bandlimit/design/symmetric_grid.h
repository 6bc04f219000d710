// Weights with the symmetries of a line or a square, fitted to the ideal low-pass of passband.h.
// Stability: inner.
#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bandlimit/design/downsample.h"

namespace bandlimit {

/// Throws Error, naming `function`, for a goal out of range.
void check_goal(const char* function, const RateGoal& goal);

/// Symmetric weights on a grid of points around the output: one number for all images of a point.
///
/// Points lie at origin + i along each axis and are mirrored; in the plane their coordinates are also swapped.
/// Distances are in samples of the finer of the two pictures. The unit of weights is that of a filter that shrinks: the
/// sum of all is 1.
class SymmetricGrid {
public:
    /// `dimensions` is 1 or 2; i goes from 0 to count - 1. `origin` is 1/2, or 0 where a sample lies on the output.
    SymmetricGrid(int dimensions, double origin, int count, const RateGoal& goal);

    std::size_t size() const { return images_.size(); }
    int count() const { return count_; }
    double origin() const { return origin_; }
    /// Which number the point (i, j) has, i and j >= 0 in any order; j = 0 on a line.
    std::size_t index(int i, int j) const;
    /// How many images the points of a number have: 1 to 8.
    double images(std::size_t u) const { return images_[u]; }

    /// The goal's weighted mean of |H - ideal|^2: w' Q w - 2 t' w + the ideal's own.
    double error(const std::vector<double>& weights) const;
    std::vector<double> times_form(const std::vector<double>& weights) const;  ///< Q w
    const std::vector<double>& target() const { return target_; }              ///< t

    /// What each number adds to H, which is real, at a frequency.
    std::vector<double> response_row(double fx, double fy) const;
    /// Where |H| is largest, and H there: among samples of the band, or between them too if `exact`.
    struct Peak {
        double fx = 0, fy = 0, value = 0;
    };
    Peak highest(const std::vector<double>& weights, bool exact) const;

private:
    /// Eight samples per wave of the farthest weight.
    double sample_pitch() const { return 0.125 / (count_ + 1); }
    Peak climbed(Peak peak, const std::vector<double>& weights) const;

    int dimensions_, count_;
    double origin_;
    std::vector<std::pair<int, int>> points_;  ///< i >= j of each number
    std::vector<double> images_, target_, form_;
    bool is_diagonal_;  ///< the form is images_ times a constant
    double constant_;
    std::vector<Peak> samples_;        ///< where highest() looks first; none without a limit on the gain
    std::vector<double> sample_rows_;  ///< what each number adds to them
};

/// One of the numbers that fit() finds: how much it adds to the weights, and what it may be.
struct Unknown {
    std::vector<double> column;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    double damping = 0;  ///< times its square is added to the error
};

struct GridFit {
    std::vector<double> values;                              ///< of the unknowns
    std::vector<double> weights;                             ///< sum of values times columns
    double error = std::numeric_limits<double>::infinity();  ///< the grid's, plus damping
};

/// A limit of |H|, at the frequencies where it was met so far. fit() adds to them.
struct GainLimit {
    double most = 1;
    bool exact = false;  ///< hold it everywhere, rather than at samples of the band
    std::vector<std::vector<double>> rows = {};
};

/// The unknowns for which the weights sum to 1 and have the least error plus damping; an infinite error if there are
/// none.
GridFit fit(const SymmetricGrid& grid, const std::vector<Unknown>& unknowns, GainLimit* limit);

}  // namespace bandlimit
