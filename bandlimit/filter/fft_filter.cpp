#include "bandlimit/filter/fft_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/resample/border_scale.h"
#include "bandlimit/resample/row_loader.h"
#include "bandlimit/resample/row_store.h"

namespace bandlimit {
namespace {

using Complex = std::complex<double>;

/// Whether `n` is a product of 2, 3 and 5, whose transforms are fast.
bool is_smooth(int n) {
    for (const int p : {2, 3, 5})
        while (n % p == 0) n /= p;
    return n == 1;
}

}  // namespace

FftTiles fft_tiles(int weights, int samples) {
    const int whole = samples + weights - 1, largest = std::max(1024, 4 * weights);
    FftTiles best;
    double least = std::numeric_limits<double>::infinity();
    for (int size = weights; size <= std::max(largest, weights + 1); ++size) {
        if (!is_smooth(size)) continue;
        const int outputs = size - weights + 1, count = (samples - 1) / outputs + 1;
        const double cost = double(count) * size * std::log2(size + 1);
        if (cost < least) {
            least = cost;
            best = {size, outputs, count};
        }
        if (size >= whole) break;
    }
    return best;
}

namespace {

/// Weights ready to run.
struct FftPlan {
    FftPlan(const WeightGrid& weights, int first_x, int first_y, const FilterDomain& domain);

    double bytes(int channels, const Parallel& parallel) const {
        const int runs = std::min(parallel.count(), x.count * y.count);
        return runs * double(x.size) * y.size * (sizeof(Complex) + 2.0 * sizeof(float) * channels);
    }
    /// Those of whole tiles.
    IndexRange rows_read(int first, int last) const {
        const int begin = first / y.outputs * y.outputs;
        const int end = std::min(domain.height, ((last - 1) / y.outputs + 1) * y.outputs);
        return {begin + first_y, end + first_y + taps_y - 1};
    }

    FilterDomain domain;
    int taps_x, taps_y, first_x, first_y;
    FftTiles x, y;
    ComplexGrid response;  ///< of the weights, conjugate
    BorderScale border;
};

FftPlan::FftPlan(const WeightGrid& weights, int first_of_x, int first_of_y, const FilterDomain& on)
    : domain(on), taps_x(weights.width), taps_y(weights.height), first_x(first_of_x), first_y(first_of_y) {
    if (on.width < 1 || on.height < 1 || weights.width < 1 || weights.height < 1)
        fail("fft_filter: ", weights.width, " x ", weights.height, " weights on ", on.width, " x ", on.height,
             " samples; pass at least one of each");
    for (const double w : weights.weights)
        if (!std::isfinite(w)) fail("fft_filter: a weight is ", w, "; pass finite ones");
    border = BorderScale(weights, first_x, first_y, on.width, on.height, on.edge_x, on.edge_y);
    x = fft_tiles(weights.width, on.width);
    y = fft_tiles(weights.height, on.height);
    response = ComplexGrid(x.size, y.size);
    for (int j = 0; j < weights.height; ++j)
        for (int i = 0; i < weights.width; ++i) response.at(i, j) = weights.at(i, j);
    fft(response);
    for (Complex& value : response.values) value = std::conj(value);
}

/// Computes tiles, in one thread.
class FftRun {
public:
    FftRun(const FftPlan& plan, const RowRun& run) : plan_(plan), run_(run), channels_(run.channels) {}

    /// Tile (i, j): those of its rows that are in the target. Returns whether something not finite was lost.
    bool tile(int i, int j) {
        const int left = i * plan_.x.outputs, top = j * plan_.y.outputs;
        const int width = std::min(plan_.x.outputs, plan_.domain.width - left);
        const int height = std::min(plan_.y.outputs, plan_.domain.height - top);
        load(left, top, width + plan_.taps_x - 1, height + plan_.taps_y - 1);
        for (int c = 0; c < channels_; c += 2) filter(c, width, height);
        return store(left, top, width, height);
    }

private:
    /// Decodes the samples that the tile reads, and takes out what is not finite.
    void load(int left, int top, int width, int height) {
        input_ = Image<float>(width, height, channels_, Layout::interleaved);
        const IndexRange columns{left + plan_.first_x, left + plan_.first_x + width};
        const RowLoader loader(run_.sources[0], columns, plan_.domain.height, plan_.domain.edge_x, plan_.domain.edge_y,
                               plan_.domain.premultiply);
        lost_.clear();
        const std::size_t length = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_);
        for (int y = 0; y < height; ++y) {
            float* const row = &input_.view()(0, y);
            loader.load(top + plan_.first_y + y, row);
            for (std::size_t k = 0; k < length; ++k) {
                if (std::isfinite(row[k])) continue;
                row[k] = 0;
                lost_.push_back({y, static_cast<int>(k)});
            }
        }
    }

    /// Channels c and c + 1, if there are so many, of the outputs into output_.
    void filter(int c, int width, int height) {
        const bool both = c + 1 < channels_;
        const View<const float> in = input_.view();
        grid_ = ComplexGrid(plan_.x.size, plan_.y.size);
        for (int y = 0; y < in.height; ++y)
            for (int x = 0; x < in.width; ++x)
                grid_.at(x, y) = {double(in(x, y, c)), both ? double(in(x, y, c + 1)) : 0.0};
        fft(grid_);
        for (std::size_t k = 0; k < grid_.values.size(); ++k) grid_.values[k] *= plan_.response.values[k];
        inverse_fft(grid_);
        if (c == 0) output_ = Image<float>(width, height, channels_, Layout::interleaved);
        const View<float> out = output_.view();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                out(x, y, c) = static_cast<float>(grid_.at(x, y).real());
                if (both) out(x, y, c + 1) = static_cast<float>(grid_.at(x, y).imag());
            }
    }

    /// Makes NaN of all outputs that read what was taken out. Each row of samples is gone through once per row of
    /// weights, however many were taken out.
    void spread_lost(int width, int height) {
        const View<float> out = output_.view();
        std::size_t next = 0;
        while (next < lost_.size()) {
            const int y = lost_[next].y;
            std::vector<int> row(static_cast<std::size_t>(input_.width()) * static_cast<std::size_t>(channels_));
            for (; next < lost_.size() && lost_[next].y == y; ++next) row[static_cast<std::size_t>(lost_[next].k)] = 1;
            std::vector<char> hit(static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_));
            for (int c = 0; c < channels_; ++c) {
                int inside = 0;  // how many of those that the output at x reads
                const auto at = [&](int x) { return row[static_cast<std::size_t>(x * channels_ + c)]; };
                for (int x = 0; x < plan_.taps_x - 1; ++x) inside += at(x);
                for (int x = 0; x < width; ++x) {
                    inside += at(x + plan_.taps_x - 1);
                    hit[static_cast<std::size_t>(x * channels_ + c)] = inside > 0;
                    inside -= at(x);
                }
            }
            for (int i = std::max(0, y - plan_.taps_y + 1); i <= std::min(y, height - 1); ++i)
                for (std::size_t k = 0; k < hit.size(); ++k)
                    if (hit[k]) (&out(0, i))[k] = std::numeric_limits<float>::quiet_NaN();
        }
    }

    bool store(int left, int top, int width, int height) {
        spread_lost(width, height);
        RowStore store(run_, left, width, plan_.domain.premultiply);
        const IndexRange rows = run_.rows();
        const int first = std::max(top, rows.begin), last = std::min(top + height, rows.end);
        bool lost = false;
        for (int y = first; y < last; ++y) {
            const std::span<float> row{&output_.view()(0, y - top),
                                       static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_)};
            plan_.border.apply(row, left, y, channels_);
            lost |= store.store(row, y);
        }
        run_.monitor.made(std::int64_t{last - first} * width * channels_);
        return lost;
    }

    struct Sample {
        int y, k;
    };

    const FftPlan& plan_;
    const RowRun& run_;
    int channels_;
    Image<float> input_, output_;
    ComplexGrid grid_;
    std::vector<Sample> lost_;  ///< not finite; row after row
};

RowWork start(const FftPlan& plan, const RowRun& run) {
    const IndexRange rows = run.rows();
    const int first = rows.begin / plan.y.outputs, last = (rows.end - 1) / plan.y.outputs + 1;
    return {(last - first) * plan.x.count, [&plan, &run, first](int piece) {
                return FftRun(plan, run).tile(piece % plan.x.count, first + piece / plan.x.count);
            }};
}

}  // namespace

RowFilter fft_filter(const WeightGrid& weights, int first_x, int first_y, const FilterDomain& domain) {
    const auto plan = std::make_shared<const FftPlan>(weights, first_x, first_y, domain);
    return RowFilter(
        {.name = "fft_filter",
         .sources = {{domain.width, domain.height, domain.edge_y}},
         .width = domain.width,
         .height = domain.height,
         .rows_read = [plan](std::size_t, int first, int last) { return plan->rows_read(first, last); },
         .bytes = [plan](int channels, const Parallel& parallel) { return plan->bytes(channels, parallel); },
         .start = [plan](const RowRun& run) { return start(*plan, run); }});
}

}  // namespace bandlimit
