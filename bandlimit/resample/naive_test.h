// Resampling written from its definition, one output at a time, in double: what banks are compared with in tests.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/core/view.h"
#include "bandlimit/kernel/kernel.h"

namespace bandlimit {

/// What an output reads: one weight per source sample, and sum |w| of the taps before edges folded them together.
struct NaiveRow {
    std::vector<double> weights;
    double sum_abs = 0;
    int taps = 0;
};

/// The row of an output that lies `t` source samples right of sample 0, under a kernel widened by `stretch`.
inline NaiveRow naive_row(const Kernel& kernel, double t, double stretch, int inputs, Edge edge) {
    // Arguments that are meant to be integers, halves or the radius are made so: kernels may jump there.
    const auto snapped = [&](double x) {
        const double half = std::round(2 * x) / 2, end = std::copysign(kernel.radius, x);
        return std::abs(x - half) < 1e-11 ? half : std::abs(x - end) < 1e-11 ? end : x;
    };
    const auto weight = [&](int s) {
        const double x = snapped((s - t) / stretch);
        if (kernel.form == Kernel::Form::nearest) return snapped(s - t) > -0.5 && snapped(s - t) <= 0.5 ? 1.0 : 0.0;
        if (kernel.form == Kernel::Form::area && stretch > 1)
            return std::max(0.0, std::min(s + 0.5, t + stretch / 2) - std::max(s - 0.5, t - stretch / 2));
        return kernel.value(x);
    };
    const int reach = static_cast<int>(std::ceil((kernel.radius + 1) * stretch)) + 1;
    const int first = static_cast<int>(std::floor(t)) - reach, last = static_cast<int>(std::ceil(t)) + reach;
    double whole = 0, inside = 0;
    for (int s = first; s <= last; ++s) {
        whole += weight(s);
        if (s >= 0 && s < inputs) inside += weight(s);
    }
    NaiveRow row{std::vector<double>(static_cast<std::size_t>(inputs)), 0, 0};
    for (int s = first; s <= last; ++s) {
        const int at = s >= 0 && s < inputs ? s : resolve(s, inputs, edge);
        const double w = weight(s) / (edge == Edge::renormalize ? inside : whole);
        if (at < 0 || w == 0) continue;
        row.weights[static_cast<std::size_t>(at)] += w;
        row.sum_abs += std::abs(w);
        ++row.taps;
    }
    return row;
}

/// The row of output i of the resampling from src to dst.
inline NaiveRow naive_row(const Kernel& kernel, const Axis& src, const Axis& dst, int i, Edge edge) {
    const double step = ((dst.end - dst.begin) / dst.count) / ((src.end - src.begin) / src.count);
    const double t = (dst.begin - src.begin) * src.count / (src.end - src.begin) + (i + 0.5) * step - 0.5;
    return naive_row(kernel, t, std::max(1.0, std::abs(step)), src.count, edge);
}

/// The weighted sum of a row of samples, and of their magnitudes.
inline double dot(const NaiveRow& row, View<const float> src, int y, int c) {
    double sum = 0;
    for (int x = 0; x < src.width; ++x)
        sum += row.weights[static_cast<std::size_t>(x)] * static_cast<double>(src(x, y, c));
    return sum;
}

}  // namespace bandlimit
