#include "bandlimit/resample/radial.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {
namespace {

constexpr double table_density = 4096;  // entries per unit: linear interpolation errs by f'' / (8 * 4096^2) < 1e-7

/// The integers within `radius` of `center`.
struct Span {
    int first, last;
    Span(double center, double radius)
        : first(static_cast<int>(std::ceil(center - radius))), last(static_cast<int>(std::floor(center + radius))) {}
    int count() const { return last - first + 1; }
};

}  // namespace

/// Weights around one output, relative to the source samples at its whole position.
struct RadialBank::Disc {
    Span x, y, near_x, near_y;
    std::vector<float> weights;
    float sum = 0;  ///< of the whole disc, in the order of row()
};

RadialBank::RadialBank(const Kernel& kernel, const Axis& src_x, const Axis& dst_x, const Axis& src_y, const Axis& dst_y,
                       Edge edge_x, Edge edge_y)
    : x_(src_x, dst_x),
      y_(src_y, dst_y),
      width_(src_x.count),
      height_(src_y.count),
      outputs_(dst_x.count),
      edge_x_(edge_x),
      edge_y_(edge_y),
      radius_(kernel.radius) {
    if (!is_radial(kernel))
        fail("RadialBank: ", kernel.name, " is separable; use make_bank, or a radial kernel such as jinc3");
    // The last entry lies at the radius, where a kernel may jump to 0, and holds what it jumps from.
    const double intervals = std::ceil(radius_ * table_density);
    density_ = intervals / radius_;
    for (double i = 0; i < intervals; ++i) table_.push_back(kernel.value(i / density_));
    table_.push_back(kernel.value(std::nextafter(radius_, 0.0)));
    at_radius_ = kernel.value(radius_);
}

double RadialBank::table_value(double distance) const {
    if (distance >= radius_) return distance == radius_ ? at_radius_ : 0;
    const double at = distance * density_;
    const std::size_t i = std::min(static_cast<std::size_t>(at), table_.size() - 2);
    return std::lerp(table_[i], table_[i + 1], at - static_cast<double>(i));
}

IndexRange RadialBank::rows_read(int first, int last) const {
    const double radius = radius_ * y_.stretch();
    int begin = 0, end = 0;
    for (const int i : {first, last - 1}) {  // positions are monotonic
        const Position at = y_(i);
        const Span span(at.fraction, radius);
        const int low = static_cast<int>(at.whole) + span.first, high = static_cast<int>(at.whole) + span.last + 1;
        begin = i == first ? low : std::min(begin, low);
        end = i == first ? high : std::max(end, high);
    }
    return {begin, end};
}

RadialBank::Disc RadialBank::disc_at(const Position& x, const Position& y) const {
    const double stretch_x = x_.stretch(), stretch_y = y_.stretch();
    constexpr double open = 1 - 1e-12;  // the nearest samples lie strictly within one pitch
    Disc disc{{x.fraction, radius_ * stretch_x},
              {y.fraction, radius_ * stretch_y},
              {x.fraction, stretch_x * open},
              {y.fraction, stretch_y * open},
              {},
              0};
    for (int j = disc.y.first; j <= disc.y.last; ++j)
        for (int i = disc.x.first; i <= disc.x.last; ++i) {
            const double w = table_value(std::hypot((i - x.fraction) / stretch_x, (j - y.fraction) / stretch_y));
            disc.weights.push_back(static_cast<float>(w));
            disc.sum += disc.weights.back();
        }
    return disc;
}

void RadialBank::row(int y, ConstLines rows, int channels, float antiring, float* out) const {
    const Position at_y = y_(y);
    std::map<std::int64_t, Disc> discs;  // one per distinct phase of x
    std::vector<float> low(static_cast<std::size_t>(channels)), high(low.size()), sums(low.size());
    for (int i = 0; i < outputs_; ++i, out += channels) {
        const Position at_x = x_(i);
        auto found = discs.find(at_x.phase);
        if (found == discs.end()) found = discs.emplace(at_x.phase, disc_at(at_x, at_y)).first;
        const Disc& disc = found->second;
        std::fill(sums.begin(), sums.end(), 0.0f);
        float read = 0;  // sum of the weights that are not dropped, rounded as the sum of ones is
        double magnitude = 0;
        bool has_near = false;
        const float* weight = disc.weights.data();
        for (int j = disc.y.first; j <= disc.y.last; ++j) {
            const float* const line = resolve(static_cast<int>(at_y.whole) + j, height_, edge_y_) < 0
                                          ? nullptr
                                          : rows[static_cast<int>(at_y.whole) + j];
            const bool near_row = j >= disc.near_y.first && j <= disc.near_y.last;
            for (int k = disc.x.first; k <= disc.x.last; ++k, ++weight) {
                const int source = resolve(static_cast<int>(at_x.whole) + k, width_, edge_x_);
                const bool is_dropped =
                    (source < 0 && edge_x_ == Edge::renormalize) || (!line && edge_y_ == Edge::renormalize);
                if (*weight == 0 || is_dropped) continue;
                read += *weight;
                magnitude += std::abs(*weight);
                if (source < 0 || !line) continue;
                const bool is_near = near_row && k >= disc.near_x.first && k <= disc.near_x.last;
                for (int c = 0; c < channels; ++c) {
                    const float value = line[static_cast<std::ptrdiff_t>(source) * channels + c];
                    const auto channel = static_cast<std::size_t>(c);
                    sums[channel] = std::fma(*weight, value, sums[channel]);
                    if (!is_near) continue;
                    low[channel] = has_near && low[channel] <= value ? low[channel] : value;
                    high[channel] = has_near && high[channel] >= value ? high[channel] : value;
                }
                has_near = has_near || is_near;
            }
        }
        const bool rescales = edge_x_ == Edge::renormalize || edge_y_ == Edge::renormalize;
        const auto divisor = static_cast<double>(rescales ? read : disc.sum);
        if (cancels(divisor, magnitude))
            fail("RadialBank: output (", i, ", ", y,
                 ") has no weight inside the source; use Edge::clamp, or axes that overlap");
        for (std::size_t c = 0; c < sums.size(); ++c) {
            const float value = static_cast<float>(static_cast<double>(sums[c]) / divisor);
            const bool limit = antiring > 0 && has_near;
            const float limited = limit ? (value < low[c] ? low[c] : high[c] < value ? high[c] : value) : value;
            out[c] = limited == value ? value : std::fma(antiring, limited, (1 - antiring) * value);
        }
    }
}

}  // namespace bandlimit
