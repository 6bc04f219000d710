#include "bandlimit/antialias/supersample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "bandlimit/antialias/resolve_table.h"
#include "bandlimit/core/axis.h"
#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bandlimit/sampling/sequence.h"

namespace bandlimit {
namespace {

constexpr int most_channels = 4;
constexpr int most_stored = most_channels + 1;  // with a weight
constexpr int pixel_patterns = 64;              // different ones, with options.pixel_seed
constexpr int pixels_per_task = 64;
constexpr std::size_t budget = 1 << 25;  // bytes of samples that are kept, if a few rows are not more

int color_channels(int channels) { return channels == 2 || channels == 4 ? channels - 1 : channels; }

/// Of Rec. 709; of grey, itself.
float luma(std::span<const float> value) {
    return value.size() < 3 ? value[0] : 0.2126f * value[0] + 0.7152f * value[1] + 0.0722f * value[2];
}

struct WeightedSample {
    double weight;  ///< not 0: what lies outside the kernel cannot matter, even if it is not finite
    int sample;
};

/// What the samples of one pixel weigh in each pixel around it, without those that weigh nothing.
class SparseTable {
public:
    SparseTable(const ResolveTable& table, int reach) {
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                const bool is_inside = std::max(std::abs(dx), std::abs(dy)) <= table.reach;
                for (int s = 0; is_inside && s < table.samples; ++s)
                    if (const double weight = table.weight(dx, dy, s); weight != 0) taps_.push_back({weight, s});
                ends_.push_back(taps_.size());
            }
    }
    /// Those of the pixel that is the `pixel`-th of the square of the reach, by rows.
    std::span<const WeightedSample> of(int pixel) const {
        const auto i = static_cast<std::size_t>(pixel);
        const std::size_t first = i == 0 ? 0 : ends_[i - 1];
        return std::span(taps_).subspan(first, ends_[i] - first);
    }

private:
    std::vector<WeightedSample> taps_;
    std::vector<std::size_t> ends_;
};

/// Patterns and their weights: one of each, or many that take turns.
struct Patterns {
    std::vector<SamplePattern> patterns;
    std::vector<SparseTable> tables;
    int reach = 0;
    double mean_weight = 0;  ///< the sum of a table, on average
    std::optional<std::uint64_t> seed;

    std::size_t of_pixel(int x, int y) const {
        if (!seed) return 0;
        return hash_of(*seed, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)) % pixel_patterns;
    }
};

Patterns patterns_of(const SupersampleOptions& o) {
    Patterns all{{o.pattern}, {}, 0, 0, o.pixel_seed};
    std::vector<ResolveTable> tables{resolve_table(o.pattern, o.kernel, o.reconstruction)};
    if (o.pixel_seed) {
        all.patterns.clear(), tables.clear();
        for (std::uint32_t i = 0; i < pixel_patterns; ++i) {
            all.patterns.push_back(wrapped(o.pattern, sobol_point(i, *o.pixel_seed)));
            tables.push_back(unnormalised_table(all.patterns.back(), o.kernel, o.reconstruction));
        }
    }
    for (const ResolveTable& table : tables) all.reach = std::max(all.reach, table.reach);
    for (const ResolveTable& table : tables) {
        all.tables.emplace_back(table, all.reach);
        all.mean_weight += std::accumulate(table.weights.begin(), table.weights.end(), 0.0) / double(tables.size());
    }
    return all;
}

/// Changes a sample to what is filtered, and back. For karis the colour is multiplied by its weight, which is kept in
/// a channel of its own.
struct Tone {
    ToneWeight kind;
    int channels;

    int stored() const { return channels + (kind == ToneWeight::karis ? 1 : 0); }

    void store(std::span<float> sample) const {
        const auto colors = sample.first(static_cast<std::size_t>(color_channels(channels)));
        if (kind == ToneWeight::lottes) {
            const float divisor = 1 + std::max(0.0f, *std::max_element(colors.begin(), colors.end()));
            for (float& c : colors) c /= divisor;
        } else if (kind == ToneWeight::karis) {
            const float weight = 1 / (1 + std::max(0.0f, luma(colors)));
            for (float& c : colors) c *= weight;
            sample.back() = weight;
        }
    }

    /// `sum` is what was filtered; `least` the weight of the brightest sample.
    void restore(std::span<double> sum, double least) const {
        const auto colors = sum.first(static_cast<std::size_t>(color_channels(channels)));
        if (kind == ToneWeight::lottes) {
            constexpr double whitest = 1 - 1e-7;  // what float holds of a tone just below 1
            const double divisor = 1 - std::clamp(*std::max_element(colors.begin(), colors.end()), 0.0, whitest);
            for (double& c : colors) c /= divisor;
        } else if (kind == ToneWeight::karis) {
            const double weight = std::max(sum[static_cast<std::size_t>(channels)], least);
            for (double& c : colors) c /= weight;
        }
    }
};

/// Rows of samples around rows of pixels, and their sums.
class Resolver {
public:
    Resolver(const PointValue& value, int channels, const PixelArea& area, const SupersampleOptions& options)
        : value_(value),
          patterns_(patterns_of(options)),
          tone_{options.tone, channels},
          area_(area),
          columns_(area.width + 2 * patterns_.reach),
          count_(options.pattern.count()) {
        const std::size_t rows = budget / (row_size() * sizeof(float));
        const auto halo = static_cast<std::size_t>(2 * patterns_.reach);
        block_ = static_cast<int>(std::clamp<std::size_t>(rows > halo ? rows - halo : 1, 1, 64));
        block_ = std::min(block_, area.height);
        samples_.resize((static_cast<std::size_t>(block_) + halo) * row_size());
    }

    void run(const ResolvedRows& rows, const Parallel& parallel) {
        Image<float> out(area_.width, block_, tone_.channels, Layout::interleaved);
        const int halo = 2 * patterns_.reach;
        take_samples(0, halo, parallel);
        for (int y = 0; y < area_.height; y += block_) {
            const int height = std::min(block_, area_.height - y);
            take_samples(y + halo, height, parallel);
            const View<float> block = cropped(out.view(), 0, 0, area_.width, height);
            for_pixels(height, area_.width, parallel, [&](int row, int x) { resolve(y, row, x, block); });
            rows(y, block);
            keep_halo(height);
        }
    }

private:
    std::size_t pixel_size() const {
        return static_cast<std::size_t>(count_) * static_cast<std::size_t>(tone_.stored());
    }
    std::size_t row_size() const { return static_cast<std::size_t>(columns_) * pixel_size(); }
    float* samples_at(int held_row, int column) {
        return samples_.data() + static_cast<std::size_t>(held_row) * row_size() +
               static_cast<std::size_t>(column) * pixel_size();
    }

    /// Calls at(row, x) for `height` rows of `width` pixels.
    template <class At>
    static void for_pixels(int height, int width, const Parallel& parallel, const At& at) {
        const int pieces = (width - 1) / pixels_per_task + 1;
        parallel_for(static_cast<std::ptrdiff_t>(height) * pieces, 1, parallel,
                     [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (std::ptrdiff_t i = begin; i < end; ++i) {
                             const int row = static_cast<int>(i / pieces);
                             const int first = static_cast<int>(i % pieces) * pixels_per_task;
                             for (int x = first; x < std::min(width, first + pixels_per_task); ++x) at(row, x);
                         }
                     });
    }

    /// Evaluates `height` rows of samples from `row` on, counted from the first that is needed, and holds them behind
    /// those that are held.
    void take_samples(int row, int height, const Parallel& parallel) {
        for_pixels(height, columns_, parallel,
                   [&](int i, int column) { take_pixel(row + i, column, samples_at(held_ + i, column)); });
        held_ += height;
    }

    void take_pixel(int row, int column, float* to) const {
        const Axis pixels{1, 0, 1};
        const int x = area_.x + column - patterns_.reach, y = area_.y + row - patterns_.reach;
        const auto stored = static_cast<std::size_t>(tone_.stored());
        const auto channels = static_cast<std::size_t>(tone_.channels);
        for (const Point& p : patterns_.patterns[patterns_.of_pixel(x, y)].points) {
            value_(pixels.position(x) + p.x, pixels.position(y) + p.y, std::span(to, channels));
            tone_.store(std::span(to, stored));
            to += stored;
        }
    }

    struct Sum {
        std::array<double, most_stored> values{};
        double weight = 0;
        double least = 1;  ///< of the tone weights
    };

    /// Adds samples of one pixel; with `clip`, without negative weights.
    template <int stored, bool clip>
    void add(Sum& sum, std::span<const WeightedSample> taps, const float* pixel) const {
        add<clip>(sum, taps, pixel, std::make_index_sequence<stored>());
    }
    template <bool clip, std::size_t... channel>
    void add(Sum& sum, std::span<const WeightedSample> taps, const float* pixel,
             std::index_sequence<channel...>) const {
        constexpr std::size_t stored = sizeof...(channel);
        const bool is_weighted = tone_.kind == ToneWeight::karis;
        Sum local = sum;  // which the compiler keeps in registers
        for (const WeightedSample& tap : taps) {
            const double weight = clip ? std::max(tap.weight, 0.0) : tap.weight;
            const float* sample = pixel + static_cast<std::size_t>(tap.sample) * stored;
            ((local.values[channel] += weight * double{sample[channel]}), ...);
            local.weight += weight;
            if (is_weighted) local.least = std::min(local.least, double{sample[stored - 1]});
        }
        sum = local;
    }

    /// The weighted sum of the samples around pixel (x, y + row).
    template <int stored, bool clip = false>
    Sum sum_around(int y, int row, int x) {
        Sum sum;
        const int reach = patterns_.reach, side = 2 * reach + 1;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                const std::size_t which = patterns_.of_pixel(area_.x + x + i - reach, area_.y + y + row + j - reach);
                add<stored, clip>(sum, patterns_.tables[which].of(j * side + i), samples_at(row + j, x + i));
            }
        return sum;
    }

    template <int stored>
    Sum mean_of_pixel(int row, int x) {
        std::vector<WeightedSample> equal;
        for (int s = 0; s < count_; ++s) equal.push_back({1, s});
        Sum sum;
        add<stored, false>(sum, equal, samples_at(row + patterns_.reach, x + patterns_.reach));
        return sum;
    }

    /// Where patterns differ, weights may nearly cancel, in few pixels; there, something simpler does.
    template <int stored>
    Sum safe_sum(int y, int row, int x) {
        const Sum sum = sum_around<stored>(y, row, x);
        if (!patterns_.seed || sum.weight > patterns_.mean_weight / 5) return sum;
        const Sum positive = sum_around<stored, true>(y, row, x);
        return positive.weight > 0 ? positive : mean_of_pixel<stored>(row, x);
    }

    Sum sum_of_pixel(int y, int row, int x) {
        switch (tone_.stored()) {
            case 1: return safe_sum<1>(y, row, x);
            case 2: return safe_sum<2>(y, row, x);
            case 3: return safe_sum<3>(y, row, x);
            case 4: return safe_sum<4>(y, row, x);
            default: return safe_sum<most_stored>(y, row, x);
        }
    }

    void resolve(int y, int row, int x, View<float> out) {
        Sum sum = sum_of_pixel(y, row, x);
        for (double& v : sum.values) v /= sum.weight;
        tone_.restore(sum.values, sum.least);
        for (int c = 0; c < tone_.channels; ++c)
            out(x, row, c) = static_cast<float>(sum.values[static_cast<std::size_t>(c)]);
    }

    /// Moves the samples that the next rows need to the front.
    void keep_halo(int used_rows) {
        std::copy(samples_at(used_rows, 0), samples_at(held_, 0), samples_.data());
        held_ -= used_rows;
    }

    const PointValue& value_;
    Patterns patterns_;
    Tone tone_;
    PixelArea area_;
    int columns_, count_;
    int block_ = 1, held_ = 0;
    std::vector<float> samples_;  ///< of rows of pixels that are held, by pixel, sample and channel
};

void check_area(int channels, const PixelArea& area) {
    if (channels < 1 || channels > most_channels) fail("supersample: ", channels, " channels; pass 1 to 4");
    if (area.width < 1 || area.height < 1)
        fail("supersample: ", area.width, " x ", area.height, " pixels; pass at least 1 x 1");
}

struct NamedTone {
    ToneWeight tone;
    std::string_view name;
};
constexpr std::array tones{NamedTone{ToneWeight::none, "none"}, NamedTone{ToneWeight::karis, "karis"},
                           NamedTone{ToneWeight::lottes, "lottes"}};

}  // namespace

ToneWeight parse_tone_weight(std::string_view name) {
    for (const NamedTone& t : tones)
        if (t.name == name) return t.tone;
    fail("tone weight \"", name, "\" is unknown; use none, karis or lottes");
}

std::string_view name_of(ToneWeight tone) {
    return std::find_if(tones.begin(), tones.end(), [tone](const NamedTone& t) { return t.tone == tone; })->name;
}

void check_supersampling(const SupersampleOptions& options) {
    resolve_table(options.pattern, options.kernel, options.reconstruction);
}

std::uint64_t supersampling_bytes(int width, int channels, const SupersampleOptions& options) {
    const int reach = unnormalised_table(options.pattern, options.kernel, options.reconstruction).reach;
    const auto row = static_cast<std::uint64_t>(width + 2 * reach) *
                     static_cast<std::uint64_t>(options.pattern.count()) * static_cast<std::uint64_t>(channels + 1) *
                     sizeof(float);
    return std::max<std::uint64_t>(budget, row * static_cast<std::uint64_t>(2 * reach + 1));
}

void supersample_rows(const PointValue& value, int channels, const PixelArea& area, const SupersampleOptions& options,
                      const ResolvedRows& rows, const Parallel& parallel) {
    check_area(channels, area);
    Resolver(value, channels, area, options).run(rows, parallel);
}

Image<float> supersample(const PointValue& value, int channels, const PixelArea& area,
                         const SupersampleOptions& options, const Parallel& parallel) {
    check_area(channels, area);
    Image<float> image(area.width, area.height, channels, Layout::interleaved);
    const View<float> all = image.view();
    supersample_rows(
        value, channels, area, options,
        [&](int y, View<const float> rows) {
            std::copy_n(rows.data, static_cast<std::ptrdiff_t>(rows.height) * rows.dy, &all(0, y));
        },
        parallel);
    return image;
}

PointValue colors_of(const Scene& scene, int frame) {
    if (scene.color)  // quicker, and opaque
        return [color = scene.color, frame](double x, double y, std::span<float> value) {
            const std::array<double, 3> at = color(x, y, frame);
            for (std::size_t c = 0; c < 3; ++c) value[c] = static_cast<float>(at[c]);
            value[3] = 1;
        };
    return [at = scene.at, frame](double x, double y, std::span<float> value) {
        const SceneSample sample = at(x, y, frame);
        for (std::size_t c = 0; c < 3; ++c) value[c] = static_cast<float>(sample.color[c] * sample.alpha);
        value[3] = static_cast<float>(sample.alpha);
    };
}

void divide_by_alpha(View<float> rows) {
    const int alpha = rows.channels - 1;
    for (int y = 0; y < rows.height; ++y)
        for (int x = 0; x < rows.width; ++x)
            if (rows(x, y, alpha) != 0)
                for (int c = 0; c < alpha; ++c) rows(x, y, c) /= rows(x, y, alpha);
}

Image<float> supersample(const Scene& scene, int width, int height, int frame, const SupersampleOptions& options,
                         const Parallel& parallel) {
    Image<float> image = supersample(colors_of(scene, frame), 4, {0, 0, width, height}, options, parallel);
    divide_by_alpha(image.view());
    return image;
}

}  // namespace bandlimit
