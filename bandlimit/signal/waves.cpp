// Signals that oscillate: zone plate, Siemens star, chirp; and stripes, whose smooth form is one wave.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bandlimit/math/quadrature.h"
#include "bandlimit/signal/check.h"
#include "bandlimit/signal/coverage.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

constexpr double pi = std::numbers::pi;

/// The part of a number of periods that matters, in [-1/2, 1/2]; exact.
double within_period(double periods) { return periods - std::nearbyint(periods); }

/// cos(2 pi periods) and exp(2 pi i periods).
double cosine(double periods) { return std::cos(2 * pi * within_period(periods)); }
std::complex<double> oscillation(double periods) {
    const double angle = 2 * pi * within_period(periods);
    return {std::cos(angle), std::sin(angle)};
}

std::complex<double> mean_of(const Wave& wave, double a, double b) {
    const Quadrature nodes = quadrature(a, b, panels_for((b - a) * std::max(wave.frequency(a), wave.frequency(b))));
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < nodes.at.size(); ++i) sum += nodes.weights[i] * wave.value(nodes.at[i]);
    return sum / (b - a);
}

/// A signal of the form of `product`: its mean over a cell is made of the means of the two waves.
Signal product_signal(const std::string& name, std::function<double(double, double)> value,
                      const WaveProduct& product) {
    const auto mean = [product](const Cell& cell) {
        return product.offset + (mean_of(product.x, cell.x0, cell.x1) * mean_of(product.y, cell.y0, cell.y1)).real();
    };
    return {name, std::move(value), mean, product};
}

/// How the phase of a chirp grows with the distance t from where it begins.
struct Sweep {
    double from, to, length;
    bool exponential;

    double frequency(double t) const {
        t = inside(t);
        return exponential ? from * std::pow(to / from, t / length) : from + (to - from) * t / length;
    }
    double periods(double t) const { return periods_inside(inside(t)) + (t - inside(t)) * frequency(t); }

private:
    /// A frame away from the frame the frequency stays: an exponential chirp soon leaves what numbers can hold.
    double inside(double t) const { return std::clamp(t, -length, 2 * length); }
    double periods_inside(double t) const {
        if (!exponential) return (from + (to - from) * t / length / 2) * t;
        const double growth = std::log(to / from);
        // expm1(g t) / g stays accurate as the two frequencies meet.
        return growth == 0 ? from * t : from * length * std::expm1(growth * t / length) / growth;
    }
};

Signal sinusoid(const UnitVector& direction, double frequency, double phase) {
    const auto wave = [](double f, double start, double scale) {
        return Wave{[f, start, scale](double x) { return scale * oscillation(f * x + start); },
                    [f](double) { return std::abs(f); }};
    };
    const auto value = [=](double x, double y) {
        return 0.5 + 0.5 * cosine(direction.along(x, y) * frequency + phase - 0.25);
    };
    // The sine is the cosine a quarter of a period later.
    return product_signal("stripes", value,
                          {0.5, wave(direction.x * frequency, phase - 0.25, 0.5), wave(direction.y * frequency, 0, 1)});
}

/// A wave along x or y alone.
WaveProduct plane_product(const UnitVector& direction, const Wave& wave) {
    const Wave one{[](double) { return 1.0; }, [](double) { return 0.0; }};
    return direction.y == 0 ? WaveProduct{0.5, wave, one} : WaveProduct{0.5, one, wave};
}

}  // namespace

Signal zone_plate(const Frame& frame, const ZonePlateOptions& options) {
    const Point center = center_of("zone_plate", options.center, frame);
    const double radius = radius_of("zone_plate", options.radius, std::max(frame.width, frame.height) / 2);
    check_option("zone_plate", "max_frequency", options.max_frequency, 1e-9, 1e3, "1e-9 to 1000 cycles per pixel");
    check_phase("zone_plate", options.phase);
    const double slope = options.max_frequency / radius;  // of the frequency, cycles per pixel and pixel
    const auto wave = [slope](double middle, double phase, double scale) {
        return Wave{[=](double x) { return scale * oscillation(slope / 2 * (x - middle) * (x - middle) + phase); },
                    [=](double x) { return slope * std::abs(x - middle); }};
    };
    const auto value = [slope, center, phase = options.phase](double x, double y) {
        const double dx = x - center.x, dy = y - center.y;
        return 0.5 + 0.5 * cosine(slope / 2 * (dx * dx + dy * dy) + phase);
    };
    return product_signal("zoneplate", value, {0.5, wave(center.x, options.phase, 0.5), wave(center.y, 0, 1)});
}

Signal siemens_star(const Frame& frame, const SiemensStarOptions& options) {
    const Point center = center_of("siemens_star", options.center, frame);
    const double radius = radius_of("siemens_star", options.radius, std::min(frame.width, frame.height) / 2);
    check_option("siemens_star", "spokes", options.spokes, 1, 1e6, "1 to 1000000 bright spokes");
    check_phase("siemens_star", options.phase);
    const auto value = [center, radius, spokes = options.spokes, phase = options.phase, sinusoid = options.sinusoid](
                           double x, double y) {
        const double dx = x - center.x, dy = y - center.y, r = std::hypot(dx, dy);
        if (r > radius || r == 0) return 0.5;
        const double periods = spokes * std::atan2(dy, dx) / (2 * pi) - phase;
        if (sinusoid) return 0.5 + 0.5 * cosine(periods);
        const double from_spoke = std::abs(within_period(periods));  // its middle is at 0, its border at 1/4
        return from_spoke < 0.25 ? 1.0 : from_spoke > 0.25 ? 0.0 : 0.5;
    };
    return {"siemens", value, nullptr, {}};
}

Signal chirp(const Frame& frame, const ChirpOptions& options) {
    check_frame("chirp", frame);
    const double least = options.exponential ? 1e-9 : 0;
    const char* const help = options.exponential ? "1e-9 to 1000 cycles per pixel" : "0 to 1000 cycles per pixel";
    check_option("chirp", "from", options.from, least, 1e3, help);
    check_option("chirp", "to", options.to, least, 1e3, help);
    check_angle("chirp", options.angle);
    check_phase("chirp", options.phase);
    const UnitVector direction = direction_at(options.angle);
    const double length = std::abs(direction.x) * frame.width + std::abs(direction.y) * frame.height;
    const Point at = middle(frame);
    const double begin = direction.along(at.x, at.y) - length / 2;
    const Sweep sweep{options.from, options.to, length, options.exponential};
    const auto periods = [sweep, begin, phase = options.phase](double t) { return sweep.periods(t - begin) + phase; };
    const auto along = [periods](double t) { return 0.5 + 0.5 * cosine(periods(t)); };

    const auto value = [direction, along](double x, double y) { return along(direction.along(x, y)); };
    if (direction.x == 0 || direction.y == 0) {
        const double sign = direction.x + direction.y;
        const Wave wave{[=](double x) { return 0.5 * oscillation(periods(sign * x)); },
                        [=](double x) { return std::abs(sweep.frequency(sign * x - begin)); }};
        return product_signal("chirp", value, plane_product(direction, wave));
    }
    const auto mean = [=](const Cell& cell) {
        const auto [low, high] = extent_along(cell, direction);
        const double highest =
            std::max(std::abs(sweep.frequency(low - begin)), std::abs(sweep.frequency(high - begin)));
        return mean_along(cell, direction, along, {}, highest);
    };
    return {"chirp", value, mean, {}};
}

Signal stripes(const StripesOptions& options) {
    check_length("stripes", "period", options.period);
    check_angle("stripes", options.angle);
    check_phase("stripes", options.phase);
    check_option("stripes", "duty", options.duty, 0, 1, "0 to 1");
    const UnitVector direction = direction_at(options.angle);
    if (options.sinusoid) return sinusoid(direction, 1 / options.period, options.phase);
    const auto value = [direction, o = options](double x, double y) {
        const double periods = direction.along(x, y) / o.period + o.phase, part = periods - std::floor(periods);
        if (o.duty == 0 || o.duty == 1) return o.duty;
        return part == 0 || part == o.duty ? 0.5 : part < o.duty ? 1.0 : 0.0;
    };
    const auto mean = [direction, o = options](const Cell& cell) {
        const auto [low, high] = extent_along(cell, direction);
        double share = 0;
        for (double stripe = std::floor(low / o.period + o.phase); (stripe - o.phase) * o.period < high; ++stripe)
            share += share_below(cell, direction, (stripe + o.duty - o.phase) * o.period) -
                     share_below(cell, direction, (stripe - o.phase) * o.period);
        return share;
    };
    return {"stripes", value, mean, {}};
}

}  // namespace bandlimit
