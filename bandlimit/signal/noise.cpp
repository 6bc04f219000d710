// Noise: white, and band-limited.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/edge.h"
#include "bandlimit/kernel/kernel.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/math/random.h"
#include "bandlimit/signal/check.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

/// A number that depends on its arguments alone.
double random_at(std::uint64_t seed, std::int64_t x, std::int64_t y) {
    return uniform_from(hash_of(seed, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)));
}

/// One period of a band-limited function, finely enough sampled that interpolation between the samples is exact: at
/// least four samples to the shortest period.
struct Field {
    int factor = 1;  ///< samples per pixel
    ComplexGrid samples;

    static int sampling_factor(double cutoff) { return std::max(1, static_cast<int>(std::ceil(4 * cutoff))); }
};

/// Clears all but the frequencies in (0, cutoff], in cycles per sample. Returns how many are left.
int keep_band(ComplexGrid& spectrum, double cutoff) {
    int kept = 0;
    for (int y = 0; y < spectrum.height; ++y)
        for (int x = 0; x < spectrum.width; ++x) {
            const double f = std::hypot(bin_frequency(x, spectrum.width), bin_frequency(y, spectrum.height));
            if (f > 0 && f <= cutoff) ++kept;
            else spectrum.at(x, y) = 0;
        }
    return kept;
}

void check_noise(int width, int height, const BandLimitedNoiseOptions& options) {
    const char* const function = "band_limited_noise";
    check_option(function, "cutoff", options.cutoff, 1e-9, 16, "up to 16 cycles per pixel, above 0");
    check_option(function, "rms", options.rms, 1e-9, 1e9, "a number above 0; 0.1 is usual");
    const int longest = (1 << 30) / Field::sampling_factor(options.cutoff);
    if (width < 1 || height < 1 || width > longest || height > longest)
        fail(function, ": size ", width, " x ", height, "; pass 1 to ", longest, " pixels each way");
}

Field make_field(int width, int height, const BandLimitedNoiseOptions& options) {
    const int factor = Field::sampling_factor(options.cutoff);
    Field field{factor, ComplexGrid(width * factor, height * factor)};
    Random random(options.seed);
    for (std::complex<double>& value : field.samples.values) value = random.uniform(-1, 1);
    fft(field.samples);
    if (keep_band(field.samples, options.cutoff / factor) == 0)
        fail("band_limited_noise: cutoff = ", options.cutoff, " holds no frequency of ", width, " x ", height,
             " pixels; pass at least ", 1.0 / std::max(width, height));
    inverse_fft(field.samples);
    double energy = 0;
    for (const std::complex<double>& value : field.samples.values) energy += value.real() * value.real();
    const double scale = options.rms / std::sqrt(energy / static_cast<double>(field.samples.values.size()));
    for (std::complex<double>& value : field.samples.values) value *= scale;
    return field;
}

/// The samples of a periodic row that a position between them is made of.
struct Neighbours {
    static constexpr int radius = 9;
    int first = 0, count = 1;
    double weights[2 * radius] = {1};

    /// The interpolator need only pass a quarter of the sampling rate and stop three quarters: this window does so to
    /// -130 dB.
    Neighbours(double index) {
        static const Kernel kernel = kaiser(radius, 13.8);
        const double whole = std::floor(index), fraction = index - whole;
        first = static_cast<int>(whole);
        if (fraction == 0) return;  // a sample itself, as every centre of a pixel is
        first -= radius - 1;
        count = 2 * radius;
        for (int i = 0; i < count; ++i) weights[i] = kernel.value(i - (radius - 1) - fraction);
    }
};

double interpolate(const Field& field, const Neighbours& x, const Neighbours& y) {
    double sum = 0;
    for (int j = 0; j < y.count; ++j) {
        const int row = resolve(y.first + j, field.samples.height, Edge::wrap);
        double line = 0;
        for (int i = 0; i < x.count; ++i)
            line += x.weights[i] * field.samples.at(resolve(x.first + i, field.samples.width, Edge::wrap), row).real();
        sum += y.weights[j] * line;
    }
    return sum;
}

}  // namespace

Signal white_noise(const WhiteNoiseOptions& options) {
    const auto value = [seed = options.seed](double x, double y) {
        return random_at(seed, static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)));
    };
    return {"noise", value, nullptr, {}};
}

Signal band_limited_noise(int width, int height, const BandLimitedNoiseOptions& options) {
    check_noise(width, height, options);
    const auto field = std::make_shared<const Field>(make_field(width, height, options));
    // Pixel centres lie on the samples that are multiples of the factor.
    const Axis pixels{1, 0, 1};
    const auto value = [field, pixels](double x, double y) {
        return 0.5 + interpolate(*field, {pixels.index(x) * field->factor}, {pixels.index(y) * field->factor});
    };
    return {"noise", value, nullptr, {}};
}

std::uint64_t band_limited_noise_bytes(int width, int height, const BandLimitedNoiseOptions& options) {
    check_noise(width, height, options);
    const auto side = [factor = Field::sampling_factor(options.cutoff)](int pixels) {
        return static_cast<std::uint64_t>(pixels) * static_cast<std::uint64_t>(factor);
    };
    return side(width) * side(height) * sizeof(std::complex<double>);
}

}  // namespace bandlimit
