#include "bandlimit/filter/window_sums.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "bandlimit/core/allocator.h"
#include "bandlimit/core/error.h"
#include "bandlimit/filter/window_rows.h"

namespace bandlimit {
namespace {

using Doubles = std::vector<double, SampleAllocator<double>>;

constexpr int group = window_group;  // columns that begin anew together

std::size_t padded(int n) { return (static_cast<std::size_t>(n) + group - 1) / group * group; }

/// `planes` lines of the same length, each a multiple of the group and zeros at first.
class Lines {
public:
    Lines(int planes, int length, int before = 0) {
        const std::size_t lead = padded(before), stride = lead + padded(length);
        samples_.assign(stride * static_cast<std::size_t>(planes), 0.0);
        for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p)
            lines_.push_back(samples_.data() + p * stride + lead);
    }
    double* const* get() const { return lines_.data(); }
    double* operator[](int p) const { return lines_[static_cast<std::size_t>(p)]; }

private:
    Doubles samples_;
    std::vector<double*> lines_;
};

/// No sample outside adds anything, and none is further away than this.
bool adds_nothing_outside(Edge edge) { return edge == Edge::renormalize || edge == Edge::zero; }
int reach(int n, int radius, Edge edge) { return adds_nothing_outside(edge) ? std::min(radius, n - 1) : radius; }

/// The sums of a band of rows.
class Band {
public:
    Band(const BoxWindow& window, int planes, const FillRow& fill)
        : window_(window),
          planes_(planes),
          fill_(fill),
          rx_(reach(window.width, window.radius, window.edge)),
          ry_(reach(window.height, window.radius, window.edge)),
          columns_(planes, window.width + rx_ + 1, rx_),  // sum_blocks() reads one more
          entering_(planes, window.width),
          leaving_(planes, window.width),
          sums_(planes, window.width),
          fresh_(planes, group),
          suffix_(static_cast<std::size_t>(8) * static_cast<std::size_t>(2 * rx_ + 1)),
          begins_anew_(padded(window.width) / group) {}

    void run(IndexRange rows, const TakeSums& take) {
        begin(rows.begin);
        for (int y = rows.begin; y < rows.end; ++y) {
            if (y > rows.begin) slide(y);
            sum_along_x();
            take(y, sums_.get());
        }
    }

private:
    int stored_row(int y) const { return resolve(y, window_.height, window_.edge); }

    /// All columns, from the rows of the window about row y.
    void begin(int y) {
        for (int p = 0; p < planes_; ++p) std::fill_n(columns_[p], window_.width, 0.0);
        for (int v = y - ry_; v <= y + ry_; ++v) {
            const int row = stored_row(v);
            if (row < 0) continue;
            fill_(row, {0, window_.width}, entering_.get());
            for (int p = 0; p < planes_; ++p)
                slide_row(columns_[p], entering_[p], nullptr, window_.width, begins_anew_.data());
        }
    }

    /// The columns of a group, from the same, with the same bits.
    void begin_anew(int y, int g) {
        const IndexRange xs{g * group, std::min(window_.width, (g + 1) * group)};
        for (int p = 0; p < planes_; ++p) std::fill_n(columns_[p] + xs.begin, xs.count(), 0.0);
        for (int v = y - ry_; v <= y + ry_; ++v) {
            const int row = stored_row(v);
            if (row < 0) continue;
            fill_(row, xs, fresh_.get());
            for (int p = 0; p < planes_; ++p)
                for (int x = xs.begin; x < xs.end; ++x) columns_[p][x] += fresh_[p][x - xs.begin];
        }
    }

    /// From the windows about row y - 1 to those about row y.
    void slide(int y) {
        const int in = stored_row(y + ry_), out = stored_row(y - ry_ - 1);
        const IndexRange all{0, window_.width};
        if (in >= 0) fill_(in, all, entering_.get());
        if (out >= 0) fill_(out, all, leaving_.get());
        std::fill(begins_anew_.begin(), begins_anew_.end(), std::uint8_t{0});
        for (int p = 0; p < planes_; ++p)
            slide_row(columns_[p], in >= 0 ? entering_[p] : nullptr, out >= 0 ? leaving_[p] : nullptr, window_.width,
                      begins_anew_.data());
        for (std::size_t g = 0; g < begins_anew_.size(); ++g)
            if (begins_anew_[g] != 0) begin_anew(y, static_cast<int>(g));
    }

    void sum_along_x() {
        if (!adds_nothing_outside(window_.edge)) extend();
        std::vector<const double*> in;
        for (int p = 0; p < planes_; ++p) in.push_back(columns_[p] - rx_);
        sum_blocks(planes_, in.data(), sums_.get(), 2 * rx_ + 1, window_.width, suffix_.data());
    }

    /// What the columns outside hold.
    void extend() {
        for (int x = -rx_; x < window_.width + rx_; ++x) {
            if (x == 0) x = window_.width;
            if (x >= window_.width + rx_) break;
            for (int p = 0; p < planes_; ++p) columns_[p][x] = columns_[p][resolve(x, window_.width, window_.edge)];
        }
    }

    BoxWindow window_;
    int planes_;
    const FillRow& fill_;
    int rx_, ry_;
    Lines columns_, entering_, leaving_, sums_, fresh_;
    Doubles suffix_;
    std::vector<std::uint8_t> begins_anew_;
};

/// A power of two of bands, so that few threads share them evenly, and so few that their first windows cost little. It
/// does not depend on threads: where sums begin anew decides their last bits.
int band_count(int height, int radius) {
    const double least = std::max(32.0, 2.0 * (2.0 * radius + 1));
    int count = 1;
    while (count < 64 && height / (2.0 * count) >= least) count *= 2;
    return count;
}

}  // namespace

void window_sums(const BoxWindow& window, int planes, const FillRow& fill, const TakeSums& take,
                 const Parallel& parallel) {
    if (window.width < 1 || window.height < 1 || planes < 1)
        fail("window_sums: ", planes, " planes of ", window.width, " x ", window.height, "; pass at least 1 of each");
    if (window.radius < 0 || window.radius > BoxWindow::most_radius)
        fail("window_sums: radius = ", window.radius, "; pass 0 to ", BoxWindow::most_radius);
    const int bands = band_count(window.height, window.radius);
    const auto first_of = [&](std::ptrdiff_t band) { return static_cast<int>(band * window.height / bands); };
    parallel_for(bands, 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Band sums(window, planes, fill);
        for (std::ptrdiff_t b = begin; b < end; ++b) sums.run({first_of(b), first_of(b + 1)}, take);
    });
}

std::vector<double> window_counts(int n, int radius, Edge edge) {
    std::vector<double> counts(static_cast<std::size_t>(n), 2.0 * radius + 1);
    if (edge != Edge::renormalize) return counts;
    for (int i = 0; i < n; ++i)
        counts[static_cast<std::size_t>(i)] = std::min(n - 1, i + radius) - std::max(0, i - radius) + 1;
    return counts;
}

}  // namespace bandlimit
