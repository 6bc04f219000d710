// Points, discs, lines and polygons, band-limited before they are sampled.
//
//     std::vector<RasterShape> shapes{
//         {LineShape{{10, 10}, {90, 40}, 0.5}},
//         {DiscShape{{50, 50}, 20}, {1, 0.2f, 0, 1}},
//     };
//     Image<float> picture(100, 100, 4);
//     draw(shapes, raster_filter("cone:1"), picture.view());
//
// Shapes are drawn in the order of the list over what is there, by coverage: C' = (1 - A) C + A F, where A is the
// coverage of the pixel (raster_filter.h) times the alpha of the shape.
//
// That is right for one shape on a plain ground, and wrong where edges of several meet in a pixel: blending cannot know
// that two halves cover different halves. Two shapes that share an edge, both at half the coverage, leave 1/2 * 1/2 of
// the ground: a seam. Shapes of one group are blended at once instead, by the sum of their coverages: C' = (1 - sum A) C
// + sum A F. That is exact as long as they do not overlap. Where their coverages sum to more than 1 they are scaled to 1.
//
// Common to all
//   units      pixels; pixel (i, j) is centred at (i + 1/2, j + 1/2), y down
//   colour     linear light; views of three channels, or four where alpha is coverage and colour multiplied by it
//   range      coordinates, radii and widths up to 1e9 in magnitude; what is outside the picture costs little
//   exactness  the coverage of points, discs, lines and convex polygons is that of raster_filter.h, at corners and ends
//              as well. Polylines, which are sums of convex parts, are exact where they neither cross nor touch
//              themselves and no segment is shorter than what a bend cuts off; else coverage is added and limited to 1
// Stability: evolving.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "bandlimit/antialias/raster_filter.h"
#include "bandlimit/core/parallel.h"
#include "bandlimit/core/view.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// How lines end: straight where the line ends, or by half a disc around its end.
enum class LineCap { butt, round };

/// An area of one pixel in a point without extent: its picture is the filter itself, limited to 1.
struct PointShape {
    Point at;
};
struct DiscShape {
    Point center;
    double radius = 1;  ///< > 0
};
/// A straight line; with butt ends and no length it is nothing.
struct LineShape {
    Point from, to;
    double width = 1;  ///< > 0, may be far below a pixel
    LineCap cap = LineCap::butt;
};
/// A line through two or more points, round at its bends.
struct PolylineShape {
    std::vector<Point> points;
    double width = 1;
    LineCap cap = LineCap::butt;
    bool closed = false;  ///< also from the last point to the first, without ends
};
/// A convex polygon of three or more corners, in either order; nothing if they lie on a line.
struct PolygonShape {
    std::vector<Point> points;
};
using ShapeGeometry = std::variant<PointShape, DiscShape, LineShape, PolylineShape, PolygonShape>;

struct RasterShape {
    ShapeGeometry geometry;
    std::array<float, 4> color{1, 1, 1, 1};  ///< not multiplied by alpha, which is in [0, 1]
    int group = 0;  ///< neighbours in the list with the same number other than 0 are drawn together
};

/// Throws Error for what no shape can be: values that are not finite or out of range, too few points, and polygons that
/// are not convex, naming the corner.
void check(const RasterShape& shape);

/// Shapes that are ready to be drawn, band by band if need be. Copies share the shapes.
class Rasterizer {
public:
    /// memory   some 300 bytes per shape, and per point of polylines
    /// throws   Error as check(), naming the shape by its index
    Rasterizer(std::span<const RasterShape> shapes, const RasterFilter& filter);

    /// Draws over rows [first_row, first_row + band.height) of the picture. The result does not depend on how the
    /// picture is cut into bands.
    ///
    /// shapes   band of 3 or 4 channels
    /// cost     in proportion to the pixels that the filter touches
    /// throws   Error for another number of channels; Stopped
    void draw(View<float> band, int first_row = 0, const Parallel& parallel = {}) const;

    /// The truth to compare with: draws every one of samples x samples points per pixel as inside or outside, one shape
    /// over the other, and filters these. Overlap and shared edges are right at each point. A point without extent is
    /// the sample nearest to it, samples^2 times.
    ///
    /// error    of an edge about 1 / samples^1.5 times the largest value of the filter
    /// cost     (2 * samples * radius)^2 products per pixel near a shape
    /// memory   per thread 100 MB at most
    /// throws   as draw(); Error unless samples is 1 to 64, samples * filter.radius() at most 1024, and for so few
    ///          samples that the filter has none of them
    void draw_supersampled(View<float> band, int samples, int first_row = 0, const Parallel& parallel = {}) const;

    struct Prepared;

private:
    std::shared_ptr<const Prepared> prepared_;
};

/// Draws over a whole picture. Throws as Rasterizer.
void draw(std::span<const RasterShape> shapes, const RasterFilter& filter, View<float> image,
          const Parallel& parallel = {});

}  // namespace bandlimit
