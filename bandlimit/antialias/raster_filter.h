// Filters that band-limit shapes before they are sampled, and how much of a filter simple shapes cover.
//
//     RasterFilter filter = raster_filter("cone:1");
//     double a = line_coverage(filter, 0.25, 1);  // .7032: a pixel a quarter of a pixel off a line of width 1
//
// A shape seen through a filter h of integral 1 is the convolution of its indicator function with h; its value at a
// pixel's centre p is the integral of h(q - p) over the shape: its coverage. We never integrate over the shape. Let V be
// a vector field with divergence h; by Gauss's theorem the integral of h over a shape is the flux of V through its
// outline, a sum over edges and arcs, each on its own. That is exact at corners, ends and thin shapes too.
//   radial     V(q) = q H(|q|) / (2 pi |q|^2), H(r) the integral of h over the disc of radius r. An edge at distance d
//              from p, from t0 to t1 along its line, gives F(d, t1) - F(d, t0): one table of two arguments for all edges
//   separable  V(x, y) = (K(x) k(y), 0), K the integral of k: the flux through an edge is an integral over its length,
//              by quadrature between the knots of k; through a whole line, a table of the distance for its direction
//
// Units: pixels; angles in radians from x towards y, which is down in pictures.
// Stability: evolving.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "bandlimit/kernel/kernel.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// A filter of two dimensions, scaled to an integral of 1: a value, cheap to copy.
///
/// error   coverage within 2e-6 for continuous kernels, for kernels that jump (box, sinc:R, jincN-unscaled) within 2e-5
/// memory  0.6 MB of tables if radial, 64 kB if separable
class RasterFilter {
public:
    /// A kernel as it is in two dimensions: separable (also box) or radial.
    /// throws  Error for nearest, for a radius above 64, and for kernels whose integral is not above 0
    explicit RasterFilter(const Kernel& kernel);

    const std::string& name() const;
    double radius() const;  ///< h is 0 beyond: from the centre if radial, else from it along each axis
    bool is_radial() const;
    /// Whether it is nowhere negative. Coverage then lies in [0, 1]; else it overshoots as the filter does.
    bool is_positive() const;
    bool is_continuous() const;  ///< whether the kernel ends at 0, and not by a jump
    double reach() const;        ///< from the centre in any direction: radius(), times sqrt(2) if separable

    double value(double x, double y) const;       ///< h
    double response(double fx, double fy) const;  ///< its transform at frequencies in cycles per pixel; 1 at 0

    /// How far h reaches along a unit vector.
    double reach_along(double nx, double ny) const;
    /// The coverage of a half plane: its outward normal is (nx, ny), a unit vector, its border `distance` away from the
    /// pixel's centre, which is inside where that is above 0.
    double half_plane(double distance, double nx, double ny) const;
    /// Whether that is a look-up or a formula; else it is an integral, worth a table where a direction is used often.
    bool has_quick_half_plane(double nx, double ny) const;

    /// The flux of V outward through the edge from a to b, relative to the pixel's centre, of a shape on its left (on
    /// its right on a screen, where y points down; both mean: x turns towards y within the shape).
    double edge_flux(Point a, Point b) const;
    /// The same for an edge `distance` away along its outward normal, which goes from t0 to t1 > t0 along its line. For
    /// radial filters.
    double edge_flux(double distance, double t0, double t1) const;
    /// The same through the arc around `center` from angle `from` to `to`, at most pi more; the shape is towards the
    /// centre.
    double arc_flux(Point center, double radius, double from, double to) const;

    /// The same through a whole circle, some of which is within reach.
    double circle_flux(Point center, double radius) const;

    struct Tables;

private:
    std::shared_ptr<const Tables> tables_;
};

/// The filter h(r) = 3 / (pi R^2) (1 - r / R) for r < R, 1/8 to 64 pixels: the usual one for points and lines.
RasterFilter cone_filter(double radius);
/// The Gaussian of this sigma, 1/40 to 12 pixels, radial, cut off at 5 sigma, where 4e-6 of it are left.
RasterFilter gaussian_filter(double sigma);

/// "cone:R", "gaussian:SIGMA", or a kernel as parse_kernel() reads it.
/// throws  Error as parse_kernel() and the functions above
RasterFilter raster_filter(std::string_view name);

/// The coverage of a half plane whose edge is `distance` pixels from the pixel's centre, at the angle `towards` of its
/// outward normal; above 0 if the centre is inside. It rises from 0 to 1.
double edge_coverage(const RasterFilter& filter, double distance, double towards = 0);
/// The coverage of an endless line, its axis `distance` away.
double line_coverage(const RasterFilter& filter, double distance, double width, double towards = 0);
/// The coverage of a disc whose centre is at `offset` from the pixel's centre.
double disc_coverage(const RasterFilter& filter, Point offset, double radius);
/// The transform of a filtered disc: that of the disc, R J1(2 pi f R) / f, times that of the filter. Through the tent
/// (whose transform is sinc^2 along each axis) or the quadratic B-spline (sinc^3) it is the almost band-limited disc.
double disc_spectrum(const RasterFilter& filter, double radius, double fx, double fy);

}  // namespace bandlimit
