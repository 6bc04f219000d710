#include "bandlimit/filter/bokeh.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/kernel/shapes.h"
#include "bandlimit/resample/row_store.h"

namespace bandlimit {
namespace {

constexpr double most_points = 2049;  // of the grid that a shape is sampled on
constexpr int points_per_sample = 16;

/// Which samples a point's own cell lies over, and how much of it over the first.
struct Place {
    int sample;
    double share;
};

std::vector<Place> places_of(int points, double radius, int reach) {
    const double pitch = 2 * radius / (points - 1);
    std::vector<Place> places;
    for (int i = 0; i < points; ++i) {
        // From the left edge of sample 0 of the grid.
        const double begin = i * pitch - radius - pitch / 2 + reach + 0.5, end = begin + pitch;
        const double border = std::floor(begin) + 1;
        places.push_back({static_cast<int>(std::floor(begin)), std::clamp((border - begin) / (end - begin), 0.0, 1.0)});
    }
    return places;
}

/// In float: twice as fast as in double, and the root divides the relative error by the exponent again.
float signed_power(float x, float exponent) { return std::copysign(std::pow(std::abs(x), exponent), x); }

/// Raises the colours of a row, which may be multiplied by its alpha.
void raise(std::span<float> row, int channels, int alpha, bool multiplied, float exponent) {
    const auto count = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < row.size(); i += count) {
        const float a = multiplied && alpha >= 0 ? row[i + static_cast<std::size_t>(alpha)] : 1;
        for (std::size_t c = 0; c < count; ++c) {
            if (static_cast<int>(c) == alpha) continue;
            row[i + c] = a > 0 ? a * signed_power(row[i + c] / a, exponent) : 0.0f;
        }
    }
}

/// Calls of_row(y) for y in [0, rows).
template <class OfRow>
void for_rows(int rows, Parallel parallel, OfRow of_row) {
    parallel_for(rows, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t y = begin; y < end; ++y) of_row(static_cast<int>(y));
    });
}

std::span<float> row_of(Image<float>& image, int y) {
    return {&image.view()(0, y), static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels())};
}

/// The rows of a run, raised, through the convolution, and back.
bool run_boosted(const RowFilter& convolution, float gamma, bool premultiply, const RowRun& run) {
    const SourceRows& source = run.sources[0];
    const TargetRows& target = run.target;
    const ViewShape from = shape_of(source.samples), to = shape_of(target.samples);
    const bool multiplied = premultiply || source.encoding.associated;
    const int alpha = source.encoding.alpha;
    const Encoding between{Transfer::linear, alpha, multiplied};
    Image<float> bright(from.width, from.height, run.channels, Layout::interleaved);
    Image<float> blurred(to.width, to.height, run.channels, Layout::interleaved);
    for_rows(from.height, run.parallel, [&](int y) {
        decode_row(source.samples, y, source.encoding, premultiply, row_of(bright, y));
        raise(row_of(bright, y), run.channels, alpha, multiplied, gamma);
    });
    convolution.run({bright.view(), source.first_row, between}, {blurred.view(), target.first_row, between, {}},
                    run.parallel);
    std::atomic<bool> lost = false;
    for_rows(to.height, run.parallel, [&](int y) {
        raise(row_of(blurred, y), run.channels, alpha, multiplied, 1 / gamma);
        if (RowStore(run, 0, to.width, premultiply).store(row_of(blurred, y), target.first_row + y)) lost = true;
        run.monitor.made(std::int64_t{to.width} * run.channels);
    });
    return lost;
}

}  // namespace

WeightGrid aperture(std::string_view text, double radius) {
    if (!(radius >= 0.5 && radius <= 1000)) fail("aperture: radius = ", radius, "; pass 0.5 to 1000 samples");
    const int reach = static_cast<int>(std::ceil(radius - 0.5)), size = 2 * reach + 1;
    const int points = static_cast<int>(std::min(std::ceil(2 * radius * points_per_sample) + 1, most_points));
    const WeightGrid fine = parse_shape(text, points);
    const std::vector<Place> places = places_of(points, radius, reach);
    WeightGrid grid(size, size);
    const double cell = std::pow(2 * radius / (points - 1), 2);
    const auto add = [&](int x, int y, double w) {
        // The outer halves of the cells at the border lie outside the grid.
        if (w != 0 && x >= 0 && y >= 0 && x < size && y < size) grid.at(x, y) += w;
    };
    for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i) {
            const double weight = cell * fine.at(i, j);
            if (weight == 0) continue;
            const auto [x, share_x] = places[static_cast<std::size_t>(i)];
            const auto [y, share_y] = places[static_cast<std::size_t>(j)];
            add(x, y, weight * share_x * share_y);
            add(x + 1, y, weight * (1 - share_x) * share_y);
            add(x, y + 1, weight * share_x * (1 - share_y));
            add(x + 1, y + 1, weight * (1 - share_x) * (1 - share_y));
        }
    return grid;
}

RowFilter boosted(const Convolution& convolution, double gamma, bool premultiply) {
    if (!(gamma > 0 && std::isfinite(gamma))) fail("boosted: gamma = ", gamma, "; pass a finite one above 0");
    const RowFilter filter = convolution.rows();
    RowProtocol protocol = filter.protocol();
    protocol.name = "boosted";
    protocol.start = [filter, gamma, premultiply](const RowRun& run) {
        return RowWork{1, [filter, gamma, premultiply, &run](int) {
                           return run_boosted(filter, static_cast<float>(gamma), premultiply, run);
                       }};
    };
    return RowFilter(std::move(protocol));
}

}  // namespace bandlimit
