#include "bandlimit/analysis/audit_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bandlimit/analysis/taper.h"
#include "bandlimit/math/fft.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/signal/signal.h"

namespace bandlimit {
namespace {

constexpr double reach = 5;  // pitches of the coarser grid that filters are expected to reach
constexpr double mid = 0.5;
constexpr double plate_amplitude = 0.45, impulse_amplitude = 0.45;
constexpr double edge_low = 0.25, edge_high = 0.75;

struct Pair {
    double low, high;
};
/// Checkerboards of black and white tell curves apart, those inside the range are safe from clipping.
constexpr std::array pairs{Pair{0, 1}, Pair{0, 0.5}, Pair{0.6, 0.8}};
constexpr std::size_t inner_pair = 2;
constexpr int greys = 9;

int round_up(double n, int multiple) { return static_cast<int>(std::ceil(n / multiple)) * multiple; }

/// Source pixels of a panel in whose middle half neighbours do not reach, a whole number of periods of the phases.
int panel_size(const Ratio& ratio) { return round_up(4 * reach * ratio.stretch() + 6, ratio.from); }

double to_code(double value, double code) { return code > 0 ? std::round(value / code) * code : value; }

/// The middle third of the panel that is the i-th from the top and as wide as the image.
View<const float> middle_of(View<const float> image, int panels, int i) {
    const int height = image.height / panels, third = height / 3;
    return cropped(image, image.width / 3, i * height + third, std::max(1, image.width / 3), std::max(1, third));
}

template <class F>
double mean_over(View<const float> v, F f) {
    double sum = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) sum += f(double(v(x, y)));
    return sum / (double(v.width) * v.height);
}

template <class F>
double largest_over(View<const float> v, F f) {
    double largest = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) largest = std::max(largest, f(double(v(x, y))));
    return largest;
}

// ---- Light

/// By how much a checkerboard's result is brighter than averaging in `light` makes it.
double light_error(View<const float> result, const Pair& pair, Light light) {
    const double expected = (decode(light, pair.low) + decode(light, pair.high)) / 2;
    const double mean = mean_over(result, [&](double v) { return decode(light, v); });
    return encode(light, mean) - encode(light, expected);
}

/// Whether every value is one of those that went in: then nothing was averaged.
bool is_picked(View<const float> result, const Pair& pair, double tolerance) {
    return largest_over(result, [&](double v) { return std::min(std::abs(v - pair.low), std::abs(v - pair.high)); }) <=
           tolerance;
}

}  // namespace

Image<float> light_scene(const Ratio& ratio, double code) {
    const int size = panel_size(ratio);
    Image<float> image(size, size * (static_cast<int>(pairs.size()) + greys));
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < size; ++x) {
            const int panel = y / size, grey = panel - static_cast<int>(pairs.size());
            const double value = grey >= 0          ? double(grey) / (greys - 1)
                                 : (x + y) % 2 == 0 ? pairs[static_cast<std::size_t>(panel)].low
                                                    : pairs[static_cast<std::size_t>(panel)].high;
            image.view()(x, y) = static_cast<float>(to_code(value, code));
        }
    return image;
}

LightReport read_light(View<const float> result, const Ratio& ratio, double code) {
    LightReport report;
    const int panels = static_cast<int>(pairs.size()) + greys;
    const double tolerance = std::max(1.5 * code, 1e-4);
    const auto rounded = [&](std::size_t i) { return Pair{to_code(pairs[i].low, code), to_code(pairs[i].high, code)}; };
    report.checker = mean_over(middle_of(result, panels, 0), [](double v) { return v; });
    for (int g = 0; g < greys; ++g) {
        const double value = to_code(double(g) / (greys - 1), code);
        report.flat_error = std::max(report.flat_error, largest_over(middle_of(result, panels, g + int(pairs.size())),
                                                                     [&](double v) { return std::abs(v - value); }));
    }
    bool picked = true;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        picked = picked && is_picked(middle_of(result, panels, int(i)), rounded(i), tolerance);
    if (picked) return report;
    report.error = 1;
    // Where growing overshoots, black and white are clipped: only the pair inside the range counts.
    const std::size_t first = ratio.shrinks() ? 0 : inner_pair;
    for (const Light light : {Light::codes, Light::srgb, Light::gamma22, Light::bt709}) {
        double square = 0;
        for (std::size_t i = first; i < pairs.size(); ++i) {
            const double e = light_error(middle_of(result, panels, int(i)), rounded(i), light);
            square += e * e / double(pairs.size() - first);
        }
        // Other curves are told from sRGB only by black and white, and by what explains clearly more.
        const bool is_other = light == Light::gamma22 || light == Light::bt709;
        if (is_other && !ratio.shrinks()) continue;
        if (std::sqrt(square) < (is_other ? 0.7 : 1) * report.error)
            report.error = std::sqrt(square), report.light = light;
    }
    if (report.error > std::max(2 * code, 0.008)) report.light = Light::unknown;
    return report;
}

// ---- Alpha

Image<float> alpha_scene(const Ratio& ratio) {
    const int size = panel_size(ratio);
    Image<float> image(2 * size, 3 * size, 4);
    const auto put = [&](int x, int y, const std::array<float, 4>& rgba) {
        for (int c = 0; c < 4; ++c) image.view()(x, y, c) = rgba[static_cast<std::size_t>(c)];
    };
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            // The border lies off the middle: at half size a box would see either side of it alone.
            if (y < size) put(x, y, x <= size ? std::array{1.f, 0.f, 0.f, 1.f} : std::array{0.f, 1.f, 0.f, 0.f});
            else if (y < 2 * size) put(x, y, {1, 1, 1, static_cast<float>((x + y) % 2)});
            else put(x, y, {0.8f, 0.4f, 0.2f, 128 / 255.f});
        }
    return image;
}

AlphaReport read_alpha(View<const float> result, const Ratio& ratio, double code) {
    AlphaReport report;
    report.ratio = ratio;
    const double tolerance = std::max(3 * code, 0.01);
    const int row = result.height / 6;
    const int far = result.width * 7 / 8;  // in the transparent half, away from its borders
    const auto value = [&](int x, int c) { return double(result(x, row, std::min(c, result.channels - 1))); };
    if (value(far, 1) > 1 - tolerance && value(far, 0) < tolerance && value(far, 2) < tolerance) report.hidden = "kept";
    else if (std::max({value(far, 0), value(far, 1), value(far, 2)}) < tolerance) report.hidden = "zero";
    else report.hidden = "changed";
    const View<const float> alpha = channels_of(result, result.channels - 1);
    if (result.channels < 4 || largest_over(alpha, [](double v) { return 1 - v; }) < tolerance) {
        report.mode = AlphaMode::dropped;
        return report;
    }
    for (int x = 0; x < result.width; ++x)
        if (value(x, 3) > tolerance) report.leak = std::max(report.leak, value(x, 1));
    report.mode = report.leak > tolerance ? AlphaMode::bleeds : AlphaMode::weighted;
    const auto identity = [](double v) { return v; };
    // Where nothing is averaged, nothing is wrong with the average.
    const View<const float> checker = middle_of(alpha, 3, 1);
    report.coverage = is_picked(checker, {0, 1}, tolerance) ? 0.5 : mean_over(checker, identity);
    const std::array<double, 4> flat{0.8, 0.4, 0.2, 128 / 255.0};
    for (int c = 0; c < 4; ++c)
        report.flat_error = std::max(
            report.flat_error, largest_over(middle_of(channels_of(result, c), 3, 2),
                                            [&](double v) { return std::abs(v - flat[static_cast<std::size_t>(c)]); }));
    return report;
}

// ---- Pictures

namespace {

/// Distance of impulses, and half the period of the stripes: no filter reaches from one to the next.
int spacing(const Ratio& ratio) { return static_cast<int>(std::ceil(2 * reach * ratio.stretch())) + 3; }

Signal plate_of(int width) { return zone_plate({double(width), double(width)}, {.phase = -0.25}); }

double plate_value(const Signal& plate, double x, double y) {
    return mid + 2 * plate_amplitude * (plate.value(x, y) - mid);
}

/// Output positions in pixels of the source, whose pixel i covers [i, i + 1].
struct Place {
    Axis x, y;
};
Place place_of(const PictureScene& scene, const ScaleReport& report) {
    return {target_axis(report.x.placement, scene.width, scene.target(scene.width)),
            target_axis(report.y.placement, scene.height(), scene.target(scene.height()))};
}

double decibels(double ratio) { return ratio > 0 ? std::max(-200.0, 10 * std::log10(ratio)) : -200; }

/// Power of the result above 1.25 of the source's Nyquist frequency over all of it, mean removed: replicas, while
/// growing.
double replica_power(const View<const float>& plate, const PictureScene& scene) {
    const int cut = plate.width / 20, size = plate.width - 2 * cut;
    const std::vector<double> window = hann(size);
    ComplexGrid grid(size, size);
    double sum = 0, weights = 0;
    const auto weight = [&](int x, int y) { return window[std::size_t(x)] * window[std::size_t(y)]; };
    const auto value = [&](int x, int y) { return decode(scene.light, double(plate(x + cut, y + cut))); };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += weight(x, y) * value(x, y), weights += weight(x, y);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) grid.at(x, y) = weight(x, y) * (value(x, y) - sum / weights);
    fft(grid);
    const double limit = 1.25 * 0.5 * scene.ratio.step();
    double above = 0, all = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double power = std::norm(grid.at(x, y));
            const double f = std::max(std::abs(bin_frequency(x, size)), std::abs(bin_frequency(y, size)));
            all += power;
            if (f > limit) above += power;
        }
    return all > 0 ? above / all : 0;
}

void read_plate(const PictureScene& scene, View<const float> result, ScaleReport& report) {
    const int size = scene.target(scene.width);
    const View<const float> plate = cropped(result, 0, 0, size, size);
    report.plate = Image<float>(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) report.plate.view()(x, y) = plate(x, y);

    const Place place = place_of(scene, report);
    const Signal signal = plate_of(scene.width);
    const double nyquist = 0.5 / scene.ratio.stretch();
    const double border = std::max(0.05 * scene.width, reach * scene.ratio.stretch());
    double pass = 0, pass_count = 0, alias = 0, alias_count = 0;
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
            const double x = place.x.position(i), y = place.y.position(j);
            if (std::min({x, y, scene.width - x, scene.width - y}) < border) continue;
            const double half = scene.width / 2.0;
            const double f = 0.5 * std::max(std::abs(x - half), std::abs(y - half)) / half;  // cycles per source pixel
            const double v = decode(scene.light, double(plate(i, j)));
            if (f < 0.7 * nyquist) pass += std::pow(v - plate_value(signal, x, y), 2), ++pass_count;
            if (f > 1.25 * nyquist) alias += (v - mid) * (v - mid), ++alias_count;
        }
    const double power = plate_amplitude * plate_amplitude / 2;
    report.pass_error = decibels(pass_count > 0 ? pass / pass_count / power : 0);
    report.alias = scene.ratio.shrinks() ? decibels(alias_count > 0 ? alias / alias_count / power : 0)
                                         : decibels(replica_power(plate, scene));
}

/// The slope of the curve at the middle: what turns the rounding of codes into that of light.
double slope_of(Light light) {
    const double h = 1e-3, stored = encode(light, mid);
    return (decode(light, stored + h) - decode(light, stored - h)) / (2 * h);
}

/// The energy of v, and what is left of it after the best product of a column and a row, by power iteration.
struct Rank {
    double energy = 0, rest = 0;
};
Rank rank_of(const std::vector<double>& v, int width, int height) {
    std::vector<double> row(std::size_t(width), 1), column(std::size_t(height), 0);
    const auto cell = [&](int x, int y) { return v[std::size_t(y) * std::size_t(width) + std::size_t(x)]; };
    const auto normalise = [](std::vector<double>& a) {
        double square = 0;
        for (const double x : a) square += x * x;
        for (double& x : a) x /= square > 0 ? std::sqrt(square) : 1;
        return square;
    };
    Rank rank;
    for (const double x : v) rank.energy += x * x;
    // Start from the row that holds most.
    double most = -1;
    for (int y = 0; y < height; ++y) {
        double square = 0;
        for (int x = 0; x < width; ++x) square += cell(x, y) * cell(x, y);
        if (square > most) {
            most = square;
            for (int x = 0; x < width; ++x) row[std::size_t(x)] = cell(x, y);
        }
    }
    double explained = 0;
    for (int step = 0; step < 30; ++step) {
        normalise(row);
        for (int y = 0; y < height; ++y) {
            column[std::size_t(y)] = 0;
            for (int x = 0; x < width; ++x) column[std::size_t(y)] += cell(x, y) * row[std::size_t(x)];
        }
        normalise(column);
        for (int x = 0; x < width; ++x) {
            row[std::size_t(x)] = 0;
            for (int y = 0; y < height; ++y) row[std::size_t(x)] += cell(x, y) * column[std::size_t(y)];
        }
        std::vector<double> copy = row;
        explained = normalise(copy);
    }
    rank.rest = std::max(0.0, rank.energy - explained);
    return rank;
}

void read_edges(const PictureScene& scene, View<const float> result, ScaleReport& report) {
    const int first = scene.target(scene.width + scene.strip), height = scene.target(scene.strip);
    const int gap = spacing(scene.ratio), border = scene.ratio.to * gap / scene.ratio.from;
    const auto beyond = [&](int row, double low, double high) {
        double most = 0;
        for (int x = border; x < result.width - border; ++x) {
            const double v = decode(scene.light, double(result(x, row)));
            most = std::max({most, v - high, low - v});
        }
        return std::max(0.0, most / (high - low));
    };
    report.overshoot = beyond(first + height / 2, edge_low, edge_high);
    report.overrange = beyond(first + height + height / 2, 0, 1);
    const KernelFinding& kernel = report.x.kernel;
    if (!kernel.is_known || kernel.candidate.kernel.form == Kernel::Form::nearest) return;
    Image<float> row(scene.width, 1), out(scene.target(scene.width), 1);
    for (int x = 0; x < scene.width; ++x) row.view()(x, 0) = static_cast<float>((x / gap) % 2);
    apply(bank_of(kernel.candidate, report.x.placement, scene.width, out.width()), row.view(), out.view());
    for (int x = border; x < out.width() - border; ++x)
        report.expected_overshoot =
            std::max({report.expected_overshoot, double(out.view()(x, 0)) - 1, -double(out.view()(x, 0))});
}

}  // namespace

PictureScene picture_scene(const Ratio& ratio, Light light, double code) {
    const int width = round_up(ratio.shrinks() ? 512 : 256, ratio.from);
    return {ratio, light, code, width, panel_size(ratio)};
}

Image<float> draw(const PictureScene& scene) {
    Image<float> image(scene.width, scene.height());
    const Signal plate = plate_of(scene.width);
    const int gap = spacing(scene.ratio);
    const Axis pixels{scene.width, 0, double(scene.width)};
    const auto value = [&](int x, int y) {
        if (y < scene.width) return plate_value(plate, pixels.position(x), pixels.position(y));
        const int strip = (y - scene.width) / scene.strip, row = (y - scene.width) % scene.strip;
        if (strip > 0) {
            const bool bright = (x / gap) % 2 != 0;
            return strip == 1 ? (bright ? edge_high : edge_low) : (bright ? 1.0 : 0.0);
        }
        if (row != scene.strip / 2 || x % gap != 0 || x == 0) return mid;
        return (x / gap) % 2 == 0 ? mid + impulse_amplitude : mid - impulse_amplitude;
    };
    for (int y = 0; y < scene.height(); ++y)
        for (int x = 0; x < scene.width; ++x)
            image.view()(x, y) = static_cast<float>(to_code(encode(scene.light, value(x, y)), scene.code));
    return image;
}

std::optional<bool> is_separable(const PictureScene& scene, View<const float> result, double& rest_of_energy) {
    const double noise = slope_of(scene.light) * scene.code / std::sqrt(12.0);
    const double scale = scene.ratio.scale();
    const int gap = spacing(scene.ratio), top = scene.target(scene.width), height = scene.target(scene.strip);
    const int width = static_cast<int>(gap * scale);
    const double ground = decode(scene.light, to_code(encode(scene.light, mid), scene.code));
    double energy = 0, rest = 0, cells = 0;
    for (int x = gap; x + gap < scene.width; x += gap) {
        const int left = static_cast<int>((x - gap / 2) * scale);
        std::vector<double> patch;
        for (int j = 0; j < height; ++j)
            for (int i = 0; i < width; ++i)
                patch.push_back(decode(scene.light, double(result(left + i, top + j))) - ground);
        // What lies near the strip's borders belongs to its neighbours.
        for (int j = 0; j < height; ++j)
            if (std::abs(j - height / 2) > gap * scale / 2)
                for (int i = 0; i < width; ++i) patch[std::size_t(j * width + i)] = 0;
        const Rank rank = rank_of(patch, width, height);
        energy += rank.energy, rest += rank.rest;
        // What is exactly grey was not rounded.
        cells += double(std::count_if(patch.begin(), patch.end(), [](double v) { return std::abs(v) > 1e-6; }));
    }
    rest_of_energy = energy > 0 ? std::sqrt(rest / energy) : 0;
    const double floor = energy > 0 ? std::sqrt(cells * noise * noise / energy) : 1;
    // Jinc leaves a twelfth and more; a product leaves what rounding does, twice where passes round in between.
    if (rest_of_energy < std::max(0.01, std::min(2.5 * floor, 0.05))) return true;
    if (rest_of_energy > std::max(0.04, 4 * floor)) return false;
    return {};
}

void read_pictures(const PictureScene& scene, View<const float> result, ScaleReport& report) {
    read_plate(scene, result, report);
    read_edges(scene, result, report);
}

}  // namespace bandlimit
