#include "bandlimit/texture/level_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bandlimit/resample/fetch_banks.h"

namespace bandlimit {
Fetches downsample8() {
    constexpr double inner = 0.75777, arm = 2.907, inner_weight = 0.37487566, arm_weight = -0.12487566;
    return {{-inner, -inner, inner_weight}, {inner, -inner, inner_weight}, {inner, inner, inner_weight},
            {-inner, inner, inner_weight},  {-arm, 0, arm_weight},         {arm, 0, arm_weight},
            {0, -arm, arm_weight},          {0, arm, arm_weight}};
}

RowFilter level_filter(const MipFilter& filter, const Grid& src, const Grid& dst, int channels, const LevelOptions& o) {
    if (const auto* fetches = std::get_if<Fetches>(&filter))
        return term_filter(bank_terms(*fetches, src, dst, o.edge_x, o.edge_y), o.premultiply);
    const auto* taps = std::get_if<Taps>(&filter);
    if (taps && (src.x.count == dst.x.count || src.y.count == dst.y.count))
        return term_filter(bank_terms(*taps, src, dst, o.edge_x, o.edge_y), o.premultiply);
    ResizeOptions options{.edge = o.edge_x, .edge_y = o.edge_y, .premultiply = o.premultiply};
    if (taps) options.reconstruction = *taps;
    if (const auto* kernel = std::get_if<Kernel>(&filter)) options.reconstruction = *kernel;
    return Resizer(src, dst, channels, options).rows();
}

int reach_of(const MipFilter& filter, double step) {
    double reach = 0;
    if (const auto* fetches = std::get_if<Fetches>(&filter)) {
        for (const Fetch& f : *fetches) reach = std::max({reach, std::abs(f.x), std::abs(f.y)});
        reach = reach * step / 2 + 1;
    } else if (const auto* taps = std::get_if<Taps>(&filter)) {
        reach = std::abs(taps->first) + static_cast<double>(taps->weights.size());
    } else {
        const auto* kernel = std::get_if<Kernel>(&filter);
        reach = (kernel ? kernel->radius : shrink3().radius) * std::max(1.0, step) + 1;
    }
    return static_cast<int>(std::min(std::ceil(reach), 0x1p29));
}

}  // namespace bandlimit
