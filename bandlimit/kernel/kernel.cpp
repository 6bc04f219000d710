#include "bandlimit/kernel/kernel.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"
#include "bandlimit/math/bessel.h"

namespace bandlimit {
namespace {

constexpr double window_radius = 1.65;

/// Shortest text that reads back as the same parameter in a kernel's name.
std::string number(double x) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

std::vector<double> integers_below(double radius) {
    std::vector<double> knots;
    for (double x = 1; x < radius; ++x) knots.push_back(x);
    return knots;
}

void check_lobes(const char* function, int lobes) {
    if (lobes < 1 || lobes > 1000) fail(function, ": lobes = ", lobes, "; pass 1 to 1000 (3 is the usual choice)");
}

void check_radius(const char* function, double radius) {
    if (!(radius >= 0.5 && radius <= 1000)) fail(function, ": radius = ", radius, "; pass 0.5 to 1000");
}

/// 1 within the radius, 0 beyond, 1/2 at it: the value at a jump is the mean of both sides.
double inside(double x, double radius) {
    x = std::abs(x);
    return x < radius ? 1 : x == radius ? 0.5 : 0;
}

}  // namespace

Kernel nearest() {
    return {"nearest", 0.5, [](double x) { return inside(x, 0.5); }, Kernel::Form::nearest, {}};
}

Kernel box() {
    return {"box", 0.5, [](double x) { return inside(x, 0.5); }, Kernel::Form::area, {}};
}

Kernel tent() {
    return {"tent", 1, [](double x) { return std::max(0.0, 1 - std::abs(x)); }, Kernel::Form::separable, {}};
}

Kernel quadratic_bspline() {
    const auto value = [](double x) {
        x = std::abs(x);
        if (x < 0.5) return 0.75 - x * x;
        if (x < 1.5) return 0.5 * (1.5 - x) * (1.5 - x);
        return 0.0;
    };
    return {"quadratic", 1.5, value, Kernel::Form::separable, {0.5}};
}

Kernel quadratic_interpolating() {
    const auto value = [](double x) {
        x = std::abs(x);
        if (x < 0.5) return 1 - 2 * x * x;
        if (x < 1.5) return (x - 1) * (x - 1.5);
        return 0.0;
    };
    return {"quadratic-interp", 1.5, value, Kernel::Form::separable, {0.5}};
}

Kernel cubic(double b, double c) {
    if (!(std::abs(b) <= 100 && std::abs(c) <= 100))
        fail("cubic: B = ", b, ", C = ", c,
             "; pass numbers of at most 100 (Mitchell 1/3 and 1/3, Catmull-Rom 0 and 0.5)");
    const auto value = [b, c](double x) {
        x = std::abs(x);
        if (x < 1) return (((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + 6 - 2 * b) / 6;
        // In the distance from the outer end, so that the value there, and with B = 0 that at 1, is exactly 0.
        const double u = 2 - x;
        if (x < 2) return u * u * ((b + 6 * c) * u - 6 * c) / 6;
        return 0.0;
    };
    return {"cubic:" + number(b) + ":" + number(c), 2, value, Kernel::Form::separable, {1}};
}

namespace {
Kernel renamed(Kernel kernel, std::string name) {
    kernel.name = std::move(name);
    return kernel;
}
}  // namespace

Kernel bspline() { return renamed(cubic(1, 0), "bspline"); }
Kernel catmull_rom() { return renamed(cubic(0, 0.5), "catmull-rom"); }
Kernel mitchell() { return renamed(cubic(1.0 / 3, 1.0 / 3), "mitchell"); }

Kernel magic_sharp_2013() {
    // J. Costella, "The Magic Kernel", johncostella.com/magic, 2021: m(x) behind the taps -1/4, 3/2, -1/4.
    const auto value = [](double x) {
        x = std::abs(x);
        if (x < 0.5) return 17 / 16.0 - 7 / 4.0 * x * x;
        if (x < 1.5) return (x - 1) * (x - 7 / 4.0);
        if (x < 2.5) return -(x - 2.5) * (x - 2.5) / 8;
        return 0.0;
    };
    return {"magic-sharp-2013", 2.5, value, Kernel::Form::separable, {0.5, 1.5}};
}

Kernel magic_sharp_2021() {
    // The same source, with more taps.
    const auto value = [](double x) {
        x = std::abs(x);
        if (x < 0.5) return 577 / 576.0 - 239 / 144.0 * x * x;
        if (x < 1.5) return 35 / 36.0 * (x - 1) * (x - 239 / 140.0);
        if (x < 2.5) return (x - 2) * (65 / 24.0 - x) / 6;
        if (x < 3.5) return (x - 3) * (x - 15 / 4.0) / 36;
        if (x < 4.5) return -(x - 4.5) * (x - 4.5) / 288;
        return 0.0;
    };
    return {"magic-sharp-2021", 4.5, value, Kernel::Form::separable, {0.5, 1.5, 2.5, 3.5}};
}

Kernel lanczos(int lobes) {
    check_lobes("lanczos", lobes);
    const auto value = [lobes](double x) { return std::abs(x) < lobes ? sinc(x) * sinc(x / lobes) : 0; };
    return {"lanczos" + std::to_string(lobes), double(lobes), value, Kernel::Form::separable, integers_below(lobes)};
}

Kernel truncated_sinc(double radius) {
    check_radius("sinc", radius);
    const auto value = [radius](double x) { return inside(x, radius) * sinc(x); };
    return {"sinc:" + number(radius), radius, value, Kernel::Form::separable, integers_below(radius)};
}

Kernel gaussian(double sigma) {
    if (!(sigma >= 0.1 && sigma <= 250)) fail("gaussian: sigma = ", sigma, "; pass 0.1 to 250 (in source pitches)");
    const double radius = 4 * sigma;
    const auto value = [sigma, radius](double x) { return inside(x, radius) * std::exp(-x * x / (2 * sigma * sigma)); };
    return {"gaussian:" + number(sigma), radius, value, Kernel::Form::separable, {2 * sigma}};
}

Kernel blackman_harris() {
    const auto value = [](double x) { return inside(x, window_radius) * std::exp(-2.29 * x * x); };
    return {"blackman-harris", window_radius, value, Kernel::Form::separable, {}};
}

Kernel blackman_harris_window() {
    // Harris 1978, "On the use of windows for harmonic analysis", table 1: minimum 4-term window, -92 dB.
    const auto value = [](double x) {
        const double t = std::abs(x) / window_radius;
        const auto cosine = [t](int n) { return sin_pi(n * t + 0.5); };
        return inside(x, window_radius) * (0.35875 + 0.48829 * cosine(1) + 0.14128 * cosine(2) + 0.01168 * cosine(3));
    };
    return {"blackman-harris-window", window_radius, value, Kernel::Form::separable, {}};
}

Kernel kaiser(double radius, double beta) {
    check_radius("kaiser", radius);
    if (!(beta >= 0 && beta <= 100)) fail("kaiser: beta = ", beta, "; pass 0 (no window) to 100 (4 to 10 are usual)");
    const auto value = [radius, beta, scale = 1 / bessel_i0(beta)](double x) {
        const double t = x / radius;
        return inside(x, radius) * sinc(x) * bessel_i0(beta * std::sqrt(std::max(0.0, 1 - t * t))) * scale;
    };
    return {"kaiser:" + number(radius) + ":" + number(beta), radius, value, Kernel::Form::separable,
            integers_below(radius)};
}

Kernel jinc_lanczos(int lobes) {
    check_lobes("jinc", lobes);
    const double radius = jinc_zero(lobes), scale = jinc_zero(1) / radius;
    const auto value = [radius, scale](double r) { return std::abs(r) < radius ? jinc(r) * jinc(r * scale) : 0; };
    return {"jinc" + std::to_string(lobes), radius, value, Kernel::Form::radial, integers_below(radius)};
}

Kernel jinc_lanczos_unscaled(int lobes) {
    check_lobes("jinc-unscaled", lobes);
    // 0 at the jump itself, as published: samples do lie there.
    const auto value = [lobes](double r) {
        return std::abs(r) < lobes ? std::numbers::pi * jinc(r) * jinc(r / lobes) : 0;
    };
    return {"jinc" + std::to_string(lobes) + "-unscaled", double(lobes), value, Kernel::Form::radial,
            integers_below(lobes)};
}

Kernel radial_lanczos(int lobes) {
    Kernel kernel = renamed(lanczos(lobes), "radial-lanczos" + std::to_string(lobes));
    kernel.form = Kernel::Form::radial;
    return kernel;
}

}  // namespace bandlimit
