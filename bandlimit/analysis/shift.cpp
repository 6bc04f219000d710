#include "bandlimit/analysis/shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "bandlimit/analysis/finite.h"
#include "bandlimit/analysis/taper.h"
#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr int largest_window = 1024;
constexpr int smallest_axis = 4;
constexpr double fit_band = 0.25;  // cycles per sample: below most of what down- and upsampling alias or cut
constexpr double residual_band = 0.1;
constexpr double flat = 1e-3;     // share of gradient energy under which a direction holds no structure
constexpr double oblique = 0.02;  // sine of the angle to an axis from which stripes are not along it
constexpr double coherent = 0.5;  // agreement of phases below which images are unrelated

struct Vec {
    double x = 0, y = 0;
};

// ---- Images
// ----------------------------------------------------------------------------------------------------------

Image<float> mean_of_channels(View<const float> v) {
    Image<float> mean(v.width, v.height);
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) {
            double total = 0;
            for (int c = 0; c < v.channels; ++c) total += double(finite_or_zero(v(x, y, c)));
            mean.view()(x, y) = static_cast<float>(total / v.channels);
        }
    return mean;
}

/// Scales to a mean of 0 and a largest value of 1, so that no scale of the input is special. False for a constant.
bool standardize(View<float> v) {
    double total = 0, most = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) total += double(v(x, y));
    const double mean = total / (double(v.width) * v.height);
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) most = std::max(most, std::abs(double(v(x, y)) - mean));
    if (!(most > 1e-6 * std::abs(mean))) return false;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) v(x, y) = static_cast<float>((double(v(x, y)) - mean) / most);
    return true;
}

Image<float> run(const Bank& bank, View<const float> v, Parallel parallel) {
    Image<float> out(bank.output_count(), v.height);
    apply(bank, v, out.view(), parallel);
    return out;
}

Image<float> run(const Bank& along_x, const Bank& along_y, View<const float> v, Parallel parallel) {
    const Image<float> rows = run(along_x, v, parallel);
    Image<float> out(rows.width(), along_y.output_count());
    apply(along_y, transposed(rows.view()), transposed(out.view()), parallel);
    return out;
}

/// The mean of every column: an image of one row.
Image<float> column_means(View<const float> v, Parallel parallel) {
    const Taps mean{0, std::vector<double>(static_cast<std::size_t>(v.height), 1.0 / v.height), v.height};
    Image<float> out(v.width, 1);
    apply(make_bank(mean, v.height, Edge::clamp), transposed(v), transposed(out.view()), parallel);
    return out;
}

/// The largest size up to n whose only prime factors are 2, 3 and 5, for which the FFT is fast.
int fast_size(int n) {
    const auto is_fast = [](int m) {
        for (const int p : {2, 3, 5})
            while (m % p == 0) m /= p;
        return m == 1;
    };
    while (n > 1 && !is_fast(n)) --n;
    return std::max(n, 1);
}

// ---- Spectra
// ---------------------------------------------------------------------------------------------------------

/// The transform of v under a Hann window, the mean that v has under it removed.
ComplexGrid tapered_spectrum(View<const float> v) {
    const std::vector<double> wx = hann(v.width), wy = hann(v.height);
    const auto weight = [&](int x, int y) { return wx[static_cast<std::size_t>(x)] * wy[static_cast<std::size_t>(y)]; };
    double total = 0, weights = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) total += weight(x, y) * double(v(x, y)), weights += weight(x, y);
    ComplexGrid grid(v.width, v.height);
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) grid.at(x, y) = weight(x, y) * (double(v(x, y)) - total / weights);
    fft(grid);
    return grid;
}

/// Calls visit(x, y, f) for the bins of a spectrum within the band that is fitted.
template <class Visit>
void for_band(const ComplexGrid& grid, Visit visit) {
    for (int y = 0; y < grid.height; ++y) {
        const double fy = bin_frequency(y, grid.height);
        if (std::abs(fy) > fit_band) continue;
        for (int x = 0; x < grid.width; ++x) {
            const double fx = bin_frequency(x, grid.width);
            if (std::abs(fx) <= fit_band) visit(x, y, Vec{fx, fy});
        }
    }
}

/// The shift of b against a to the nearest sample: the peak of the correlation, whitened by half, which finds large
/// shifts as well as small ones, and for periodic images the smallest; weighted to low frequencies.
Vec coarse_shift(const ComplexGrid& a, const ComplexGrid& b) {
    ComplexGrid cross(a.width, a.height);
    for (int y = 0; y < cross.height; ++y)
        for (int x = 0; x < cross.width; ++x) {
            const double fx = bin_frequency(x, cross.width) / fit_band, fy = bin_frequency(y, cross.height) / fit_band;
            const Complex c = b.at(x, y) * std::conj(a.at(x, y));
            if (c != 0.0) cross.at(x, y) = c * std::exp(-2 * (fx * fx + fy * fy)) / std::sqrt(std::abs(c));
        }
    inverse_fft(cross);
    const auto peak = std::max_element(cross.values.begin(), cross.values.end(),
                                       [](const Complex& p, const Complex& q) { return p.real() < q.real(); });
    const int at = static_cast<int>(peak - cross.values.begin());
    return {bin_frequency(at % cross.width, cross.width) * cross.width,
            bin_frequency(at / cross.width, cross.height) * cross.height};
}

/// Products of two spectra, averaged over the bins around one.
struct Products {
    Complex cross;          ///< B conj(A)
    double aa = 0, bb = 0;  ///< |A|^2 and |B|^2
    double coherence() const { return aa * bb > 0 ? std::norm(cross) / (aa * bb) : 0; }
};

Products products_around(const ComplexGrid& a, const ComplexGrid& b, int x, int y) {
    // Fewer bins than these would always agree; more of a small image would lie too far apart in phase.
    const int rx = std::min(2, a.width / 16), ry = std::min(2, a.height / 16);
    Products p;
    for (int j = y - ry; j <= y + ry; ++j)
        for (int i = x - rx; i <= x + rx; ++i) {
            const int u = (i + a.width) % a.width, v = (j + a.height) % a.height;
            p.cross += b.at(u, v) * std::conj(a.at(u, v));
            p.aa += std::norm(a.at(u, v));
            p.bb += std::norm(b.at(u, v));
        }
    return p;
}

/// The shift d that explains the phases -2 pi f.d of B conj(A) best, by least squares. The error of a phase is that of
/// a coherence g: (1 - g) / g.
Vec fit_plane(const ComplexGrid& a, const ComplexGrid& b) {
    double xx = 0, xy = 0, yy = 0, px = 0, py = 0;
    for_band(a, [&](int x, int y, Vec f) {
        const Products p = products_around(a, b, x, y);
        const double coherence = p.coherence();
        const double weight = std::abs(p.cross) * coherence / (1 - coherence + 0.01);
        const double phase = -std::arg(p.cross) / (2 * pi);
        xx += weight * f.x * f.x, xy += weight * f.x * f.y, yy += weight * f.y * f.y;
        px += weight * f.x * phase, py += weight * f.y * phase;
    });
    if (a.width == 1) return {0, yy > 0 ? py / yy : 0};
    if (a.height == 1) return {xx > 0 ? px / xx : 0, 0};
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0)) return {};
    return {(px * yy - py * xy) / determinant, (py * xx - px * xy) / determinant};
}

// ---- Alignment
// -------------------------------------------------------------------------------------------------------

/// The parts of two images that show the same.
struct Aligned {
    View<const float> a;
    Image<float> b;
    Vec shift;
    double residual = 1;
};

/// The cells [begin, begin + size) of a and those `shift` further in b overlap, for the largest fast size.
Axis overlap(int count, double shift) {
    const int moved = static_cast<int>(std::lround(shift));
    const int size = fast_size(std::max(1, count - std::abs(moved)));
    const int begin = std::max(0, -moved) + (count - std::abs(moved) - size) / 2;
    return {size, double(begin), double(begin + size)};
}

/// Samples of v on an axis that lies `shift` further along; sharp up to the band that is fitted.
Bank shifted_bank(int count, const Axis& axis, double shift) {
    return make_bank(kaiser(8, 8), Axis{count, 0, double(count)},
                     Axis{axis.count, axis.begin + shift, axis.end + shift}, Edge::reflect);
}

/// `a` through the zero-phase filter that makes its spectrum most like that of b: what a filter does to the content
/// near a taper's slope then happens to both images, and cancels.
Image<float> equalized(View<const float> a, const ComplexGrid& spectrum_a, const ComplexGrid& spectrum_b) {
    ComplexGrid grid(a.width, a.height);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) grid.at(x, y) = double(a(x, y));
    fft(grid);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const Products p = products_around(spectrum_a, spectrum_b, x, y);
            grid.at(x, y) *= p.aa > 0 ? p.cross.real() / p.aa : 0;
        }
    inverse_fft(grid);
    Image<float> out(a.width, a.height);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) out.view()(x, y) = static_cast<float>(grid.at(x, y).real());
    return out;
}

/// The share of B's power that A lacks at low frequencies, where resampling leaves no alias but other faults show.
double residual_of(const ComplexGrid& a, const ComplexGrid& b) {
    double missing = 0, all = 0;
    for_band(a, [&](int x, int y, Vec f) {
        if (std::hypot(f.x, f.y) > residual_band || (x == 0 && y == 0)) return;
        missing += std::norm(b.at(x, y) - a.at(x, y));
        all += std::norm(b.at(x, y));
    });
    return all > 0 ? std::min(1.0, missing / all) : 1;
}

/// Shifts b back by ever better estimates, until the phases of what is left are flat; then once more against what a
/// looks like through b's filter.
Aligned align(View<const float> a, View<const float> b, Parallel parallel) {
    const auto crop = [](View<const float> v, const Axis& x, const Axis& y) {
        return cropped(v, static_cast<int>(x.begin), static_cast<int>(y.begin), x.count, y.count);
    };
    Axis x = overlap(a.width, 0), y = overlap(a.height, 0);
    Vec shift = coarse_shift(tapered_spectrum(crop(a, x, y)), tapered_spectrum(crop(b, x, y)));
    x = overlap(a.width, shift.x), y = overlap(a.height, shift.y);
    const double limit_x = std::abs(shift.x) + 2, limit_y = std::abs(shift.y) + 2;  // beyond it the crop is another

    const View<const float> part = crop(a, x, y);
    Image<float> back;
    ComplexGrid spectrum_a = tapered_spectrum(part), spectrum_b;
    const auto shift_back = [&] {
        back = run(shifted_bank(a.width, x, shift.x), shifted_bank(a.height, y, shift.y), b, parallel);
        spectrum_b = tapered_spectrum(back.view());
    };
    const auto refine = [&] {
        for (int step = 0; step < 6; ++step) {
            const Vec update = fit_plane(spectrum_a, spectrum_b);
            shift.x = std::clamp(shift.x + update.x, -limit_x, limit_x);
            shift.y = std::clamp(shift.y + update.y, -limit_y, limit_y);
            if (std::abs(update.x) < 1e-4 && std::abs(update.y) < 1e-4) return;
            shift_back();
        }
    };
    shift_back();
    refine();
    spectrum_a = tapered_spectrum(equalized(part, spectrum_a, spectrum_b).view());
    refine();
    return {part, std::move(back), shift, residual_of(spectrum_a, spectrum_b)};
}

// ---- What the images allow to say
// ------------------------------------------------------------------------------------

struct Gradient {
    Image<float> x, y;
};

/// Derivatives of a Gaussian of 1.5 samples: the same in all directions, and nothing left beyond the fitted band.
Gradient gradient(View<const float> v, Parallel parallel) {
    constexpr int radius = 6;
    Taps smooth{-radius, {}, 1}, slope{-radius, {}, 1};
    for (int i = -radius; i <= radius; ++i) {
        smooth.weights.push_back(std::exp(-i * i / (2 * 1.5 * 1.5)));
        slope.weights.push_back(i * smooth.weights.back());
    }
    const auto bank = [](const Taps& taps, int count) { return make_bank(taps, count, Edge::reflect); };
    return {run(bank(slope, v.width), bank(smooth, v.height), v, parallel),
            run(bank(smooth, v.width), bank(slope, v.height), v, parallel)};
}

/// Mean products of gradient components, the structure tensor, scaled to a trace of 1.
struct Tensor {
    double xx = 0, xy = 0, yy = 0;
};

Tensor tensor_of(const Gradient& g) {
    Tensor t;
    const View<const float> gx = g.x.view(), gy = g.y.view();
    const std::vector<double> wx = hann(gx.width), wy = hann(gx.height);  // borders reflect, and turn gradients there
    for (int y = 0; y < gx.height; ++y)
        for (int x = 0; x < gx.width; ++x) {
            const double weight = wx[static_cast<std::size_t>(x)] * wy[static_cast<std::size_t>(y)];
            const double dx = weight * double(gx(x, y)), dy = weight * double(gy(x, y));
            t.xx += dx * dx, t.xy += dx * dy, t.yy += dy * dy;
        }
    const double trace = t.xx + t.yy;
    if (trace > 0) t.xx /= trace, t.xy /= trace, t.yy /= trace;
    return t;
}

/// The directions along which an image varies most and least, and the share of the gradient's energy along the latter.
struct Directions {
    Vec most{1, 0}, least{0, 1};
    double least_share = 0;
};

Directions directions_of(const Tensor& t) {
    const double mean = (t.xx + t.yy) / 2, spread = std::hypot((t.xx - t.yy) / 2, t.xy);
    const double angle = std::atan2(2 * t.xy, t.xx - t.yy) / 2;
    const Vec most{std::cos(angle), std::sin(angle)};
    return {most, {-most.y, most.x}, std::max(0.0, mean - spread)};
}

Image<float> along(const Gradient& g, Vec direction) {
    Image<float> out(g.x.width(), g.x.height());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.view()(x, y) =
                static_cast<float>(direction.x * double(g.x.view()(x, y)) + direction.y * double(g.y.view()(x, y)));
    return out;
}

/// Whether the derivatives of two aligned images along a direction come from one scene: their phases agree.
bool agree(const Gradient& a, const Gradient& b, Vec direction) {
    const ComplexGrid fa = tapered_spectrum(along(a, direction).view());
    const ComplexGrid fb = tapered_spectrum(along(b, direction).view());
    double real = 0, power = 0, squares = 0;
    for_band(fa, [&](int x, int y, Vec) {
        const Complex c = fb.at(x, y) * std::conj(fa.at(x, y));
        real += c.real(), power += std::abs(c), squares += std::norm(c);
    });
    if (!(power > 0)) return false;
    // Half of the frequencies mirror the other half, and the taper couples 1.5 neighbours per axis.
    const double coupling = (fa.width > 1 ? 1.5 : 1) * (fa.height > 1 ? 1.5 : 1);
    const double independent = std::max(1.0, power * power / squares / 2 / coupling);
    const double deviation = 1 / std::sqrt(2 * independent);  // of the mean cosine of random phases
    return real / power >= std::clamp(5 * deviation, coherent, 0.95);
}

Shift solve(View<const float> a, View<const float> b, Parallel parallel);

/// The shift along x of images whose rows are all alike, or too few to tell.
Shift solve_along_x(View<const float> a, View<const float> b, Parallel parallel) {
    const Image<float> row_a = column_means(a, parallel), row_b = column_means(b, parallel);
    const Shift shift = solve(row_a.view(), row_b.view(), parallel);
    return {shift.x, {}, shift.residual};
}

Shift swapped(const Shift& shift) { return {shift.y, shift.x, shift.residual}; }

/// The same for images that vary along one direction only.
Shift solve_along(Vec direction, View<const float> a, View<const float> b, Parallel parallel) {
    if (a.width == 1 || a.height == 1) return {};
    if (std::abs(direction.y) < oblique) return solve_along_x(a, b, parallel);
    if (std::abs(direction.x) < oblique) return swapped(solve_along_x(transposed(a), transposed(b), parallel));
    return {};
}

Shift solve(View<const float> a, View<const float> b, Parallel parallel) {
    const Tensor ta = tensor_of(gradient(a, parallel)), tb = tensor_of(gradient(b, parallel));
    const Directions both = directions_of({ta.xx + tb.xx, ta.xy + tb.xy, ta.yy + tb.yy});
    const bool is_line = a.width == 1 || a.height == 1;
    if (!is_line && both.least_share < flat) return solve_along(both.most, a, b, parallel);

    const Aligned aligned = align(a, b, parallel);
    const Gradient ga = gradient(aligned.a, parallel), gb = gradient(aligned.b.view(), parallel);
    if (!agree(ga, gb, both.most)) return {};
    if (!is_line && !agree(ga, gb, both.least)) return solve_along(both.most, a, b, parallel);
    Shift shift{{}, {}, aligned.residual};
    if (a.width > 1) shift.x = aligned.shift.x;
    if (a.height > 1) shift.y = aligned.shift.y;
    return shift;
}

}  // namespace

ShiftWindow shift_window(int width, int height) {
    const int w = std::min(width, largest_window), h = std::min(height, largest_window);
    return {(width - w) / 2, (height - h) / 2, w, h};
}

Shift estimate_shift(View<const float> a, View<const float> b, Parallel parallel) {
    if (!same_shape(a, b) || a.width < 1 || a.height < 1 || a.channels < 1)
        fail("estimate_shift: images of ", a.width, " x ", a.height, " x ", a.channels, " and ", b.width, " x ",
             b.height, " x ", b.channels, "; pass images of one shape, with samples");
    const ShiftWindow w = shift_window(a.width, a.height);
    Image<float> window_a = mean_of_channels(cropped(a, w.x, w.y, w.width, w.height));
    Image<float> window_b = mean_of_channels(cropped(b, w.x, w.y, w.width, w.height));
    if (!standardize(window_a.view()) || !standardize(window_b.view())) return {};
    const View<const float> va = std::as_const(window_a).view(), vb = std::as_const(window_b).view();
    if (w.width < smallest_axis && w.height < smallest_axis) return {};
    if (w.height < smallest_axis) return solve_along_x(va, vb, parallel);
    if (w.width < smallest_axis) return swapped(solve_along_x(transposed(va), transposed(vb), parallel));
    return solve(va, vb, parallel);
}

}  // namespace bandlimit
