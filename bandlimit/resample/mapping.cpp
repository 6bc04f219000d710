#include "bandlimit/resample/mapping.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr double position_limit = 1 << 30;  // so that indices fit an int with room for any radius

struct Ratio {
    std::int64_t p = 0, q = 0;
};

/// The relative error of the pitch of an axis, and the error of its begin in pitches, if both ends carry a few
/// roundings, as those of a part of another axis do.
double uncertainty(const Axis& axis) {
    constexpr double roundings = 16 * 0x1p-53;
    return roundings * (1 + (std::abs(axis.begin) + std::abs(axis.end)) / std::abs(axis.end - axis.begin));
}

/// The simplest fraction within the relative tolerance of r; q = 0 if there is none with modest numbers.
Ratio as_ratio(double r, double tolerance) {
    constexpr std::int64_t largest_q = 1 << 20, largest_p = 1 << 30;
    // Continued fraction: each convergent is the best approximation for its denominator.
    std::int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    double rest = r;
    while (std::abs(rest) < position_limit) {
        const double whole = std::floor(rest);
        const auto a = static_cast<std::int64_t>(whole);
        const std::int64_t p = a * p1 + p0, q = a * q1 + q0;
        if (q > largest_q || std::abs(p) > largest_p) return {};
        if (std::abs(static_cast<double>(p) / static_cast<double>(q) - r) <= tolerance * std::abs(r)) return {p, q};
        p0 = p1, q0 = q1, p1 = p, q1 = q;
        rest = 1 / (rest - whole);
    }
    return {};
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

void check(const Axis& src, const Axis& dst) {
    if (src.count < 1 || dst.count < 1)
        fail("make_bank: src.count = ", src.count, ", dst.count = ", dst.count, "; both must be at least 1");
    const double step = dst.pitch() / src.pitch();
    const double first = src.index(dst.position(0)), last = src.index(dst.position(dst.count - 1));
    if (!(std::isfinite(step) && step != 0 && std::abs(step) < position_limit && std::abs(first) < position_limit &&
          std::abs(last) < position_limit))
        fail("make_bank: intervals [", src.begin, ", ", src.end, "] and [", dst.begin, ", ", dst.end,
             "]; both must be finite and not empty, and lie together");
}

}  // namespace

Mapping::Mapping(const Axis& src, const Axis& dst) : src_(src), dst_(dst) {
    check(src, dst);
    step_ = dst.pitch() / src.pitch();
    const Ratio ratio = as_ratio(step_, uncertainty(src) + uncertainty(dst));
    p_ = ratio.p, q_ = ratio.q;
    if (q_ == 0) return;
    step_ = static_cast<double>(p_) / static_cast<double>(q_);
    // t(i) = s + (i + 1/2) p/q - 1/2 is a multiple of 1/(2q) but for the shift s of the intervals.
    units_ = 2 * q_;
    const double shift = (dst.begin - src.begin) / src.pitch() * static_cast<double>(units_);
    const double snapped = std::round(shift);
    const double cells = uncertainty(src) * src.count + uncertainty(dst) * dst.count * std::abs(step_);
    const bool exact = std::abs(shift - snapped) <= cells * static_cast<double>(units_);
    shift_ = static_cast<std::int64_t>(exact ? snapped : std::floor(shift));
    shift_fraction_ = exact ? 0 : shift - std::floor(shift);
}

double Mapping::span() const {
    if (q_ == 0) return std::max(1.0, std::abs(step_));
    return static_cast<double>(std::max(units_, 2 * std::abs(p_)));
}

Position Mapping::operator()(int output) const {
    if (q_ == 0) {
        const double t = src_.index(dst_.position(output)), whole = std::floor(t);
        return {static_cast<std::int64_t>(whole), t - whole, output, t - whole};
    }
    const std::int64_t at = (2 * std::int64_t{output} + 1) * p_ - q_ + shift_;
    const std::int64_t whole = floor_divide(at, units_), phase = at - whole * units_;
    const double offset = static_cast<double>(phase) + shift_fraction_;
    return {whole, offset / units(), phase, offset};
}

}  // namespace bandlimit
