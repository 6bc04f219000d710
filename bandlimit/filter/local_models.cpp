#include "bandlimit/filter/local_models.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "bandlimit/filter/gaussian_sums.h"
#include "bandlimit/filter/moment_rows.h"
#include "bandlimit/filter/polynomial_fit.h"
#include "bandlimit/filter/window_sums.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

constexpr int most_gaussian_radius = 255;
constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

void check(View<const float> signal, View<const float> guide, const LocalModelOptions& o) {
    constexpr const char* name = "fit_local_models";
    if (signal.width < 1 || signal.height < 1) fail(name, ": the signal has no samples; pass at least one");
    if (signal.width != guide.width || signal.height != guide.height)
        fail(name, ": the signal has ", signal.width, " x ", signal.height, " samples, the guide ", guide.width, " x ",
             guide.height, "; pass a guide of the signal's size");
    const int most = o.window == WindowShape::box ? BoxWindow::most_radius : most_gaussian_radius;
    if (o.radius < 0 || o.radius > most)
        fail(name, ": radius = ", o.radius, "; pass 0 to ", most, " for a window of this shape");
    if (!(o.epsilon >= 0)) fail(name, ": epsilon = ", o.epsilon, "; pass 0 or more");
    if (o.order != 1 && o.order != 2) fail(name, ": order = ", o.order, "; pass 1 or 2");
    const int terms = PolynomialShape{guide.channels, 1, o.order}.terms();
    if (guide.channels > LocalModels::most_terms || terms > LocalModels::most_terms)
        fail(name, ": a guide of ", guide.channels, " channels has too many terms for order ", o.order, "; pass up to ",
             o.order == 1 ? 44 : 8);
}

/// Rows of floats, each with memory for a multiple of window_group.
class FloatRows {
public:
    FloatRows(int count, int width) {
        const std::size_t stride = (static_cast<std::size_t>(width) / window_group + 1) * window_group;
        samples_.resize(stride * static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) rows_.push_back(samples_.data() + i * stride);
    }
    float* const* get() const { return rows_.data(); }

private:
    std::vector<float> samples_;
    std::vector<float*> rows_;
};

void put(float* const* rows, View<float> to, int first_x, int y) {
    for (int c = 0; c < to.channels; ++c)
        if (to.dx == 1) std::copy_n(rows[c], to.width - first_x, &to(first_x, y, c));
        else
            for (int x = first_x; x < to.width; ++x) to(x, y, c) = rows[c][x - first_x];
}

/// How many samples, or how much weight, box windows have.
class Weights {
public:
    explicit Weights(const BoxWindow& window)
        : width_(static_cast<std::size_t>(window.width)),
          x_(window_counts(window.width, window.radius, window.edge)),
          y_(window_counts(window.height, window.radius, window.edge)),
          inside_x_(window_counts(window.width, window.radius, Edge::renormalize)),
          inside_y_(window_counts(window.height, window.radius, Edge::renormalize)),
          adds_zeros_(window.edge == Edge::zero) {
        x_.resize((x_.size() / window_group + 1) * window_group, 1.0);
    }

    /// Of row y; `counted` are the sums of the weights of what is stored, null where all are 1.
    std::vector<double> row(int y, const double* counted) const {
        std::vector<double> row(x_.size());
        const auto v = static_cast<std::size_t>(y);
        scale_row(x_.data(), y_[v], row.data(), static_cast<int>(row.size()));
        for (std::size_t x = 0; counted != nullptr && x < width_; ++x)
            row[x] = counted[x] + (adds_zeros_ ? row[x] - inside_x_[x] * inside_y_[v] : 0);
        return row;
    }

private:
    std::size_t width_;
    std::vector<double> x_, y_, inside_x_, inside_y_;  // x_ with room for a multiple of window_group
    bool adds_zeros_;
};

/// A run of fits over a picture: to values of the guide itself, or to coefficients.
class Fitter {
public:
    Fitter(View<const float> signal, View<const float> guide, const LocalModelOptions& options)
        : rows_(signal, guide, options.order), guide_(guide), options_(options) {
        for (int k = 0; k < guide.channels; ++k)  // under Edge::zero, what lies outside has to be 0
            offsets_.push_back(options.edge == Edge::zero ? 0 : rows_.offset(k));
        no_offsets_.assign(static_cast<std::size_t>(std::max(signal.channels, guide.channels)), 0.0);
        signal_ = signal;
    }

    const std::vector<double>& offsets() const { return offsets_; }

    /// `to` has the signals as channels, or all coefficients.
    void run(View<float> to, bool wants_values, const Parallel& parallel) const {
        if (options_.window == WindowShape::box) run_box(to, wants_values, parallel);
        else run_gaussian(to, wants_values, parallel);
    }

private:
    bool is_fast() const { return options_.order == 1 && shape().guides <= most_linear_guides; }
    const PolynomialShape& shape() const { return rows_.shape(); }

    void run_box(View<float> to, bool wants_values, const Parallel& parallel) const {
        const BoxWindow window{guide_.width, guide_.height, options_.radius, options_.edge};
        const Weights weights(window);
        const int counted = rows_.has_holes() ? 1 : 0;  // without holes, no weights need to be summed
        const FillRow fill = [&](int y, IndexRange xs, double* const* planes) {
            std::vector<double*> all(static_cast<std::size_t>(shape().planes()));
            std::copy_n(planes, shape().planes() - 1 + counted, all.begin() + 1 - counted);
            rows_.fill(y, xs, offsets_.data(), no_offsets_.data(), all.data());
        };
        const TakeSums take = [&](int y, const double* const* sums) {
            const std::vector<double> weight = weights.row(y, counted == 1 ? sums[0] : nullptr);
            std::vector<const double*> all(static_cast<std::size_t>(shape().planes()), weight.data());
            std::copy_n(sums + counted, shape().planes() - 1, all.begin() + 1);
            FloatRows out(to.channels, to.width);
            if (is_fast()) solve_linear(y, all.data(), wants_values, out);
            else solve(y, {0, to.width}, all.data(), offsets_.data(), no_offsets_.data(), wants_values, out);
            put(out.get(), to, 0, y);
        };
        window_sums(window, shape().planes() - 1 + counted, fill, take, parallel);
    }

    void solve_linear(int y, const double* const* sums, bool wants_values, const FloatRows& out) const {
        LinearFit fit{shape().guides, shape().signals, options_.epsilon, sums};
        std::vector<double> samples;
        std::vector<double*> at;
        if (wants_values) {
            const std::size_t stride = (static_cast<std::size_t>(guide_.width) / window_group + 1) * window_group;
            samples.resize(stride * static_cast<std::size_t>(fit.guides));
            for (int k = 0; k < fit.guides; ++k) at.push_back(samples.data() + static_cast<std::size_t>(k) * stride);
            rows_.fill_guides(y, {0, guide_.width}, offsets_.data(), at.data());
            fit.at = at.data();
        }
        solve_linear_row(fit, guide_.width, out.get());
    }

    /// Columns `xs` of row y, from sums about offsets of their own.
    void solve(int y, IndexRange xs, const double* const* sums, const double* offsets, const double* signal_offsets,
               bool wants_values, const FloatRows& out) const {
        PolynomialFit fit(shape(), options_.epsilon,
                          options_.window == WindowShape::box ? variance_noise : float_variance_noise);
        std::vector<double> away(static_cast<std::size_t>(shape().guides)), shift;
        for (std::size_t k = 0; k < away.size(); ++k) shift.push_back(offsets[k] - offsets_[k]);
        const int values = wants_values ? 1 : 1 + shape().terms();
        const std::ptrdiff_t step = shape().signals * values > 1 ? out.get()[1] - out.get()[0] : 0;
        for (int i = 0; i < xs.count(); ++i) {
            const bool is_known = fit.solve(sums, i);
            for (int k = 0; is_known && wants_values && k < shape().guides; ++k)
                away[static_cast<std::size_t>(k)] =
                    static_cast<double>(guide_(xs.begin + i, y, k)) - offsets[k] - fit.mean(k);
            for (int s = 0; s < shape().signals; ++s) {
                float* const to = out.get()[s * values] + i;
                if (!is_known)
                    for (int v = 0; v < values; ++v) to[v * step] = nothing;
                else if (wants_values) to[0] = static_cast<float>(fit.value(s, away.data()) + signal_offsets[s]);
                else fit.coefficients(s, shift.data(), signal_offsets[s], to, step);
            }
        }
    }

    void run_gaussian(View<float> to, bool wants_values, const Parallel& parallel) const {
        const GaussianWindow window{guide_.width, guide_.height, gaussian_sigma(options_.radius), options_.edge,
                                    shape().planes()};
        const auto start = [&](const GaussianTile& tile) {
            struct Offsets {
                std::vector<double> guides, signals;
            };
            const auto offsets = std::make_shared<Offsets>();
            for (int k = 0; k < shape().guides; ++k)
                offsets->guides.push_back(MomentRows::offset(guide_, k, tile.source_xs, tile.source_ys));
            for (int s = 0; s < shape().signals; ++s)
                offsets->signals.push_back(MomentRows::offset(signal_, s, tile.source_xs, tile.source_ys));
            const FillTileRow fill = [this, offsets](int y, IndexRange xs, double* const* planes) {
                if (y >= 0) rows_.fill(y, xs, offsets->guides.data(), offsets->signals.data(), planes);
                else rows_.fill_zero(offsets->guides.data(), offsets->signals.data(), planes);
            };
            const TakeTileRow take = [this, offsets, tile, to, wants_values](int y, const double* const* means) {
                FloatRows out(to.channels, tile.xs.count());
                solve(y, tile.xs, means, offsets->guides.data(), offsets->signals.data(), wants_values, out);
                put(out.get(), cropped(to, 0, 0, tile.xs.end, to.height), tile.xs.begin, y);
            };
            return TileWork{fill, take};
        };
        gaussian_sums(window, start, parallel);
    }

    MomentRows rows_;
    View<const float> guide_, signal_;
    LocalModelOptions options_;
    std::vector<double> offsets_, no_offsets_;  // of the guides; zeros
};

/// Models, or zeros and the weight 0 where there is none.
void fill_models(View<const float> models, int y, IndexRange xs, double* const* planes) {
    for (int x = xs.begin, i = 0; x < xs.end; ++x, ++i) {
        const bool is_there = y >= 0 && !std::isnan(models(x, y));
        planes[0][i] = is_there || y < 0 ? 1 : 0;  // outside a border of zeros are models of zeros
        for (int c = 0; c < models.channels; ++c)
            planes[1 + c][i] = is_there ? static_cast<double>(models(x, y, c)) : 0;
    }
}

void take_means(View<float> to, int y, IndexRange xs, const double* weights, const double* const* sums) {
    for (int c = 0; c < to.channels; ++c)
        for (int x = xs.begin, i = 0; x < xs.end; ++x, ++i)
            to(x, y, c) = weights[i] > 0 ? static_cast<float>(sums[c][i] / weights[i]) : nothing;
}

/// The means of models over windows.
Image<float> averaged(const Image<float>& models, const LocalModelOptions& o, const Parallel& parallel) {
    Image<float> means(models.width(), models.height(), models.channels());
    const View<const float> from = models.view();
    const View<float> to = means.view();
    if (o.window == WindowShape::box) {
        const BoxWindow window{from.width, from.height, o.radius, o.edge};
        const Weights weights(window);
        window_sums(
            window, 1 + from.channels,
            [&](int y, IndexRange xs, double* const* planes) { fill_models(from, y, xs, planes); },
            [&](int y, const double* const* sums) {
                take_means(to, y, {0, to.width}, weights.row(y, sums[0]).data(), sums + 1);
            },
            parallel);
        return means;
    }
    const GaussianWindow window{from.width, from.height, gaussian_sigma(o.radius), o.edge, 1 + from.channels};
    gaussian_sums(
        window,
        [&](const GaussianTile& tile) {
            return TileWork{
                [&](int y, IndexRange xs, double* const* planes) { fill_models(from, y, xs, planes); },
                [&, tile](int y, const double* const* sums) { take_means(to, y, tile.xs, sums[0], sums + 1); }};
        },
        parallel);
    return means;
}

void check(const LocalModels& m, View<const float> guide) {
    constexpr const char* name = "apply_local_models";
    if (m.guides < 1 || m.signals < 1 || (m.order != 1 && m.order != 2) || m.guides > LocalModels::most_terms ||
        m.offsets.size() != static_cast<std::size_t>(m.guides) ||
        m.coefficients.channels() != m.signals * (1 + m.terms()) || m.coefficients.width() < 1 ||
        m.coefficients.height() < 1)
        fail(name, ": the models are not complete; pass what fit_local_models() made");
    if (guide.channels != m.guides)
        fail(name, ": the guide has ", guide.channels, " channels; pass one of ", m.guides,
             ", as the models were fitted to");
    if (guide.width < 1 || guide.height < 1) fail(name, ": the guide has no samples; pass at least one");
}

bool has_gaps(View<const float> models) {
    for (int y = 0; y < models.height; ++y)
        for (int x = 0; x < models.width; ++x)
            if (std::isnan(models(x, y))) return true;
    return false;
}

/// Coefficients between samples, linearly; where models are missing, of those that are there.
Image<float> interpolated(const Image<float>& models, int width, int height, const Parallel& parallel) {
    const ResizeOptions options{.reconstruction = tent(), .edge = Edge::clamp, .premultiply = false};
    if (!has_gaps(models.view())) return resample(models.view(), width, height, options, parallel);
    Image<float> weighted(models.width(), models.height(), 1 + models.channels());
    for (int y = 0; y < models.height(); ++y)
        for (int x = 0; x < models.width(); ++x) {
            if (std::isnan(models.view()(x, y))) continue;
            weighted.view()(x, y, 0) = 1;
            for (int c = 0; c < models.channels(); ++c) weighted.view()(x, y, 1 + c) = models.view()(x, y, c);
        }
    const Image<float> sums = resample(weighted.view(), width, height, options, parallel);
    Image<float> means(width, height, models.channels());
    for (int c = 0; c < models.channels(); ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const float weight = sums.view()(x, y, 0);
                means.view()(x, y, c) = weight > 1e-6f ? sums.view()(x, y, 1 + c) / weight : nothing;
            }
    return means;
}

/// The value of the polynomial whose constant and coefficients are channels first, first + 1, .... [terms] is room.
float value_at(const LocalModels& m, View<const float> coefficients, int first, View<const float> guide, int x, int y) {
    double u[LocalModels::most_terms];
    for (int k = 0; k < m.guides; ++k)
        u[k] = static_cast<double>(guide(x, y, k)) - m.offsets[static_cast<std::size_t>(k)];
    double value = static_cast<double>(coefficients(x, y, first));
    const auto coefficient = [&](int term) { return static_cast<double>(coefficients(x, y, first + 1 + term)); };
    for (int k = 0; k < m.guides; ++k) value += coefficient(k) * u[k];
    PolynomialShape{m.guides, m.signals, m.order}.each_guide_pair(
        [&](int term, int k, int l) { value += coefficient(term) * (u[k] * u[l]); });
    return static_cast<float>(value);
}

}  // namespace

std::string_view name_of(WindowShape shape) { return shape == WindowShape::box ? "box" : "gaussian"; }

WindowShape parse_window_shape(std::string_view name) {
    for (const WindowShape shape : {WindowShape::box, WindowShape::gaussian})
        if (name == name_of(shape)) return shape;
    fail("\"", name, "\" is not a window; choose box or gaussian");
}

double gaussian_sigma(int radius) { return std::sqrt(radius * (radius + 1.0) / 3); }

LocalModels fit_local_models(View<const float> signal, View<const float> guide, const LocalModelOptions& options,
                             const Parallel& parallel) {
    check(signal, guide, options);
    const Fitter fitter(signal, guide, options);
    LocalModels models{guide.channels, signal.channels, options.order, fitter.offsets(), {}};
    models.coefficients = Image<float>(signal.width, signal.height, signal.channels * (1 + models.terms()));
    fitter.run(models.coefficients.view(), false, parallel);
    if (options.averages) models.coefficients = averaged(models.coefficients, options, parallel);
    return models;
}

Image<float> apply_local_models(const LocalModels& models, View<const float> guide, const Parallel& parallel) {
    check(models, guide);
    const bool has_same_size =
        guide.width == models.coefficients.width() && guide.height == models.coefficients.height();
    const Image<float> other =
        has_same_size ? Image<float>() : interpolated(models.coefficients, guide.width, guide.height, parallel);
    const View<const float> coefficients = has_same_size ? models.coefficients.view() : other.view();
    Image<float> result(guide.width, guide.height, models.signals);
    parallel_for(guide.height, 16, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int s = 0; s < models.signals; ++s)
                for (int x = 0; x < guide.width; ++x)
                    result.view()(x, y, s) = value_at(models, coefficients, s * (1 + models.terms()), guide, x, y);
    });
    return result;
}

Image<float> guided_filter(View<const float> signal, View<const float> guide, const LocalModelOptions& options,
                           const Parallel& parallel) {
    check(signal, guide, options);
    if (options.averages)
        return apply_local_models(fit_local_models(signal, guide, options, parallel), guide, parallel);
    Image<float> result(signal.width, signal.height, signal.channels);
    Fitter(signal, guide, options).run(result.view(), true, parallel);
    return result;
}

}  // namespace bandlimit
