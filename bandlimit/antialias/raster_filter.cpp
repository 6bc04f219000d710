#include "bandlimit/antialias/raster_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bandlimit/antialias/cubic_table.h"
#include "bandlimit/core/error.h"
#include "bandlimit/kernel/name_parts.h"
#include "bandlimit/math/bessel.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/signal/coverage.h"

namespace bandlimit {
namespace {

using std::numbers::pi;

constexpr double largest_radius = 64;
constexpr int cells_1d = 2048, cells_2d = 256;

double square(double x) { return x * x; }

/// Gauss-Legendre quadrature with 8 points on each of `panels` equal parts: exact for products of the pieces of cubics
/// and their integrals, without the calls and the allocation of integrate().
template <class F>
double integral(double a, double b, const F& f, int panels = 1) {
    constexpr std::array at{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363},
        weights{0.3626837833783620, 0.3137066458778874, 0.2223810344533745, 0.1012285362903763};
    const double half = (b - a) / (2 * panels);
    double sum = 0;
    for (int p = 0; p < panels; ++p) {
        const double middle = a + (2 * p + 1) * half;
        for (std::size_t i = 0; i < at.size(); ++i)
            sum += weights[i] * (f(middle - half * at[i]) + f(middle + half * at[i]));
    }
    return sum * half;
}

/// Parameters in (low, high) at which a path meets something, with both ends; then in ascending order.
class Breaks {
public:
    Breaks(double low, double high) : low_(low), high_(high) { add_always(low), add_always(high); }
    void add(double t) {
        if (t > low_ && t < high_ && count_ < t_.size()) add_always(t);
    }
    /// Adds what of t + 2 pi n lies between the ends, which are at most 2 pi apart.
    void add_angle(double t) {
        t -= 2 * pi * std::ceil((t - low_) / (2 * pi) - 1);  // in (low, low + 2 pi]
        add(t);
    }
    template <class F>
    double sum_over_intervals(const F& f) {
        std::sort(t_.data(), t_.data() + count_);
        double sum = 0;
        for (std::size_t i = 0; i + 1 < count_; ++i)
            if (t_[i + 1] > t_[i]) sum += f(t_[i], t_[i + 1]);
        return sum;
    }

private:
    void add_always(double t) { t_[count_++] = t; }

    double low_, high_;
    std::array<double, 640> t_;  // a kernel of 64 lobes has 65 borders, each met 8 times by an arc
    std::size_t count_ = 0;
};

/// The signed angle from a to b as seen from the origin, over 2 pi.
double turns(Point a, Point b) { return std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y) / (2 * pi); }

}  // namespace

struct RasterFilter::Tables {
    std::string name;
    double radius = 0;
    bool is_radial = false, is_positive = true, is_continuous = true, is_box = false;
    std::vector<double> borders;  ///< of the smooth parts of the kernel, 0 and the radius among them, ascending
    CubicTable profile;           ///< h along a radius, or k, for arguments >= 0
    // Radial: the mean of h over the disc of radius r, the half plane less 1/2, and F for both arguments in [0, radius].
    CubicTable mean_within, above_half;
    std::vector<double> flux;
    // Separable: the integral of k from -radius on.
    CubicTable primitive;

    explicit Tables(const Kernel& kernel);

    double flux_near(double d, double t) const;
    double flux_to(double d, double t) const;
    double separable_edge(Point a, Point b) const;
    double radial_arc(Point c, double radius, double from, double to) const;
    double separable_arc(Point c, double radius, double from, double to) const;
    double radial_disc(double distance, double radius) const;

private:
    void make_radial(const std::vector<double>& sums);
};

RasterFilter::Tables::Tables(const Kernel& kernel)
    : name(kernel.name),
      radius(kernel.radius),
      is_radial(bandlimit::is_radial(kernel)),
      is_box(kernel.form == Kernel::Form::area) {
    if (kernel.form == Kernel::Form::nearest)
        fail("raster: the kernel ", name, " covers no area; choose box, or a smoother one");
    if (!(radius <= largest_radius))
        fail("raster: the filter ", name, " has a radius of ", radius, " pixels; choose one of at most ",
             largest_radius);
    borders = {0, radius};
    borders.insert(borders.end(), kernel.knots.begin(), kernel.knots.end());
    std::sort(borders.begin(), borders.end());

    const double edge = radius * (1 - 1e-12);  // values at a jump are means of both sides
    const auto value = [&](double x) { return kernel.value(std::min(x, edge)); };
    const auto density = [&](double r) { return value(r) * (is_radial ? 2 * pi * r : 2); };
    // Integrals from 0 to each entry of the table.
    std::vector<double> sums{0};
    double magnitude = 0;
    for (int i = 0; i < cells_1d; ++i) {
        const double a = radius * i / cells_1d, b = radius * (i + 1) / cells_1d;
        sums.push_back(sums.back() + integral(a, b, density));
        magnitude += std::abs(sums.back() - sums[sums.size() - 2]);
    }
    const double total = sums.back();
    if (!(total > 1e-3 * magnitude))
        fail("raster: the filter ", name, " has an integral of ", total, "; choose a kernel that keeps brightness");
    profile = CubicTable(0, radius, cells_1d, [&](double x) { return value(x) / total; });
    for (int i = 0; i <= cells_1d; ++i)
        is_positive = is_positive && value(radius * i / cells_1d) >= -1e-12 * std::abs(value(0));
    is_continuous = std::abs(value(radius)) <= 1e-3 * std::abs(value(0));
    for (double& sum : sums) sum /= total;
    if (is_radial) {
        make_radial(sums);
        return;
    }
    primitive = CubicTable(-radius, radius, 2 * cells_1d, [&](double x) {
        const double half = sums[static_cast<std::size_t>(std::lround(std::abs(x) / radius * cells_1d))] / 2;
        return x < 0 ? 0.5 - half : 0.5 + half;
    });
}

void RasterFilter::Tables::make_radial(const std::vector<double>& sums) {
    mean_within = CubicTable(0, radius, cells_1d, [&](double r) {
        return r == 0 ? profile(0) : sums[static_cast<std::size_t>(std::lround(r / radius * cells_1d))] / (pi * r * r);
    });
    const double step = radius / cells_2d;
    const auto density = [&](double d, double t) {
        const double square_distance = d * d + t * t;
        return square_distance < radius * radius ? d * mean_within(std::sqrt(square_distance)) / 2
                                                 : d / (2 * pi * square_distance);
    };
    // Three points of Gauss's rule are as exact as the cubics between the entries.
    const double outer = std::sqrt(0.15);
    for (int j = 0; j <= cells_2d; ++j) {
        double sum = 0;
        flux.push_back(sum);
        for (int i = 0; i < cells_2d; ++i) {
            const auto at = [&](double u) { return density(j * step, (i + 0.5 + u) * step); };
            sum += step / 18 * (5 * at(-outer) + 8 * at(0) + 5 * at(outer));
            flux.push_back(sum);
        }
    }
    above_half = CubicTable(0, radius, cells_1d, [&](double d) {
        const double chord = std::sqrt(std::max(0.0, radius * radius - d * d));
        const double within = integral(
            0, chord, [&](double t) { return density(d, t); }, 8);
        return d == 0 ? 0 : 2 * within + std::atan2(d, chord) / pi;
    });
}

/// F for 0 <= d, t <= radius.
double RasterFilter::Tables::flux_near(double d, double t) const {
    const double per_unit = cells_2d / radius;
    const CubicStencil row(d * per_unit, cells_2d), column(t * per_unit, cells_2d);
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
        const double* v = flux.data() + (row.first + j) * (cells_2d + 1) + column.first;
        sum += row.weights[static_cast<std::size_t>(j)] * (column.weights[0] * v[0] + column.weights[1] * v[1] +
                                                           column.weights[2] * v[2] + column.weights[3] * v[3]);
    }
    return sum;
}

/// F, which is odd in both arguments.
double RasterFilter::Tables::flux_to(double d, double t) const {
    const double x = std::abs(d), y = std::abs(t);
    double f;
    if (x >= radius) f = std::atan2(y, x) / (2 * pi);
    else if (y <= radius) f = flux_near(x, y);
    else  // from the table's end on, as seen from the pixel's centre
        f = flux_near(x, radius) + std::atan2(x * (y - radius), x * x + y * radius) / (2 * pi);
    return (d < 0) != (t < 0) ? -f : f;
}

double RasterFilter::Tables::separable_edge(Point a, Point b) const {
    const double dx = b.x - a.x, dy = b.y - a.y;
    if (std::max(a.y, b.y) <= -radius || std::min(a.y, b.y) >= radius || std::max(a.x, b.x) <= -radius) return 0;
    if (std::min(a.x, b.x) >= radius) return primitive(b.y) - primitive(a.y);
    Breaks breaks(0, 1);
    for (const double border : borders)
        for (const double at : {border, -border}) {
            if (dx != 0) breaks.add((at - a.x) / dx);
            if (dy != 0) breaks.add((at - a.y) / dy);
        }
    return breaks.sum_over_intervals([&](double from, double to) {
        const double middle = (from + to) / 2, x = a.x + dx * middle, y = a.y + dy * middle;
        if (std::abs(y) > radius || x < -radius) return 0.0;
        if (x > radius) return primitive(a.y + dy * to) - primitive(a.y + dy * from);
        return dy *
               integral(from, to, [&](double t) { return primitive(a.x + dx * t) * profile(std::abs(a.y + dy * t)); });
    });
}

double RasterFilter::Tables::radial_arc(Point c, double arc, double from, double to) const {
    const auto at = [&](double phi) { return Point{c.x + arc * std::cos(phi), c.y + arc * std::sin(phi)}; };
    const double distance = std::hypot(c.x, c.y), towards = std::atan2(-c.y, -c.x);  // of the nearest point
    Breaks breaks(from, to);
    breaks.add((from + to) / 2);  // so that no part is seen under pi or more
    breaks.add_angle(towards);    // profiles with a peak are not smooth there
    // |c + arc e(phi)| = radius, written so that large arcs do not cancel.
    const double half = (radius + distance - arc) * (radius - distance + arc) / (4 * distance * arc);
    if (half > 0 && half < 1) {  // sin^2 of half the angle between the nearest point and there
        const double angle = 2 * std::asin(std::sqrt(half));
        breaks.add_angle(towards + angle), breaks.add_angle(towards - angle);
    }
    return breaks.sum_over_intervals([&](double a, double b) {
        const Point middle = at((a + b) / 2);
        if (square(middle.x) + square(middle.y) >= radius * radius) return turns(at(a), at(b));
        return integral(
            a, b,
            [&](double phi) {
                const Point q = at(phi);
                const double outward = q.x * std::cos(phi) + q.y * std::sin(phi);
                return outward * mean_within(std::sqrt(square(q.x) + square(q.y))) / 2 * arc;
            },
            2);
    });
}

/// The flux through a whole circle: by symmetry twice that of a half, which begins at the nearest point.
double RasterFilter::Tables::radial_disc(double distance, double arc) const {
    const double gap = arc - distance;
    // At the angle psi from the nearest point, with s = sin^2(psi / 2): |q|^2 = gap^2 + 4 distance arc s.
    const double last = (radius - gap) * (radius + gap) / (4 * distance * arc);
    const double end = last >= 1 || distance == 0 ? pi : 2 * std::asin(std::sqrt(std::max(0.0, last)));
    const double near = integral(
        0, end,
        [&](double psi) {
            const double s = square(std::sin(psi / 2));
            return (gap + 2 * distance * s) * mean_within(std::sqrt(gap * gap + 4 * distance * arc * s)) / 2 * arc;
        },
        2);
    const double far = pi - std::atan2(arc * std::sin(end), gap - 2 * arc * square(std::sin(end / 2)));
    return 2 * near + (end < pi ? far / pi : 0);
}

double RasterFilter::Tables::separable_arc(Point c, double arc, double from, double to) const {
    Breaks breaks(from, to);
    for (const double border : borders)
        for (const double at : {border, -border}) {
            const double x = (at - c.x) / arc, y = (at - c.y) / arc;
            if (std::abs(x) < 1) breaks.add_angle(std::acos(x)), breaks.add_angle(-std::acos(x));
            if (std::abs(y) < 1) breaks.add_angle(std::asin(y)), breaks.add_angle(pi - std::asin(y));
        }
    const auto y_at = [&](double phi) { return c.y + arc * std::sin(phi); };
    return breaks.sum_over_intervals([&](double a, double b) {
        const double middle = (a + b) / 2, x = c.x + arc * std::cos(middle);
        if (std::abs(y_at(middle)) > radius || x < -radius) return 0.0;
        if (x > radius) return primitive(y_at(b)) - primitive(y_at(a));
        return integral(a, b, [&](double phi) {
            return primitive(c.x + arc * std::cos(phi)) * profile(std::abs(y_at(phi))) * arc * std::cos(phi);
        });
    });
}

RasterFilter::RasterFilter(const Kernel& kernel) : tables_(std::make_shared<Tables>(kernel)) {}

const std::string& RasterFilter::name() const { return tables_->name; }
double RasterFilter::radius() const { return tables_->radius; }
bool RasterFilter::is_radial() const { return tables_->is_radial; }
bool RasterFilter::is_positive() const { return tables_->is_positive; }
bool RasterFilter::is_continuous() const { return tables_->is_continuous; }
double RasterFilter::reach() const { return radius() * (is_radial() ? 1 : std::numbers::sqrt2); }

double RasterFilter::value(double x, double y) const {
    const auto profile = [&](double r) { return r < radius() ? tables_->profile(r) : 0; };
    return is_radial() ? profile(std::hypot(x, y)) : profile(std::abs(x)) * profile(std::abs(y));
}

double RasterFilter::response(double fx, double fy) const {
    const auto transform = [&](double f, auto weight) {
        double sum = 0;
        const std::vector<double>& borders = tables_->borders;
        for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
            const int panels = 1 + static_cast<int>(std::min(1e4, std::abs(f) * (borders[i + 1] - borders[i])));
            sum += integrate([&](double x) { return tables_->profile(x) * weight(f * x, x); }, borders[i],
                             borders[i + 1], panels);
        }
        return sum;
    };
    if (is_radial())
        return transform(std::hypot(fx, fy), [](double fr, double r) { return 2 * pi * r * bessel_j0(2 * pi * fr); });
    const auto cosine = [](double fx_, double) { return 2 * std::cos(2 * pi * fx_); };
    return transform(fx, cosine) * transform(fy, cosine);
}

double RasterFilter::reach_along(double nx, double ny) const {
    return is_radial() ? radius() : radius() * (std::abs(nx) + std::abs(ny));
}

double RasterFilter::half_plane(double distance, double nx, double ny) const {
    if (is_radial()) return 0.5 + std::copysign(tables_->above_half(std::abs(distance)), distance);
    // k is even and both axes have the same: the normal may point between the x axis and the diagonal.
    const double c = std::max(std::abs(nx), std::abs(ny)), s = std::min(std::abs(nx), std::abs(ny));
    if (s == 0) return tables_->primitive(distance);
    if (tables_->is_box) return share_below({-0.5, -0.5, 0.5, 0.5}, {c, s}, distance);
    const double length = 4 * radius() + std::abs(distance);
    return edge_flux({c * distance + s * length, s * distance - c * length},
                     {c * distance - s * length, s * distance + c * length});
}

bool RasterFilter::has_quick_half_plane(double nx, double ny) const {
    return is_radial() || tables_->is_box || nx == 0 || ny == 0;
}

double RasterFilter::edge_flux(Point a, Point b) const {
    if (!is_radial()) return tables_->separable_edge(a, b);
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length == 0) return 0;
    return edge_flux((a.x * dy - a.y * dx) / length, (a.x * dx + a.y * dy) / length, (b.x * dx + b.y * dy) / length);
}

double RasterFilter::edge_flux(double distance, double t0, double t1) const {
    return tables_->flux_to(distance, t1) - tables_->flux_to(distance, t0);
}

double RasterFilter::arc_flux(Point center, double arc, double from, double to) const {
    return is_radial() ? tables_->radial_arc(center, arc, from, to) : tables_->separable_arc(center, arc, from, to);
}

double RasterFilter::circle_flux(Point center, double circle) const {
    if (is_radial()) return tables_->radial_disc(std::hypot(center.x, center.y), circle);
    return arc_flux(center, circle, 0, pi) + arc_flux(center, circle, pi, 2 * pi);
}

RasterFilter cone_filter(double radius) {
    if (!(radius >= 0.125 && radius <= largest_radius))
        fail("cone:", radius, ": the radius is out of range; pass 0.125 to ", largest_radius, " pixels (1 is usual)");
    const auto value = [radius](double r) { return std::max(0.0, 1 - r / radius); };
    return RasterFilter({message("cone:", radius), radius, value, Kernel::Form::radial, {}});
}

RasterFilter gaussian_filter(double sigma) {
    if (!(sigma >= 0.025 && sigma <= 12))
        fail("gaussian:", sigma, ": sigma is out of range; pass 0.025 to 12 pixels (0.5 is usual)");
    const auto value = [sigma](double r) { return r > 5 * sigma ? 0 : std::exp(-square(r / sigma) / 2); };
    return RasterFilter({message("gaussian:", sigma), 5 * sigma, value, Kernel::Form::radial, {}});
}

RasterFilter raster_filter(std::string_view name) {
    const NameParts parts = split_name(name);
    const auto parameter = [&](std::string_view form) { return number_parameters(parts, "filter", 1, form)[0]; };
    if (parts.head == "cone") return cone_filter(parameter("cone:R, as cone:1"));
    if (parts.head == "gaussian") return gaussian_filter(parameter("gaussian:SIGMA, as gaussian:0.5"));
    return RasterFilter(parse_kernel(name));
}

double edge_coverage(const RasterFilter& filter, double distance, double towards) {
    return filter.half_plane(distance, std::cos(towards), std::sin(towards));
}

double line_coverage(const RasterFilter& filter, double distance, double width, double towards) {
    return edge_coverage(filter, distance + width / 2, towards) - edge_coverage(filter, distance - width / 2, towards);
}

double disc_coverage(const RasterFilter& filter, Point offset, double radius) {
    const double distance = std::hypot(offset.x, offset.y);
    if (distance >= radius + filter.reach()) return 0;
    if (distance <= radius - filter.reach()) return 1;
    return filter.circle_flux(offset, radius);
}

double disc_spectrum(const RasterFilter& filter, double radius, double fx, double fy) {
    // 2 J1(x) / x = 2 jinc(x / pi), the transform over its value at 0, which is the area.
    return pi * radius * radius * 2 * jinc(2 * radius * std::hypot(fx, fy)) * filter.response(fx, fy);
}

}  // namespace bandlimit
