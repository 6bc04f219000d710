// Exact means of simple shapes over cells.
// Stability: evolving.
#pragma once
#include <functional>
#include <vector>

#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// A unit vector.
struct UnitVector {
    double x = 1, y = 0;
    /// The coordinate of a point along this direction.
    double along(double px, double py) const { return x * px + y * py; }
};

/// The direction at `degrees` clockwise from the right; exact at multiples of 90, and equal in x and y at 45.
UnitVector direction_at(double degrees);

inline double area(const Cell& cell) { return (cell.x1 - cell.x0) * (cell.y1 - cell.y0); }
inline Point middle(const Cell& cell) { return {(cell.x0 + cell.x1) / 2, (cell.y0 + cell.y1) / 2}; }

/// The least and the largest coordinate along `direction` in `cell`.
struct Extent {
    double low = 0, high = 0;
};
Extent extent_along(const Cell& cell, const UnitVector& direction);

/// The share of `cell` whose coordinate along `direction` is below t.
///
/// error  about 1e-16, if t is exact
double share_below(const Cell& cell, const UnitVector& direction, double t);

/// The mean over `cell` of a function of the coordinate along `direction`.
///
/// `knots` lists, in any order, where f or a derivative of it jumps; between them it must be smooth.
/// `frequency` is the highest one of f, in cycles per pixel.
/// error  some 1e-15
double mean_along(const Cell& cell, const UnitVector& direction, const std::function<double(double)>& f,
                  std::vector<double> knots, double frequency = 0);

/// How many panels of quadrature() an interval with so many periods needs. Throws Error above a million.
int panels_for(double periods);

/// The area of `cell` that a disc around (0, 0) covers.
///
/// error  about 1e-16 times (radius + 1) times the sides of the cell
double disc_area(const Cell& cell, double radius);

/// The length of [0, x] that is bright if each period begins with a bright part of `duty` periods; x < 0 counts
/// negative.
double bright_length(double x, double period, double duty);

}  // namespace bandlimit
