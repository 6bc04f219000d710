#include "bandlimit/filter/bilateral_upsample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bandlimit/core/error.h"
#include "bandlimit/filter/bilateral_tile.h"
#include "bandlimit/resample/mapping.h"
#include "bandlimit/resample/row_store.h"

namespace bandlimit {
namespace {

constexpr int least_rows = 16;  // of a piece

/// For each output of an axis: which samples it is made of, and their weights in space.
struct Windows {
    Windows(int inputs, int outputs, UpsampleWindow window, double sigma, int radius) {
        const Mapping mapping(Axis{inputs}, Axis{outputs});
        const bool is_bilinear = window == UpsampleWindow::bilinear;
        taps = is_bilinear ? 2 : 2 * radius + 1;
        for (int i = 0; i < outputs; ++i) {
            const Position at = mapping(i);
            const int whole = static_cast<int>(at.whole);
            if (is_bilinear) {
                first.push_back(whole);
                weights.insert(weights.end(), {1 - at.fraction, at.fraction});
                continue;
            }
            const int nearest = whole + (at.fraction > 0.5);
            first.push_back(nearest - radius);
            for (int k = -radius; k <= radius; ++k) {
                const double distance = nearest + k - whole - at.fraction;
                weights.push_back(k == 0 && sigma == 0 ? 1 : space_weight(distance, sigma));
            }
        }
    }
    IndexRange reach(int begin, int end) const {
        return {first[static_cast<std::size_t>(begin)], first[static_cast<std::size_t>(end - 1)] + taps};
    }
    const double* of(int i) const { return weights.data() + std::ptrdiff_t{i} * taps; }

    int taps = 0;
    std::vector<int> first;
    std::vector<double> weights;  ///< [outputs][taps]
};

struct Plan {
    Plan(int width_, int height_, const BilateralOptions& o, View<const float> full_, View<const float> guide_,
         UpsampleWindow window);

    int width, height;  ///< of the signal
    BilateralOptions options;
    View<const float> full, guide;
    Windows x, y;
};

void check(int width, int height, const BilateralOptions& o, View<const float> full, View<const float> guide) {
    constexpr const char* name = "bilateral_upsampler";
    if (width < 1 || height < 1 || full.width < 1 || full.height < 1)
        fail(name, ": from ", width, " x ", height, " to ", full.width, " x ", full.height,
             " samples; pass at least 1 x 1 of both");
    if (o.separable) fail(name, ": there is no separable form; leave it out");
    const RangeChannels range(o.sigma_range, full.channels);
    if (guide.width == 0) return;
    if (guide.width != width || guide.height != height)
        fail(name, ": a guide of ", guide.width, " x ", guide.height, " for a signal of ", width, " x ", height,
             "; pass one of the same size");
    if (guide.channels != full.channels)
        fail(name, ": guides of ", guide.channels, " and ", full.channels, " channels; pass two of the same kind");
}

Plan::Plan(int width_, int height_, const BilateralOptions& o, View<const float> full_, View<const float> guide_,
           UpsampleWindow window)
    : width(width_),
      height(height_),
      options(o),
      full(full_),
      guide(guide_),
      x((check(width, height, o, full, guide), Windows(width, full.width, window, o.sigma_space, bilateral_radius(o)))),
      y(height, full.height, window, o.sigma_space, bilateral_radius(o)) {}

/// Computes some rows of outputs.
class RowsRun {
public:
    RowsRun(const Plan& plan, const RowRun& run, IndexRange rows)
        : plan_(plan),
          run_(run),
          rows_(rows),
          guide_rows_{plan.guide, 0, {}},
          guides_self_(plan.guide.width == 0),
          range_(plan.options.sigma_range, plan.full.channels),
          tile_(plan.x.reach(0, plan.full.width), plan.y.reach(rows.begin, rows.end), run.channels, range_),
          out_(plan.full.width, rows.count(), run.channels, Layout::interleaved) {}

    /// Returns whether a value that is not finite was lost.
    bool operator()() {
        const BilateralOptions& o = plan_.options;
        tile_.load({run_.sources[0], plan_.height, o.edge_x, o.edge_y, o.premultiply},
                   {guides_self_ ? run_.sources[0] : guide_rows_, plan_.height, o.edge_x, o.edge_y, false});
        const int together = tile_.is_mixed() ? 1 : run_.channels;
        for (int c = 0; c < run_.channels; c += together) {
            tile_.mark(c, together);
            for (int y = rows_.begin; y < rows_.end; ++y)
                for (int x = 0; x < plan_.full.width; ++x) upsample(x, y, c, together);
        }
        return store();
    }

private:
    /// A sample of the window that counts.
    struct Tap {
        double weight, square;  ///< in space; the squared distance in range, in powers of 2
        int x, y;
    };

    /// Output (x, y) of channels [first, first + count).
    void upsample(int x, int y, int first, int count) {
        find_taps(x, y);
        float* const out = &out_.view()(x, y - rows_.begin);
        if (taps_.empty())
            return static_cast<void>(std::fill_n(out + first, count, std::numeric_limits<float>::quiet_NaN()));
        const Tap* nearest = &taps_[0];
        for (const Tap& tap : taps_)
            if (tap.square < nearest->square) nearest = &tap;
        double weights = 0;
        for (Tap& tap : taps_) weights += tap.weight *= std::exp2(nearest->square - tap.square);
        for (int c = first; c < first + count; ++c) {
            const double middle = signal(*nearest, c);
            double sum = 0;
            for (const Tap& tap : taps_) sum += tap.weight * (signal(tap, c) - middle);
            out[c] = static_cast<float>(middle + sum / weights);
        }
    }

    double signal(const Tap& tap, int c) { return static_cast<double>(*tile_.signal(tap.x, tap.y, c)); }

    void find_taps(int x, int y) {
        taps_.clear();
        const double* const along_x = plan_.x.of(x);
        const double* const along_y = plan_.y.of(y);
        find_own(x, y);
        for (int j = 0; j < plan_.y.taps; ++j)
            for (int i = 0; i < plan_.x.taps; ++i) {
                const double weight = along_x[i] * along_y[j];
                const int u = plan_.x.first[static_cast<std::size_t>(x)] + i;
                const int v = plan_.y.first[static_cast<std::size_t>(y)] + j;
                if (weight == 0 || std::isinf(*tile_.guide(u, v))) continue;
                taps_.push_back({weight, squared_range(tile_.guide(u, v)), u, v});
            }
    }

    /// Takes the guide at an output to own_: NaN where it is missing.
    void find_own(int x, int y) {
        own_.clear();
        for (const int c : range_.channels) {
            const float value = plan_.full(x, y, c);
            own_.push_back(static_cast<double>(std::isnan(value) ? value : limited_guide(value)));
        }
    }

    /// Over the channels that the output's guide has.
    double squared_range(const float* guide) const {
        double sum = 0;
        for (std::size_t c = 0; c < own_.size(); ++c, guide += tile_.plane()) {
            const double t = (static_cast<double>(*guide) - own_[c]) * static_cast<double>(range_.scales[c]);
            if (!std::isnan(own_[c])) sum += t * t;
        }
        return sum;
    }

    bool store() {
        RowStore store(run_, 0, plan_.full.width, plan_.options.premultiply);
        const auto length = static_cast<std::size_t>(plan_.full.width) * static_cast<std::size_t>(run_.channels);
        bool lost = false;
        for (int y = rows_.begin; y < rows_.end; ++y)
            lost |= store.store({&out_.view()(0, y - rows_.begin), length}, y);
        run_.monitor.made(static_cast<std::int64_t>(length) * rows_.count());
        return lost;
    }

    const Plan& plan_;
    const RowRun& run_;
    IndexRange rows_;
    SourceRows guide_rows_;
    bool guides_self_;
    RangeChannels range_;
    BilateralTile tile_;
    Image<float> out_;
    std::vector<Tap> taps_;
    std::vector<double> own_;
};

RowWork start(const Plan& plan, const RowRun& run) {
    if (plan.guide.width == 0 && run.channels != plan.full.channels)
        fail("bilateral_upsampler: a signal of ", run.channels, " channels as the guide of ", plan.full.channels,
             " channels; pass a guide of the signal's size");
    const RowParts parts(run.rows(), least_rows, std::numeric_limits<int>::max());
    return {parts.count(), [&plan, &run, parts](int i) { return RowsRun(plan, run, parts[i])(); }};
}

double bytes_of(const Plan& plan, int channels, const Parallel& parallel) {
    const IndexRange columns = plan.x.reach(0, plan.full.width);
    const double rows = plan.y.taps + least_rows * std::max(1.0, double(plan.height) / plan.full.height);
    const double samples =
        columns.count() * rows * (channels + plan.full.channels + 1) + double(plan.full.width) * least_rows * channels;
    return parallel.count() * samples * static_cast<double>(sizeof(float));
}

}  // namespace

RowFilter bilateral_upsampler(int width, int height, const BilateralOptions& options, View<const float> full_guide,
                              View<const float> guide, UpsampleWindow window) {
    check_bilateral(options);
    const auto plan = std::make_shared<const Plan>(width, height, options, full_guide, guide, window);
    return RowFilter(
        {.name = "bilateral_upsampler",
         .sources = {{width, height, options.edge_y}},
         .width = full_guide.width,
         .height = full_guide.height,
         .rows_read = [plan](std::size_t, int first, int last) { return plan->y.reach(first, last); },
         .bytes = [plan](int channels, const Parallel& parallel) { return bytes_of(*plan, channels, parallel); },
         .start = [plan](const RowRun& run) { return start(*plan, run); }});
}

Image<float> bilateral_upsampled(View<const float> signal, View<const float> guide, View<const float> full_guide,
                                 const BilateralOptions& options, UpsampleWindow window, const Parallel& parallel) {
    const RowFilter filter = bilateral_upsampler(signal.width, signal.height, options, full_guide, guide, window);
    Image<float> out(full_guide.width, full_guide.height, signal.channels);
    filter.run({signal, 0, {}}, {out.view(), 0, {}, {}}, parallel);
    return out;
}

}  // namespace bandlimit
