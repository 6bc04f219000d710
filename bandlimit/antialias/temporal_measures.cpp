#include "bandlimit/antialias/temporal_measures.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bandlimit/analysis/image_spectrum.h"
#include "bandlimit/color/transfer.h"
#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr float still_speed = 1e-3f;  // output pixels per frame

/// Linear light as a display shows it; what is no number is black.
float clamped(float linear) { return linear > 0 ? std::min(linear, 1.0f) : 0; }

void check_shape(const char* name, const View<const float>& view, int width, int height, int least_channels) {
    if (view.width == width && view.height == height && view.channels >= least_channels) return;
    fail("TemporalMeter: ", name, " of ", view.width, " x ", view.height, " with ", view.channels, " channels; pass ",
         width, " x ", height, " with ", least_channels);
}

bool is_disoccluded(const ShownFrame& frame, int x, int y) {
    return frame.disocclusion.width > 0 && frame.disocclusion(x, y) >= 0.5f;
}

/// Between the four pixels about a place inside of `codes`.
float interpolated(View<const float> codes, float x, float y, int channel) {
    const int left = std::min(static_cast<int>(x), codes.width - 1), right = std::min(left + 1, codes.width - 1);
    const int top = std::min(static_cast<int>(y), codes.height - 1), bottom = std::min(top + 1, codes.height - 1);
    const float tx = x - static_cast<float>(left), ty = y - static_cast<float>(top);
    const float upper = (1 - tx) * codes(left, top, channel) + tx * codes(right, top, channel);
    const float lower = (1 - tx) * codes(left, bottom, channel) + tx * codes(right, bottom, channel);
    return (1 - ty) * upper + ty * lower;
}

std::optional<double> mean(double sum, double count) {
    return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

std::optional<double> root_mean(double sum, double count) {
    return count > 0 ? std::optional<double>(std::sqrt(sum / count)) : std::nullopt;
}

}  // namespace

/// What a row adds to the sums of the meter: added up row after row, whoever measured them.
struct TemporalMeter::RowSums {
    double warped = 0, warped_count = 0, disoccluded = 0, disoccluded_count = 0, elsewhere = 0, elsewhere_count = 0;
};

TemporalMeter::TemporalMeter(int width, int height) {
    if (width < 1 || height < 1) fail("TemporalMeter: ", width, " x ", height, " pixels; pass at least 1 x 1");
    for (Image<float>* image : {&mean_, &spread_, &before_, &now_})
        *image = Image<float>(width, height, 3, Layout::interleaved);
    moved_ = Image<float>(width, height);
}

void TemporalMeter::add(const ShownFrame& frame, const Parallel& parallel) {
    const int width = mean_.width(), height = mean_.height();
    check_shape("shown", frame.shown, width, height, 3);
    if (frame.truth.width > 0) check_shape("truth", frame.truth, width, height, 3);
    if (frame.motion.width > 0) check_shape("motion", frame.motion, width, height, 2);
    if (frame.disocclusion.width > 0) check_shape("disocclusion", frame.disocclusion, width, height, 1);
    std::vector<RowSums> rows(static_cast<std::size_t>(height));
    ++frames_;
    parallel_for(height, 8, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t y = begin; y < end; ++y)
            add_row(frame, static_cast<int>(y), rows[static_cast<std::size_t>(y)]);
    });
    for (const RowSums& row : rows) {
        warped_ += row.warped, warped_count_ += row.warped_count;
        disoccluded_ += row.disoccluded, disoccluded_count_ += row.disoccluded_count;
        elsewhere_ += row.elsewhere, elsewhere_count_ += row.elsewhere_count;
    }
    std::swap(before_, now_);
}

void TemporalMeter::add_row(const ShownFrame& frame, int y, RowSums& sums) {
    for (int x = 0; x < mean_.width(); ++x) {
        if (frame.motion.width > 0 && !(std::hypot(frame.motion(x, y, 0), frame.motion(x, y, 1)) <= still_speed))
            moved_.view()(x, y) = 1;
        for (int c = 0; c < 3; ++c) {
            const float light = clamped(frame.shown(x, y, c));
            const auto code = static_cast<float>(linear_to_srgb(static_cast<double>(light)));
            now_.view()(x, y, c) = code;
            // Welford 1962: loses no digits where the spread is small.
            float& mean = mean_.view()(x, y, c);
            const float difference = code - mean;
            mean += difference / static_cast<float>(frames_);
            spread_.view()(x, y, c) += difference * (code - mean);
            if (frame.truth.width == 0) continue;
            const double error = static_cast<double>(light) - static_cast<double>(clamped(frame.truth(x, y, c)));
            const bool is_new = is_disoccluded(frame, x, y);
            (is_new ? sums.disoccluded : sums.elsewhere) += error * error;
            (is_new ? sums.disoccluded_count : sums.elsewhere_count) += 1;
        }
    }
    if (frames_ > 1) compare_to_before(frame, y, sums);
}

void TemporalMeter::compare_to_before(const ShownFrame& frame, int y, RowSums& sums) const {
    const View<const float> before = before_.view();
    for (int x = 0; x < before.width; ++x) {
        const float from_x = static_cast<float>(x) + (frame.motion.width > 0 ? frame.motion(x, y, 0) : 0);
        const float from_y = static_cast<float>(y) + (frame.motion.width > 0 ? frame.motion(x, y, 1) : 0);
        const bool is_inside = from_x >= 0 && from_y >= 0 && from_x <= static_cast<float>(before.width - 1) &&
                               from_y <= static_cast<float>(before.height - 1);
        if (!is_inside || is_disoccluded(frame, x, y)) continue;
        for (int c = 0; c < 3; ++c)
            sums.warped +=
                static_cast<double>(std::abs(now_.view()(x, y, c) - interpolated(before, from_x, from_y, c)));
        sums.warped_count += 3;
    }
}

TemporalMeasures TemporalMeter::measures() const {
    TemporalMeasures m;
    double deviation = 0, count = 0;
    for (int y = 0; y < mean_.height() && frames_ > 0; ++y)
        for (int x = 0; x < mean_.width(); ++x) {
            if (moved_.view()(x, y) != 0) continue;
            ++count;
            for (int c = 0; c < 3; ++c)
                deviation += std::sqrt(std::max(0.0, static_cast<double>(spread_.view()(x, y, c)) / frames_)) / 3;
        }
    if (frames_ > 1) m.flicker = mean(deviation, count);
    m.still = count / (static_cast<double>(mean_.width()) * mean_.height());
    m.warped_difference = mean(warped_, warped_count_);
    m.error_disoccluded = root_mean(disoccluded_, disoccluded_count_);
    m.error_elsewhere = root_mean(elsewhere_, elsewhere_count_);
    return m;
}

double energy_above_half_nyquist(View<const float> linear) {
    Image<float> light(linear.width, linear.height, std::min(linear.channels, 3));
    for (int c = 0; c < light.channels(); ++c)
        for (int y = 0; y < linear.height; ++y)
            for (int x = 0; x < linear.width; ++x) light.view()(x, y, c) = clamped(linear(x, y, c));
    const RadialSpectrum spectrum = radial_spectrum(light.view());
    double above = 0, all = 0;
    for (std::size_t bin = 0; bin < spectrum.power.size(); ++bin) {
        all += spectrum.power[bin];
        if (spectrum.frequency(static_cast<int>(bin)) >= 0.25) above += spectrum.power[bin];
    }
    return all > 0 ? above / all : 0;
}

}  // namespace bandlimit
