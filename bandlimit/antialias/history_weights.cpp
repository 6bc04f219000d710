#include "bandlimit/antialias/history_weights.h"

#include <cstddef>

#include "bandlimit/kernel/kernel.h"

namespace bandlimit {
namespace {

constexpr int lanczos_parts = 64;

/// From the polynomials of the four samples, by rising powers.
constexpr CubicPart cubic(const double (&polynomials)[4][4]) {
    CubicPart part{};
    for (std::size_t power = 0; power < 4; ++power)
        for (std::size_t k = 0; k < 4; ++k) part[power][k] = static_cast<float>(polynomials[k][power]);
    return part;
}

constexpr CubicPart bilinear_part = cubic({{0, 0, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}});
constexpr CubicPart catmull_rom_part =
    cubic({{0, -0.5, 1, -0.5}, {1, 0, -2.5, 1.5}, {0, 0.5, 2, -1.5}, {0, 0, -0.5, 0.5}});
constexpr CubicPart bspline_part =
    cubic({{1.0 / 6, -0.5, 0.5, -1.0 / 6}, {4.0 / 6, 0, -1, 0.5}, {1.0 / 6, 0.5, 0.5, -0.5}, {0, 0, 0, 1.0 / 6}});

/// Lanczos-2 of sum 1.
std::array<double, 4> lanczos_at(double t) {
    static const Kernel kernel = lanczos(2);
    std::array<double, 4> w{};
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += w[static_cast<std::size_t>(k)] = kernel.value(t - (k - 1));
    for (double& v : w) v /= sum;
    return w;
}

/// Through four points of each part, its ends included: neighbours meet.
std::vector<CubicPart> made_lanczos() {
    std::vector<CubicPart> parts;
    for (int i = 0; i < lanczos_parts; ++i) {
        std::array<double, 4> p[4];
        for (int j = 0; j < 4; ++j) p[j] = lanczos_at((i + j / 3.0) / lanczos_parts);
        double polynomials[4][4];
        for (std::size_t k = 0; k < 4; ++k) {
            const double a = p[0][k], b = p[1][k], c = p[2][k], d = p[3][k];
            polynomials[k][0] = a;
            polynomials[k][1] = (-11 * a + 18 * b - 9 * c + 2 * d) / 2;
            polynomials[k][2] = (18 * a - 45 * b + 36 * c - 9 * d) / 2;
            polynomials[k][3] = (-9 * a + 27 * b - 27 * c + 9 * d) / 2;
        }
        parts.push_back(cubic(polynomials));
    }
    return parts;
}

}  // namespace

std::span<const CubicPart> history_weights(HistoryKernel kernel) {
    static const std::vector<CubicPart> lanczos_2 = made_lanczos();
    switch (kernel) {
        case HistoryKernel::bilinear: return {&bilinear_part, 1};
        case HistoryKernel::bspline: return {&bspline_part, 1};
        case HistoryKernel::lanczos2: return lanczos_2;
        case HistoryKernel::catmull_rom:
        case HistoryKernel::catmull_rom5: break;
    }
    return {&catmull_rom_part, 1};
}

}  // namespace bandlimit
