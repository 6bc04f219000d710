#include "bandlimit/antialias/raster_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace bandlimit {
namespace {

using std::numbers::pi;

constexpr double nowhere = 4e9;  // beyond every shape
constexpr int lookup_cells = 128;
constexpr double pixels_worth_a_lookup = 2 * lookup_cells;
constexpr std::size_t most_lookups = 4096;

/// Half the chord of a circle at a distance from its centre; below 0 where there is none.
double half_chord(double radius, double distance) {
    const double square = (radius - distance) * (radius + distance);
    return radius > 0 && square > 0 ? std::sqrt(square) : -1;
}

Interval intersection(Interval a, Interval b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

/// Where slope * x < limit.
Interval below(double slope, double limit) {
    if (slope > 0) return {-nowhere, limit / slope};
    if (slope < 0) return {limit / slope, nowhere};
    return limit > 0 ? Interval{-nowhere, nowhere} : Interval{0, 0};
}

/// The pixels [first, last) of a row whose centres lie inside.
struct Pixels {
    int first, last;
    Pixels(Interval x, int width) {
        const auto pixel = [&](double at) {
            return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, double(width)));
        };
        first = pixel(x.begin);
        last = std::max(first, pixel(x.end));
    }
};

/// Calls `value` for each pixel of `outer` but those of `inner`, to which it adds 1.
template <class F>
void add_around(CoverageRow& row, Interval outer, Interval inner, const F& value) {
    if (outer.is_empty()) return;
    const Pixels all(outer, row.width());
    if (all.first == all.last) return;
    row.touch(all.first, all.last);
    Pixels full(intersection(inner, outer), row.width());
    if (full.first == full.last) full.first = full.last = all.last;
    for (int x = all.first; x < full.first; ++x) row[x] += value(x + 0.5);
    for (int x = full.first; x < full.last; ++x) row[x] += 1;
    for (int x = full.last; x < all.last; ++x) row[x] += value(x + 0.5);
}

/// A corner of a polygon of which a band of rows is left; its edge is that from here on, null along the border.
struct Corner {
    Point at;
    const PieceEdge* edge;
};

/// Keeps what lies on the side of y = `level` that `sign` points to.
void clip(std::vector<Corner>& corners, double level, double sign, std::vector<Corner>& spare) {
    spare.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Corner &here = corners[i], &next = corners[i + 1 < corners.size() ? i + 1 : 0];
        const double a = sign * (here.at.y - level), b = sign * (next.at.y - level);
        if (a >= 0) spare.push_back(here);
        if ((a >= 0) == (b >= 0)) continue;
        const double x = here.at.x + (next.at.x - here.at.x) * (a / (a - b));
        spare.push_back({{x, level}, a >= 0 ? nullptr : here.edge});
    }
    corners.swap(spare);
}

/// An edge as a row sees it: for the pixel at x the edge is c - nx x away along its normal, and goes from t0 - ux x to
/// t1 - ux x along its line.
struct RowEdge {
    Point begin, end;
    double nx, ny, c, t0, t1, reach;
    int lookup;
    bool is_border;
};

std::vector<RowEdge>& row_edges(const Piece& piece, double y, const RasterFilter& filter) {
    thread_local std::vector<Corner> corners, spare;
    thread_local std::vector<RowEdge> edges;
    corners.clear(), edges.clear();
    for (const PieceEdge& edge : piece.edges) corners.push_back({edge.begin, &edge});
    const double half = filter.reach() * (1 + 1e-9);  // borders are out of the filter's reach
    clip(corners, y - half, 1, spare);
    clip(corners, y + half, -1, spare);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i].at, b = corners[i + 1 < corners.size() ? i + 1 : 0].at;
        const PieceEdge* edge = corners[i].edge;
        const double nx = edge ? edge->nx : 0, ny = edge ? edge->ny : a.y < y ? -1 : 1;
        const auto along = [&](Point p) { return -ny * p.x + nx * (p.y - y); };
        edges.push_back({a, b, nx, ny, nx * a.x + ny * (a.y - y), along(a), along(b), filter.reach_along(nx, ny),
                         edge ? edge->lookup : -1, edge == nullptr});
    }
    return edges;
}

}  // namespace

std::vector<PieceEdge> polygon_edges(std::vector<Point> corners) {
    const auto same = [](Point a, Point b) { return a.x == b.x && a.y == b.y; };
    corners.erase(std::unique(corners.begin(), corners.end(), same), corners.end());
    while (corners.size() > 1 && same(corners.front(), corners.back())) corners.pop_back();
    if (corners.size() < 3) return {};
    double area = 0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area += (corners[i].x - corners[0].x) * (corners[i + 1].y - corners[0].y) -
                (corners[i].y - corners[0].y) * (corners[i + 1].x - corners[0].x);
    if (area == 0) return {};
    if (area < 0) std::reverse(corners.begin(), corners.end());
    std::vector<PieceEdge> edges;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % corners.size()];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        edges.push_back({a, (b.y - a.y) / length, -(b.x - a.x) / length, length});
    }
    return edges;
}

Cell bounds_of(const Piece& piece) {
    if (piece.kind != Piece::Kind::polygon) {
        const double r = piece.radius;
        return {piece.center.x - r, piece.center.y - r, piece.center.x + r, piece.center.y + r};
    }
    Cell bounds{nowhere, nowhere, -nowhere, -nowhere};
    for (const PieceEdge& edge : piece.edges) {
        bounds.x0 = std::min(bounds.x0, edge.begin.x), bounds.x1 = std::max(bounds.x1, edge.begin.x);
        bounds.y0 = std::min(bounds.y0, edge.begin.y), bounds.y1 = std::max(bounds.y1, edge.begin.y);
    }
    return bounds;
}

Interval chord_of(const Piece& piece, double y) {
    if (piece.kind == Piece::Kind::impulse) return {};
    if (piece.kind == Piece::Kind::polygon) {
        Interval chord{nowhere, -nowhere};
        for (std::size_t i = 0; i < piece.edges.size(); ++i) {
            const Point a = piece.edges[i].begin, b = piece.edges[(i + 1) % piece.edges.size()].begin;
            if ((a.y <= y) == (b.y <= y)) continue;
            // From the same end for both shapes beside an edge.
            const bool is_up = a.y < b.y;
            const Point low = is_up ? a : b, high = is_up ? b : a;
            const double x = low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
            chord = {std::min(chord.begin, x), std::max(chord.end, x)};
        }
        return chord;
    }
    const double dy = y - piece.center.y, half = half_chord(piece.radius, std::abs(dy));
    Interval chord{piece.center.x - half, piece.center.x + half};
    if (piece.kind == Piece::Kind::sector) {
        // Left of the first ray, and right of the last.
        const auto beside = [&](double angle, double sign) {
            const Interval x = below(sign * std::sin(angle), sign * std::cos(angle) * dy);
            return Interval{x.begin + piece.center.x, x.end + piece.center.x};
        };
        chord = intersection(chord, intersection(beside(piece.from, 1), beside(piece.to, -1)));
    }
    return chord;
}

void CoverageRow::touch(int begin, int end) {
    const auto zero = [&](int from, int to) {
        if (from < to) std::fill(values_.begin() + from, values_.begin() + to, 0.0);
    };
    if (begin_ == end_) {
        zero(begin, end);
        begin_ = begin, end_ = end;
        return;
    }
    zero(begin, begin_), zero(end_, end);
    begin_ = std::min(begin_, begin), end_ = std::max(end_, end);
}

void PieceRenderer::prepare(const std::vector<Piece*>& pieces) {
    if (filter_.is_radial()) prepare_discs(pieces);
    else if (filter_.is_continuous()) prepare_edges(pieces);
}

/// Seen through a radial filter, discs of a radius look the same from everywhere at a distance.
void PieceRenderer::prepare_discs(const std::vector<Piece*>& pieces) {
    std::map<double, double> rims;
    for (const Piece* piece : pieces)
        if (piece->kind == Piece::Kind::disc) rims[piece->radius] += 2 * pi * piece->radius * 2 * filter_.radius();
    std::map<double, int> lookups;
    for (const auto& rim : rims) {
        if (rim.second < pixels_worth_a_lookup || tables_.size() == most_lookups) continue;
        const double radius = rim.first;
        lookups[radius] = static_cast<int>(tables_.size());
        tables_.emplace_back(std::max(0.0, radius - filter_.radius()), radius + filter_.radius(), lookup_cells,
                             [&](double distance) {
                                 return disc_coverage(filter_, {distance, 0}, radius);
                             });
    }
    for (Piece* piece : pieces)
        if (const auto found = lookups.find(piece->radius); piece->kind == Piece::Kind::disc && found != lookups.end())
            piece->lookup = found->second;
}

/// Edges of one direction have one table of distances; mirrored and transposed ones share it.
void PieceRenderer::prepare_edges(const std::vector<Piece*>& pieces) {
    const auto direction = [](const PieceEdge& edge) {
        const double x = std::abs(edge.nx), y = std::abs(edge.ny);
        return std::pair(std::max(x, y), std::min(x, y));
    };
    std::map<std::pair<double, double>, double> lengths;
    for (const Piece* piece : pieces)
        for (const PieceEdge& edge : piece->edges) lengths[direction(edge)] += std::min(edge.length, 1e4);
    std::map<std::pair<double, double>, int> lookups;
    for (const auto& entry : lengths) {
        const auto [nx, ny] = entry.first;
        const double reach = filter_.reach_along(nx, ny), x = nx, y = ny;
        // Near an axis the half plane is little smoother than the kernel.
        const int cells = ny < nx / 16 ? 8 * lookup_cells : lookup_cells;
        if (filter_.has_quick_half_plane(x, y) || entry.second * 2 * reach < 2 * cells ||
            tables_.size() == most_lookups)
            continue;
        lookups[entry.first] = static_cast<int>(tables_.size());
        tables_.emplace_back(0, reach, cells, [&](double d) { return filter_.half_plane(d, x, y) - 0.5; });
    }
    for (Piece* piece : pieces)
        for (PieceEdge& edge : piece->edges)
            if (const auto found = lookups.find(direction(edge)); found != lookups.end()) edge.lookup = found->second;
}

void PieceRenderer::add(const Piece& piece, double y, CoverageRow& row) const {
    switch (piece.kind) {
        case Piece::Kind::polygon: return add_polygon(piece, y, row);
        case Piece::Kind::disc: return add_disc(piece, y, row);
        case Piece::Kind::sector: return add_sector(piece, y, row);
        case Piece::Kind::impulse: return add_impulse(piece, y, row);
    }
}

void PieceRenderer::add_polygon(const Piece& piece, double y, CoverageRow& row) const {
    const std::vector<RowEdge>& edges = row_edges(piece, y, filter_);
    if (edges.size() < 3) return;
    Interval outer{-nowhere, nowhere}, inner = outer, hull{nowhere, -nowhere};
    for (const RowEdge& edge : edges) {
        hull = {std::min(hull.begin, edge.begin.x), std::max(hull.end, edge.begin.x)};
        if (edge.is_border) continue;
        outer = intersection(outer, below(edge.nx, edge.c + edge.reach));
        inner = intersection(inner, below(edge.nx, edge.c - edge.reach));
    }
    outer = intersection(outer, {hull.begin - filter_.radius(), hull.end + filter_.radius()});

    const double reach_square = filter_.reach() * filter_.reach();
    const auto through_all = [&](double x) {
        double sum = 0;
        for (const RowEdge& e : edges) {
            if (filter_.is_radial()) {
                sum += filter_.edge_flux(e.c - e.nx * x, e.t0 + e.ny * x, e.t1 + e.ny * x);
            } else if (!e.is_border) {
                sum += filter_.edge_flux({e.begin.x - x, e.begin.y - y}, {e.end.x - x, e.end.y - y});
            }
        }
        return sum;
    };
    add_around(row, outer, inner, [&](double x) {
        // Where all edges within reach cross all of the filter, they cut off parts that do not overlap.
        double outside = 0;
        for (const RowEdge& e : edges) {
            const double d = e.c - e.nx * x;
            if (e.is_border || d >= e.reach) continue;
            const double t0 = e.t0 + e.ny * x, t1 = e.t1 + e.ny * x, rest = reach_square - d * d;
            if (t0 > 0 || t1 < 0 || t1 * t1 < rest) return through_all(x);  // t0 is the t1 of another one
            if (e.lookup >= 0) {
                const CubicTable& above_half = tables_[static_cast<std::size_t>(e.lookup)];
                outside += 0.5 - std::copysign(above_half(std::abs(d)), d);
            } else if (filter_.has_quick_half_plane(e.nx, e.ny)) {
                outside += filter_.half_plane(-d, e.nx, e.ny);
            } else {
                return through_all(x);
            }
        }
        return 1 - outside;
    });
}

void PieceRenderer::add_disc(const Piece& piece, double y, CoverageRow& row) const {
    const double dy = piece.center.y - y, reach = filter_.reach();
    const double wide = half_chord(piece.radius + reach, std::abs(dy)),
                 narrow = half_chord(piece.radius - reach, std::abs(dy));
    const auto around = [&](double half) { return Interval{piece.center.x - half, piece.center.x + half}; };
    add_around(row, around(wide), around(narrow), [&](double x) {
        const Point offset{piece.center.x - x, dy};
        if (piece.lookup < 0) return disc_coverage(filter_, offset, piece.radius);
        return tables_[static_cast<std::size_t>(piece.lookup)](std::hypot(offset.x, offset.y));
    });
}

void PieceRenderer::add_sector(const Piece& piece, double y, CoverageRow& row) const {
    const double dy = piece.center.y - y, r = piece.radius;
    const double half = half_chord(r + filter_.reach(), std::abs(dy));
    const Point begin{r * std::cos(piece.from), r * std::sin(piece.from)},
        end{r * std::cos(piece.to), r * std::sin(piece.to)};
    add_around(row, {piece.center.x - half, piece.center.x + half}, {}, [&](double x) {
        const Point c{piece.center.x - x, dy}, a{c.x + begin.x, c.y + begin.y}, b{c.x + end.x, c.y + end.y};
        return filter_.edge_flux(c, a) + filter_.arc_flux(c, r, piece.from, piece.to) + filter_.edge_flux(b, c);
    });
}

void PieceRenderer::add_impulse(const Piece& piece, double y, CoverageRow& row) const {
    const double r = filter_.radius();
    if (std::abs(piece.center.y - y) >= r) return;
    add_around(row, {piece.center.x - r, piece.center.x + r}, {},
               [&](double x) { return std::min(1.0, filter_.value(x - piece.center.x, y - piece.center.y)); });
}

}  // namespace bandlimit
