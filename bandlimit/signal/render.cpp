#include "bandlimit/signal/render.h"

#include <algorithm>
#include <cmath>

#include "bandlimit/core/error.h"
#include "bandlimit/math/quadrature.h"
#include "bandlimit/signal/coverage.h"

namespace bandlimit {
namespace {

using Complex = std::complex<double>;

constexpr int rows_per_task = 8;
constexpr int smallest_block = 8;  // rows made at a time, each from `samples` fine rows and the kernel's margin ...
constexpr int block_samples = 1 << 24;  // ... or more, while the fine image has no more samples than this: 64 MB

/// Sets each pixel to at(column, row).
template <class At>
void fill(View<float> image, Parallel parallel, At at) {
    parallel_for(image.height, rows_per_task, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < image.width; ++x) image(x, y) = static_cast<float>(at(x, y));
    });
}

void draw_points(const Signal& signal, const Grid& grid, View<float> image, Parallel parallel) {
    fill(image, parallel, [&](int x, int y) { return signal.value(grid.x.position(x), grid.y.position(y)); });
}

Cell cell_at(const Grid& grid, int x, int y) {
    const Axis column = grid.x.cells(x, x + 1), row = grid.y.cells(y, y + 1);
    const auto [x0, x1] = std::minmax(column.begin, column.end);
    const auto [y0, y1] = std::minmax(row.begin, row.end);
    return {x0, y0, x1, y1};
}

/// The points and weights that integrate kernel(u) f(u) over the kernel's support, scaled to pass a constant.
Quadrature kernel_nodes(const Kernel& kernel, double cycles_per_pitch) {
    std::vector<double> ends{-kernel.radius, 0, kernel.radius};
    for (const double knot : kernel.knots) ends.insert(ends.end(), {-knot, knot});
    std::sort(ends.begin(), ends.end());
    Quadrature all;
    double sum = 0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        // Twice the panels that the wave alone needs, since the kernel bends too.
        const Quadrature part =
            quadrature(ends[i - 1], ends[i], panels_for(2 * cycles_per_pitch * (ends[i] - ends[i - 1])));
        for (std::size_t k = 0; k < part.at.size(); ++k) {
            all.at.push_back(part.at[k]);
            all.weights.push_back(part.weights[k] * kernel.value(part.at[k]));
            sum += all.weights.back();
        }
    }
    for (double& weight : all.weights) weight /= sum;
    return all;
}

/// `wave` seen through `kernel`, at the samples of an axis.
std::vector<Complex> filtered(const Wave& wave, const Kernel& kernel, const Axis& axis, Parallel parallel) {
    const double reach = kernel.radius * axis.pitch();
    const double highest = std::max({wave.frequency(axis.begin - reach), wave.frequency(axis.begin + reach),
                                     wave.frequency(axis.end - reach), wave.frequency(axis.end + reach)});
    const Quadrature nodes = kernel_nodes(kernel, highest * std::abs(axis.pitch()));
    std::vector<Complex> result(static_cast<std::size_t>(axis.count));
    parallel_for(axis.count, rows_per_task, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
            Complex sum = 0;
            for (std::size_t k = 0; k < nodes.at.size(); ++k)
                sum +=
                    nodes.weights[k] * wave.value(axis.position(static_cast<double>(i)) + axis.pitch() * nodes.at[k]);
            result[static_cast<std::size_t>(i)] = sum;
        }
    });
    return result;
}

void draw_product(const WaveProduct& product, const Kernel& kernel, const Grid& grid, View<float> image,
                  Parallel parallel) {
    const std::vector<Complex> columns = filtered(product.x, kernel, grid.x, parallel);
    const std::vector<Complex> rows = filtered(product.y, kernel, grid.y, parallel);
    fill(image, parallel, [&](int x, int y) {
        return product.offset + (columns[static_cast<std::size_t>(x)] * rows[static_cast<std::size_t>(y)]).real();
    });
}

bool has_product_form(const Signal& signal, const Kernel& kernel) {
    return signal.product && !is_radial(kernel) && kernel.form != Kernel::Form::nearest;
}

void draw_exact(const Signal& signal, const Kernel& kernel, const Grid& grid, View<float> image, Parallel parallel) {
    if (has_product_form(signal, kernel)) return draw_product(*signal.product, kernel, grid, image, parallel);
    fill(image, parallel, [&](int x, int y) { return signal.mean(cell_at(grid, x, y)); });
}

/// `axis` with a margin that the kernel cannot leave, and `samples` samples to the pixel.
Axis fine_axis(const Axis& axis, const Kernel& kernel, int samples) {
    const int margin = static_cast<int>(std::ceil(kernel.radius));
    if (axis.count > (1 << 30) / samples - 2 * margin)
        fail("render: ", axis.count, " pixels with ", samples, " samples each; at most ",
             (1 << 30) / samples - 2 * margin, " pixels can be supersampled so");
    Axis fine = axis.cells(-margin, axis.count + margin);
    fine.count *= samples;
    return fine;
}

Grid fine_grid(const Grid& grid, const Sampling& sampling) {
    return {fine_axis(grid.x, sampling.kernel, sampling.samples), fine_axis(grid.y, sampling.kernel, sampling.samples)};
}

/// How many rows of the image to make at a time.
int block_height(const Grid& fine, int samples) {
    return std::max(smallest_block, block_samples / fine.x.count / samples);
}

void draw_supersampled(const Signal& signal, const Sampling& sampling, const Grid& grid, View<float> image,
                       Parallel parallel) {
    const Grid fine = fine_grid(grid, sampling);
    const Resizer resizer(fine, grid, 1, {.reconstruction = sampling.kernel, .edge = Edge::clamp});
    const int block = block_height(fine, sampling.samples);
    for (int first = 0; first < image.height; first += block) {
        const int last = std::min(first + block, image.height);
        const IndexRange needed = resizer.rows_needed(first, last);
        Image<float> points(fine.x.count, needed.end - needed.begin);
        draw_points(signal, {fine.x, fine.y.cells(needed.begin, needed.end)}, points.view(), parallel);
        resizer.run({std::as_const(points).view(), needed.begin, {}},
                    {cropped(image, 0, first, image.width, last - first), first, {}, {}}, parallel);
    }
}

void check_shape(const Grid& grid, const View<float>& image) {
    if (image.width != grid.x.count || image.height != grid.y.count || image.channels != 1)
        fail("render: a grid of ", grid.x.count, " x ", grid.y.count, " and an image of ", image.width, " x ",
             image.height, " x ", image.channels, "; sizes must be equal, with 1 channel");
    for (const Axis& axis : {grid.x, grid.y})
        if (axis.count > 0 && !(std::isfinite(axis.pitch()) && axis.pitch() != 0))
            fail("render: an axis from ", axis.begin, " to ", axis.end, "; pass finite ends that differ");
}

}  // namespace

void check_sampling(const Signal& signal, const Sampling& sampling) {
    const Kernel& kernel = sampling.kernel;
    if (sampling.mode == Sampling::Mode::supersampled) {
        if (sampling.samples < 1 || sampling.samples > 1024)
            fail("render: samples = ", sampling.samples, "; pass 1 to 1024 per pixel and axis");
        if (kernel.form == Kernel::Form::nearest)
            fail("render: nearest takes one sample of a pixel; use point sampling, or another kernel");
    }
    if (sampling.mode == Sampling::Mode::exact && !has_product_form(signal, kernel)) {
        if (kernel.form != Kernel::Form::area)
            fail("render: ", signal.name, " has no exact form under ", kernel.name,
                 "; supersample it, or use a separable kernel with zoneplate, sinusoidal stripes, or a chirp along x "
                 "or y");
        if (!signal.mean)
            fail("render: ", signal.name, " has no exact form; supersample it, or use one of ", exact_signals());
    }
}

std::uint64_t rendering_bytes(const Grid& grid, const Sampling& sampling) {
    const auto size = [](double samples) { return static_cast<std::uint64_t>(samples * sizeof(float)); };
    if (sampling.mode != Sampling::Mode::supersampled)
        return 4 * size(grid.x.count) + 4 * size(grid.y.count);  // of a product: a complex double each
    const Grid fine = fine_grid(grid, sampling);
    const int rows = std::min(block_height(fine, sampling.samples), grid.y.count);
    // Once for the fine rows, and at most as much again for the filter's own copies of some of them.
    return 2 * size((rows + 2 * std::ceil(sampling.kernel.radius)) * sampling.samples * fine.x.count);
}

void render(const Signal& signal, const Grid& grid, const Sampling& sampling, View<float> image, Parallel parallel) {
    check_shape(grid, image);
    check_sampling(signal, sampling);
    if (image.width == 0 || image.height == 0) return;
    switch (sampling.mode) {
        case Sampling::Mode::point: return draw_points(signal, grid, image, parallel);
        case Sampling::Mode::exact: return draw_exact(signal, sampling.kernel, grid, image, parallel);
        case Sampling::Mode::supersampled: return draw_supersampled(signal, sampling, grid, image, parallel);
    }
}

Image<float> render(const Signal& signal, int width, int height, const Sampling& sampling, Parallel parallel) {
    if (width < 1 || height < 1) fail("render: size ", width, " x ", height, "; pass at least 1 x 1");
    Image<float> image(width, height);
    render(signal, {{width, 0, double(width)}, {height, 0, double(height)}}, sampling, image.view(), parallel);
    return image;
}

std::string exact_signals() { return "zoneplate, chirp, edge, stripes, checker, box, disc, ramp, impulse, line"; }

}  // namespace bandlimit
