#include "bandlimit/filter/gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "bandlimit/core/error.h"
#include "bandlimit/core/image.h"
#include "bandlimit/resample/bank_builder.h"
#include "bandlimit/resample/term_filter.h"

namespace bandlimit {
namespace {

using enum GradientResult;
constexpr std::array<std::string_view, 8> result_names{"magnitude", "dx",     "dy",        "value",
                                                       "direction", "tensor", "coherence", "normals"};

bool needs_window(GradientResult result) { return result == tensor || result == coherence; }

double number(float v) { return static_cast<double>(v); }

/// The bank of `count` samples to outputs at [outputs), which may lie outside and read what the edge puts there.
Bank grid_bank(const Taps& taps, int count, IndexRange outputs, Edge edge) {
    BankBuilder builder(count, outputs.count(), edge, CutRows::unfinished);
    const PhaseRow row{taps.first, taps.weights, taps.first, taps.first};
    for (int i = outputs.begin; i < outputs.end; ++i) {
        Position at;
        at.whole = i;
        builder.add(at, row);
    }
    return builder.take();
}

/// The indices that outputs at [outputs) of these taps read.
IndexRange read_by(const Taps& taps, IndexRange outputs) {
    return {outputs.begin + taps.first, outputs.end + taps.first + static_cast<int>(taps.weights.size()) - 1};
}

/// The same taps on samples that begin where the first of them reads.
Bank inner_bank(const Taps& taps, int outputs) {
    const int count = outputs + static_cast<int>(taps.weights.size()) - 1;
    return grid_bank({0, taps.weights, 1}, count, {0, outputs}, Edge::clamp);
}

/// Weights of the differences f(i + 1) - f(i) that do what taps of sum 0 do to f.
Taps on_differences(const Taps& taps) {
    Taps result{taps.first, {}, 1};
    double sum = 0;
    for (std::size_t i = 0; i + 1 < taps.weights.size(); ++i) result.weights.push_back(-(sum += taps.weights[i]));
    return result;
}

/// Filters one after the other, each on what the one before made.
struct Chain {
    std::vector<RowFilter> steps = {};

    IndexRange rows_read(int first, int last) const {
        IndexRange rows{first, last};
        for (auto step = steps.rbegin(); step != steps.rend(); ++step)
            rows = step->protocol().rows_read(0, rows.begin, rows.end);
        return rows;
    }
    double bytes(int channels) const {
        double sum = 0;
        for (const RowFilter& step : steps) sum += static_cast<double>(step.bytes(channels, {1}));
        return sum;
    }
    /// Makes the rows of `to`, of which the first is row `first`.
    void run(const SourceRows& source, View<float> to, int first) const {
        if (steps.size() == 1) {
            steps[0].run(source, {to, first, {}, {}}, {1});
            return;
        }
        const IndexRange rows = steps[1].protocol().rows_read(0, first, first + to.height);
        Image<float> between(steps[0].protocol().width, rows.count(), to.channels, Layout::interleaved);
        steps[0].run(source, {between.view(), rows.begin, {}, {}}, {1});
        steps[1].run({std::as_const(between).view(), rows.begin, {}}, {to, first, {}, {}}, {1});
    }
};

/// A picture, and how far beyond it on each side derivatives are wanted.
struct Domain {
    int width, height;
    Edge edge;
    bool premultiply;
    int before = 0, after = 0;

    IndexRange columns() const { return {-before, width + after}; }
    IndexRange rows() const { return {-before, height + after}; }
    bool is_padded() const { return before != 0 || after != 0; }
};

int used(const Taps& taps) {
    return static_cast<int>(std::count_if(taps.weights.begin(), taps.weights.end(), [](double w) { return w != 0; }));
}

/// One product on the padded domain.
RowFilter product(const Taps& x, const Taps& y, const Domain& d) {
    if (!d.is_padded())
        return term_filter(Terms{{y.weights, x.weights}}, x.first, y.first,
                           {d.width, d.height, d.edge, d.edge, d.premultiply});
    return term_filter({{grid_bank(x, d.width, d.columns(), d.edge), grid_bank(y, d.height, d.rows(), d.edge)}},
                       d.premultiply);
}

/// The derivative along x, or along y.
Chain derivative_chain(const Gradient& gradient, bool is_x, const Domain& d) {
    const Taps &x = is_x ? gradient.along : gradient.across, &y = is_x ? gradient.across : gradient.along;
    if (used(gradient.along) <= 2) return {{product(x, y, d)}};
    const Taps difference{0, {-1, 1}, 1}, self{0, {1}, 1};
    const Taps then_x = is_x ? on_differences(x) : x, then_y = is_x ? y : on_differences(y);
    const Bank first_x = grid_bank(is_x ? difference : self, d.width, read_by(then_x, d.columns()), d.edge);
    const Bank first_y = grid_bank(is_x ? self : difference, d.height, read_by(then_y, d.rows()), d.edge);
    return {{term_filter({{first_x, first_y}}, d.premultiply),
             term_filter({{inner_bank(then_x, d.columns().count()), inner_bank(then_y, d.rows().count())}}, false)}};
}

Chain laplacian_chain(const Laplacian& laplacian, const Domain& d) {
    const WeightSize size = size_of(laplacian.terms);
    return {{term_filter(laplacian.terms, centred_first(size.width), centred_first(size.height),
                         {d.width, d.height, d.edge, d.edge, d.premultiply})}};
}

/// Hue in turns, at value 1, as red, green and blue.
std::array<float, 3> hsv(double hue, double saturation) {
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double turns = std::abs(hue - static_cast<double>(c) / 3), from_peak = std::min(turns, 1 - turns);
        const double colour = std::clamp(2 - 6 * from_peak, 0.0, 1.0);
        rgb[c] = static_cast<float>(1 - saturation * (1 - colour));
    }
    return rgb;
}

/// Gradients of one sample, of all its channels.
struct Slopes {
    const float *x, *y;
    int channels;
};

/// What is averaged over the window, of one sample.
void fields_of(GradientResult result, Slopes s, float* to) {
    const auto count = static_cast<std::size_t>(s.channels);
    switch (result) {
        case dx:
        case value: std::copy_n(s.x, count, to); return;
        case dy: std::copy_n(s.y, count, to); return;
        case magnitude:
            for (std::size_t c = 0; c < count; ++c) to[c] = s.x[c] * s.x[c] + s.y[c] * s.y[c];
            return;
        case direction:
            std::copy_n(s.x, count, to);
            std::copy_n(s.y, count, to + count);
            return;
        case normals: to[0] = s.x[0], to[1] = s.y[0]; return;
        case tensor:
        case coherence:
            to[0] = to[1] = to[2] = 0;
            for (std::size_t c = 0; c < count; ++c) {
                to[0] += s.x[c] * s.x[c];
                to[1] += s.x[c] * s.y[c];
                to[2] += s.y[c] * s.y[c];
            }
            return;
    }
}

int field_count(GradientResult result, int channels) {
    switch (result) {
        case direction: return 2 * channels;
        case normals: return 2;
        case tensor:
        case coherence: return 3;
        default: return channels;
    }
}

void store_direction(const float* fields, int channels, float* to) {
    double x = 0, y = 0, most = -1;
    for (int c = 0; c < channels; ++c) {
        const double u = number(fields[c]), v = number(fields[channels + c]), square = u * u + v * v;
        if (square > most || std::isnan(square)) x = u, y = v, most = square;  // one that is NaN stays
    }
    const double turns = std::atan2(y, x) / (2 * std::numbers::pi);
    const auto rgb = hsv(turns < 0 ? turns + 1 : turns, std::min(std::sqrt(most), 1.0));
    std::copy(rgb.begin(), rgb.end(), to);
}

void store_normal(const float* fields, const GradientOptions& o, bool to_codes, float* to) {
    const double up = o.convention == NormalConvention::opengl ? 1 : -1;
    const double x = -o.height * number(fields[0]), y = up * o.height * number(fields[1]);
    const double length = std::sqrt(x * x + y * y + 1);
    const double n[] = {x / length, y / length, 1 / length};
    for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(to_codes ? (n[c] + 1) / 2 : n[c]);
}

/// What is stored of one sample. `channels` are the source's.
void store(const GradientOptions& o, const float* fields, int channels, bool is_laplacian, bool to_codes, float* to) {
    switch (o.result) {
        case dx:
        case dy:
        case value: std::copy_n(fields, channels, to); return;
        case magnitude:
            for (int c = 0; c < channels; ++c) to[c] = is_laplacian ? std::abs(fields[c]) : std::sqrt(fields[c]);
            return;
        case direction: store_direction(fields, channels, to); return;
        case normals: store_normal(fields, o, to_codes, to); return;
        case tensor:
        case coherence: {
            const StructureTensor t{number(fields[0]), number(fields[1]), number(fields[2])};
            const float found = static_cast<float>(coherence_of(t, o.coherence));
            if (o.result == coherence) return static_cast<void>(to[0] = found);
            std::copy_n(fields, 3, to);
            to[3] = static_cast<float>(std::sqrt(eigenvalues(t).larger));
            to[4] = static_cast<float>(orientation(t));
            to[5] = found;
            return;
        }
    }
}

/// A gradient_filter() ready to run.
class GradientPlan {
public:
    GradientPlan(const DerivativeOperator& derivative, int width, int height, GradientOptions options)
        : options_(std::move(options)),
          width_(width),
          height_(height),
          is_laplacian_(std::holds_alternative<Laplacian>(derivative)) {
        Domain domain{width, height, options_.edge, options_.premultiply};
        if (is_laplacian_) {
            x_ = laplacian_chain(std::get<Laplacian>(derivative), domain);
            return;
        }
        const auto& gradient = std::get<Gradient>(derivative);
        const Taps window = needs_window(options_.result) ? convolved(gradient.mean, options_.window) : gradient.mean;
        if (window.weights.size() > 1) {
            domain.before = -window.first;
            domain.after = window.first + static_cast<int>(window.weights.size()) - 1;
            padding_ = domain.before + domain.after;
            window_ = term_filter({{inner_bank(window, width), inner_bank(window, height)}}, false);
        }
        if (options_.result != dy) x_ = derivative_chain(gradient, true, domain);
        if (options_.result != dx) y_ = derivative_chain(gradient, false, domain);
        block_ = std::max(block_, padding_);
    }

    IndexRange rows_read(int first, int last) const {
        IndexRange all{first, last};
        for (const Chain* chain : {&x_, &y_}) {
            if (chain->steps.empty()) continue;
            const IndexRange read = chain->rows_read(first, last + padding_);
            all = {std::min(all.begin, read.begin), std::max(all.end, read.end)};
        }
        return all;
    }

    double bytes(int channels, const Parallel& parallel) const {
        const double samples = double(width_ + padding_) * (std::min(block_, height_) + padding_);
        const double held = samples * sizeof(float) * (5 * channels + 2 * field_count(options_.result, channels));
        const double engine =
            x_.bytes(channels) + y_.bytes(channels) + (window_ ? static_cast<double>(window_->bytes(3, {1})) : 0.0);
        return parallel.count() * (held + engine);
    }

    RowWork start(const RowRun& run) const {
        const RowParts parts(run.rows(), block_, run.parallel.count());
        return {parts.count(), [this, &run, parts](int piece) {
                    const IndexRange rows = parts[piece];
                    bool lost = false;
                    for (int first = rows.begin; first < rows.end; first += block_)
                        lost |= make(run, first, std::min(first + block_, rows.end));
                    return lost;
                }};
    }

private:
    bool has_gradient() const { return !x_.steps.empty() && !y_.steps.empty(); }

    /// Derivatives of rows [first, last) and of those that the window reads besides.
    Image<float> slopes(const Chain& chain, const RowRun& run, int first, int last) const {
        if (chain.steps.empty()) return {};
        Image<float> image(width_ + padding_, last - first + padding_, run.channels, Layout::interleaved);
        chain.run(run.sources[0], image.view(), first);
        return image;
    }

    Image<float> fields(const RowRun& run, int first, int last) const {
        Image<float> x = slopes(x_, run, first, last), y = slopes(y_, run, first, last);
        if (!has_gradient()) return y_.steps.empty() ? std::move(x) : std::move(y);
        Image<float> all(x.width(), x.height(), field_count(options_.result, run.channels), Layout::interleaved);
        for (int v = 0; v < all.height(); ++v)
            for (int u = 0; u < all.width(); ++u)
                fields_of(options_.result, {&x.view()(u, v), &y.view()(u, v), run.channels}, &all.view()(u, v));
        return all;
    }

    Image<float> averaged(Image<float> fields, int first, int last) const {
        if (!window_) return fields;
        Image<float> means(width_, last - first, fields.channels(), Layout::interleaved);
        window_->run({std::as_const(fields).view(), first, {}}, {means.view(), first, {}, {}}, {1});
        return means;
    }

    bool make(const RowRun& run, int first, int last) const {
        const Image<float> means = averaged(fields(run, first, last), first, last);
        const bool to_codes = is_integer(depth_of(const_view(run.target.samples)));
        const Encoding encoding{has_source_units(options_.result) ? run.target.encoding.transfer : Transfer::linear, -1,
                                false};
        const int channels = channels_of(options_.result, run.channels);
        std::vector<float> row(static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels));
        bool lost = false;
        for (int y = first; y < last; ++y) {
            for (int x = 0; x < width_; ++x)
                store(options_, &means.view()(x, y - first), run.channels, is_laplacian_, to_codes,
                      &row[static_cast<std::size_t>(x) * static_cast<std::size_t>(channels)]);
            lost |= encode_row(row, false, run.target.samples, y - run.target.first_row, encoding);
            run.monitor.made(std::int64_t{width_} * run.channels);
        }
        return lost;
    }

    GradientOptions options_;
    int width_, height_, padding_ = 0;
    int block_ = 48;  ///< rows at a time: with the rows that windows read besides, they are made anew by each
    bool is_laplacian_;
    Chain x_, y_;                      ///< of a Laplacian, x_ alone
    std::optional<RowFilter> window_;  ///< over fields
};

void check(const DerivativeOperator& derivative, int width, int height, const GradientOptions& o) {
    if (width < 1 || height < 1) fail("gradients: ", width, " x ", height, " samples; pass at least one");
    if (o.edge == Edge::renormalize)
        fail("gradients: Edge::renormalize has nothing to rescale weights of sum 0 to; pass another edge, as reflect");
    if (!has_result(derivative, o.result))
        fail("gradients: this operator has no ", name_of(o.result),
             "; Laplacians have magnitude and value, gradients all but value");
    double sum = 0;
    bool is_below = false;
    for (const double w : o.window.weights) sum += w, is_below |= !(w >= 0);
    if (is_below || !(std::abs(sum - 1) < 1e-9))
        fail("gradients: a window of ", o.window.weights.size(), " weights that sum to ", sum,
             "; pass one without negative weights that sums to 1");
    if (!std::isfinite(o.height)) fail("gradients: height = ", o.height, "; pass a finite one");
}

}  // namespace

std::string_view name_of(GradientResult result) { return result_names[static_cast<std::size_t>(result)]; }

GradientResult parse_gradient_result(std::string_view name) {
    const auto found = std::find(result_names.begin(), result_names.end(), name);
    if (found == result_names.end())
        fail("result \"", name,
             "\" is unknown; choose magnitude, dx, dy, direction, tensor, coherence, normals, or value of a Laplacian");
    return static_cast<GradientResult>(found - result_names.begin());
}

int channels_of(GradientResult result, int channels) {
    switch (result) {
        case direction:
        case normals: return 3;
        case tensor: return 6;
        case coherence: return 1;
        default: return channels;
    }
}

bool has_source_units(GradientResult result) {
    using enum GradientResult;
    return result == magnitude || result == dx || result == dy || result == value;
}

bool has_result(const DerivativeOperator& derivative, GradientResult result) {
    using enum GradientResult;
    if (std::holds_alternative<Laplacian>(derivative)) return result == magnitude || result == value;
    return result != value;
}

RowFilter gradient_filter(const DerivativeOperator& derivative, int width, int height, const GradientOptions& options) {
    check(derivative, width, height, options);
    const auto plan = std::make_shared<const GradientPlan>(derivative, width, height, options);
    RowProtocol protocol;
    protocol.name = "gradients";
    protocol.sources = {{width, height, options.edge}};
    protocol.width = width, protocol.height = height;
    protocol.target_channels = has_source_units(options.result) ? 0 : channels_of(options.result, 1);
    protocol.rows_read = [plan](std::size_t, int first, int last) { return plan->rows_read(first, last); };
    protocol.bytes = [plan](int channels, const Parallel& parallel) { return plan->bytes(channels, parallel); };
    protocol.start = [plan](const RowRun& run) { return plan->start(run); };
    return RowFilter(std::move(protocol));
}

}  // namespace bandlimit
