#include "bandlimit/antialias/frame_gather.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/bank_builder.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {
namespace {

/// The weights of an axis, and what is known of them.
struct GatherAxis {
    Bank bank;
    std::vector<float> sums, peaks;
    std::vector<int> nearest;
    double mean = 0;
};

double integral(const Kernel& kernel) {
    constexpr int steps = 4096;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += kernel.value((i + 0.5) / steps * kernel.radius);
    return 2 * sum * kernel.radius / steps;
}

GatherAxis gather_axis(const Kernel& kernel, bool is_input_sized, int in, int out, double jitter) {
    const double step = double(in) / out;           // input pixels per output pixel
    const double unit = is_input_sized ? 1 : step;  // input pixels per unit of the kernel
    const double reach = kernel.radius * unit;
    GatherAxis axis;
    axis.mean = integral(kernel) * unit;
    BankBuilder builder(in, out, Edge::zero, CutRows::unfinished);
    for (int i = 0; i < out; ++i) {
        const double at = (i + 0.5) * step - 0.5 - jitter;  // among the samples
        axis.nearest.push_back(std::clamp(static_cast<int>(std::lround(at)), 0, in - 1));
        PhaseRow row{static_cast<int>(std::ceil(at - reach)), {}, axis.nearest.back(), axis.nearest.back()};
        for (int k = row.first; k <= at + reach; ++k) row.weights.push_back(kernel.value((k - at) / unit));
        if (row.weights.empty()) row = {axis.nearest.back(), {0}, axis.nearest.back(), axis.nearest.back()};
        builder.add({0, 0, i, 0}, row);
    }
    axis.bank = builder.take();
    for (int i = 0; i < out; ++i) {
        float sum = 0, peak = 0;
        for (const float w : axis.bank.row(i)) sum += w, peak = std::max(peak, w);
        axis.sums.push_back(sum), axis.peaks.push_back(peak);
    }
    return axis;
}

}  // namespace

WeightLimits weight_limits(const Kernel& kernel) {
    constexpr int steps = 256;
    for (int i = 0; i < steps; ++i)
        if (kernel.value((i + 0.5) / steps * kernel.radius) < 0) return {0.25f, 0.5f};
    return {0.02f, 0.3f};
}

FrameGather frame_gather(const Kernel& kernel, bool is_input_sized, int in_width, int in_height, int out_width,
                         int out_height, Point jitter) {
    if (is_radial(kernel) || kernel.form == Kernel::Form::nearest)
        fail("accumulate: ", kernel.name, " is not separable; choose e.g. gaussian or lanczos2");
    if (!(std::abs(jitter.x) <= 1 && std::abs(jitter.y) <= 1))
        fail("accumulate: jitter ", jitter.x, ", ", jitter.y, " is out of range; pass pixels of the input, -1 to 1");
    GatherAxis x = gather_axis(kernel, is_input_sized, in_width, out_width, jitter.x);
    GatherAxis y = gather_axis(kernel, is_input_sized, in_height, out_height, jitter.y);
    std::vector<BankTerm> terms(1);
    terms[0].x = std::move(x.bank), terms[0].y = std::move(y.bank);
    return {term_filter(std::move(terms), false),
            std::move(x.sums),
            std::move(y.sums),
            std::move(x.peaks),
            std::move(y.peaks),
            std::move(x.nearest),
            std::move(y.nearest),
            x.mean * y.mean};
}

}  // namespace bandlimit
