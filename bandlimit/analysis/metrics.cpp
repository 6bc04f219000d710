#include "bandlimit/analysis/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bandlimit/analysis/finite.h"
#include "bandlimit/core/error.h"
#include "bandlimit/resample/apply.h"

namespace bandlimit {
namespace {

constexpr int window_radius = 5, window_size = 2 * window_radius + 1;
constexpr int block_rows = 64;
constexpr int strip_columns = 512;  // measured at a time by one thread, so that its moments stay in its cache
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;

int inner(int size, int border) { return size - 2 * border; }

void check_meter(const char* function, int width, int height, int channels, int border) {
    if (width < 1 || height < 1 || channels < 1)
        fail(function, ": images of ", width, " x ", height, " x ", channels, "; pass at least one sample");
    if (border < 0 || border > (std::min(width, height) - 1) / 2)
        fail(function, ": border = ", border, " of ", width, " x ", height, " samples; pass 0 to ",
             (std::min(width, height) - 1) / 2, ", so that something is left");
}

void check_rows(const char* function, View<const float> a, View<const float> b, int width, int channels, int room) {
    if (!same_shape(a, b) || a.width != width || a.channels != channels || a.height > room)
        fail(function, ": blocks of ", a.width, " x ", a.height, " x ", a.channels, " and ", b.width, " x ", b.height,
             " x ", b.channels, " where ", width, " x at most ", room, " x ", channels, " are expected");
}

void check_complete(const char* function, int rows, int height) {
    if (rows != height) fail(function, ": ", rows, " of ", height, " rows were added; add all of them first");
}

Taps gaussian_window() {
    Taps taps{-window_radius, {}, 1};
    double total = 0;
    for (int i = -window_radius; i <= window_radius; ++i) {
        taps.weights.push_back(std::exp(-i * i / (2 * 1.5 * 1.5)));
        total += taps.weights.back();
    }
    for (double& w : taps.weights) w /= total;
    return taps;
}

/// The window at every position where it lies inside `count` samples, or at all of them, with reflected borders.
Bank window_bank(int count, bool reflected) {
    const Axis whole{count, 0, double(count)};
    return make_bank(gaussian_window(), whole, reflected ? whole : whole.cells(window_radius, count - window_radius),
                     Edge::reflect);
}

/// Structural similarity from the window's means of s = a + b - 1, d = a - b and of their squares.
///
/// Sum and difference need one moment less than a and b, and keep the difference of nearly equal images precise:
/// 4 mu_a mu_b = mu_s'^2 - mu_d^2 and 4 cov(a, b) = var(s) - var(d), with mu_s' = mu_s + 1, the mean of a + b.
double similarity(double mu_s, double mu_d, double mean_s2, double mean_d2) {
    const double var_s = std::max(0.0, mean_s2 - mu_s * mu_s), var_d = std::max(0.0, mean_d2 - mu_d * mu_d);
    const double s2 = (mu_s + 1) * (mu_s + 1), d2 = mu_d * mu_d;
    return (s2 - d2 + 2 * c1) / (s2 + d2 + 2 * c1) * ((var_s - var_d + 2 * c2) / (var_s + var_d + 2 * c2));
}

/// Sum, difference, and the squares of both.
Image<float> moments_of(View<const float> sum_and_difference) {
    const View<const float> from = sum_and_difference;
    Image<float> moments(from.width, from.height, 4);
    const View<float> m = moments.view();
    for (int y = 0; y < from.height; ++y)
        for (int p = 0; p < 2; ++p)
            for (int x = 0; x < from.width; ++x) {
                const float value = from(x, y, p);
                m(x, y, p) = value;
                m(x, y, p + 2) = value * value;
            }
    return moments;
}

/// Runs rows, then columns, a plane at a time: the lanes of a single plane are contiguous along y.
Image<float> windowed(const Bank& along_x, const Bank& along_y, View<const float> planes) {
    Image<float> rows(along_x.output_count(), planes.height, planes.channels);
    apply(along_x, planes, rows.view(), {1});
    Image<float> means(along_x.output_count(), along_y.output_count(), planes.channels);
    for (int p = 0; p < planes.channels; ++p)
        apply(along_y, transposed(channels_of(std::as_const(rows).view(), p)), transposed(channels_of(means.view(), p)),
              {1});
    return means;
}

/// The similarities of row `y` of such means, added up.
double row_similarity(View<const float> m, int y) {
    double total = 0;
    for (int x = 0; x < m.width; ++x)
        total += similarity(double(m(x, y, 0)), double(m(x, y, 1)), double(m(x, y, 2)), double(m(x, y, 3)));
    return total;
}

}  // namespace

double Measures::psnr() const { return mse == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(mse); }

ErrorMeter::ErrorMeter(int width, int height, int channels, int border, Parallel parallel)
    : width_(width), height_(height), border_(border), parallel_(parallel) {
    check_meter("ErrorMeter", width, height, channels, border);
    square_.resize(static_cast<std::size_t>(channels));
    largest_.resize(static_cast<std::size_t>(channels));
}

void ErrorMeter::add_rows(View<const float> a, View<const float> b) {
    const auto channels = square_.size();
    check_rows("ErrorMeter::add_rows", a, b, width_, static_cast<int>(channels), height_ - rows_);
    const int begin = std::max(0, border_ - rows_), end = std::min(a.height, height_ - border_ - rows_);
    rows_ += a.height;
    if (begin >= end) return;
    const auto count = static_cast<std::size_t>(end - begin) * channels;
    std::vector<double> square(count), largest(count);
    parallel_for(end - begin, 16, parallel_, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (std::ptrdiff_t row = first; row < last; ++row)
            for (int c = 0; c < a.channels; ++c) {
                const int y = begin + static_cast<int>(row);
                double total = 0, most = 0;
                for (int x = border_; x < width_ - border_; ++x) {
                    const double d = double(finite_or_zero(a(x, y, c))) - double(finite_or_zero(b(x, y, c)));
                    total += d * d;
                    most = std::max(most, std::abs(d));
                }
                const std::size_t at = static_cast<std::size_t>(row) * channels + static_cast<std::size_t>(c);
                square[at] = total;
                largest[at] = most;
            }
    });
    for (std::size_t i = 0; i < count; ++i) {
        square_[i % channels] += square[i];
        largest_[i % channels] = std::max(largest_[i % channels], largest[i]);
    }
}

void ErrorMeter::fill(std::vector<Measures>& per_channel) const {
    check_complete("ErrorMeter::fill", rows_, height_);
    per_channel.resize(square_.size());
    for (std::size_t c = 0; c < square_.size(); ++c) {
        per_channel[c].mse = square_[c] / (double(inner(width_, border_)) * inner(height_, border_));
        per_channel[c].max_abs = largest_[c];
    }
}

SsimMeter::SsimMeter(int width, int height, int channels, int border, Parallel parallel)
    : width_(width), height_(height), border_(border), parallel_(parallel) {
    check_meter("SsimMeter", width, height, channels, border);
    const int w = inner(width, border), h = inner(height, border);
    small_ = std::min(w, h) < window_size;
    planes_ = Image<float>(w, small_ ? h : std::min(h, block_rows + window_size - 1), 2 * channels);
    total_.resize(static_cast<std::size_t>(channels));
}

void SsimMeter::hold_row(View<const float> a, View<const float> b, int y) {
    const View<float> planes = planes_.view();
    for (int c = 0; c < a.channels; ++c)
        for (int x = 0; x < planes.width; ++x) {
            const float va = finite_or_zero(a(x + border_, y, c)), vb = finite_or_zero(b(x + border_, y, c));
            planes(x, held_, 2 * c) = (va - 0.5f) + (vb - 0.5f);
            planes(x, held_, 2 * c + 1) = va - vb;
        }
    ++held_;
}

void SsimMeter::measure_held() {
    const View<float> held = cropped(planes_.view(), 0, 0, planes_.width(), held_);
    const int beyond = small_ ? 0 : window_size - 1;  // columns that the window reaches, left and right together
    const int columns = held.width - beyond, strip = small_ ? columns : std::min(columns, strip_columns);
    const int strips = (columns - 1) / strip + 1;
    const Bank along_y = window_bank(held_, small_), along_x = window_bank(strip + beyond, small_);
    const Bank along_last = window_bank(columns - (strips - 1) * strip + beyond, small_);
    const std::size_t channels = total_.size(), jobs = static_cast<std::size_t>(strips) * channels;
    const int rows = along_y.output_count();
    std::vector<double> sums(static_cast<std::size_t>(rows) * jobs);  // of rows, then strips, then channels
    parallel_for(static_cast<std::ptrdiff_t>(jobs), 1, parallel_, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (auto job = static_cast<std::size_t>(first); job < static_cast<std::size_t>(last); ++job) {
            const int s = static_cast<int>(job / channels), c = static_cast<int>(job % channels), x = s * strip;
            const View<const float> part = cropped(held, x, 0, std::min(strip, columns - x) + beyond, held_);
            const Image<float> means = windowed(s + 1 < strips ? along_x : along_last, along_y,
                                                moments_of(channels_of(part, 2 * c, 2)).view());
            for (int y = 0; y < rows; ++y)
                sums[static_cast<std::size_t>(y) * jobs + job] = row_similarity(means.view(), y);
        }
    });
    for (std::size_t i = 0; i < sums.size(); ++i) total_[i % channels] += sums[i];
    positions_ += double(columns) * rows;
    if (small_) return;
    // The next window begins in the rows that this one ended with.
    const int kept = window_size - 1;
    for (int p = 0; p < held.channels; ++p)
        for (int y = 0; y < kept; ++y) std::copy_n(&held(0, held_ - kept + y, p), held.width, &held(0, y, p));
    held_ = kept;
}

void SsimMeter::add_rows(View<const float> a, View<const float> b) {
    check_rows("SsimMeter::add_rows", a, b, width_, static_cast<int>(total_.size()), height_ - rows_);
    for (int y = 0; y < a.height; ++y, ++rows_) {
        if (rows_ < border_ || rows_ >= height_ - border_) continue;
        hold_row(a, b, y);
        if (held_ == planes_.height() || rows_ == height_ - border_ - 1) measure_held();
    }
}

void SsimMeter::fill(std::vector<Measures>& per_channel) const {
    check_complete("SsimMeter::fill", rows_, height_);
    per_channel.resize(total_.size());
    for (std::size_t c = 0; c < total_.size(); ++c) per_channel[c].ssim = total_[c] / positions_;
}

Metrics summarize(std::vector<Measures> per_channel) {
    Metrics all;
    all.ssim = 0;
    const auto channels = static_cast<double>(per_channel.size());
    for (const Measures& m : per_channel) {
        all.mse += m.mse / channels;
        all.ssim += m.ssim / channels;
        all.max_abs = std::max(all.max_abs, m.max_abs);
    }
    all.per_channel = std::move(per_channel);
    return all;
}

namespace {

template <class... Meters>
Metrics measure(View<const float> a, View<const float> b, int border, Parallel parallel) {
    if (!same_shape(a, b))
        fail("compare: images of ", a.width, " x ", a.height, " x ", a.channels, " and ", b.width, " x ", b.height,
             " x ", b.channels, "; pass images of one shape");
    std::vector<Measures> per_channel;
    const auto run = [&](auto meter) {
        meter.add_rows(a, b);
        meter.fill(per_channel);
    };
    (run(Meters(a.width, a.height, a.channels, border, parallel)), ...);
    return summarize(std::move(per_channel));
}

}  // namespace

Metrics compare(View<const float> a, View<const float> b, int border, Parallel parallel) {
    return measure<ErrorMeter, SsimMeter>(a, b, border, parallel);
}

double mse(View<const float> a, View<const float> b, int border) { return measure<ErrorMeter>(a, b, border, {}).mse; }

double psnr(View<const float> a, View<const float> b, int border) {
    return measure<ErrorMeter>(a, b, border, {}).psnr();
}

double max_abs(View<const float> a, View<const float> b, int border) {
    return measure<ErrorMeter>(a, b, border, {}).max_abs;
}

double ssim(View<const float> a, View<const float> b, int border) { return measure<SsimMeter>(a, b, border, {}).ssim; }

}  // namespace bandlimit
