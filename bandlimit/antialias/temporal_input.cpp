#include "bandlimit/antialias/temporal_input.h"

#include <algorithm>
#include <cmath>

namespace bandlimit {
namespace {

constexpr int grain = 8;  // rows per thread at least
constexpr float far_away = 1e10f;

/// Calls body(x, y, sample) for up to 3 x 3 samples about (x, y) that lie inside.
template <class Body>
void each_neighbour(int x, int y, int width, int height, const Body& body) {
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) body(u, v);
}

bool is_finite(View<const float> color, int x, int y) {
    for (int c = 0; c < color.channels; ++c)
        if (!std::isfinite(color(x, y, c))) return false;
    return true;
}

/// The mean of the finite samples about one that is not; 0 if there are none.
void fill_from_neighbours(View<const float> color, int x, int y, float* to) {
    std::fill_n(to, color.channels, 0.0f);
    int count = 0;
    each_neighbour(x, y, color.width, color.height, [&](int u, int v) {
        if (!is_finite(color, u, v)) return;
        ++count;
        for (int c = 0; c < color.channels; ++c) to[c] += color(u, v, c);
    });
    for (int c = 0; c < color.channels && count > 0; ++c) to[c] /= static_cast<float>(count);
}

Image<float> finite_color(const TemporalFrame& frame, const TemporalOptions& options, const Parallel& parallel) {
    const View<const float>& color = frame.color;
    Image<float> result(color.width, color.height, color.channels, Layout::interleaved);
    parallel_for(color.height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < color.width; ++x) {
                float* const to = &result.view()(x, y);
                bool finite = true;
                for (int c = 0; c < color.channels; ++c) finite &= std::isfinite(to[c] = color(x, y, c));
                if (!finite) fill_from_neighbours(color, x, y, to);
                if (options.compresses_highlights) compress_highlight(to);
            }
    });
    return result;
}

float depth_at(const TemporalFrame& frame, int x, int y) {
    const float depth = frame.depth(x, y);
    return std::isfinite(depth) ? depth : far_away;
}

Image<float> guide_of(const TemporalFrame& frame, const TemporalOptions& options, const Parallel& parallel) {
    const int width = frame.color.width, height = frame.color.height;
    Image<float> result(width, height, 4, Layout::interleaved);
    const bool has_depth = frame.depth.width > 0, has_motion = frame.motion.width > 0;
    parallel_for(height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < width; ++x) {
                float* const to = &result.view()(x, y);
                int near_x = x, near_y = y;
                to[3] = has_depth ? depth_at(frame, x, y) : far_away;
                to[2] = to[3];
                if (has_depth && options.dilates_motion)
                    each_neighbour(x, y, width, height, [&](int u, int v) {
                        if (const float depth = depth_at(frame, u, v); depth < to[2])
                            to[2] = depth, near_x = u, near_y = v;
                    });
                for (int c = 0; c < 2; ++c) {
                    const float motion = has_motion ? frame.motion(near_x, near_y, c) : 0;
                    to[c] = std::isfinite(motion) ? motion : 0;
                }
            }
    });
    return result;
}

/// Centre and half extent of `count` colours: of their range, or their mean and standard deviation.
void box_of(const float (*colors)[3], int count, bool is_variance, float* box) {
    for (int c = 0; c < 3; ++c) {
        float low = colors[0][c], high = low, sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const float v = colors[i][c];
            low = std::min(low, v), high = std::max(high, v);
            sum += v, squares += v * v;
        }
        const float mean = sum / static_cast<float>(count);
        box[c] = is_variance ? mean : (low + high) / 2;
        box[3 + c] = is_variance ? std::sqrt(std::max(0.0f, squares / static_cast<float>(count) - mean * mean))
                                 : (high - low) / 2;
    }
}

Image<float> box_of(const Image<float>& color, const TemporalOptions& options, const Parallel& parallel) {
    const int width = color.width(), height = color.height();
    Image<float> result(width, height, 6, Layout::interleaved);
    parallel_for(height, grain, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        float colors[9][3];
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < width; ++x) {
                int count = 0;
                each_neighbour(x, y, width, height, [&](int u, int v) {
                    std::copy_n(&color.view()(u, v), 3, colors[count]);
                    if (options.rectifies_ycocg) to_ycocg(colors[count]);
                    ++count;
                });
                box_of(colors, count, options.rectification == Rectification::variance, &result.view()(x, y));
            }
    });
    return result;
}

}  // namespace

void compress_highlight(float* rgb) {
    const float most = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(most > 1)) return;
    const float scale = (1 + std::log(most)) / most;
    for (int c = 0; c < 3; ++c) rgb[c] *= scale;
}

void restore_highlight(float* rgb) {
    const float most = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(most > 1)) return;
    const float scale = std::exp(most - 1) / most;
    for (int c = 0; c < 3; ++c) rgb[c] *= scale;
}

void to_ycocg(float* rgb) {
    const float r = rgb[0], g = rgb[1], b = rgb[2];
    rgb[0] = (r + 2 * g + b) / 4, rgb[1] = (r - b) / 2, rgb[2] = (2 * g - r - b) / 4;
}

void to_rgb(float* ycocg) {
    const float y = ycocg[0], co = ycocg[1], cg = ycocg[2];
    ycocg[0] = y - cg + co, ycocg[1] = y + cg, ycocg[2] = y - cg - co;
}

TemporalInput temporal_input(const TemporalFrame& frame, const TemporalOptions& options, const Parallel& parallel) {
    TemporalInput input;
    input.color = finite_color(frame, options, parallel);
    input.guide = guide_of(frame, options, parallel);
    if (options.rectification != Rectification::none) input.box = box_of(input.color, options, parallel);
    return input;
}

}  // namespace bandlimit
