#include "bandlimit/filter/bilateral_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/filter/bilateral_rows.h"
#include "bandlimit/resample/row_loader.h"

namespace bandlimit {
namespace {

constexpr float missing = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int vector_floats = 16;

bool is_lost(int i, int n, Edge edge) { return edge == Edge::renormalize && (i < 0 || i >= n); }

}  // namespace

RangeChannels::RangeChannels(const std::vector<double>& sigmas, int count) {
    const auto given = static_cast<int>(sigmas.size());
    if (given != 1 && given != count)
        fail("sigma-range: ", given, " values for a guide of ", count, " channels; pass one for all, or one for each");
    for (int c = 0; c < count; ++c) {
        const double sigma = sigmas[static_cast<std::size_t>(given == 1 ? 0 : c)];
        if (std::isinf(sigma)) continue;
        channels.push_back(c);
        scales.push_back(static_cast<float>(range_scale(sigma)));
    }
    if (scales.empty()) scales.push_back(1);
}

double space_weight(double distance, double sigma) {
    if (distance == 0) return 1;
    return sigma > 0 ? std::exp(-0.5 * (distance / sigma) * (distance / sigma)) : 0;
}

float limited_guide(float value) {
    constexpr float farthest = 1e38f;
    return std::clamp(value, -farthest, farthest);
}

BilateralTile::BilateralTile(IndexRange columns, IndexRange rows, int signals, const RangeChannels& range)
    : columns_(columns), rows_(rows), signals_(signals), range_(range) {
    row_ = (columns.count() / vector_floats + 2) * vector_floats;
    plane_ = row_ * rows.count();
    is_read_.resize(static_cast<std::size_t>(rows.count()));
    samples_.resize(static_cast<std::size_t>(plane_ * (signals + range.count() + 1)));
}

void BilateralTile::load(const TileSource& signal, const TileSource& guide) {
    const int width = shape_of(signal.rows.samples).width, channels = shape_of(guide.rows.samples).channels;
    const RowLoader signals(signal.rows, columns_, signal.height, signal.edge_x, signal.edge_y, signal.premultiply);
    const RowLoader guides(guide.rows, columns_, guide.height, guide.edge_x, guide.edge_y, guide.premultiply);
    const auto length = static_cast<std::size_t>(columns_.count());
    std::vector<float> signal_row(length * static_cast<std::size_t>(signals_));
    std::vector<float> guide_row(length * static_cast<std::size_t>(channels));
    for (int y = rows_.begin; y < rows_.end; ++y) {
        if (is_lost(y, signal.height, signal.edge_y)) {
            for (int x = columns_.begin; x < columns_.end; ++x) lose(x, y);
            continue;
        }
        is_read_[static_cast<std::size_t>(y - rows_.begin)] = true;
        signals.load(y, signal_row.data());
        load_signal(y, signal_row.data());
        if (!range_.channels.empty()) {
            guides.load(y, guide_row.data());
            load_guide(y, guide_row.data(), channels);
        }
        for (int x = columns_.begin; x < columns_.end; ++x)
            if (is_lost(x, width, signal.edge_x)) lose(x, y);
        find_mixed(y);
    }
}

void BilateralTile::load_signal(int y, const float* from) {
    for (int c = 0; c < signals_; ++c) {
        float* const to = signal(columns_.begin, y, c);
        for (int i = 0; i < columns_.count(); ++i) to[i] = from[i * signals_ + c];
    }
}

void BilateralTile::load_guide(int y, const float* from, int channels) {
    float* const first = signal(columns_.begin, y, signals_);
    float* const centre = first + range_.count() * plane_;
    std::fill_n(centre, columns_.count(), 0.0f);
    for (int k = 0; k < range_.count(); ++k) {
        const int c = range_.channels[static_cast<std::size_t>(k)];
        float* const to = first + k * plane_;
        for (int i = 0; i < columns_.count(); ++i) {
            const float value = from[i * channels + c];
            to[i] = std::isnan(value) ? 0 : limited_guide(value);
            if (std::isnan(value)) centre[i] = nan;
        }
    }
    for (int i = 0; i < columns_.count(); ++i) {
        if (!std::isnan(centre[i])) {
            centre[i] = first[i];
            continue;
        }
        blind_.push_back({y, columns_.begin + i});
        for (const int c : range_.channels) {
            const float value = from[i * channels + c];
            blind_guides_.push_back(std::isnan(value) ? nan : limited_guide(value));
        }
    }
}

/// As if signal and guide were missing.
void BilateralTile::lose(int x, int y) {
    for (int c = 0; c < signals_; ++c) *signal(x, y, c) = nan;
    *signal(x, y, signals_ + range_.count()) = nan;
}

void BilateralTile::find_mixed(int y) {
    if (is_mixed_ || signals_ == 1) return;
    for (int x = columns_.begin; x < columns_.end; ++x) {
        int finite = 0;
        for (int c = 0; c < signals_; ++c) finite += std::isfinite(*signal(x, y, c));
        if (finite > 0 && finite < signals_) is_mixed_ = true;
    }
}

std::span<const float> BilateralTile::blind_guide(int x, int y) const {
    const auto found = std::lower_bound(blind_.begin(), blind_.end(), std::pair{y, x});
    const auto count = static_cast<std::size_t>(range_.count());
    return std::span(blind_guides_).subspan(static_cast<std::size_t>(found - blind_.begin()) * count, count);
}

void BilateralTile::mark(int first, int count) {
    for (int y = rows_.begin; y < rows_.end; ++y) {
        const float* const own = centre(columns_.begin, y);
        float* const marked = signal(columns_.begin, y, signals_);
        for (int i = 0; i < columns_.count(); ++i) {
            bool is_there = !std::isnan(own[i]);
            for (int c = first; c < first + count; ++c) is_there &= std::isfinite(*signal(columns_.begin + i, y, c));
            marked[i] = is_there ? own[i] : missing;
            if (is_there) continue;
            for (int c = first; c < first + count; ++c) *signal(columns_.begin + i, y, c) = 0;
        }
    }
}

}  // namespace bandlimit
