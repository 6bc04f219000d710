#include "bandlimit/analysis/line_probe.h"

#include <bit>
#include <cmath>
#include <numeric>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int largest_term = 128;

int round_up(int n, int multiple) { return (n + multiple - 1) / multiple * multiple; }

/// Row `band`, column `train` + 1 of the Sylvester matrix: over all bands the signs of a train sum to 0, and those of
/// two trains are orthogonal.
int sign(int band, int train) {
    const unsigned both = static_cast<unsigned>(band) & static_cast<unsigned>(train + 1);
    return std::popcount(both) % 2 == 0 ? 1 : -1;
}

/// The output row in the middle of a band.
int middle_row(const LineProbe& probe, int band) {
    return static_cast<int>((band + 0.5) * probe.band * probe.ratio.scale());
}

}  // namespace

Ratio ratio_of(double scale) {
    if (!(scale >= 0.125 && scale <= 8)) fail("ratio_of: scale = ", scale, "; pass 1/8 to 8");
    for (int larger = 1; larger <= largest_term; ++larger) {
        const int other = static_cast<int>(std::lround(larger * (scale < 1 ? scale : 1 / scale)));
        const Ratio ratio = scale < 1 ? Ratio{other, larger} : Ratio{larger, other};
        if (other > 0 && std::abs(ratio.scale() - scale) <= 1e-6 * scale) return ratio;
    }
    fail("ratio_of: scale = ", scale, " is not a ratio of numbers up to ", largest_term,
         "; pass one, e.g. 1/2 or 37/100");
}

LineProbe line_probe(const Ratio& ratio, double reach) {
    if (!(reach >= 1 && reach <= 16)) fail("line_probe: reach = ", reach, "; pass 1 to 16");
    const double radius = reach * ratio.stretch();
    const int diameter = static_cast<int>(std::ceil(2 * radius)) + 2;
    LineProbe probe{ratio, reach};
    probe.order = static_cast<int>(std::bit_ceil(static_cast<unsigned>(diameter + 1)));
    probe.band = round_up(diameter + 2, ratio.from / std::gcd(ratio.from, probe.order));
    // Two borders, and between them every phase once, or enough outputs for a mean.
    probe.inputs = round_up(2 * diameter + std::max(48, ratio.from), ratio.from);
    probe.outputs = probe.inputs / ratio.from * ratio.to;
    return probe;
}

Image<float> draw(const LineProbe& probe, float low, float high) {
    Image<float> image(probe.inputs, probe.height());
    for (int y = 0; y < probe.height(); ++y)
        for (int x = 0; x < probe.inputs; ++x)
            image.view()(x, y) = sign(y / probe.band, x % probe.period()) > 0 ? high : low;
    return image;
}

int MeasuredBank::interior_begin() const {
    return std::min(outputs / 2, static_cast<int>(std::ceil((reach + 1) * ratio.stretch() / ratio.step())));
}

double MeasuredBank::corner_position(int output) const {
    const Axis source{inputs, 0, double(inputs)}, target{outputs, 0, double(inputs)};
    return source.index(target.position(output));
}

MeasuredBank measure(const LineProbe& probe, View<const float> result, double low, double high, double noise) {
    if (result.width != probe.outputs || result.height != probe.out_height() || result.channels != 1)
        fail("measure: the result has ", result.width, " x ", result.height, " x ", result.channels,
             " samples; this probe gives ", probe.outputs, " x ", probe.out_height(), " x 1");
    if (low == high) fail("measure: low = high = ", low, "; pass the two values of the probe");
    const double amplitude = (high - low) / 2, mean = (high + low) / 2;
    MeasuredBank bank{probe.ratio, probe.reach, probe.inputs, probe.outputs, probe.period(), {}};
    bank.noise = noise / std::abs(amplitude) / std::sqrt(probe.order);
    double total = 0;
    for (int i = 0; i < probe.outputs; ++i) {
        for (int train = 0; train < probe.period(); ++train) {
            double sum = 0;
            for (int band = 0; band < probe.order; ++band)
                sum += sign(band, train) * double(result(i, middle_row(probe, band)));
            bank.weights.push_back(sum / (amplitude * probe.order));
        }
        if (i < bank.interior_begin() || i >= bank.interior_end()) continue;
        for (int band = 0; band < probe.order; ++band) total += double(result(i, middle_row(probe, band))) - mean;
    }
    bank.bias = total / (double(bank.interior_end() - bank.interior_begin()) * probe.order);
    return bank;
}

}  // namespace bandlimit
