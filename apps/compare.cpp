// bandlimit compare: how far two images are apart, and by how much they are shifted.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>
#include "apps/common.h"
#include "bandlimit/analysis/metrics.h"
#include "bandlimit/analysis/shift.h"
#include "bandlimit/color/encoding.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit::app {
namespace {

using nlohmann::ordered_json;

constexpr int block_rows = 16;

enum class Measure { encoded, linear };

struct Options {
    std::string a, b, diff;
    int border = 0;
    Space space = Space::automatic;
    std::optional<Measure> measure;  ///< default: encoded for integer files, else linear
    Parallel parallel;
    bool json = false;
};

/// What a file's samples are measured as.
class Source {
public:
    Source(const std::string& path, int threads) : reader_(path, threads) {}

    const ImageInfo& info() const { return reader_.info(); }

    /// Reads the next rows; the view is valid until the next call.
    View<const float> read(int y, int rows, Measure measure, Space space, Parallel parallel) {
        const ImageInfo& in = info();
        if (values_.width() == 0) {
            stored_ = make_image(in.depth, in.width, std::min(block_rows, in.height), in.channels());
            values_ = Image<float>(in.width, std::min(block_rows, in.height), in.channels(), Layout::interleaved);
        }
        const AnyView stored =
            std::visit([&](auto view) { return AnyView(cropped(view, 0, 0, in.width, rows)); }, view_of(stored_));
        reader_.read_rows(y, stored);
        const View<float> values = cropped(values_.view(), 0, 0, in.width, rows);
        parallel_for(rows, 4, parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (int row = static_cast<int>(begin); row < end; ++row)
                decode(const_view(stored), row, measure, in.encoding(space), space == Space::data, values);
        });
        return values;
    }

private:
    void decode(const AnyConstView& stored, int row, Measure measure, const Encoding& encoding, bool is_data,
                View<float> values) const {
        const std::span<float> out(&values(0, row),
                                   static_cast<std::size_t>(values.width) * static_cast<std::size_t>(values.channels));
        if (measure == Measure::linear) return decode_row(stored, row, encoding, false, out);
        decode_row(stored, row, Encoding{}, false, out);  // as stored
        if (is_data || is_integer(info().depth) || encoding.transfer != Transfer::linear) return;
        for (int x = 0; x < values.width; ++x)
            for (int c = 0; c < values.channels; ++c)
                if (c != encoding.alpha)
                    values(x, row, c) = static_cast<float>(linear_to_srgb(double(values(x, row, c))));
    }

    ImageReader reader_;
    AnyImage stored_;
    Image<float> values_;
};

/// Copies what lies in a window out of rows that pass by.
class WindowCollector {
public:
    explicit WindowCollector(const ShiftWindow& window, int channels)
        : window_(window), image_(window.width, window.height, channels, Layout::interleaved) {}

    void add_rows(int y, View<const float> rows) {
        for (int row = std::max(0, window_.y - y); row < std::min(rows.height, window_.y + window_.height - y); ++row)
            for (int x = 0; x < window_.width; ++x)
                for (int c = 0; c < rows.channels; ++c)
                    image_.view()(x, y + row - window_.y, c) = rows(window_.x + x, row, c);
    }
    View<float> view() { return image_.view(); }

private:
    ShiftWindow window_;
    Image<float> image_;
};

/// Writes |a - b| of the colour channels, row by row.
class DiffWriter {
public:
    DiffWriter(const std::string& path, const ImageInfo& a, int threads) : alpha_(a.alpha) {
        const FormatAbilities format = abilities_of(path);
        ImageTarget target;
        target.width = a.width;
        target.height = a.height;
        for (int c = 0; c < a.channels(); ++c)
            if (c != a.alpha || a.channels() == 1)
                target.channel_names.push_back(a.channel_names[static_cast<std::size_t>(c)]);
        target.depth = nearest_depth(format, a.depth);
        target.transfer = Transfer::linear;
        target.is_data = true;
        channels_ = static_cast<int>(target.channel_names.size());
        stored_ = make_image(target.depth, a.width, 1, channels_);
        writer_.emplace(path, target, threads);
    }

    void add_rows(View<const float> a, View<const float> b) {
        for (int y = 0; y < a.height; ++y) {
            row_.clear();
            for (int x = 0; x < a.width; ++x)
                for (int c = 0; c < a.channels; ++c)
                    if (c != alpha_ || a.channels == 1) row_.push_back(std::abs(a(x, y, c) - b(x, y, c)));
            encode_row(row_, false, view_of(stored_), 0, Encoding{});
            writer_->write_rows(const_view(view_of(stored_)));
        }
    }
    void finish() { writer_->finish(); }

private:
    int alpha_, channels_ = 0;
    AnyImage stored_;
    std::vector<float> row_;
    std::optional<ImageWriter> writer_;
};

ShiftWindow window_within(int width, int height, int border) {
    ShiftWindow window = shift_window(width - 2 * border, height - 2 * border);
    window.x += border;
    window.y += border;
    return window;
}

/// Applies a transfer function to every channel but alpha.
void convert(View<float> v, int alpha, double (*transfer)(double)) {
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x)
            for (int c = 0; c < v.channels; ++c)
                if (c != alpha) v(x, y, c) = static_cast<float>(transfer(double(v(x, y, c))));
}

/// Filters move edges if one looks at their results through another transfer function than they ran in: bright sides
/// grow. So the shift of sRGB files is estimated from codes and from linear light, and the one counts that leaves less
/// unexplained.
Shift shift_of(const Options& o, const Source& a, const Source& b, Measure as, View<float> va, View<float> vb) {
    const Shift measured = estimate_shift(va, vb, o.parallel);
    const bool has_curve =
        a.info().encoding(o.space).transfer == Transfer::srgb && b.info().encoding(o.space).transfer == Transfer::srgb;
    if (!has_curve) return measured;
    const auto transfer = as == Measure::encoded ? srgb_to_linear : linear_to_srgb;
    convert(va, a.info().alpha, transfer);
    convert(vb, b.info().alpha, transfer);
    const Shift other = estimate_shift(va, vb, o.parallel);
    return other.residual < measured.residual ? other : measured;
}

struct Result {
    Metrics metrics;
    Shift shift;
};

/// Takes all rows of both files through the meters and the windows.
Metrics pass_rows(const Options& o, Console& console, Source& a, Source& b, Measure as, WindowCollector& window_a,
                  WindowCollector& window_b) {
    const int width = a.info().width, height = a.info().height, channels = a.info().channels();
    ErrorMeter errors(width, height, channels, o.border, o.parallel);
    SsimMeter similarity(width, height, channels, o.border, o.parallel);
    std::optional<DiffWriter> diff;
    if (!o.diff.empty()) diff.emplace(o.diff, a.info(), o.parallel.threads);

    Progress progress(console, "comparing", height);
    for (int y = 0, rows = 0; y < height; y += rows) {
        rows = std::min(block_rows, height - y);
        const View<const float> va = a.read(y, rows, as, o.space, o.parallel);
        const View<const float> vb = b.read(y, rows, as, o.space, o.parallel);
        errors.add_rows(va, vb);
        similarity.add_rows(va, vb);
        window_a.add_rows(y, va);
        window_b.add_rows(y, vb);
        if (diff) diff->add_rows(va, vb);
        progress.advance_to(y + rows);
    }
    if (diff) diff->finish();
    std::vector<Measures> per_channel;
    errors.fill(per_channel);
    similarity.fill(per_channel);
    return summarize(std::move(per_channel));
}

Result measure(const Options& o, Console& console, Source& a, Source& b, Measure as) {
    const ImageInfo& info = a.info();
    const ShiftWindow window = window_within(info.width, info.height, o.border);
    WindowCollector window_a(window, info.channels()), window_b(window, info.channels());
    Metrics metrics = pass_rows(o, console, a, b, as, window_a, window_b);
    return {std::move(metrics), shift_of(o, a, b, as, window_a.view(), window_b.view())};
}

void check_same_shape(const Options& o, const ImageInfo& a, const ImageInfo& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::runtime_error(
            fmt::format("{} is {} x {}, {} is {} x {}; resize one of them first (bandlimit resize)", o.a, a.width,
                        a.height, o.b, b.width, b.height));
    if (a.channels() != b.channels())
        throw std::runtime_error(
            fmt::format("{} has {} channels, {} has {}; give both the same", o.a, a.channels(), o.b, b.channels()));
    if (o.border > (std::min(a.width, a.height) - 1) / 2)
        throw std::runtime_error(fmt::format("--border {} leaves nothing of {}, which is {} x {}; use {} or less",
                                             o.border, o.a, a.width, a.height, (std::min(a.width, a.height) - 1) / 2));
}

ordered_json decibels(double psnr) { return std::isinf(psnr) ? ordered_json("inf") : ordered_json(psnr); }
ordered_json or_null(const std::optional<double>& v) { return v ? ordered_json(*v) : ordered_json(); }

ordered_json report(const Options& o, const ImageInfo& info, Measure as, const Result& r) {
    ordered_json channels = ordered_json::array();
    for (std::size_t c = 0; c < r.metrics.per_channel.size(); ++c) {
        const Measures& m = r.metrics.per_channel[c];
        channels.push_back({{"channel", info.channel_names[c]},
                            {"mse", m.mse},
                            {"psnr", decibels(m.psnr())},
                            {"max_abs", m.max_abs},
                            {"ssim", m.ssim}});
    }
    return {{"mse", r.metrics.mse},
            {"psnr", decibels(r.metrics.psnr())},
            {"max_abs", r.metrics.max_abs},
            {"ssim", r.metrics.ssim},
            {"shift_x", or_null(r.shift.x)},
            {"shift_y", or_null(r.shift.y)},
            {"width", info.width},
            {"height", info.height},
            {"channels", info.channels()},
            {"measure", as == Measure::encoded ? "encoded" : "linear"},
            {"border", o.border},
            {"per_channel", channels}};
}

std::string psnr_text(double psnr) { return std::isinf(psnr) ? "inf" : fmt::format("{:.3f}", psnr); }

/// "+0.500  (B lies right of A)"
std::string shift_text(const std::optional<double>& shift, const char* below, const char* above) {
    if (!shift) return "undefined";
    const double rounded = std::round(*shift * 1000) / 1000 + 0.0;  // + 0: no minus zero
    const std::string text = fmt::format("{:+.3f} px", rounded);
    return std::abs(rounded) < 0.005 ? text : fmt::format("{}  (B lies {} A)", text, rounded < 0 ? below : above);
}

void print(Console& console, const Options& o, const ImageInfo& info, Measure as, const Result& r) {
    console.print("A  {}\nB  {}\n", o.a, o.b);
    console.print("{} x {}, {} channel{}, {} values, white is 1", info.width, info.height, info.channels(),
                  info.channels() == 1 ? "" : "s", as == Measure::encoded ? "encoded" : "linear");
    if (o.border > 0) console.print(", without a border of {}", o.border);
    console.print("\n\n");
    console.print("{:<10}{:>12}{:>10}{:>12}{:>10}\n", "", "MSE", "PSNR/dB", "max |A-B|", "SSIM");
    const auto line = [&](const std::string& name, const Measures& m) {
        console.print("{:<10}{:>12.5g}{:>10}{:>12.6f}{:>10.6f}\n", name, m.mse, psnr_text(m.psnr()), m.max_abs, m.ssim);
    };
    line("all", r.metrics);
    for (std::size_t c = 0; info.channels() > 1 && c < r.metrics.per_channel.size(); ++c)
        line(info.channel_names[c], r.metrics.per_channel[c]);
    console.print("\nshift x   {}\nshift y   {}\n", shift_text(r.shift.x, "left of", "right of"),
                  shift_text(r.shift.y, "above", "below"));
}

void run(const Options& o, Console& console) {
    if (!o.diff.empty()) check_output_path(o.diff);
    Source a(o.a, o.parallel.threads), b(o.b, o.parallel.threads);
    check_same_shape(o, a.info(), b.info());
    const bool codes = is_integer(a.info().depth) && is_integer(b.info().depth);
    const Measure as = o.measure.value_or(codes ? Measure::encoded : Measure::linear);
    const Result result = measure(o, console, a, b, as);
    if (o.json) console.print_json(report(o, a.info(), as, result));
    else print(console, o, a.info(), as, result);
}

}  // namespace

void add_compare(Program& program) {
    auto o = std::make_shared<Options>();
    Verb verb = program.add_verb("compare", "Measure how far two images are apart: MSE, PSNR, SSIM, shift",
                                 "bandlimit compare examples/coffee.png examples/coffee.png");
    verb.add_option("A", o->a, "The first image").required();
    verb.add_option("B", o->b, "The second image; a shift above 0 means that its content lies right of or below A's")
        .required();
    verb.add_option("--border", o->border, "Pixels to leave out on every side; default 0")
        .in_range(0, 1 << 30)
        .type_name("N");
    add_space(verb, o->space);
    verb.add_option_function<std::string>(
            "--measure",
            [o](const std::string& s) {
                if (s != "encoded" && s != "linear")
                    throw UsageError("--measure: \"" + s + "\" is unknown; choose encoded or linear");
                o->measure = s == "encoded" ? Measure::encoded : Measure::linear;
            },
            "What to compare: codes, divided by the largest (default where both files hold integers;\n"
            "linear floats are sRGB-encoded for it), or linear light (default for float files)")
        .type_name("encoded|linear");
    verb.add_option("--diff", o->diff,
                    "Write |A - B| of the measured values, without alpha, to an image of linear codes,\n"
                    "to be read with --space data")
        .type_name("OUT");
    add_threads(verb, o->parallel);
    add_json(verb, o->json);
    program.add_quiet(verb);
    program.on(
        verb,
        [o] {
            if (!o->diff.empty()) check_output_format(o->diff, {});
        },
        [o](Console& console) { run(*o, console); });
}

}  // namespace bandlimit::app
