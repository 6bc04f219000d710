#include "bandlimit/job/supersample.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <set>

#include "bandlimit/analysis/metrics.h"
#include "bandlimit/antialias/multisample.h"
#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/signal/render.h"

namespace bandlimit::job {
namespace {

constexpr int rgba = 4;

/// The file to be written: with alpha where it can have one.
ImageTarget target_of(const SupersampleJob& job) {
    const FormatAbilities format = abilities_of(job.out);
    const auto holds = [&](int n) {
        return format.channels.empty() ||
               std::find(format.channels.begin(), format.channels.end(), n) != format.channels.end();
    };
    const int channels = format.alpha && holds(rgba) ? rgba : 3;
    ImageTarget target;
    target.width = job.width;
    target.height = job.height;
    target.channel_names = channel_names(channels);
    target.alpha = alpha_among(channels);
    target.depth = job.depth.value_or(nearest_depth(format, format.is_linear ? Depth::f32 : Depth::u8));
    target.transfer = format.is_linear || !is_integer(target.depth) ? Transfer::linear : Transfer::srgb;
    return target;
}

Scene scene_of(const SupersampleJob& job) {
    try {
        return make_scene(job.scene, job.width, job.height);
    } catch (const Error& e) {
        throw OptionError(e.what());  // it is made of nothing but options
    }
}

double samples_per_pixel(const SupersampleJob& job) {
    if (!job.mixed) return job.options.pattern.count();
    return *job.mixed == MixedMode::full ? 1 : 0.5;
}

/// Takes rows that are multiplied by alpha to the file, and adds up their luma.
class SceneWriter {
public:
    SceneWriter(const SupersampleJob& job, const Context& context)
        : context_(context), target_(target_of(job)), writer_(job.out, target_, false, context.parallel.threads) {}

    void write(int y, View<const float> rows) {
        Image<float> divided(rows.width, rows.height, rgba, Layout::interleaved);
        const View<float> out = divided.view();
        for (int j = 0; j < rows.height; ++j)
            for (int x = 0; x < rows.width; ++x) {
                for (int c = 0; c < rgba; ++c) out(x, j, c) = rows(x, j, c);
                luma_ += 0.2126 * rows(x, j, 0) + 0.7152 * rows(x, j, 1) + 0.0722 * rows(x, j, 2);
            }
        divide_by_alpha(out);
        // Without alpha, over black: that is what colour multiplied by alpha is.
        writer_.write(target_.alpha >= 0 ? View<const float>(out) : channels_of(rows, 0, 3));
        context_.report({"supersampling", double(y + rows.height), double(target_.height)});
    }

    void finish() { writer_.finish(); }
    double mean_luma() const { return luma_ / target_.width / target_.height; }

private:
    const Context& context_;
    ImageTarget target_;
    PictureWriter writer_;
    double luma_ = 0;
};

// ---- Reports

std::vector<EdgeSweep> edges_of(const SamplePattern& pattern) {
    std::vector<EdgeSweep> edges;
    for (int degrees = -90; degrees < 90; degrees += 5) edges.push_back(sweep_edge(pattern.points, degrees));
    return edges;
}

/// Nine parts of an image, spread evenly, or all of it if it is small.
std::vector<PixelArea> parts_of(int width, int height) {
    constexpr int side = 16, each_way = 3;
    if (width <= side * each_way && height <= side * each_way) return {{0, 0, width, height}};
    const int part_width = std::min(side, width), part_height = std::min(side, height);
    const auto place = [](int i, int size, int part) { return (2 * i + 1) * size / (2 * each_way) - part / 2; };
    std::vector<PixelArea> parts;
    for (int j = 0; j < each_way; ++j)
        for (int i = 0; i < each_way; ++i)
            parts.push_back({std::max(0, place(i, width, part_width)), std::max(0, place(j, height, part_height)),
                             part_width, part_height});
    return parts;
}

/// The pattern with so many points, if there is one.
std::optional<SamplePattern> with_count_if_any(const SamplePattern& pattern, int count) {
    try {
        return with_count(pattern, count);
    } catch (const Error&) {
        return {};
    }
}

/// Parts of a job's image, drawn with any options.
class Parts {
public:
    Parts(const SupersampleJob& job, const Scene& scene, const Context& context)
        : areas_(parts_of(job.width, job.height)), colors_(colors_of(scene, job.frame)), parallel_(context.parallel) {}

    std::vector<Image<float>> draw(const SupersampleOptions& options) const {
        std::vector<Image<float>> images;
        for (const PixelArea& area : areas_)
            images.push_back(bandlimit::supersample(colors_, rgba, area, options, parallel_));
        return images;
    }

private:
    std::vector<PixelArea> areas_;
    PointValue colors_;
    Parallel parallel_;
};

double psnr_of(const std::vector<Image<float>>& images, const std::vector<Image<float>>& truth) {
    double error = 0;
    for (std::size_t i = 0; i < images.size(); ++i)
        error += mse(channels_of(images[i].view(), 0, 3), channels_of(truth[i].view(), 0, 3));
    return -10 * std::log10(error / static_cast<double>(images.size()));
}

double mean_luma_of(const std::vector<Image<float>>& images) {
    double sum = 0;
    for (const Image<float>& image : images)
        sum +=
            0.2126 * mean_of(image.view(), 0) + 0.7152 * mean_of(image.view(), 1) + 0.0722 * mean_of(image.view(), 2);
    return sum / static_cast<double>(images.size());
}

std::vector<PsnrOfCount> psnr_of_counts(const SupersampleOptions& options, const Parts& parts) {
    const std::vector<Image<float>> truth = parts.draw({regular_pattern(256), options.kernel});
    std::set<int> wanted{1, 2, 4, 8, 16, 32, 64};
    if (options.pattern.count() < 256) wanted.insert(options.pattern.count());
    std::vector<PsnrOfCount> counts;
    for (const int count : wanted) {
        SupersampleOptions other = options;
        if (count != options.pattern.count()) {
            const std::optional<SamplePattern> pattern = with_count_if_any(options.pattern, count);
            if (!pattern) continue;
            other.pattern = *pattern;
        }
        counts.push_back({count, psnr_of(parts.draw(other), truth)});
    }
    return counts;
}

std::optional<double> tone_bias(const SupersampleOptions& options, const Parts& parts) {
    if (options.tone == ToneWeight::none) return {};
    SupersampleOptions plain = options;
    plain.tone = ToneWeight::none;
    return mean_luma_of(parts.draw(options)) / mean_luma_of(parts.draw(plain)) - 1;
}

PointValue values_of(const Signal& signal) {
    return [value = signal.value](double x, double y, std::span<float> to) { to[0] = static_cast<float>(value(x, y)); };
}

MixedError mixed_error(MixedMode mode, const Kernel& kernel, const Parallel& parallel) {
    constexpr int size = 64;
    constexpr double limit = 0.35;
    const double middle = Axis{size, 0, size}.position(size / 2);
    const Signal plate = zone_plate({size, size}, {.center = Point{middle, middle}, .radius = size / 2.0});
    const Image<float> truth = render(plate, size, size);
    const Image<float> image = mixed_resolution(values_of(plate), 1, size, size, mode, kernel, parallel);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (std::hypot(x - size / 2, y - size / 2) / size < limit) {
                sum += std::pow(image.view()(x, y) - truth.view()(x, y), 2);
                ++count;
            }
    return {mode, kernel.name, std::sqrt(sum / count)};
}

/// Black beside stripes of a frequency that pixels do not hold, along a slanted line.
ShadedSurfaces striped_outline() {
    const Signal wave = stripes({.period = 1.3, .angle = 20, .sinusoid = true});
    return {[](double x, double y) { return x + 0.3 * y < 40 ? 1 : 0; },
            [wave](int surface, double x, double y, double footprint) {
                if (surface == 0) return 0.0;
                const double half = footprint / 2;
                return half == 0 ? wave.value(x, y) : wave.mean({x - half, y - half, x + half, y + half});
            }};
}

}  // namespace

void check(const SupersampleJob& job) {
    if (!is_scene(job.scene)) scene_of(job);  // says which there are
    if (job.width < 1 || job.height < 1)
        throw OptionError("size", fmt::format("{} x {} pixels; pass at least 1 x 1", job.width, job.height));
    check_supersampling(job.options);
    target_of(job);
}

SupersampleSummary supersample(const SupersampleJob& job, const Context& context) {
    check_output_path(job.out);
    check(job);
    const auto start = std::chrono::steady_clock::now();
    const Scene scene = scene_of(job);
    const PointValue colors = colors_of(scene, job.frame);
    const auto pixels = static_cast<std::uint64_t>(job.width) * static_cast<std::uint64_t>(job.height);
    require_memory(job.mixed ? 4 * pixels * rgba * sizeof(float) : supersampling_bytes(job.width, rgba, job.options),
                   fmt::format("supersampling {} x {} pixels", job.width, job.height));
    SceneWriter writer(job, context);
    if (job.mixed)
        writer.write(
            0, mixed_resolution(colors, rgba, job.width, job.height, *job.mixed, job.options.kernel, context.parallel)
                   .view());
    else
        supersample_rows(
            colors, rgba, {0, 0, job.width, job.height}, job.options,
            [&](int y, View<const float> rows) { writer.write(y, rows); }, context.parallel);
    writer.finish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {samples_per_pixel(job), writer.mean_luma(), seconds.count()};
}

double alias_energy(const SupersampleOptions& options, const Parallel& parallel) {
    constexpr int size = 128;
    constexpr double highest = 2, half = size / 2.0;
    const Signal plate = zone_plate({size, size}, {.max_frequency = highest});
    const Image<float> image = bandlimit::supersample(values_of(plate), 1, {0, 0, size, size}, options, parallel);
    const Axis axis{size, -half, half};
    double sum = 0;
    int count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double away = std::max(std::abs(axis.position(x)), std::abs(axis.position(y)));
            if (highest * away / half < 0.5) continue;
            sum += std::pow(image.view()(x, y) - 0.5, 2);
            ++count;
        }
    return sum / count * 8;
}

std::vector<MixedError> mixed_errors(const Kernel& kernel, const Parallel& parallel) {
    std::vector<Kernel> kernels{tent(), catmull_rom(), lanczos(3)};
    const auto is_there = [&](const Kernel& k) { return k.name == kernel.name; };
    if (std::none_of(kernels.begin(), kernels.end(), is_there)) kernels.push_back(kernel);
    std::vector<MixedError> errors;
    for (const MixedMode mode : {MixedMode::uniform, MixedMode::interlaced, MixedMode::checkerboard})
        for (const Kernel& k : kernels) errors.push_back(mixed_error(mode, k, parallel));
    return errors;
}

std::vector<ShadingError> shading_errors(const SamplePattern& pattern, const Parallel& parallel) {
    constexpr int size = 64;
    const ShadedSurfaces scene = striped_outline();
    const Image<float> truth = bandlimit::supersample(scene, size, size, regular_pattern(1024), 0, parallel);
    const auto rmse = [&](const Image<float>& image) { return std::sqrt(mse(image.view(), truth.view())); };
    const double share = 1 / std::sqrt(pattern.count());
    return {{"multisample", false, rmse(multisample(scene, size, size, pattern, 0, parallel))},
            {"multisample", true, rmse(multisample(scene, size, size, pattern, 1, parallel))},
            {"supersample", false, rmse(bandlimit::supersample(scene, size, size, pattern, 0, parallel))},
            {"supersample", true, rmse(bandlimit::supersample(scene, size, size, pattern, share, parallel))}};
}

ResolveReport report_on(const SupersampleJob& job, const Context& context) {
    const Scene scene = scene_of(job);
    ResolveReport report;
    report.edges = edges_of(job.options.pattern);
    report.alias_energy = alias_energy(job.options, context.parallel);
    const Parts parts(job, scene, context);
    report.counts = psnr_of_counts(job.options, parts);
    report.tone_bias = tone_bias(job.options, parts);
    report.mixed = mixed_errors(job.options.kernel, context.parallel);
    report.shading = shading_errors(job.options.pattern, context.parallel);
    return report;
}

}  // namespace bandlimit::job
