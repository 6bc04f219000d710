#include "bandlimit/antialias/history_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bandlimit/kernel/kernel.h"

namespace bandlimit {
namespace {

constexpr int phases = 1024;

/// Lanczos-2 of sum 1 at phases + 1 places from 0 to 1.
const std::vector<std::array<float, 4>>& lanczos_table() {
    static const std::vector<std::array<float, 4>> table = [] {
        const Kernel kernel = lanczos(2);
        std::vector<std::array<float, 4>> rows;
        for (int i = 0; i <= phases; ++i) {
            std::array<double, 4> w{};
            double sum = 0;
            for (int k = 0; k < 4; ++k) sum += w[std::size_t(k)] = kernel.value(double(i) / phases - (k - 1));
            std::array<float, 4> row{};
            for (std::size_t k = 0; k < 4; ++k) row[k] = static_cast<float>(w[k] / sum);
            rows.push_back(row);
        }
        return rows;
    }();
    return table;
}

void lanczos_weights(float t, float* w) {
    const float at = t * phases;
    const int i = std::min(static_cast<int>(at), phases - 1);
    const float rest = at - static_cast<float>(i);
    const auto& a = lanczos_table()[static_cast<std::size_t>(i)];
    const auto& b = lanczos_table()[static_cast<std::size_t>(i) + 1];
    for (std::size_t k = 0; k < 4; ++k) w[k] = a[k] + rest * (b[k] - a[k]);
}

}  // namespace

void history_weights(HistoryKernel kernel, float t, float* w) {
    const float t2 = t * t, t3 = t2 * t;
    switch (kernel) {
        case HistoryKernel::bilinear: w[0] = 0, w[1] = 1 - t, w[2] = t, w[3] = 0; return;
        case HistoryKernel::bspline:
            w[0] = (1 - 3 * t + 3 * t2 - t3) / 6, w[1] = (4 - 6 * t2 + 3 * t3) / 6;
            w[2] = (1 + 3 * t + 3 * t2 - 3 * t3) / 6, w[3] = t3 / 6;
            return;
        case HistoryKernel::lanczos2: return lanczos_weights(t, w);
        case HistoryKernel::catmull_rom:
        case HistoryKernel::catmull_rom5: break;
    }
    w[0] = -0.5f * t + t2 - 0.5f * t3, w[1] = 1 - 2.5f * t2 + 1.5f * t3;
    w[2] = 0.5f * t + 2 * t2 - 1.5f * t3, w[3] = -0.5f * t2 + 0.5f * t3;
}

namespace {

/// The sums of 4 x 4 samples, inside the image or clamped to it.
struct Patch {
    const float* at[4][4];

    Patch(View<const float> sums, int x, int y) {
        const bool is_inside = x >= 1 && y >= 1 && x + 2 < sums.width && y + 2 < sums.height;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i)
                at[j][i] = is_inside ? &sums(x + i - 1, y + j - 1)
                                     : &sums(std::clamp(x + i - 1, 0, sums.width - 1),
                                             std::clamp(y + j - 1, 0, sums.height - 1));
    }
};

}  // namespace

HistorySample sample_history(View<const float> sums, HistoryKernel kernel, int x, int y, float dx, float dy,
                             float least_weight) {
    const float whole_x = std::floor(dx), whole_y = std::floor(dy);
    const float tx = dx - whole_x, ty = dy - whole_y;
    x += static_cast<int>(whole_x), y += static_cast<int>(whole_y);
    HistorySample result;
    if (tx == 0 && ty == 0 && kernel != HistoryKernel::bspline) {
        std::copy_n(&sums(std::clamp(x, 0, sums.width - 1), std::clamp(y, 0, sums.height - 1)), 4, result.sums);
        result.weight = result.sums[3];
        result.is_exact = true;
        if (result.weight > least_weight)
            for (int c = 0; c < 3; ++c) result.color[c] = result.sums[c] / result.weight;
        return result;
    }
    float wx[4], wy[4];
    history_weights(kernel, tx, wx);
    history_weights(kernel, ty, wy);
    const Patch patch(sums, x, y);
    const bool drops_corners = kernel == HistoryKernel::catmull_rom5;
    float sum[4] = {};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            if (drops_corners && (i == 0 || i == 3) && (j == 0 || j == 3)) continue;
            const float w = wx[i] * wy[j];
            for (int c = 0; c < 4; ++c) sum[c] += w * patch.at[j][i][c];
        }
    float low[3], high[3];
    std::fill_n(low, 3, 3e38f), std::fill_n(high, 3, -3e38f);
    for (int j = 1; j < 3; ++j)
        for (int i = 1; i < 3; ++i) {
            const float* const p = patch.at[j][i];
            result.weight += p[3] * (i == 1 ? 1 - tx : tx) * (j == 1 ? 1 - ty : ty);
            if (!(p[3] > least_weight)) continue;
            const float scale = 1 / p[3];
            for (int c = 0; c < 3; ++c) {
                const float v = p[c] * scale;
                low[c] = std::min(low[c], v), high[c] = std::max(high[c], v);
            }
        }
    if (low[0] > high[0]) return {};  // none of the four remembers anything
    result.weight = std::max(result.weight, 0.0f);
    const bool is_sound = sum[3] > least_weight;
    const float scale = is_sound ? 1 / sum[3] : 0;
    for (int c = 0; c < 3; ++c)
        result.color[c] = is_sound ? std::clamp(sum[c] * scale, low[c], high[c]) : (low[c] + high[c]) / 2;
    return result;
}

}  // namespace bandlimit
