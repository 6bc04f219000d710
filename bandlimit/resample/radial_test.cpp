#include "bandlimit/resample/radial.h"
#include "bandlimit/kernel/radial_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bandlimit/core/image.h"

namespace bandlimit {
namespace {

std::vector<Kernel> radial_kernels() {
    std::vector<Kernel> kernels{jinc_lanczos_unscaled(3)};
    for (const KernelInfo& info : kernel_list())
        if (Kernel kernel = parse_kernel(info.example); is_radial(kernel)) kernels.push_back(std::move(kernel));
    return kernels;
}

/// The weights of an output that lies `x` and `y` right of and below sample (0, 0) of n x n: channel i of the picture
/// is 1 at sample i alone.
std::vector<float> weights_of(const Kernel& kernel, int n, double x, double y) {
    Image<float> impulses(n, n, n * n, Layout::interleaved);
    std::vector<const float*> lines;
    for (int v = 0; v < n; ++v) {
        for (int u = 0; u < n; ++u) impulses.view()(u, v, v * n + u) = 1;
        lines.push_back(&impulses.view()(0, v));
    }
    const Axis src{n, 0, double(n)};
    const RadialBank bank(kernel, src, {1, x, x + 1}, src, {1, y, y + 1}, Edge::zero, Edge::zero);
    std::vector<float> weights(std::size_t(n * n));
    bank.row(0, lines.data(), n * n, 0, weights.data());
    return weights;
}

TEST(RadialBank, HasTheWeightsThatAnalysisHasUpToTheEdgeOfTheKernel) {
    constexpr int n = 11;
    constexpr double tolerance = 4e-7;  // 1e-7 of the table, of weights up to 1, and a few roundings of their sum
    for (const Kernel& kernel : radial_kernels())
        for (const double y : {5.0, 4.7})
            // Samples just inside the radius, on it, and just beyond.
            for (const double inside : {0.3, 1e-3, 2e-4, 1e-4, 1e-6, 1e-9, 0.0, -1e-9, -1e-4}) {
                const double x = 5 + kernel.radius - std::floor(kernel.radius) - inside;
                const RadialWeights expected = radial_weights_at(kernel, x, y);
                const std::vector<float> found = weights_of(kernel, n, x, y);
                for (int v = 0; v < n; ++v)
                    for (int u = 0; u < n; ++u) {
                        const int i = u - expected.first_x, j = v - expected.first_y;
                        const bool is_read = i >= 0 && j >= 0 && i < expected.width && j < expected.height;
                        const double weight = is_read ? expected.weights[std::size_t(j * expected.width + i)] : 0.0;
                        ASSERT_NEAR(found[std::size_t(v * n + u)], weight, tolerance)
                            << kernel.name << ' ' << x << ' ' << y << " at " << u << ' ' << v;
                    }
            }
}

}  // namespace
}  // namespace bandlimit
