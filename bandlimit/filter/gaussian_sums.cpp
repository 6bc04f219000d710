#include "bandlimit/filter/gaussian_sums.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/filter/window_rows.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {
namespace {

constexpr int least_tile = 32;

std::vector<double> gaussian_weights(double sigma, int reach) {
    std::vector<double> weights;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i) {
        weights.push_back(i == 0 ? 1 : std::exp(-i * i / (2 * sigma * sigma)));
        sum += weights.back();
    }
    for (double& w : weights) w /= sum;
    return weights;
}

/// Rows of doubles, each with memory for a multiple of window_group.
struct Rows {
    Rows(int planes, int count) {
        const std::size_t stride = (static_cast<std::size_t>(count) / window_group + 1) * window_group;
        samples.resize(stride * static_cast<std::size_t>(planes));
        for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p) lines.push_back(samples.data() + p * stride);
    }
    std::vector<double> samples;
    std::vector<double*> lines;
};

class Tiles {
public:
    explicit Tiles(const GaussianWindow& window)
        : window_(window),
          reach_(static_cast<int>(std::ceil(4 * window.sigma))),
          tile_(std::max(least_tile, reach_)),
          side_(tile_ + 2 * reach_),
          filter_(filter_of(window.sigma, reach_, side_)) {}

    int columns() const { return (window_.width - 1) / tile_ + 1; }
    int count() const { return columns() * ((window_.height - 1) / tile_ + 1); }

    void run(int index, const std::function<TileWork(const GaussianTile&)>& start) const {
        const int left = index % columns() * tile_, top = index / columns() * tile_;
        const GaussianTile tile{{left, std::min(window_.width, left + tile_)},
                                {top, std::min(window_.height, top + tile_)},
                                source_of(left, window_.width),
                                source_of(top, window_.height)};
        const TileWork work = start(tile);
        const Image<float> block = gathered(tile, work);
        Image<float> means(side_, tile_, window_.planes);
        filter_.run({block.view(), 0, {}}, {means.view(), reach_, {}, {}}, {.threads = 1});
        hand_over(means, tile, work);
    }

private:
    static RowFilter filter_of(double sigma, int reach, int side) {
        const std::vector<double> weights = gaussian_weights(sigma, reach);
        return term_filter({{weights, weights}}, -reach, -reach, {side, side, Edge::zero, Edge::zero, false});
    }

    IndexRange source_of(int first, int n) const {
        return stored_indices({first - reach_, first + tile_ + reach_}, n, window_.edge);
    }

    Image<float> gathered(const GaussianTile& tile, const TileWork& work) const {
        Image<float> block(side_, side_, window_.planes);
        Rows row(window_.planes, tile.source_xs.count()), outside(window_.planes, 1);
        if (window_.edge == Edge::zero) work.fill(-1, {0, 1}, outside.lines.data());
        for (int v = 0; v < side_; ++v) {
            const int y = resolve(tile.ys.begin - reach_ + v, window_.height, window_.edge);
            if (y >= 0) work.fill(y, tile.source_xs, row.lines.data());
            for (int u = 0; u < side_; ++u) {
                const int x = y < 0 ? -1 : resolve(tile.xs.begin - reach_ + u, window_.width, window_.edge);
                for (std::size_t p = 0; p < row.lines.size(); ++p)
                    block.view()(u, v, static_cast<int>(p)) =
                        static_cast<float>(x < 0 ? outside.lines[p][0] : row.lines[p][x - tile.source_xs.begin]);
            }
        }
        return block;
    }

    void hand_over(const Image<float>& means, const GaussianTile& tile, const TileWork& work) const {
        Rows row(window_.planes, tile_);
        for (int y = tile.ys.begin; y < tile.ys.end; ++y) {
            for (std::size_t p = 0; p < row.lines.size(); ++p)
                for (int x = 0; x < tile.xs.count(); ++x)
                    row.lines[p][x] =
                        static_cast<double>(means.view()(reach_ + x, y - tile.ys.begin, static_cast<int>(p)));
            work.take(y, row.lines.data());
        }
    }

    GaussianWindow window_;
    int reach_, tile_, side_;  // tiles so small that what varies over one is not much more than over a window
    RowFilter filter_;
};

}  // namespace

void gaussian_sums(const GaussianWindow& window, const std::function<TileWork(const GaussianTile& tile)>& start,
                   const Parallel& parallel) {
    const Tiles tiles(window);
    parallel_for(tiles.count(), 1, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) tiles.run(static_cast<int>(i), start);
    });
}

}  // namespace bandlimit
