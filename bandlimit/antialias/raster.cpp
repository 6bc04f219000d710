#include "bandlimit/antialias/raster.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/antialias/raster_pieces.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

constexpr double largest_length = 1e9;
constexpr double negligible_dent = 1e-6;  // pixels by which a corner may be off a convex outline

Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double length(Point a) { return std::hypot(a.x, a.y); }
double angle(Point a) { return std::atan2(a.y, a.x); }
Point left_of(Point direction) { return {-direction.y, direction.x}; }

void check_point(Point p) {
    if (!(std::abs(p.x) <= largest_length && std::abs(p.y) <= largest_length))
        fail("the point (", p.x, ", ", p.y, ") is out of range; pass coordinates within 1e9 pixels");
}

void check_points(const std::vector<Point>& points, std::size_t least, const char* kind) {
    if (points.size() < least) fail("a ", kind, " of ", points.size(), " points; pass at least ", least);
    for (const Point p : points) check_point(p);
}

void check_length(const char* name, double value) {
    if (!(value > 0 && value <= largest_length))
        fail("a ", name, " of ", value, "; pass one above 0 and up to 1e9 pixels");
}

/// The corners without repetitions, and where they were.
struct Corners {
    std::vector<Point> at;
    std::vector<std::size_t> index;
};

Corners distinct(const std::vector<Point>& points) {
    Corners corners;
    const auto same = [](Point a, Point b) { return a.x == b.x && a.y == b.y; };
    for (std::size_t i = 0; i < points.size(); ++i)
        if (corners.at.empty() || !same(points[i], corners.at.back()))
            corners.at.push_back(points[i]), corners.index.push_back(i);
    while (corners.at.size() > 1 && same(corners.at.front(), corners.at.back()))
        corners.at.pop_back(), corners.index.pop_back();
    return corners;
}

void check_convex(const std::vector<Point>& points) {
    const Corners corners = distinct(points);
    const std::size_t n = corners.at.size();
    double area = 0, turns = 0;
    const auto corner = [&](std::size_t i) { return corners.at[i % n]; };
    for (std::size_t i = 1; i + 1 < n; ++i) area += cross(corner(i) - corner(0), corner(i + 1) - corner(0));
    for (std::size_t i = 0; i < n && n > 2; ++i) {
        const Point in = corner(i + 1) - corner(i), out = corner(i + 2) - corner(i + 1);
        turns += std::atan2(cross(in, out), dot(in, out)) / (2 * pi);
        const double dent = -std::copysign(1.0, area) * cross(in, out) / std::max(length(in), length(out));
        if (dent > negligible_dent)
            fail("the polygon is not convex at its point ", corners.index[(i + 1) % n],
                 " (counted from 0); split it into convex ones, in one group");
    }
    if (n > 2 && area != 0 && std::abs(std::abs(turns) - 1) > 0.01)
        fail("the polygon goes around ", std::lround(std::abs(turns)), " times; pass an outline that does so once");
}

void check_geometry(const PointShape& s) { check_point(s.at); }
void check_geometry(const DiscShape& s) { check_point(s.center), check_length("radius", s.radius); }
void check_geometry(const LineShape& s) { check_point(s.from), check_point(s.to), check_length("width", s.width); }
void check_geometry(const PolylineShape& s) {
    check_points(s.points, 2, "polyline");
    check_length("width", s.width);
}
void check_geometry(const PolygonShape& s) {
    check_points(s.points, 3, "polygon");
    check_convex(s.points);
}

Piece disc_piece(Point center, double radius) {
    return {.kind = Piece::Kind::disc, .center = center, .radius = radius};
}

/// The part of a disc from the direction of `from` to that of `to`, which is reached by turning from x towards y.
Piece sector_piece(Point center, double radius, Point from, Point to) {
    const double begin = angle(from), end = angle(to);
    return {.kind = Piece::Kind::sector,
            .center = center,
            .radius = radius,
            .from = begin,
            .to = end < begin ? end + 2 * pi : end};
}

void add_polygon(std::vector<Point> corners, std::vector<Piece>& pieces) {
    std::vector<PieceEdge> edges = polygon_edges(std::move(corners));
    if (!edges.empty()) pieces.push_back({.kind = Piece::Kind::polygon, .edges = std::move(edges)});
}

/// What a bend does to the segments that meet there. Both end at the line that halves its angle, on its inner side; on
/// the outer side a sector lies between them.
struct Bend {
    double angle = 0;  ///< above 0 if it turns from x towards y: the inner side is the left one
    double cut = 0;    ///< what the inner sides of the segments lack
};

/// A line of some width through points, as pieces that do not overlap.
class Stroke {
public:
    Stroke(const std::vector<Point>& points, double width, bool closed)
        : half_(width / 2), at_(distinct_line(points, closed)), closed_(closed && at_.size() > 2) {
        segments_ = at_.size() - (closed_ ? 0 : 1);
        for (std::size_t i = 0; i < segments_; ++i) {
            const Point way = point(i + 1) - point(i);
            lengths_.push_back(length(way));
            directions_.push_back({way.x / lengths_[i], way.y / lengths_[i]});
        }
        for (std::size_t i = 0; i < at_.size(); ++i) bends_.push_back(bend_at(i));
    }

    void add_to(std::vector<Piece>& pieces, LineCap cap) const {
        if (segments_ == 0) {
            if (cap == LineCap::round) pieces.push_back(disc_piece(at_[0], half_));
            return;
        }
        for (std::size_t i = 0; i < segments_; ++i) add_segment(i, pieces);
        for (std::size_t i = 0; i < at_.size(); ++i) {
            if (bends_[i].angle == 0) continue;
            const Point in = left_of(before(i)), out = left_of(directions_[i]);
            pieces.push_back(bends_[i].angle > 0 ? sector_piece(at_[i], half_, -1 * in, -1 * out)
                                                 : sector_piece(at_[i], half_, out, in));
        }
        if (closed_ || cap == LineCap::butt) return;
        const Point first = left_of(directions_.front()), last = left_of(directions_.back());
        pieces.push_back(sector_piece(at_.front(), half_, first, -1 * first));
        pieces.push_back(sector_piece(at_.back(), half_, -1 * last, last));
    }

private:
    static std::vector<Point> distinct_line(const std::vector<Point>& points, bool closed) {
        std::vector<Point> at = distinct(points).at;
        // An open line may end where it begins.
        if (!closed && (points.back().x != at.back().x || points.back().y != at.back().y)) at.push_back(points.back());
        return at;
    }
    Point point(std::size_t i) const { return at_[i % at_.size()]; }
    Point before(std::size_t i) const { return directions_[(i + segments_ - 1) % segments_]; }
    bool bends_at(std::size_t i) const { return closed_ || (i > 0 && i + 1 < at_.size()); }

    Bend bend_at(std::size_t i) const {
        if (!bends_at(i)) return {};
        const double turn = std::atan2(cross(before(i), directions_[i]), dot(before(i), directions_[i]));
        if (std::abs(turn) < 1e-9) return {};
        // A segment gives at most half of itself to each of its ends, or all of it to the only one that bends.
        const auto room = [&](std::size_t segment) {
            const bool both = bends_at(segment) && bends_at((segment + 1) % at_.size());
            return lengths_[segment] * (both ? 0.5 : 1);
        };
        const double cut = half_ * std::tan(std::abs(turn) / 2);
        const bool fits = cut <= std::min(room((i + segments_ - 1) % segments_), room(i));
        return {turn, fits ? cut : 0};
    }

    void add_segment(std::size_t i, std::vector<Piece>& pieces) const {
        const Point a = point(i), b = point(i + 1), along = directions_[i], left = half_ * left_of(along);
        const Bend &first = bends_[i], &last = bends_[(i + 1) % at_.size()];
        const auto cut = [](const Bend& bend, bool is_left) { return (bend.angle > 0) == is_left ? bend.cut : 0; };
        std::vector<Point> corners{a - left + cut(first, false) * along, b - left - cut(last, false) * along};
        if (last.cut > 0) corners.push_back(b);
        corners.push_back(b + left - cut(last, true) * along);
        corners.push_back(a + left + cut(first, true) * along);
        if (first.cut > 0) corners.push_back(a);
        add_polygon(std::move(corners), pieces);
    }

    double half_;
    std::vector<Point> at_;
    bool closed_;
    std::size_t segments_ = 0;
    std::vector<double> lengths_;
    std::vector<Point> directions_;
    std::vector<Bend> bends_;
};

void add_pieces(const PointShape& s, std::vector<Piece>& pieces) {
    pieces.push_back({.kind = Piece::Kind::impulse, .center = s.at});
}
void add_pieces(const DiscShape& s, std::vector<Piece>& pieces) { pieces.push_back(disc_piece(s.center, s.radius)); }
void add_pieces(const LineShape& s, std::vector<Piece>& pieces) {
    Stroke({s.from, s.to}, s.width, false).add_to(pieces, s.cap);
}
void add_pieces(const PolylineShape& s, std::vector<Piece>& pieces) {
    Stroke(s.points, s.width, s.closed).add_to(pieces, s.cap);
}
void add_pieces(const PolygonShape& s, std::vector<Piece>& pieces) { add_polygon(s.points, pieces); }

struct PreparedShape {
    std::vector<Piece> pieces;
    std::array<float, 4> color;
    Cell bounds;
};

/// Shapes [first, last), drawn at once, and the y between which they are.
struct Layer {
    std::size_t first, last;
    double y0, y1;
};

/// Row `y` of `band` at x: (1 - A) what is there + A F, where `add` holds A F and, last, A.
void blend(View<float> band, int x, int y, const std::array<double, 4>& add) {
    for (int c = 0; c < band.channels; ++c) {
        float& value = band(x, y, c);
        value = static_cast<float>((1 - add[3]) * double(value) + add[static_cast<std::size_t>(c)]);
    }
}

void check_band(const char* function, View<float> band) {
    if (band.channels != 3 && band.channels != 4)
        fail(function, ": a picture of ", band.channels, " channels; pass one of 3, or of 4 with alpha");
}

}  // namespace

struct Rasterizer::Prepared {
    PieceRenderer renderer;
    std::vector<PreparedShape> shapes;
    std::vector<Layer> layers;

    void draw_rows(View<float> band, int first_row, int begin, int end) const;
    void add_row(const Layer& layer, double y, CoverageRow& row, std::vector<std::array<double, 4>>& sums,
                 View<float> band, int in_band) const;
    bool touches(const PreparedShape& shape, double y0, double y1) const {
        const double reach = renderer.filter().radius();
        return shape.bounds.y0 - reach < y1 && shape.bounds.y1 + reach > y0;
    }
};

void check(const RasterShape& shape) {
    std::visit([](const auto& geometry) { check_geometry(geometry); }, shape.geometry);
    for (const float c : shape.color)
        if (!(std::abs(c) <= 1e9f)) fail("a colour of ", c, "; pass finite values up to 1e9");
    if (!(shape.color[3] >= 0 && shape.color[3] <= 1)) fail("an alpha of ", shape.color[3], "; pass 0 to 1");
}

Rasterizer::Rasterizer(std::span<const RasterShape> shapes, const RasterFilter& filter) {
    auto prepared = std::make_shared<Prepared>(Prepared{PieceRenderer(filter), {}, {}});
    std::vector<Piece*> pieces;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        try {
            check(shapes[i]);
        } catch (const Error& e) {
            fail("shape ", i, " (counted from 0): ", e.what());
        }
        PreparedShape shape{{}, shapes[i].color, {largest_length, largest_length, -largest_length, -largest_length}};
        std::visit([&](const auto& geometry) { add_pieces(geometry, shape.pieces); }, shapes[i].geometry);
        for (const Piece& piece : shape.pieces) {
            const Cell bounds = bounds_of(piece);
            shape.bounds = {std::min(shape.bounds.x0, bounds.x0), std::min(shape.bounds.y0, bounds.y0),
                            std::max(shape.bounds.x1, bounds.x1), std::max(shape.bounds.y1, bounds.y1)};
        }
        const bool continues = i > 0 && shapes[i].group != 0 && shapes[i].group == shapes[i - 1].group;
        if (!continues) prepared->layers.push_back({i, i, shape.bounds.y0, shape.bounds.y1});
        Layer& layer = prepared->layers.back();
        layer = {layer.first, i + 1, std::min(layer.y0, shape.bounds.y0), std::max(layer.y1, shape.bounds.y1)};
        prepared->shapes.push_back(std::move(shape));
    }
    for (PreparedShape& shape : prepared->shapes)
        for (Piece& piece : shape.pieces) pieces.push_back(&piece);
    prepared->renderer.prepare(pieces);
    prepared_ = std::move(prepared);
}

/// Draws one layer over row `in_band` of the band, whose pixels have their centres at `y`.
void Rasterizer::Prepared::add_row(const Layer& layer, double y, CoverageRow& row,
                                   std::vector<std::array<double, 4>>& sums, View<float> band, int in_band) const {
    const bool is_positive = renderer.filter().is_positive(), is_group = layer.last - layer.first > 1;
    int begin = row.width(), end = 0;  // of what `sums` holds, in a group
    for (std::size_t i = layer.first; i < layer.last; ++i) {
        const PreparedShape& shape = shapes[i];
        if (!touches(shape, y, y)) continue;
        row.clear();
        for (const Piece& piece : shape.pieces) renderer.add(piece, y, row);
        const auto& color = shape.color;
        for (int x = row.begin(); x < row.end(); ++x) {
            const double coverage = is_positive ? std::clamp(row[x], 0.0, 1.0) : row[x];
            if (coverage == 0) continue;
            const double alpha = coverage * double(color[3]);
            const std::array<double, 4> part{alpha * double(color[0]), alpha * double(color[1]),
                                             alpha * double(color[2]), alpha};
            if (!is_group) {
                blend(band, x, in_band, part);
                continue;
            }
            for (std::size_t c = 0; c < 4; ++c) sums[static_cast<std::size_t>(x)][c] += part[c];
            begin = std::min(begin, x), end = std::max(end, x + 1);
        }
    }
    for (int x = begin; x < end; ++x) {
        std::array<double, 4>& sum = sums[static_cast<std::size_t>(x)];
        const double excess = is_positive ? std::max(1.0, sum[3]) : 1;
        for (double& value : sum) value /= excess;
        blend(band, x, in_band, sum);
        sum = {};
    }
}

void Rasterizer::Prepared::draw_rows(View<float> band, int first_row, int begin, int end) const {
    CoverageRow row(band.width);
    std::vector<std::array<double, 4>> sums(static_cast<std::size_t>(band.width));
    const double reach = renderer.filter().radius(), top = first_row + 0.5;
    const auto row_at = [&](double y) { return static_cast<int>(std::clamp(y - top, double(begin), double(end))); };
    for (const Layer& layer : layers)  // a row too many at either end
        for (int y = row_at(layer.y0 - reach); y < row_at(layer.y1 + reach + 1); ++y)
            add_row(layer, top + y, row, sums, band, y);
}

void Rasterizer::draw(View<float> band, int first_row, const Parallel& parallel) const {
    check_band("draw", band);
    parallel_for(band.height, 8, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        prepared_->draw_rows(band, first_row, static_cast<int>(begin), static_cast<int>(end));
    });
}

void draw(std::span<const RasterShape> shapes, const RasterFilter& filter, View<float> image,
          const Parallel& parallel) {
    Rasterizer(shapes, filter).draw(image, 0, parallel);
}

namespace {

/// The samples that the filter reads around a pixel's centre: those from `first` on, counted from the pixel's own
/// first, along each axis, and their weights, which sum to 1.
struct SampleWeights {
    int first = 0, count = 0;
    std::vector<float> weights;

    SampleWeights(const RasterFilter& filter, int samples) {
        if (!(samples >= 1 && samples <= 64 && samples * filter.radius() <= 1024))
            fail("draw_supersampled: ", samples, " samples with a filter of radius ", filter.radius(),
                 "; pass 1 to 64, and at most 1024 within the radius");
        first = static_cast<int>(std::ceil((0.5 - filter.radius()) * samples - 0.5));
        count = samples - 2 * first;
        const auto at = [&](int i) { return (first + i + 0.5) / samples - 0.5; };
        std::vector<double> exact;
        double sum = 0;
        for (int j = 0; j < count; ++j)
            for (int i = 0; i < count; ++i) exact.push_back(filter.value(at(i), at(j))), sum += exact.back();
        if (!(sum > 0.1 * samples * samples))
            fail("draw_supersampled: ", samples, " samples per axis miss the filter ", filter.name(), "; pass more");
        for (const double w : exact) weights.push_back(static_cast<float>(w / sum));
    }
};

/// A rectangle of samples: shapes drawn on a transparent ground, colour multiplied by alpha.
struct Samples {
    int x0, y0, width, height;  ///< in samples
    std::vector<std::array<float, 4>> values;

    void clear(int x0_, int y0_, int width_, int height_) {
        x0 = x0_, y0 = y0_, width = width_, height = height_;
        values.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {});
    }
    std::array<float, 4>* row(int y) {
        return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
};

void blend_sample(std::array<float, 4>& sample, const std::array<float, 4>& color, float alpha) {
    for (std::size_t c = 0; c < 3; ++c) sample[c] = (1 - alpha) * sample[c] + alpha * color[c];
    sample[3] = (1 - alpha) * sample[3] + alpha;
}

/// A point of the area of `samples` ones in one of them. A second one there takes the place of the first: blending with
/// an alpha above 1 once more would grow without limit.
void blend_impulse(std::array<float, 4>& sample, const std::array<float, 4>& color, float samples) {
    if (sample[3] <= 1) return blend_sample(sample, color, color[3] * samples);
    blend_sample(sample, {color[0] * samples, color[1] * samples, color[2] * samples}, color[3]);
    sample[3] += color[3] * (samples - 1);
}

/// Draws the points of `shape` that are at the samples; `per_pixel` samples make a pixel.
void draw_samples(const PreparedShape& shape, int per_pixel, Samples& samples) {
    std::vector<Interval> inside;
    for (int row = 0; row < samples.height; ++row) {
        const double y = (samples.y0 + row + 0.5) / per_pixel;
        if (y < shape.bounds.y0 - 1 || y > shape.bounds.y1 + 1) continue;
        inside.clear();
        for (const Piece& piece : shape.pieces) {
            if (const Interval chord = chord_of(piece, y); !chord.is_empty()) inside.push_back(chord);
            if (piece.kind != Piece::Kind::impulse) continue;
            const double x = std::floor(piece.center.x * per_pixel) - samples.x0;
            if (std::floor(piece.center.y * per_pixel) == samples.y0 + row && x >= 0 && x < samples.width)
                blend_impulse(samples.row(row)[static_cast<int>(x)], shape.color,
                              static_cast<float>(per_pixel * per_pixel));
        }
        std::sort(inside.begin(), inside.end(), [](Interval a, Interval b) { return a.begin < b.begin; });
        int done = 0;  // parts that overlap count once
        for (const Interval& chord : inside) {
            const auto sample = [&](double x) {
                return static_cast<int>(
                    std::clamp(std::ceil(x * per_pixel - 0.5) - samples.x0, 0.0, double(samples.width)));
            };
            const int end = sample(chord.end);
            for (int x = std::max(done, sample(chord.begin)); x < end; ++x)
                blend_sample(samples.row(row)[x], shape.color, shape.color[3]);
            done = std::max(done, end);
        }
    }
}

void filter_samples(Samples& samples, const SampleWeights& filter, int per_pixel, View<float> tile) {
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
            std::array<double, 4> sum{};
            const float* weight = filter.weights.data();
            for (int j = 0; j < filter.count; ++j) {
                const std::array<float, 4>* row = samples.row(y * per_pixel + j) + x * per_pixel;
                std::array<float, 4> of_row{};
                for (int i = 0; i < filter.count; ++i)
                    for (std::size_t c = 0; c < 4; ++c) of_row[c] += weight[i] * row[i][c];
                for (std::size_t c = 0; c < 4; ++c) sum[c] += double(of_row[c]);
                weight += filter.count;
            }
            blend(tile, x, y, sum);
        }
}

}  // namespace

void Rasterizer::draw_supersampled(View<float> band, int samples, int first_row, const Parallel& parallel) const {
    check_band("draw_supersampled", band);
    const SampleWeights weights(prepared_->renderer.filter(), samples);
    const int side = std::clamp(512 / samples, 4, 32), across = (band.width + side - 1) / side,
              down = (band.height + side - 1) / side;
    const double reach = prepared_->renderer.filter().radius();
    parallel_for(static_cast<std::ptrdiff_t>(across) * down, 1, parallel,
                 [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                     Samples drawn{};
                     for (std::ptrdiff_t i = begin; i < end; ++i) {
                         const int x = static_cast<int>(i % across) * side, y = static_cast<int>(i / across) * side;
                         const View<float> tile =
                             cropped(band, x, y, std::min(side, band.width - x), std::min(side, band.height - y));
                         const double left = x, top = first_row + y;
                         bool is_empty = true;
                         for (const PreparedShape& shape : prepared_->shapes) {
                             const Cell& b = shape.bounds;
                             if (b.x0 - reach > left + tile.width || b.x1 + reach < left ||
                                 b.y0 - reach > top + tile.height || b.y1 + reach < top)
                                 continue;
                             if (is_empty)
                                 drawn.clear(x * samples + weights.first, (first_row + y) * samples + weights.first,
                                             (tile.width - 1) * samples + weights.count,
                                             (tile.height - 1) * samples + weights.count);
                             is_empty = false;
                             draw_samples(shape, samples, drawn);
                         }
                         if (!is_empty) filter_samples(drawn, weights, samples, tile);
                     }
                 });
}

}  // namespace bandlimit
