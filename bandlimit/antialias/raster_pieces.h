// Convex pieces that shapes are made of, without overlap, and what a row of pixels sees of them.
// Stability: inner.
#pragma once
#include <optional>
#include <vector>

#include "bandlimit/antialias/cubic_table.h"
#include "bandlimit/antialias/raster_filter.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {

/// An edge of a polygon, from `begin` to that of the next one, its outward unit normal, and what lies behind: the
/// polygon turns from x towards y.
struct PieceEdge {
    Point begin;
    double nx = 0, ny = 0;
    double length = 0;
    int lookup = -1;
};

struct Piece {
    enum class Kind {
        polygon,
        disc,
        sector,  ///< of a disc, at most half of it
        impulse  ///< an area of 1 in one point
    };
    Kind kind = Kind::polygon;
    std::vector<PieceEdge> edges = {};  ///< of a polygon
    Point center = {};
    double radius = 0;
    double from = 0, to = 0;  ///< angles of a sector, `to` not before `from`
    int lookup = -1;          ///< of a disc
};

/// Edges of a convex polygon with these corners in either order; corners that repeat the one before are left out. None
/// if it has no area.
std::vector<PieceEdge> polygon_edges(std::vector<Point> corners);

/// The smallest rectangle with sides along the axes around a piece.
Cell bounds_of(const Piece& piece);

/// A part of a row.
struct Interval {
    double begin = 0, end = 0;
    bool is_empty() const { return !(begin < end); }
};
/// What of the line at `y` lies in a piece: empty for impulses.
Interval chord_of(const Piece& piece, double y);

/// The coverages of a row of pixels: valid in [begin, end), 0 elsewhere.
class CoverageRow {
public:
    explicit CoverageRow(int width) : values_(static_cast<std::size_t>(width)) {}
    int width() const { return static_cast<int>(values_.size()); }
    int begin() const { return begin_; }
    int end() const { return end_; }
    void clear() { begin_ = end_ = 0; }
    /// Makes [begin, end) valid, where `begin` < `end`.
    void touch(int begin, int end);
    double& operator[](int x) { return values_[static_cast<std::size_t>(x)]; }

private:
    std::vector<double> values_;
    int begin_ = 0, end_ = 0;
};

/// Adds the coverage of pieces to rows, with tables where that pays.
///
/// cost   of a row: a look-up per pixel where one or no edge is near, a sum over the near edges elsewhere; pixels inside
///        are filled, others are not looked at. A polygon costs a look at each of its edges in each row
class PieceRenderer {
public:
    explicit PieceRenderer(RasterFilter filter) : filter_(std::move(filter)) {}
    /// Makes the tables that drawing `pieces` is worth, and notes them there.
    void prepare(const std::vector<Piece*>& pieces);
    const RasterFilter& filter() const { return filter_; }
    /// Adds to the row of pixels whose centres are at `y`, those at i + 1/2.
    void add(const Piece& piece, double y, CoverageRow& row) const;

private:
    void prepare_discs(const std::vector<Piece*>& pieces);
    void prepare_edges(const std::vector<Piece*>& pieces);
    void add_polygon(const Piece& piece, double y, CoverageRow& row) const;
    void add_disc(const Piece& piece, double y, CoverageRow& row) const;
    void add_sector(const Piece& piece, double y, CoverageRow& row) const;
    void add_impulse(const Piece& piece, double y, CoverageRow& row) const;

    RasterFilter filter_;
    std::vector<CubicTable> tables_;
};

}  // namespace bandlimit
