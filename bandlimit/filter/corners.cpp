#include "bandlimit/filter/corners.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/filter/gradients.h"

namespace bandlimit {
namespace {

constexpr double farthest = 3;  // pixels from where a corner was found to where it lies
constexpr int most_steps = 30;

/// A Gaussian blurs edges so far that samples see where between them they lie.
constexpr const char* derivative_for_places = "gaussian:1.2";

struct Point {
    double x, y;
};

Image<float> gradients_of(View<const float> image, const char* derivative, const GradientOptions& options,
                          const Parallel& parallel) {
    Image<float> out(image.width, image.height, channels_of(options.result, image.channels), Layout::interleaved);
    gradient_filter(parse_derivative(derivative), image.width, image.height, options)
        .run({image, 0, {}}, {out.view(), 0, {}, {}}, parallel);
    return out;
}

StructureTensor tensor_at(View<const float> tensor, int x, int y) {
    const float* const t = &tensor(x, y);
    return {static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])};
}

/// What a corner is measured by, at every sample; NaN becomes 0.
Image<float> measured(View<const float> tensor, const CornerOptions& o) {
    Image<float> result(tensor.width, tensor.height);
    for (int y = 0; y < tensor.height; ++y)
        for (int x = 0; x < tensor.width; ++x) {
            const StructureTensor t = tensor_at(tensor, x, y);
            const double m = o.measure == CornerOptions::Measure::harris ? harris(t, o.k) : shi_tomasi(t);
            result.view()(x, y) = std::isfinite(m) ? static_cast<float>(m) : 0.0f;
        }
    return result;
}

/// Whether no neighbour is larger, nor equal and before it.
bool is_peak(View<const float> m, int x, int y) {
    const float here = m(x, y);
    for (int v = std::max(0, y - 1); v <= std::min(m.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(m.width - 1, x + 1); ++u) {
            const bool is_before = v < y || (v == y && u < x);
            if (m(u, v) > here || (is_before && m(u, v) == here)) return false;
        }
    return true;
}

/// Peaks above the threshold, the strongest first, in samples.
std::vector<Corner> peaks_of(View<const float> m, double least) {
    float most = 0;
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) most = std::max(most, m(x, y));
    std::vector<Corner> peaks;
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) {
            const double strength = static_cast<double>(m(x, y));
            if (strength > 0 && strength >= least * static_cast<double>(most) && is_peak(m, x, y))
                peaks.push_back({double(x), double(y), strength});
        }
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](const Corner& a, const Corner& b) { return a.strength > b.strength; });
    return peaks;
}

/// From `p`, in samples, to the point that lines along edges about it come nearest to; nothing where they have none.
std::optional<Point> step_from(View<const float> dx, View<const float> dy, Point p, double reach) {
    double xx = 0, xy = 0, yy = 0, x_sum = 0, y_sum = 0;
    const int left = std::max(0, static_cast<int>(std::ceil(p.x - reach)));
    const int right = std::min(dx.width - 1, static_cast<int>(std::floor(p.x + reach)));
    const int top = std::max(0, static_cast<int>(std::ceil(p.y - reach)));
    const int bottom = std::min(dx.height - 1, static_cast<int>(std::floor(p.y + reach)));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const double u = x - p.x, v = y - p.y, t = (u * u + v * v) / (reach * reach);
            if (t >= 1) continue;
            const double weight = t * t * t * (1 - t) * (1 - t);
            for (int c = 0; c < dx.channels; ++c) {
                const double gx = static_cast<double>(dx(x, y, c)), gy = static_cast<double>(dy(x, y, c));
                const double along = weight * (gx * u + gy * v);
                xx += weight * gx * gx, xy += weight * gx * gy, yy += weight * gy * gy;
                x_sum += along * gx, y_sum += along * gy;
            }
        }
    const StructureTensor t{xx, xy, yy};
    constexpr double least_share = 1e-3;  // of the larger eigenvalue: less is an edge, along which anything fits
    const Eigenvalues l = eigenvalues(t);
    if (!(l.smaller > least_share * l.larger)) return {};
    return Point{(yy * x_sum - xy * y_sum) / t.determinant(), (xx * y_sum - xy * x_sum) / t.determinant()};
}

/// The place of a corner that was found at `start`.
Point refined(View<const float> dx, View<const float> dy, Point start, double reach) {
    constexpr double settled = 1e-4;
    Point p = start;
    for (int i = 0; i < most_steps; ++i) {
        const std::optional<Point> step = step_from(dx, dy, p, reach);
        if (!step) return start;
        p.x += step->x, p.y += step->y;
        if (!(std::hypot(p.x - start.x, p.y - start.y) <= farthest)) return start;
        if (std::hypot(step->x, step->y) < settled) return p;
    }
    return start;
}

/// `reach`, or less where another corner is near.
double reach_of(const std::vector<Corner>& peaks, std::size_t i, double reach) {
    constexpr double least = 4, share = 0.75;
    double nearest = reach / share;
    for (std::size_t k = 0; k < peaks.size(); ++k)
        if (k != i) nearest = std::min(nearest, std::hypot(peaks[k].x - peaks[i].x, peaks[k].y - peaks[i].y));
    return std::min(reach, std::max(least, share * nearest));
}

void check(View<const float> image, const CornerOptions& o) {
    if (image.width < 1 || image.height < 1 || image.channels < 1)
        fail("find_corners: ", image.width, " x ", image.height, " x ", image.channels, " samples; pass at least one");
    if (!(o.k >= 0 && o.k < 0.25)) fail("find_corners: k = ", o.k, "; pass 0 to below 0.25, e.g. 0.05");
    if (!(o.least >= 0 && o.least <= 1)) fail("find_corners: least = ", o.least, "; pass a share, 0 to 1");
    if (!(o.distance >= 0 && std::isfinite(o.distance)))
        fail("find_corners: distance = ", o.distance, "; pass 0 or more pixels");
    if (!(o.reach >= 2 && o.reach <= 100)) fail("find_corners: reach = ", o.reach, "; pass 2 to 100 pixels");
}

}  // namespace

std::vector<Corner> find_corners(View<const float> image, const CornerOptions& o, Parallel parallel) {
    check(image, o);
    const GradientOptions of_tensor{
        .result = GradientResult::tensor, .edge = o.edge, .window = gaussian_taps(o.sigma), .premultiply = false};
    GradientOptions of_slopes = of_tensor;
    const std::vector<Corner> peaks =
        peaks_of(measured(gradients_of(image, "scharr", of_tensor, parallel).view(), o).view(), o.least);
    of_slopes.result = GradientResult::dx;
    const Image<float> dx = gradients_of(image, derivative_for_places, of_slopes, parallel);
    of_slopes.result = GradientResult::dy;
    const Image<float> dy = gradients_of(image, derivative_for_places, of_slopes, parallel);
    const Axis columns{image.width, 0, double(image.width)}, rows{image.height, 0, double(image.height)};
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < peaks.size(); ++i) {
        const Corner& peak = peaks[i];
        const Point p = refined(dx.view(), dy.view(), {peak.x, peak.y}, reach_of(peaks, i, o.reach));
        const Corner corner{columns.position(p.x), rows.position(p.y), peak.strength};
        if (std::none_of(corners.begin(), corners.end(),
                         [&](const Corner& c) { return std::hypot(c.x - corner.x, c.y - corner.y) < o.distance; }))
            corners.push_back(corner);
    }
    return corners;
}

}  // namespace bandlimit
