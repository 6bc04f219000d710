#include "bandlimit/kernel/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/name_parts.h"

namespace bandlimit {
namespace {

constexpr int max_size = 4096;

/// What lies this close to a border lies on it, so that rounding does not make a symmetric shape lopsided.
constexpr double on_border = 1e-12;

using Plane = std::function<double(double x, double y)>;
using Parameters = std::span<const double>;

double inside(double distance_to_border) { return distance_to_border > on_border ? 1 : 0; }

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

/// `plane` turned by `degrees` from x towards y.
Plane turned(double degrees, const Plane& plane) {
    const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
    return [=](double x, double y) { return plane(c * x + s * y, c * y - s * x); };
}

Plane disc(Parameters p) {
    return [limit = p[0]](double x, double y) { return inside(limit - (x * x + y * y)); };
}

Plane box(Parameters p) {
    return [half = p[0]](double x, double y) { return inside(half - std::max(std::abs(x), std::abs(y))); };
}

Plane skewed_box(Parameters p) {
    return [half = p[0], shear = p[1]](double x, double y) {
        return inside(half - std::max(std::abs(x - shear * y), std::abs(y)));
    };
}

/// The angle of (x, y) within the sector about 0 of `count` equal ones.
double angle_in_sector(double x, double y, double count) {
    const double sector = 2 * std::numbers::pi / count, angle = std::atan2(y, x);
    return angle - sector * std::round(angle / sector);
}

Plane polygon(Parameters p) {
    return turned(p[2], [count = p[0], apothem = p[1]](double x, double y) {
        return inside(apothem - std::hypot(x, y) * std::cos(angle_in_sector(x, y, count)));
    });
}

/// Each half of a sector has one edge: from the tip at angle 0 to the notch at half a sector.
Plane star(Parameters p) {
    const double half = std::numbers::pi / p[0], tip = p[1];
    const double notch_x = p[2] * std::cos(half), notch_y = p[2] * std::sin(half);
    const double length = std::hypot(notch_x - tip, notch_y);
    return turned(p[3], [=, count = p[0]](double x, double y) {
        const double r = std::hypot(x, y), angle = std::abs(angle_in_sector(x, y, count));
        return inside(((tip - r * std::cos(angle)) * notch_y + (notch_x - tip) * r * std::sin(angle)) / length);
    });
}

Plane donut(Parameters p) {
    return [outer = p[0], inner = p[1]](double x, double y) {
        return inside(outer - (x * x + y * y)) - inside(inner - (x * x + y * y));
    };
}

Plane exponential(Parameters p) {
    return [rate = p[0]](double x, double y) { return std::exp(-rate * std::hypot(x, y)); };
}

Plane gaussian_of_rates(double rate_x, double rate_y) {
    return [=](double x, double y) { return std::exp(-(rate_x * x * x + rate_y * y * y)); };
}

Plane gaussian(Parameters p) { return gaussian_of_rates(p[0], p[0]); }

Plane oriented_gaussian(Parameters p) { return turned(p[2], gaussian_of_rates(p[0], p[1])); }

Plane difference_of_gaussians(Parameters p) {
    return [=, a = gaussian_of_rates(p[0], p[0]), b = gaussian_of_rates(p[1], p[1])](double x, double y) {
        return a(x, y) - b(x, y);
    };
}

struct Shape {
    ShapeInfo info;
    std::string_view allowed;  ///< per parameter after SIZE: '+' above 0, '~' any number, 'n' a whole number from 3 on
    Plane (*make)(Parameters);
    bool peak_is_one = false;  ///< divide by the largest magnitude on the grid
};

constexpr std::array shapes{
    Shape{{"disc:SIZE:LIMIT", "disc:50:0.8", "1 where x^2 + y^2 < LIMIT [circle]"}, "+", disc},
    Shape{{"box:SIZE:HALF", "box:50:0.7", "1 where |x| and |y| < HALF"}, "+", box},
    Shape{{"skewed-box:SIZE:HALF:SHEAR", "skewed-box:50:0.5:0.6", "1 where |x - SHEAR y| and |y| < HALF"},
          "+~",
          skewed_box},
    Shape{{"polygon:SIZE:N:APOTHEM:DEGREES", "polygon:50:8:0.9:0",
           "1 inside the regular N-gon whose edges are APOTHEM away; at 0 degrees one edge faces right"},
          "n+~",
          polygon},
    Shape{{"star:SIZE:N:OUTER:INNER:DEGREES", "star:50:5:0.95:0.4:-90",
           "1 inside the star of N tips at the radius OUTER, notches at INNER; at 0 degrees one tip points right"},
          "n++~",
          star},
    Shape{{"donut:SIZE:OUTER:INNER", "donut:50:0.8:0.3", "1 where INNER <= x^2 + y^2 < OUTER"}, "++", donut},
    Shape{{"exponential:SIZE:RATE", "exponential:50:3", "exp(-RATE r), r = sqrt(x^2 + y^2)"}, "+", exponential},
    Shape{{"gaussian:SIZE:RATE", "gaussian:50:5", "exp(-RATE r^2)"}, "+", gaussian},
    Shape{{"oriented-gaussian:SIZE:RATE:ACROSS:DEGREES", "oriented-gaussian:50:3:30:30",
           "exp(-RATE u^2 - ACROSS v^2), where u points along DEGREES"},
          "++~",
          oriented_gaussian},
    Shape{{"difference-of-gaussians:SIZE:A:B", "difference-of-gaussians:50:5:6",
           "exp(-A r^2) - exp(-B r^2), scaled to a peak of 1: a soft donut [dog]"},
          "++",
          difference_of_gaussians,
          true},
};

std::string_view word_of(const ShapeInfo& info) { return info.name.substr(0, info.name.find(':')); }

const Shape& find_shape(const NameParts& parts) {
    const std::string_view word = parts.head == "circle" ? "disc"
                                  : parts.head == "dog"  ? "difference-of-gaussians"
                                                         : parts.head;
    std::string names;
    for (const Shape& shape : shapes) {
        if (word_of(shape.info) == word) return shape;
        names += (names.empty() ? "" : ", ") + std::string(shape.info.name);
    }
    fail("shape \"", parts.whole, "\" is unknown; choose one of: ", names);
}

/// "disc:SIZE:LIMIT, as disc:50:0.8", or both without the size.
std::string form_of(const Shape& shape, bool sized) {
    const auto written = [&](std::string_view text) {
        std::string result(text);
        if (sized) return result;
        const std::size_t first = result.find(':'), second = result.find(':', first + 1);
        return result.erase(first, second - first);
    };
    return written(shape.info.name) + ", e.g. " + written(shape.info.example);
}

/// Throws Error unless the parameters after SIZE, `p`, are as `shape` allows.
void check_parameters(const Shape& shape, Parameters p, std::string_view whole) {
    const NameParts form = split_name(shape.info.name);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto wrong = [&](std::string_view advice) {
            fail("shape \"", whole, "\": ", form.parameters[i + 1], " = ", p[i], "; pass ", advice);
        };
        if (!std::isfinite(p[i])) wrong("a finite number");
        if (shape.allowed[i] == '+' && !(p[i] > 0)) wrong("a number above 0");
        if (shape.allowed[i] == 'n' && (p[i] < 3 || p[i] > 360 || p[i] != std::floor(p[i])))
            wrong("a whole number from 3 to 360");
    }
}

WeightGrid sampled(const Shape& shape, Parameters p, int size, std::string_view whole) {
    const Plane plane = shape.make(p);
    WeightGrid grid(size, size);
    // Exactly symmetric about 0.
    const auto at = [&](int i) { return static_cast<double>(2 * i - (size - 1)) / (size - 1); };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) grid.at(x, y) = plane(at(x), at(y));
    double peak = 0;
    for (const double w : grid.weights) peak = std::max(peak, std::abs(w));
    if (peak == 0) fail("shape \"", whole, "\": all of its ", size, " x ", size, " weights are 0; pass a larger shape");
    if (shape.peak_is_one)
        for (double& w : grid.weights) w /= peak;
    return grid;
}

void check_size(double size, std::string_view whole) {
    if (!(size >= 2 && size <= max_size && size == std::floor(size)))
        fail("shape \"", whole, "\": SIZE = ", size, "; pass a whole number from 2 to ", max_size);
}

}  // namespace

std::span<const ShapeInfo> shape_list() {
    static const auto infos = [] {
        std::array<ShapeInfo, shapes.size()> all;
        std::transform(shapes.begin(), shapes.end(), all.begin(), [](const Shape& shape) { return shape.info; });
        return all;
    }();
    return infos;
}

WeightGrid parse_shape(std::string_view text) {
    const NameParts parts = split_name(text);
    const Shape& shape = find_shape(parts);
    const std::vector<double> numbers =
        number_parameters(parts, "shape", shape.allowed.size() + 1, form_of(shape, true));
    check_size(numbers[0], text);
    const Parameters rest = Parameters(numbers).subspan(1);
    check_parameters(shape, rest, text);
    return sampled(shape, rest, static_cast<int>(numbers[0]), text);
}

WeightGrid parse_shape(std::string_view text, int size) {
    const NameParts parts = split_name(text);
    const Shape& shape = find_shape(parts);
    const std::vector<double> numbers = number_parameters(parts, "shape", shape.allowed.size(), form_of(shape, false));
    check_size(size, text);
    check_parameters(shape, numbers, text);
    return sampled(shape, numbers, size, text);
}

}  // namespace bandlimit
