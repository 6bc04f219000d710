// Signals made of straight lines and circles, with their exact coverage.
#include <algorithm>
#include <cmath>

#include "bandlimit/signal/check.h"
#include "bandlimit/signal/coverage.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

/// 0 before t = 0, 1 after it, the mean of both there.
double step(double t) { return t < 0 ? 0 : t > 0 ? 1 : 0.5; }

double overlap(double a0, double a1, double b0, double b1) {
    return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

/// The coordinate along `direction` of a line that passes the middle of the frame at a distance.
double line_position(const Frame& frame, const UnitVector& direction, double offset) {
    const Point at = middle(frame);
    return direction.along(at.x, at.y) + offset;
}

Signal cell_signal(const std::string& name, const Cell& bright) {
    const auto value = [bright](double x, double y) {
        return step(x - bright.x0) * step(bright.x1 - x) * step(y - bright.y0) * step(bright.y1 - y);
    };
    const auto mean = [bright](const Cell& cell) {
        return overlap(cell.x0, cell.x1, bright.x0, bright.x1) * overlap(cell.y0, cell.y1, bright.y0, bright.y1) /
               area(cell);
    };
    return {name, value, mean, {}};
}

}  // namespace

Signal with_range(const Signal& signal, double low, double high) {
    check_position("with_range", "low", low);
    check_position("with_range", "high", high);
    const double scale = high - low;
    Signal result;
    result.name = signal.name;
    result.value = [=, value = signal.value](double x, double y) { return low + scale * value(x, y); };
    if (signal.mean) result.mean = [=, mean = signal.mean](const Cell& cell) { return low + scale * mean(cell); };
    if (signal.product) {
        result.product = signal.product;
        result.product->offset = low + scale * signal.product->offset;
        result.product->x.value = [scale, x = signal.product->x.value](double at) { return scale * x(at); };
    }
    return result;
}

Signal constant(double value) {
    check_position("constant", "value", value);
    return {"constant", [value](double, double) { return value; }, [value](const Cell&) { return value; }, {}};
}

Signal step_edge(const Frame& frame, const StepEdgeOptions& options) {
    check_frame("step_edge", frame);
    check_angle("step_edge", options.angle);
    check_position("step_edge", "offset", options.offset);
    const UnitVector direction = direction_at(options.angle);
    const double edge = line_position(frame, direction, options.offset);
    const auto value = [=](double x, double y) { return step(direction.along(x, y) - edge); };
    return {"edge", value, [=](const Cell& cell) { return 1 - share_below(cell, direction, edge); }, {}};
}

Signal thin_line(const Frame& frame, const ThinLineOptions& options) {
    check_frame("thin_line", frame);
    check_angle("thin_line", options.angle);
    check_position("thin_line", "offset", options.offset);
    check_option("thin_line", "width", options.width, 1e-9, largest_position, "1e-9 to 4e9 pixels");
    const UnitVector direction = direction_at(options.angle);
    const double center = line_position(frame, direction, options.offset);
    const double begin = center - options.width / 2, end = center + options.width / 2;
    const auto value = [=](double x, double y) {
        const double t = direction.along(x, y);
        return step(t - begin) * step(end - t);
    };
    const auto mean = [=](const Cell& cell) {
        return share_below(cell, direction, end) - share_below(cell, direction, begin);
    };
    return {"line", value, mean, {}};
}

Signal checkerboard(const CheckerboardOptions& options) {
    check_length("checkerboard", "size", options.size);
    // As 0 or 1 on even and odd squares; the product of the two axes is taken of -1 and 1.
    const auto sign = [size = options.size](double x) {
        const double squares = x / size, whole = std::floor(squares);
        if (squares == whole) return 0.0;
        return std::fmod(whole, 2) == 0 ? 1.0 : -1.0;
    };
    const auto mean_sign = [period = 2 * options.size](double a, double b) {
        return 2 * (bright_length(b, period, 0.5) - bright_length(a, period, 0.5)) / (b - a) - 1;
    };
    const auto value = [sign](double x, double y) { return 0.5 + 0.5 * sign(x) * sign(y); };
    const auto mean = [mean_sign](const Cell& cell) {
        return 0.5 + 0.5 * mean_sign(cell.x0, cell.x1) * mean_sign(cell.y0, cell.y1);
    };
    return {"checker", value, mean, {}};
}

Signal rectangle(const Frame& frame, const RectangleOptions& options) {
    check_frame("rectangle", frame);
    const double w = frame.width, h = frame.height;
    const Cell cell = options.cell.value_or(Cell{w / 4, h / 4, w * 3 / 4, h * 3 / 4});
    for (const double side : {cell.x0, cell.y0, cell.x1, cell.y1}) check_position("rectangle", "cell", side);
    if (!(cell.x0 < cell.x1 && cell.y0 < cell.y1))
        fail("rectangle: cell from (", cell.x0, ", ", cell.y0, ") to (", cell.x1, ", ", cell.y1,
             "); x0 must be below x1 and y0 below y1");
    return cell_signal("box", cell);
}

Signal impulse(const Frame& frame, const ImpulseOptions& options) {
    check_frame("impulse", frame);
    const Point corner = options.corner.value_or(Point{std::floor(frame.width / 2), std::floor(frame.height / 2)});
    check_position("impulse", "corner.x", corner.x);
    check_position("impulse", "corner.y", corner.y);
    return cell_signal("impulse", {corner.x, corner.y, corner.x + 1, corner.y + 1});
}

Signal disc(const Frame& frame, const DiscOptions& options) {
    const Point center = center_of("disc", options.center, frame);
    const double radius = radius_of("disc", options.radius, std::min(frame.width, frame.height) / 4);
    const auto value = [=](double x, double y) { return step(radius - std::hypot(x - center.x, y - center.y)); };
    const auto mean = [=](const Cell& cell) {
        const Cell around_center{cell.x0 - center.x, cell.y0 - center.y, cell.x1 - center.x, cell.y1 - center.y};
        return disc_area(around_center, radius) / area(around_center);
    };
    return {"disc", value, mean, {}};
}

Signal ramp(const Frame& frame, const RampOptions& options) {
    check_frame("ramp", frame);
    check_angle("ramp", options.angle);
    const UnitVector direction = direction_at(options.angle);
    const auto [first, last] = extent_along({0, 0, frame.width, frame.height}, direction);
    const double length = options.length.value_or(last - first);
    check_length("ramp", "length", length);
    const double begin = (first + last) / 2 - length / 2, end = begin + length;
    const auto along = [=](double t) { return std::clamp((t - begin) / length, 0.0, 1.0); };
    const auto value = [=](double x, double y) { return along(direction.along(x, y)); };
    const auto mean = [=](const Cell& cell) {
        const auto [low, high] = extent_along(cell, direction);
        // Where it is one straight piece, the mean of a ramp is its value in the middle.
        if (high <= begin || low >= end || (low >= begin && high <= end)) return along((low + high) / 2);
        return mean_along(cell, direction, along, {begin, end});
    };
    return {"ramp", value, mean, {}};
}

}  // namespace bandlimit
