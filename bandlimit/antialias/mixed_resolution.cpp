#include "bandlimit/antialias/mixed_resolution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/kernel/taps.h"

namespace bandlimit {
namespace {

/// The points origin + a u + b v of whole a and b.
struct Lattice {
    Point origin, u, v;

    Point at(double a, double b) const { return {origin.x + a * u.x + b * v.x, origin.y + a * u.y + b * v.y}; }
    /// The a and b of a point: the inverse of at().
    Point coordinates(const Point& p) const {
        const double x = p.x - origin.x, y = p.y - origin.y, area = u.x * v.y - u.y * v.x;
        return {(x * v.y - y * v.x) / area, (y * u.x - x * u.y) / area};
    }
};

Lattice lattice_of(MixedMode mode, int width, int height) {
    const Axis pixels{1, 0, 1};
    const Point first{pixels.position(0), pixels.position(0)};
    switch (mode) {
        case MixedMode::full: return {first, {1, 0}, {0, 1}};
        case MixedMode::interlaced: return {first, {1, 0}, {0, 2}};
        case MixedMode::checkerboard: return {first, {1, 1}, {1, -1}};
        case MixedMode::uniform: break;
    }
    const auto fewer = [](int n) { return Axis{static_cast<int>(std::ceil(n / std::sqrt(2.0))), 0, double(n)}; };
    const Axis x = fewer(width), y = fewer(height);
    return {{x.position(0), y.position(0)}, {x.pitch(), 0}, {0, y.pitch()}};
}

/// From the first to the last, both included.
struct Span {
    int first = 0, last = -1;
    int count() const { return last - first + 1; }
};

/// The lattice points that lie within a kernel's reach of `at`, along one of its axes.
Span within(double at, double radius) {
    return {static_cast<int>(std::ceil(at - radius)), static_cast<int>(std::floor(at + radius))};
}

/// The samples of a lattice around an image.
class LatticeSamples {
public:
    LatticeSamples(const Lattice& lattice, int width, int height, int channels, double radius)
        : lattice_(lattice), channels_(channels) {
        const std::array corners{Point{0, 0}, Point{double(width), 0}, Point{0, double(height)},
                                 Point{double(width), double(height)}};
        std::array<double, 4> a{}, b{};
        for (std::size_t i = 0; i < 4; ++i) {
            const Point c = lattice.coordinates(corners[i]);
            a[i] = c.x, b[i] = c.y;
        }
        const auto range = [radius](const std::array<double, 4>& at) {
            const auto [least, most] = std::minmax_element(at.begin(), at.end());
            return Span{within(*least, radius).first, within(*most, radius).last};
        };
        a_ = range(a), b_ = range(b);
        values_.resize(static_cast<std::size_t>(a_.count()) * static_cast<std::size_t>(b_.count()) *
                       static_cast<std::size_t>(channels));
    }

    /// Evaluates those that some pixel may read: of a turned lattice, half of them.
    void take(const PointValue& value, int width, int height, double radius, const Parallel& parallel) {
        const double margin_x = radius * (std::abs(lattice_.u.x) + std::abs(lattice_.v.x));
        const double margin_y = radius * (std::abs(lattice_.u.y) + std::abs(lattice_.v.y));
        parallel_for(b_.count(), 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (int b = b_.first + static_cast<int>(begin); b < b_.first + end; ++b)
                for (int a = a_.first; a <= a_.last; ++a) {
                    const Point p = lattice_.at(a, b);
                    if (p.x < -margin_x || p.x > width + margin_x || p.y < -margin_y || p.y > height + margin_y)
                        continue;
                    value(p.x, p.y, std::span(at(a, b), static_cast<std::size_t>(channels_)));
                }
        });
    }

    float* at(int a, int b) { return values_.data() + index(a, b); }
    const float* at(int a, int b) const { return values_.data() + index(a, b); }

private:
    std::ptrdiff_t index(int a, int b) const {
        return (static_cast<std::ptrdiff_t>(b - b_.first) * a_.count() + (a - a_.first)) * channels_;
    }

    Lattice lattice_;
    int channels_;
    Span a_, b_;
    std::vector<float> values_;
};

/// What the samples around one pixel weigh.
class Weights {
public:
    explicit Weights(const Kernel& kernel) : kernel_(kernel) {}

    /// Moves to a pixel at lattice coordinates `c`.
    void move_to(const Point& c) {
        centre_ = c;
        a_range = within(c.x, kernel_.radius), b_range = within(c.y, kernel_.radius);
        if (is_radial(kernel_)) return;
        set(along_a_, a_range, c.x);
        set(along_b_, b_range, c.y);
    }
    double at(int a, int b) const {
        if (is_radial(kernel_)) return kernel_.value(std::hypot(a - centre_.x, b - centre_.y));
        return along_a_[static_cast<std::size_t>(a - a_range.first)] *
               along_b_[static_cast<std::size_t>(b - b_range.first)];
    }

    Span a_range, b_range;

private:
    void set(std::vector<double>& weights, const Span& range, double centre) const {
        weights.clear();
        for (int i = range.first; i <= range.last; ++i) weights.push_back(kernel_.value(i - centre));
    }

    const Kernel& kernel_;
    Point centre_;
    std::vector<double> along_a_, along_b_;  ///< of separable kernels
};

/// The weighted mean of `channels` channels around a pixel.
std::array<double, 4> mean_of(const Weights& weights, const LatticeSamples& samples, int channels,
                              const Kernel& kernel) {
    std::array<double, 4> sum{};
    double total = 0, magnitude = 0;
    for (int b = weights.b_range.first; b <= weights.b_range.last; ++b)
        for (int a = weights.a_range.first; a <= weights.a_range.last; ++a) {
            const double weight = weights.at(a, b);
            if (weight == 0) continue;
            total += weight, magnitude += std::abs(weight);
            const float* sample = samples.at(a, b);
            for (int c = 0; c < channels; ++c) sum[static_cast<std::size_t>(c)] += weight * double{sample[c]};
        }
    if (cancels(total, magnitude))
        fail("mixed_resolution: the weights of ", kernel.name, " sum to ", total, "; use a wider kernel");
    for (double& s : sum) s /= total;
    return sum;
}

struct NamedMode {
    MixedMode mode;
    std::string_view name;
};
constexpr std::array modes{NamedMode{MixedMode::full, "full"}, NamedMode{MixedMode::uniform, "uniform"},
                           NamedMode{MixedMode::interlaced, "interlaced"},
                           NamedMode{MixedMode::checkerboard, "checkerboard"}};

}  // namespace

MixedMode parse_mixed(std::string_view name) {
    for (const NamedMode& m : modes)
        if (m.name == name) return m.mode;
    fail("mixed resolution \"", name, "\" is unknown; use full, uniform, interlaced or checkerboard");
}

std::string_view name_of(MixedMode mode) {
    return std::find_if(modes.begin(), modes.end(), [mode](const NamedMode& m) { return m.mode == mode; })->name;
}

Image<float> mixed_resolution(const PointValue& value, int channels, int width, int height, MixedMode mode,
                              const Kernel& kernel, const Parallel& parallel) {
    if (channels < 1 || channels > 4) fail("mixed_resolution: ", channels, " channels; pass 1 to 4");
    if (width < 1 || height < 1) fail("mixed_resolution: ", width, " x ", height, " pixels; pass at least 1 x 1");
    if (kernel.form == Kernel::Form::nearest) fail("mixed_resolution: nearest is ambiguous halfway; use box or tent");
    const Lattice lattice = lattice_of(mode, width, height);
    LatticeSamples samples(lattice, width, height, channels, kernel.radius);
    samples.take(value, width, height, kernel.radius, parallel);
    Image<float> image(width, height, channels, Layout::interleaved);
    const View<float> out = image.view();
    const Axis pixels{1, 0, 1};
    parallel_for(height, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Weights weights(kernel);
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < width; ++x) {
                weights.move_to(lattice.coordinates({pixels.position(x), pixels.position(y)}));
                const std::array<double, 4> mean = mean_of(weights, samples, channels, kernel);
                for (int c = 0; c < channels; ++c) out(x, y, c) = static_cast<float>(mean[static_cast<std::size_t>(c)]);
            }
    });
    return image;
}

}  // namespace bandlimit
