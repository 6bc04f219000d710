#include "bandlimit/filter/fft_filter.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/row_loader.h"

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

FftFilter::FftFilter(const WeightGrid& weights, int first_x, int first_y, int width, int height, Edge edge_x,
                     Edge edge_y, bool premultiply)
    : taps_x_(weights.width),
      taps_y_(weights.height),
      first_x_(first_x),
      first_y_(first_y),
      width_(width),
      height_(height),
      edge_x_(edge_x),
      edge_y_(edge_y),
      premultiply_(premultiply) {
    if (width < 1 || height < 1 || weights.width < 1 || weights.height < 1)
        fail("FftFilter: ", weights.width, " x ", weights.height, " weights on ", width, " x ", height,
             " samples; pass at least one of each");
    for (const double w : weights.weights)
        if (!std::isfinite(w)) fail("FftFilter: a weight is ", w, "; pass finite ones");
    border_ = BorderScale(weights, first_x, first_y, width, height, edge_x, edge_y);
    x_ = fft_tiles(weights.width, width);
    y_ = fft_tiles(weights.height, height);
    response_ = ComplexGrid(x_.size, y_.size);
    for (int y = 0; y < weights.height; ++y)
        for (int x = 0; x < weights.width; ++x) response_.at(x, y) = weights.at(x, y);
    fft(response_);
    for (Complex& value : response_.values) value = std::conj(value);
}

std::uint64_t FftFilter::bytes(int channels, Parallel parallel) const {
    const double samples = static_cast<double>(x_.size) * y_.size;
    const int runs = std::min(parallel.count(), x_.count * y_.count);
    return static_cast<std::uint64_t>(runs * samples * (sizeof(Complex) + 2.0 * sizeof(float) * channels));
}

IndexRange FftFilter::rows_needed(int first, int last) const {
    if (first < 0 || first >= last || last > height_)
        fail("FftFilter::rows_needed: rows ", first, " to ", last, " of ", height_, "; pass a part of them");
    const int begin = first / y_.outputs * y_.outputs;
    const int end = std::min(height_, ((last - 1) / y_.outputs + 1) * y_.outputs);
    const IndexRange stored = stored_indices({begin + first_y_, end + first_y_ + taps_y_ - 1}, height_, edge_y_);
    return stored.begin < stored.end ? stored : IndexRange{0, 0};
}

/// Computes tiles, in one thread.
class FftRun {
public:
    FftRun(const FftFilter& filter, const SourceRows& source, const TargetRows& target)
        : filter_(filter), source_(source), target_(target), channels_(shape_of(source.samples).channels) {}

    /// Tile (i, j): those of its rows that are in the target. Returns whether something not finite was lost.
    bool tile(int i, int j) {
        const int left = i * filter_.x_.outputs, top = j * filter_.y_.outputs;
        const int width = std::min(filter_.x_.outputs, filter_.width_ - left);
        const int height = std::min(filter_.y_.outputs, filter_.height_ - top);
        load(left, top, width + filter_.taps_x_ - 1, height + filter_.taps_y_ - 1);
        for (int c = 0; c < channels_; c += 2) filter(c, width, height);
        return store(left, top, width, height);
    }

private:
    /// Decodes the samples that the tile reads, and takes out what is not finite.
    void load(int left, int top, int width, int height) {
        input_ = Image<float>(width, height, channels_, Layout::interleaved);
        const IndexRange columns{left + filter_.first_x_, left + filter_.first_x_ + width};
        const RowLoader loader(source_, columns, filter_.height_, filter_.edge_x_, filter_.edge_y_,
                               filter_.premultiply_);
        lost_.clear();
        const std::size_t length = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_);
        for (int y = 0; y < height; ++y) {
            float* const row = &input_.view()(0, y);
            loader.load(top + filter_.first_y_ + y, row);
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
        grid_ = ComplexGrid(filter_.x_.size, filter_.y_.size);
        for (int y = 0; y < in.height; ++y)
            for (int x = 0; x < in.width; ++x)
                grid_.at(x, y) = {double(in(x, y, c)), both ? double(in(x, y, c + 1)) : 0.0};
        fft(grid_);
        for (std::size_t k = 0; k < grid_.values.size(); ++k) grid_.values[k] *= filter_.response_.values[k];
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
                for (int x = 0; x < filter_.taps_x_ - 1; ++x) inside += at(x);
                for (int x = 0; x < width; ++x) {
                    inside += at(x + filter_.taps_x_ - 1);
                    hit[static_cast<std::size_t>(x * channels_ + c)] = inside > 0;
                    inside -= at(x);
                }
            }
            for (int i = std::max(0, y - filter_.taps_y_ + 1); i <= std::min(y, height - 1); ++i)
                for (std::size_t k = 0; k < hit.size(); ++k)
                    if (hit[k]) (&out(0, i))[k] = std::numeric_limits<float>::quiet_NaN();
        }
    }

    bool store(int left, int top, int width, int height) {
        spread_lost(width, height);
        const AnyView targets = columns_of(target_.samples, left, width);
        const int target_end = target_.first_row + shape_of(target_.samples).height;
        bool lost = false;
        for (int y = std::max(top, target_.first_row); y < std::min(top + height, target_end); ++y) {
            const std::span<float> row{&output_.view()(0, y - top),
                                       static_cast<std::size_t>(width) * static_cast<std::size_t>(channels_)};
            filter_.border_.apply(row, left, y, channels_);
            lost |= encode_row(row, filter_.premultiply_ || source_.encoding.associated, targets, y - target_.first_row,
                               target_.encoding);
        }
        return lost;
    }

    struct Sample {
        int y, k;
    };

    const FftFilter& filter_;
    const SourceRows& source_;
    const TargetRows& target_;
    int channels_;
    Image<float> input_, output_;
    ComplexGrid grid_;
    std::vector<Sample> lost_;  ///< not finite; row after row
};

bool FftFilter::run(const SourceRows& source, const TargetRows& target, Parallel parallel) const {
    const ViewShape from = shape_of(source.samples), to = shape_of(target.samples);
    if (from.width != width_ || to.width != width_ || from.channels != to.channels || from.channels < 1)
        fail("FftFilter::run: source ", from.width, " wide with ", from.channels, " channels, target ", to.width,
             " with ", to.channels, "; need ", width_, " with equal channels");
    check_encoding("FftFilter::run", source.encoding, from.channels);
    check_encoding("FftFilter::run", target.encoding, to.channels);
    check_apart("FftFilter::run", source.samples, target.samples);
    if (to.height == 0) return false;
    const IndexRange needed = rows_needed(target.first_row, target.first_row + to.height);
    if (needed.begin < needed.end && (needed.begin < source.first_row || needed.end > source.first_row + from.height))
        fail("FftFilter::run: source rows ", source.first_row, " to ", source.first_row + from.height, "; rows ",
             needed.begin, " to ", needed.end, " are needed");
    const int first = target.first_row / y_.outputs;
    const int rows = (target.first_row + to.height - 1) / y_.outputs - first + 1;
    std::atomic<bool> lost = false;
    parallel_for(std::ptrdiff_t{rows} * x_.count, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        FftRun run(*this, source, target);
        for (std::ptrdiff_t i = begin; i < end; ++i)
            if (run.tile(static_cast<int>(i % x_.count), first + static_cast<int>(i / x_.count))) lost = true;
    });
    return lost;
}

}  // namespace bandlimit
