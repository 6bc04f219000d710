#include "bandlimit/sampling/pattern.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/kernel/name_parts.h"
#include "bandlimit/math/random.h"
#include "bandlimit/sampling/sequence.h"

namespace bandlimit {
namespace {

constexpr int most_points = 4096;

void check_count(std::string_view pattern, int count) {
    if (count < 1 || count > most_points) fail(pattern, ": ", count, " points; pass 1 to ", most_points);
}

/// The root of a count that must be a square.
int side_of(std::string_view pattern, int count) {
    check_count(pattern, count);
    const int side = static_cast<int>(std::lround(std::sqrt(count)));
    if (side * side != count)
        fail(pattern, ": ", count, " points are not a square of points; pass ", side * side, " or ",
             side * side < count ? (side + 1) * (side + 1) : std::max(1, (side - 1) * (side - 1)));
    return side;
}

/// `count` cells from border to border of a pixel.
Axis across_pixel(int count) { return {count, -0.5, 0.5}; }

SamplePattern named(std::string name, std::vector<Point> points) { return {std::move(name), std::move(points)}; }

/// "halton:16"
std::string with_parameters(std::string_view head, std::initializer_list<std::uint64_t> parameters) {
    std::string name(head);
    for (const std::uint64_t p : parameters) name += ":" + std::to_string(p);
    return name;
}

std::uint64_t number(int count) { return static_cast<std::uint64_t>(count); }

template <class Make>
std::vector<Point> made(int count, const Make& make) {
    std::vector<Point> points;
    points.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) points.push_back(make(i));
    return points;
}

Point random_point(Random& random) {
    const double x = random.uniform(-0.5, 0.5);
    return {x, random.uniform(-0.5, 0.5)};
}

struct Sixteenths {
    int x, y;
};
// D3D11_STANDARD_MULTISAMPLE_QUALITY_LEVELS
constexpr Sixteenths d3d2[]{{4, 4}, {-4, -4}};
constexpr Sixteenths d3d4[]{{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
constexpr Sixteenths d3d8[]{{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
constexpr Sixteenths d3d16[]{{1, 1},  {-1, -3}, {-3, 2},  {4, -1}, {-5, -2}, {2, 5},  {5, 3}, {3, -5},
                             {-2, 6}, {0, -7},  {-4, -6}, {-6, 4}, {-8, 0},  {7, -4}, {6, 7}, {-7, -8}};

std::span<const Sixteenths> d3d_positions(int count) {
    switch (count) {
        case 2: return d3d2;
        case 4: return d3d4;
        case 8: return d3d8;
        case 16: return d3d16;
        default: fail("d3d: ", count, " points; Direct3D has patterns of 2, 4, 8 and 16");
    }
}

/// The square of the distance between points of a pattern that repeats in every pixel.
double squared_distance(const Point& a, const Point& b) {
    const double x = std::abs(a.x - b.x), y = std::abs(a.y - b.y);
    const double across_x = std::min(x, 1 - x), across_y = std::min(y, 1 - y);
    return across_x * across_x + across_y * across_y;
}

double squared_distance(const Point& p, std::span<const Point> others) {
    double least = 2;
    for (const Point& q : others) least = std::min(least, squared_distance(p, q));
    return least;
}

/// Into [-1/2, 1/2).
double wrapped(double x) {
    const double inside = x - std::floor(x + 0.5);
    return inside < 0.5 ? inside : -0.5;
}

// ---- Names

/// What the parameters of a name are, and the pattern that they make.
struct Entry {
    PatternInfo info;
    std::size_t least_parameters, most_parameters;
    std::function<SamplePattern(std::span<const std::uint64_t>)> make;
};

int count_of(std::span<const std::uint64_t> p) { return static_cast<int>(std::min<std::uint64_t>(p[0], 1 << 30)); }

/// A pattern of a count alone.
template <class Make>
Entry plain(const PatternInfo& info, Make make) {
    return {info, 1, 1, [make](std::span<const std::uint64_t> p) { return make(count_of(p)); }};
}

/// One of a count and a seed, or first index.
template <class Make>
Entry seeded(const PatternInfo& info, Make make) {
    return {info, 1, 2, [make](std::span<const std::uint64_t> p) {
                return make(count_of(p), p.size() > 1 ? p[1] : std::uint64_t{1});
            }};
}

SamplePattern halton_from(int count, std::uint64_t first) {
    if (first > 0xffffffffu) fail("halton: first index ", first, "; pass 0 to 4294967295");
    return halton_pattern(count, static_cast<std::uint32_t>(first));
}

const std::vector<Entry>& entries() {
    static const std::vector<Entry> list{
        plain({"regular:N", "regular:4", "a grid; N is a square"}, regular_pattern),
        plain({"rotated:N", "rotated:4", "a grid turned by 45 degrees; N is a square"}, rotated_pattern),
        plain({"d3d:N", "d3d:4", "the standard pattern of Direct3D for 2, 4, 8 or 16 samples"}, d3d_pattern),
        seeded({"halton:N:FIRST", "halton:16", "Halton's sequence to bases 2 and 3, from index FIRST on (1)"},
               halton_from),
        plain({"r2:N", "r2:16", "Roberts's sequence of the plastic number"}, r2_pattern),
        seeded({"sobol:N:SEED", "sobol:16:1", "Sobol's sequence, Owen-scrambled; best for N a power of two"},
               sobol_pattern),
        seeded({"jittered:N:SEED", "jittered:16:1", "a random point in each cell of a grid; N is a square"},
               jittered_pattern),
        seeded({"random:N:SEED", "random:16:1", "independent random points: for comparison"}, random_pattern),
        seeded({"n-rooks:N:SEED", "n-rooks:8:1", "one point in each of N columns and N rows"}, n_rooks_pattern),
        seeded({"best-candidate:N:SEED", "best-candidate:16:1", "random points that keep apart: blue noise"},
               best_candidate_pattern),
        {{"quincunx", "quincunx", "the five of a die"}, 0, 0, [](auto) { return quincunx_pattern(); }},
        {{"checkerboard:N", "checkerboard", "the squares of one colour; N is 2 (if left out), 8, 18, ..."},
         0,
         1,
         [](std::span<const std::uint64_t> p) { return checkerboard_pattern(p.empty() ? 2 : count_of(p)); }},
    };
    return list;
}

std::string_view head_of(std::string_view name) { return name.substr(0, name.find(':')); }

std::string names() {
    std::string text;
    for (const PatternInfo& info : pattern_list()) text += (text.empty() ? "" : ", ") + std::string(info.name);
    return text;
}

std::uint64_t whole_number(std::string_view word, std::string_view name, std::string_view form) {
    const auto value = parse_number(word);
    if (!value || *value < 0 || *value != std::floor(*value) || *value > 0x1p53)
        fail("pattern \"", name, "\": \"", word, "\" is not a whole number; use ", form);
    return static_cast<std::uint64_t>(*value);
}

}  // namespace

SamplePattern regular_pattern(int count) {
    const Axis axis = across_pixel(side_of("regular", count));
    return named(with_parameters("regular", {number(count)}), made(count, [&](int i) {
                     return Point{axis.position(i % axis.count), axis.position(i / axis.count)};
                 }));
}

SamplePattern rotated_pattern(int count) {
    const Axis axis = across_pixel(side_of("rotated", count));
    return named(with_parameters("rotated", {number(count)}), made(count, [&](int i) {
                     const double x = axis.position(i % axis.count), y = axis.position(i / axis.count);
                     return Point{(x - y) * std::numbers::sqrt2 / 2, (x + y) * std::numbers::sqrt2 / 2};
                 }));
}

SamplePattern d3d_pattern(int count) {
    std::vector<Point> points;
    for (const Sixteenths& p : d3d_positions(count)) points.push_back({p.x / 16.0, p.y / 16.0});
    return named(with_parameters("d3d", {number(count)}), points);
}

SamplePattern halton_pattern(int count, std::uint32_t first) {
    check_count("halton", count);
    return named(with_parameters("halton", {number(count), first}),
                 made(count, [&](int i) { return halton_point(first + number(i)); }));
}

SamplePattern r2_pattern(int count) {
    check_count("r2", count);
    return named(with_parameters("r2", {number(count)}), made(count, [](int i) { return r2_point(number(i) + 1); }));
}

SamplePattern sobol_pattern(int count, std::uint64_t seed) {
    check_count("sobol", count);
    return named(with_parameters("sobol", {number(count), seed}),
                 made(count, [&](int i) { return sobol_point(static_cast<std::uint32_t>(i), seed); }));
}

SamplePattern jittered_pattern(int count, std::uint64_t seed) {
    const Axis axis = across_pixel(side_of("jittered", count));
    Random random(seed);
    return named(with_parameters("jittered", {number(count), seed}), made(count, [&](int i) {
                     const Point in_cell = random_point(random);
                     return Point{axis.position(i % axis.count + in_cell.x), axis.position(i / axis.count + in_cell.y)};
                 }));
}

SamplePattern random_pattern(int count, std::uint64_t seed) {
    check_count("random", count);
    Random random(seed);
    return named(with_parameters("random", {number(count), seed}),
                 made(count, [&](int) { return random_point(random); }));
}

SamplePattern n_rooks_pattern(int count, std::uint64_t seed) {
    check_count("n-rooks", count);
    std::vector<int> rows(static_cast<std::size_t>(count));
    std::iota(rows.begin(), rows.end(), 0);
    Random random(seed);
    for (int i = count - 1; i > 0; --i)  // Fisher and Yates; std::shuffle differs between libraries
        std::swap(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(random.integer(0, i))]);
    const Axis axis = across_pixel(count);
    return named(with_parameters("n-rooks", {number(count), seed}), made(count, [&](int i) {
                     return Point{axis.position(i), axis.position(rows[static_cast<std::size_t>(i)])};
                 }));
}

SamplePattern best_candidate_pattern(int count, std::uint64_t seed) {
    constexpr int most = 1024;  // a few seconds
    if (count < 1 || count > most) fail("best-candidate: ", count, " points; pass 1 to ", most);
    constexpr int candidates_per_point = 4;  // of those so far: in proportion to them, as Mitchell advises
    Random random(seed);
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) {
        Point best = random_point(random);
        double distance = squared_distance(best, points);
        for (int k = 1; k < candidates_per_point * i; ++k) {
            const Point candidate = random_point(random);
            const double other = squared_distance(candidate, points);
            if (other > distance) best = candidate, distance = other;
        }
        points.push_back(best);
    }
    return named(with_parameters("best-candidate", {number(count), seed}), points);
}

SamplePattern quincunx_pattern() {
    return named("quincunx", {{-0.25, -0.25}, {0.25, -0.25}, {0, 0}, {-0.25, 0.25}, {0.25, 0.25}});
}

SamplePattern checkerboard_pattern(int count) {
    check_count("checkerboard", count);
    const int half_side = static_cast<int>(std::lround(std::sqrt(count / 2.0)));
    if (2 * half_side * half_side != count)
        fail("checkerboard: ", count, " points do not fill half the squares of a board; pass 2, 8, 18, 32, ...");
    const Axis axis = across_pixel(2 * half_side);
    std::vector<Point> points;
    for (int y = 0; y < axis.count; ++y)
        for (int x = y % 2; x < axis.count; x += 2) points.push_back({axis.position(x), axis.position(y)});
    return named(count == 2 ? "checkerboard" : with_parameters("checkerboard", {number(count)}), points);
}

SamplePattern parse_pattern(std::string_view name) {
    const NameParts parts = split_name(name);
    const auto entry = std::find_if(entries().begin(), entries().end(),
                                    [&](const Entry& e) { return head_of(e.info.name) == parts.head; });
    if (entry == entries().end()) fail("pattern \"", name, "\" is unknown; use ", names());
    if (parts.parameters.size() < entry->least_parameters || parts.parameters.size() > entry->most_parameters)
        fail("pattern \"", name, "\": ", parts.parameters.size(), " parameters; write ", entry->info.name, ", e.g. ",
             entry->info.example);
    std::vector<std::uint64_t> parameters;
    for (const std::string_view word : parts.parameters)
        parameters.push_back(whole_number(word, name, entry->info.name));
    return entry->make(parameters);
}

SamplePattern with_count(const SamplePattern& pattern, int count) {
    const NameParts parts = split_name(pattern.name);
    std::string name = std::string(parts.head) + ":" + std::to_string(count);
    for (std::size_t i = 1; i < parts.parameters.size(); ++i) name += ":" + std::string(parts.parameters[i]);
    return parse_pattern(name);
}

SamplePattern wrapped(const SamplePattern& pattern, const Point& offset) {
    SamplePattern moved = pattern;
    for (Point& p : moved.points) p = {wrapped(p.x + offset.x), wrapped(p.y + offset.y)};
    return moved;
}

std::span<const PatternInfo> pattern_list() {
    static const std::vector<PatternInfo> list = [] {
        std::vector<PatternInfo> infos;
        for (const Entry& entry : entries()) infos.push_back(entry.info);
        return infos;
    }();
    return list;
}

}  // namespace bandlimit
