#include "bandlimit/math/quadrature.h"

#include <array>
#include <cmath>
#include <numbers>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int points = 16;
struct Rule {
    std::array<double, points> node{}, weight{};
};

/// Nodes are the zeros of the Legendre polynomial, by Newton's method from Tricomi's estimate.
Rule legendre_rule() {
    Rule rule;
    for (int i = 0; i < points; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
        for (int step = 0; step < 6; ++step) {
            double previous = 1, value = x;
            for (int n = 2; n <= points; ++n) {
                const double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
                previous = value;
                value = next;
            }
            slope = points * (x * value - previous) / (x * x - 1);
            x -= value / slope;
        }
        rule.node[static_cast<std::size_t>(i)] = x;
        rule.weight[static_cast<std::size_t>(i)] = 2 / ((1 - x * x) * slope * slope);
    }
    return rule;
}

/// Visits the points of all panels with their weights.
template <class Visit>
void for_each_point(const char* function, double a, double b, int panels, Visit visit) {
    if (panels < 1) fail(function, ": panels = ", panels, "; pass 1 or more");
    static const Rule rule = legendre_rule();
    const double half = (b - a) / panels / 2;
    for (int p = 0; p < panels; ++p) {
        const double middle = a + (2 * p + 1) * half;
        for (std::size_t i = 0; i < points; ++i) visit(middle + half * rule.node[i], half * rule.weight[i]);
    }
}

}  // namespace

Quadrature quadrature(double a, double b, int panels) {
    Quadrature result;
    for_each_point("quadrature", a, b, panels, [&](double x, double weight) {
        result.at.push_back(x);
        result.weights.push_back(weight);
    });
    return result;
}

double integrate(const std::function<double(double)>& f, double a, double b, int panels) {
    double sum = 0;
    for_each_point("integrate", a, b, panels, [&](double x, double weight) { sum += weight * f(x); });
    return sum;
}

}  // namespace bandlimit
