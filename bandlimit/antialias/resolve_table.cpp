#include "bandlimit/antialias/resolve_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"
#include "bandlimit/math/quadrature.h"

namespace bandlimit {
namespace {

/// Where a kernel bends or jumps, ascending, times `scale`.
std::vector<double> borders_of(const Kernel& kernel, double scale) {
    std::vector<double> borders{-kernel.radius * scale, 0, kernel.radius * scale};
    for (const double knot : kernel.knots) borders.insert(borders.end(), {-knot * scale, knot * scale});
    std::sort(borders.begin(), borders.end());
    return borders;
}

double area_of(const Kernel& kernel) {
    const std::vector<double> borders = borders_of(kernel, 1);
    double area = 0;
    for (std::size_t i = 1; i < borders.size(); ++i) area += integrate(kernel.value, borders[i - 1], borders[i]);
    return area;
}

/// The integral of narrow(t / pitch) wide(x - t) over t, piece by piece where both are smooth.
double convolved(const Kernel& narrow, double pitch, const Kernel& wide, double x) {
    std::vector<double> ends = borders_of(narrow, pitch);
    const double first = ends.front(), last = ends.back();
    for (const double border : borders_of(wide, 1)) ends.push_back(std::clamp(x + border, first, last));
    std::sort(ends.begin(), ends.end());
    double sum = 0;
    for (std::size_t i = 1; i < ends.size(); ++i)
        if (ends[i] > ends[i - 1])
            sum +=
                integrate([&](double t) { return narrow.value(t / pitch) * wide.value(x - t); }, ends[i - 1], ends[i]);
    return sum;
}

void check_kernel(const Kernel& kernel) {
    if (kernel.form == Kernel::Form::nearest)
        fail("supersampling: nearest takes one sample and resolves nothing; use box or a wider kernel");
    if (kernel.radius > 16)
        fail("supersampling: ", kernel.name, " reaches ", kernel.radius, " pixels; use a kernel of radius 16 or less");
}

/// What a sample at a distance from the output weighs.
double weight_at(const Kernel& kernel, double x, double y) {
    if (is_radial(kernel)) return kernel.value(std::hypot(x, y));
    if (kernel.form == Kernel::Form::area) {
        const auto is_inside = [&](double t) { return t >= -kernel.radius && t < kernel.radius; };
        return is_inside(x) && is_inside(y) ? 1 : 0;
    }
    const double at_x = kernel.value(x);
    return at_x == 0 ? 0 : at_x * kernel.value(y);
}

/// Whether no sample of the outermost pixels weighs anything.
bool has_empty_rim(const ResolveTable& table) {
    for (int dy = -table.reach; dy <= table.reach; ++dy)
        for (int dx = -table.reach; dx <= table.reach; ++dx)
            for (int s = 0; s < table.samples; ++s)
                if (std::max(std::abs(dx), std::abs(dy)) == table.reach && table.weight(dx, dy, s) != 0) return false;
    return true;
}

ResolveTable without_rim(const ResolveTable& table) {
    ResolveTable inner{table.reach - 1, table.samples, {}};
    for (int dy = -inner.reach; dy <= inner.reach; ++dy)
        for (int dx = -inner.reach; dx <= inner.reach; ++dx)
            for (int s = 0; s < table.samples; ++s) inner.weights.push_back(table.weight(dx, dy, s));
    return inner;
}

}  // namespace

Kernel combined_kernel(const Kernel& reconstruction, double pitch, const Kernel& band_limit) {
    for (const Kernel* kernel : {&reconstruction, &band_limit})
        if (is_radial(*kernel) || kernel->form == Kernel::Form::nearest)
            fail("combined_kernel: ", kernel->name, " is not separable; use kernels such as tent or mitchell");
    if (!(pitch > 0 && std::isfinite(pitch))) fail("combined_kernel: pitch = ", pitch, "; pass a number above 0");
    const double area = area_of(reconstruction) * pitch * area_of(band_limit);
    Kernel combined;
    combined.name = reconstruction.name + " * " + band_limit.name;
    combined.radius = reconstruction.radius * pitch + band_limit.radius;
    combined.value = [=](double x) { return convolved(reconstruction, pitch, band_limit, x) / area; };
    for (const double a : borders_of(reconstruction, pitch))
        for (const double b : borders_of(band_limit, 1))
            if (a + b > 0 && a + b < combined.radius) combined.knots.push_back(a + b);
    std::sort(combined.knots.begin(), combined.knots.end());
    combined.knots.erase(std::unique(combined.knots.begin(), combined.knots.end()), combined.knots.end());
    return combined;
}

ResolveTable unnormalised_table(const SamplePattern& pattern, const Kernel& kernel,
                                const std::optional<Kernel>& reconstruction) {
    check_kernel(kernel);
    if (pattern.points.empty()) fail("supersampling: the pattern has no points; pass at least one");
    const Kernel filter =
        reconstruction ? combined_kernel(*reconstruction, 1 / std::sqrt(pattern.count()), kernel) : kernel;
    double farthest = 0;
    for (const Point& p : pattern.points) farthest = std::max({farthest, std::abs(p.x), std::abs(p.y)});
    ResolveTable table{static_cast<int>(std::ceil(filter.radius + farthest)), pattern.count(), {}};
    for (int dy = -table.reach; dy <= table.reach; ++dy)
        for (int dx = -table.reach; dx <= table.reach; ++dx)
            for (const Point& p : pattern.points) table.weights.push_back(weight_at(filter, dx + p.x, dy + p.y));
    while (table.reach > 0 && has_empty_rim(table)) table = without_rim(table);
    return table;
}

ResolveTable resolve_table(const SamplePattern& pattern, const Kernel& kernel,
                           const std::optional<Kernel>& reconstruction) {
    ResolveTable table = unnormalised_table(pattern, kernel, reconstruction);
    const double sum = std::accumulate(table.weights.begin(), table.weights.end(), 0.0);
    if (cancels(table.weights))
        fail("supersampling: ", kernel.name, " gives the samples of ", pattern.name, " weights that sum to ", sum,
             "; use a wider kernel or more samples");
    for (double& weight : table.weights) weight /= sum;
    return table;
}

}  // namespace bandlimit
