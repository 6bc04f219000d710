#include "bandlimit/filter/bilateral.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/filter/bilateral_rows.h"
#include "bandlimit/filter/bilateral_tile.h"
#include "bandlimit/resample/row_store.h"

namespace bandlimit {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int least_columns = 512, least_rows = 64;  // of a tile

void check_sigma(const char* option, double sigma) {
    if (!(sigma >= 0)) fail(option, ": ", sigma, " is out of range; pass 0 or more, or inf");
}

/// Weights [2 radius_y + 1][2 radius_x + 1].
std::vector<float> space_weights(double sigma, int radius_x, int radius_y) {
    std::vector<float> weights;
    for (int j = -radius_y; j <= radius_y; ++j)
        for (int i = -radius_x; i <= radius_x; ++i)
            weights.push_back(static_cast<float>(space_weight(i, sigma) * space_weight(j, sigma)));
    return weights;
}

/// How far a window reaches along an axis of `samples` before all is missing or has weight 0.
int trimmed(int radius, double sigma, int samples, Edge edge) {
    if (edge == Edge::renormalize) radius = std::min(radius, std::max(0, samples - 1));
    while (radius > 0 && static_cast<float>(space_weight(radius, sigma)) == 0) --radius;
    return radius;
}

/// A filter ready to run.
struct Plan {
    Plan(int width_, int height_, const BilateralOptions& o, View<const float> guide_);

    IndexRange rows_read(int first, int last) const { return {first - radius_y, last + radius_y}; }
    double bytes(int channels, const Parallel& parallel) const;

    int width, height;
    BilateralOptions options;
    View<const float> guide;  ///< of width 0: none
    int radius_x, radius_y;
    std::vector<float> window, row, column;  ///< weights in space
};

Plan::Plan(int width_, int height_, const BilateralOptions& o, View<const float> guide_)
    : width(width_),
      height(height_),
      options(o),
      guide(guide_),
      radius_x(trimmed(bilateral_radius(o), o.sigma_space, width, o.edge_x)),
      radius_y(trimmed(bilateral_radius(o), o.sigma_space, height, o.edge_y)) {
    if (width < 1 || height < 1) fail("bilateral_filter: ", width, " x ", height, " samples; pass at least 1 x 1");
    if (guide.width > 0) {
        if (guide.width != width || guide.height != height)
            fail("bilateral_filter: a guide of ", guide.width, " x ", guide.height, " for a signal of ", width, " x ",
                 height, "; pass one of the same size");
        const RangeChannels check(o.sigma_range, guide.channels);
    }
    if (o.separable) {
        row = space_weights(o.sigma_space, radius_x, 0);
        column = space_weights(o.sigma_space, 0, radius_y);
    } else {
        window = space_weights(o.sigma_space, radius_x, radius_y);
    }
}

double Plan::bytes(int channels, const Parallel& parallel) const {
    const double columns = std::min(width, std::max(least_columns, 2 * radius_x)) + 2.0 * radius_x;
    const double rows = std::min(height, std::max(least_rows, 2 * radius_y)) + 2.0 * radius_y;
    const int guides = guide.width > 0 ? guide.channels : channels;
    return parallel.count() * columns * rows * static_cast<double>(sizeof(float)) * (2.0 * channels + guides + 1);
}

/// Output x, whose guide `own` is NaN where it is missing.
void fill_blind(const BilateralRow& row, int x, std::span<const float> own) {
    std::vector<double> sums(static_cast<std::size_t>(row.signals));
    const float* space = row.space;
    double weights = 0;
    for (int j = -row.radius_y; j <= row.radius_y; ++j)
        for (int i = -row.radius_x; i <= row.radius_x; ++i) {
            const std::ptrdiff_t at = j * row.row + i + x;
            float square = 0;
            for (std::size_t c = 0; c < own.size(); ++c) {
                const float t = (row.guide[static_cast<std::ptrdiff_t>(c) * row.plane + at] - own[c]) * row.scales[c];
                if (!std::isnan(own[c])) square = std::fma(t, t, square);
            }
            const double weight = std::isinf(row.guide[at]) ? 0.0 : static_cast<double>(*space * falloff(square));
            ++space;
            weights += weight;
            for (int c = 0; c < row.signals; ++c)
                sums[static_cast<std::size_t>(c)] += weight * static_cast<double>(row.signal[c * row.plane + at]);
        }
    for (int c = 0; c < row.signals; ++c)
        row.out[c * row.out_plane + x] =
            weights > 0 ? static_cast<float>(sums[static_cast<std::size_t>(c)] / weights) : nan;
}

/// Computes a tile of outputs.
class TileRun {
public:
    TileRun(const Plan& plan, const RowRun& run, IndexRange columns, IndexRange rows)
        : plan_(plan),
          run_(run),
          columns_(columns),
          rows_(rows),
          guide_rows_{plan.guide, 0, {}},
          guides_self_(plan.guide.width == 0),
          range_(plan.options.sigma_range, guides_self_ ? run.channels : plan.guide.channels),
          tile_({columns.begin - plan.radius_x, columns.end + plan.radius_x},
                {rows.begin - plan.radius_y, rows.end + plan.radius_y}, run.channels, range_),
          out_row_((columns.count() / 16 + 1) * 16),
          out_plane_(out_row_ * rows.count()),
          out_(static_cast<std::size_t>(out_plane_ * run.channels)) {}

    /// Returns whether a value that is not finite was lost.
    bool operator()() {
        const BilateralOptions& o = plan_.options;
        tile_.load({run_.sources[0], plan_.height, o.edge_x, o.edge_y, o.premultiply},
                   {guides_self_ ? run_.sources[0] : guide_rows_, plan_.height, o.edge_x, o.edge_y, false});
        const int together = tile_.is_mixed() ? 1 : run_.channels;
        for (int c = 0; c < run_.channels; c += together) filter(c, together);
        return store();
    }

private:
    void filter(int first, int count) {
        tile_.mark(first, count);
        if (!plan_.options.separable) return filter_rows(first, count, plan_.radius_x, plan_.radius_y, plan_.window);
        blur_along_x(first, count);
        tile_.mark(first, count);
        filter_rows(first, count, 0, plan_.radius_y, plan_.column);
    }

    void filter_rows(int first, int count, int radius_x, int radius_y, const std::vector<float>& space) {
        for (int y = rows_.begin; y < rows_.end; ++y)
            filter_row(y, first, count, radius_x, radius_y, space,
                       out_.data() + first * out_plane_ + (y - rows_.begin) * out_row_, out_plane_);
    }

    /// In place, in all rows of the tile.
    void blur_along_x(int first, int count) {
        std::vector<float> blurred(static_cast<std::size_t>(out_row_ * count));
        for (int y = rows_.begin - plan_.radius_y; y < rows_.end + plan_.radius_y; ++y) {
            if (tile_.is_lost_row(y)) continue;
            filter_row(y, first, count, plan_.radius_x, 0, plan_.row, blurred.data(), out_row_);
            for (int c = 0; c < count; ++c)
                std::copy_n(blurred.data() + c * out_row_, columns_.count(),
                            tile_.signal(columns_.begin, y, first + c));
        }
    }

    void filter_row(int y, int first, int count, int radius_x, int radius_y, const std::vector<float>& space,
                    float* out, std::ptrdiff_t out_plane) {
        const int x = columns_.begin;
        const BilateralRow row{.width = columns_.count(),
                               .signals = count,
                               .guides = range_.count(),
                               .radius_x = radius_x,
                               .radius_y = radius_y,
                               .space = space.data(),
                               .scales = range_.scales.data(),
                               .signal = tile_.signal(x, y, first),
                               .guide = tile_.guide(x, y),
                               .centre = tile_.centre(x, y),
                               .row = tile_.row(),
                               .plane = tile_.plane(),
                               .out = out,
                               .out_plane = out_plane};
        bilateral_row(row);
        for (int i = 0; i < row.width; ++i)
            if (tile_.is_blind(x + i, y)) fill_blind(row, i, tile_.blind_guide(x + i, y));
    }

    bool store() {
        RowStore store(run_, columns_.begin, columns_.count(), plan_.options.premultiply);
        std::vector<float> row(static_cast<std::size_t>(columns_.count()) * static_cast<std::size_t>(run_.channels));
        bool lost = false;
        for (int y = rows_.begin; y < rows_.end; ++y) {
            const float* const from = out_.data() + (y - rows_.begin) * out_row_;
            std::size_t k = 0;
            for (int i = 0; i < columns_.count(); ++i)
                for (int c = 0; c < run_.channels; ++c) row[k++] = from[c * out_plane_ + i];
            lost |= store.store(row, y);
            run_.monitor.made(std::int64_t{columns_.count()} * run_.channels);
        }
        return lost;
    }

    const Plan& plan_;
    const RowRun& run_;
    IndexRange columns_, rows_;
    SourceRows guide_rows_;
    bool guides_self_;
    RangeChannels range_;
    BilateralTile tile_;
    std::ptrdiff_t out_row_, out_plane_;
    std::vector<float, SampleAllocator<float>> out_;  ///< planes
};

RowWork start(const Plan& plan, const RowRun& run) {
    if (plan.guide.width == 0) const RangeChannels check(plan.options.sigma_range, run.channels);
    const int length = std::max(least_columns, 2 * plan.radius_x), across = (plan.width - 1) / length + 1;
    const RowParts rows(run.rows(), std::max(least_rows, 2 * plan.radius_y), std::numeric_limits<int>::max());
    return {rows.count() * across, [&plan, &run, rows, length, across](int piece) {
                const int first = piece % across * length;
                return TileRun(plan, run, {first, std::min(plan.width, first + length)}, rows[piece / across])();
            }};
}

}  // namespace

void check_bilateral(const BilateralOptions& o) {
    check_sigma("sigma-space", o.sigma_space);
    if (o.sigma_range.empty()) fail("sigma-range: no values; pass one for all channels of the guide, or one for each");
    for (const double sigma : o.sigma_range) check_sigma("sigma-range", sigma);
    if (o.radius) {
        if (*o.radius < 0 || *o.radius > most_bilateral_radius)
            fail("radius: ", *o.radius, " is out of range; pass 0 to ", most_bilateral_radius);
    } else if (!(3 * o.sigma_space <= most_bilateral_radius)) {
        fail("sigma-space: ", o.sigma_space, " asks for a window larger than the largest; pass a radius of 0 to ",
             most_bilateral_radius, " with it");
    }
}

int bilateral_radius(const BilateralOptions& o) {
    check_bilateral(o);
    return o.radius.value_or(static_cast<int>(std::ceil(3 * std::min(o.sigma_space, 1e6))));
}

RowFilter bilateral_filter(int width, int height, const BilateralOptions& options, View<const float> guide) {
    const auto plan = std::make_shared<const Plan>(width, height, options, guide);
    return RowFilter(
        {.name = "bilateral_filter",
         .sources = {{width, height, options.edge_y}},
         .width = width,
         .height = height,
         .rows_read = [plan](std::size_t, int first, int last) { return plan->rows_read(first, last); },
         .bytes = [plan](int channels, const Parallel& parallel) { return plan->bytes(channels, parallel); },
         .start = [plan](const RowRun& run) { return start(*plan, run); }});
}

Image<float> bilateral(View<const float> signal, const BilateralOptions& options, const Parallel& parallel) {
    return joint_bilateral(signal, {}, options, parallel);
}

Image<float> joint_bilateral(View<const float> signal, View<const float> guide, const BilateralOptions& options,
                             const Parallel& parallel) {
    const RowFilter filter = bilateral_filter(signal.width, signal.height, options, guide);
    Image<float> out(signal.width, signal.height, signal.channels);
    filter.run({signal, 0, {}}, {out.view(), 0, {}, {}}, parallel);
    return out;
}

}  // namespace bandlimit
