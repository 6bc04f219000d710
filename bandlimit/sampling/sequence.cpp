#include "bandlimit/sampling/sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"

namespace bandlimit {
namespace {

/// From [0, 1) across the pixel to the distance from its centre.
Point from_centre(double x, double y) { return {x - 0.5, y - 0.5}; }

/// The bits of one dimension of Sobol's sequence.
std::uint32_t sobol_bits(std::uint32_t index, int dimension) {
    std::uint32_t bits = 0;
    // The columns of the generator matrix: those of the identity, or of Pascal's triangle modulo 2.
    for (std::uint32_t column = 1u << 31; index != 0; index >>= 1) {
        if ((index & 1) != 0) bits ^= column;
        column = dimension == 0 ? column >> 1 : column ^ (column >> 1);
    }
    return bits;
}

/// Owen's scrambling: at each bit the halves below it change places or not, as the bits above it decide.
std::uint32_t scrambled(std::uint32_t bits, std::uint64_t seed) {
    std::uint32_t result = 0;
    std::uint64_t node = 1;  // of the binary tree of intervals: a one, then the bits above
    for (int level = 31; level >= 0; --level) {
        const std::uint32_t bit = bits >> level & 1;
        result |= (bit ^ static_cast<std::uint32_t>(hash_of(seed, node) & 1)) << level;
        node = node * 2 + bit;
    }
    return result;
}

double sobol_coordinate(std::uint32_t index, std::uint64_t seed, int dimension) {
    const auto of_dimension = hash_of(seed, static_cast<std::uint64_t>(dimension));
    return (scrambled(sobol_bits(index, dimension), of_dimension) + 0.5) * 0x1p-32;
}

/// The largest divisor of n that is at most its root.
int near_root_divisor(int n) {
    int divisor = static_cast<int>(std::sqrt(n));
    while (n % divisor != 0) --divisor;
    return divisor;
}

/// `columns` x `rows` cells, whose points are sheared so that no two share a coordinate.
std::vector<Point> sheared_grid(int columns, int rows) {
    std::vector<Point> points;
    const Axis x{columns * rows, -0.5, 0.5}, y = x;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            points.push_back({x.position(i * rows + j), y.position(j * columns + columns - 1 - i)});
    return points;
}

/// Point i in column i and row i * step (modulo n).
std::vector<Point> lattice(int n, int step) {
    const Axis pixel{n, -0.5, 0.5};
    std::vector<Point> points;
    for (int i = 0; i < n; ++i) points.push_back({pixel.position(i), pixel.position(i * step % n)});
    return points;
}

/// The square of the least distance between points of a lattice, which repeats in every pixel, in cells.
std::int64_t least_distance(int n, int step) {
    std::int64_t least = static_cast<std::int64_t>(n) * n;
    for (int i = 1; i < n; ++i) {
        const std::int64_t x = std::min(i, n - i), row = static_cast<std::int64_t>(i) * step % n;
        const std::int64_t y = std::min(row, n - row);
        least = std::min(least, x * x + y * y);
    }
    return least;
}

/// The step from 1 to n - 1 without a common divisor with n for which points lie farthest apart.
int best_step(int n) {
    int best = 1;
    for (int step = 2; step <= n / 2; ++step)
        if (std::gcd(step, n) == 1 && least_distance(n, step) > least_distance(n, best)) best = step;
    return best;
}

/// `points` in an order whose neighbours lie far apart: by steps of about the golden section.
std::vector<Point> reordered(const std::vector<Point>& points) {
    const auto n = static_cast<std::int64_t>(points.size());
    std::int64_t step = std::max<std::int64_t>(1, std::llround(0.618 * static_cast<double>(n)));
    while (std::gcd(step, n) != 1) ++step;
    std::vector<Point> result;
    for (std::int64_t i = 0; i < n; ++i) result.push_back(points[static_cast<std::size_t>(i * step % n)]);
    return result;
}

std::vector<Point> rotated_grid(int length) {
    const int columns = near_root_divisor(length);
    const bool is_nearly_square = length <= 4 * columns * columns;
    std::vector<Point> points =
        is_nearly_square ? sheared_grid(columns, length / columns) : lattice(length, best_step(length));
    const auto is_zero = [](const Point& p) { return std::abs(p.x) < 1e-12 && std::abs(p.y) < 1e-12; };
    if (std::any_of(points.begin(), points.end(), is_zero))
        for (Point& p : points) p = {p.x + 0.25 / length, p.y + 0.25 / length};
    return reordered(points);
}

struct NamedJitter {
    JitterKind kind;
    std::string_view name;
};
constexpr std::array jitters{NamedJitter{JitterKind::halton, "halton"}, NamedJitter{JitterKind::r2, "r2"},
                             NamedJitter{JitterKind::rotated_grid, "rotated"}, NamedJitter{JitterKind::sobol, "sobol"}};

}  // namespace

double radical_inverse(int base, std::uint64_t index) {
    if (base < 2) fail("radical_inverse: base = ", base, "; pass 2 or more");
    // The mirrored digits as a whole number, divided once, are as near to the true value as a double can be.
    double mirrored = 0, scale = 1;
    for (const auto b = static_cast<std::uint64_t>(base); index != 0; index /= b) {
        mirrored = mirrored * base + static_cast<double>(index % b);
        scale *= base;
    }
    return mirrored / scale;
}

Point halton_point(std::uint64_t index) { return from_centre(radical_inverse(2, index), radical_inverse(3, index)); }

Point r2_point(std::uint64_t index) {
    constexpr double g = 1.32471795724474602596;
    const auto multiple = [index](double step) {
        const double t = 0.5 + static_cast<double>(index) * step;
        return t - std::floor(t);
    };
    return from_centre(multiple(1 / g), multiple(1 / (g * g)));
}

Point sobol_point(std::uint32_t index, std::uint64_t seed) {
    return from_centre(sobol_coordinate(index, seed, 0), sobol_coordinate(index, seed, 1));
}

JitterKind parse_jitter(std::string_view name) {
    for (const NamedJitter& jitter : jitters)
        if (jitter.name == name) return jitter.kind;
    fail("jitter \"", name, "\" is unknown; use halton, r2, rotated or sobol");
}

std::string_view name_of(JitterKind kind) {
    return std::find_if(jitters.begin(), jitters.end(), [kind](const NamedJitter& j) { return j.kind == kind; })->name;
}

int jitter_length(double scale) {
    if (!(scale > 0 && scale <= 16)) fail("jitter_length: scale = ", scale, "; pass up to 16, above 0");
    return std::max(1, static_cast<int>(std::lround(8 * scale * scale)));
}

std::vector<Point> jitter_sequence(JitterKind kind, int length) {
    if (length < 1 || length > 4096) fail("jitter_sequence: length = ", length, "; pass 1 to 4096");
    if (kind == JitterKind::rotated_grid) return rotated_grid(length);
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(length); ++i)
        points.push_back(kind == JitterKind::halton ? halton_point(i + 1)
                         : kind == JitterKind::r2   ? r2_point(i + 1)
                                                    : sobol_point(i, 1));
    return points;
}

}  // namespace bandlimit
