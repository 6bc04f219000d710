#include "bandlimit/resample/resize.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/combine.h"
#include "bandlimit/resample/radial.h"

namespace bandlimit {
namespace {

constexpr int block_rows = 16;    // output rows computed together
constexpr int smallest_run = 64;  // output rows per thread: each run decodes the rows above it once more

/// Rows of interleaved floats, side by side.
class Rows {
public:
    Rows(int count, std::size_t length)
        : length_(length),
          samples_(static_cast<std::size_t>(count) * length),
          pointers_(static_cast<std::size_t>(count)) {
        for (std::size_t i = 0; i < pointers_.size(); ++i) pointers_[i] = samples_.data() + i * length_;
    }
    std::span<float> operator[](int i) { return {pointers_[static_cast<std::size_t>(i)], length_}; }
    Lines lines() const { return pointers_.data(); }
    int count() const { return static_cast<int>(pointers_.size()); }

    /// Rows [first, first + count) as an image.
    View<float> view(int first, int count, int width, int channels) {
        return {pointers_[static_cast<std::size_t>(first)], width, count, channels, channels,
                static_cast<std::ptrdiff_t>(length_),       1};
    }

private:
    std::size_t length_;
    std::vector<float> samples_;
    std::vector<float*> pointers_;
};

/// A window of rows, by index, that slides over the source: what it holds already is not made again.
class SlidingRows {
public:
    explicit SlidingRows(std::size_t length) : length_(length), rows_(0, length) {}

    /// Makes the window hold `range`, calling fill(first, rows view begin, count) for runs of rows that are contiguous.
    template <class Fill>
    void hold(IndexRange range, Fill fill) {
        const int wanted = range.end - range.begin;
        if (wanted > rows_.count()) {
            rows_ = Rows(wanted + wanted / 4, length_);
            held_ = {range.begin, range.begin};
        }
        if (range.begin < held_.begin || range.begin > held_.end) held_ = {range.begin, range.begin};
        for (int v = std::max(held_.end, range.begin); v < range.end;) {
            const int slot = slot_of(v), count = std::min(range.end - v, rows_.count() - slot);
            fill(v, slot, count);
            v += count;
        }
        held_ = {range.begin, std::max(held_.end, range.end)};
        // Rows further back than the window is long have been written over.
        held_.begin = std::max(held_.begin, held_.end - rows_.count());
    }

    Rows& rows() { return rows_; }
    const float* row(int v) const { return rows_.lines()[slot_of(v)]; }

private:
    int slot_of(int v) const {
        const int n = rows_.count();
        return ((v % n) + n) % n;
    }

    std::size_t length_;
    Rows rows_;
    IndexRange held_;
};

Bank bank_of(const Reconstruction& reconstruction, const Axis& src, const Axis& dst, Edge edge, std::string& name) {
    if (const Taps* taps = std::get_if<Taps>(&reconstruction)) {
        name = "taps";
        return make_bank(*taps, src, dst, edge);
    }
    const Kernel* given = std::get_if<Kernel>(&reconstruction);
    const Kernel kernel = given ? *given : auto_kernel(src, dst);
    name = kernel.name;
    return make_bank(kernel, src, dst, edge);
}

/// Half the source samples, at their own pitch, that an output reads before it is widened.
double radius_of(const Reconstruction& reconstruction, const Axis& src, const Axis& dst) {
    if (const Taps* taps = std::get_if<Taps>(&reconstruction))
        return static_cast<double>(taps->weights.size()) / (2 * Mapping(src, dst).stretch());
    const Kernel* given = std::get_if<Kernel>(&reconstruction);
    return given ? given->radius : auto_kernel(src, dst).radius;
}

/// Multiply-adds per sample of the source if one axis is filtered before the other.
double cost(double step_first, double step_second) {
    const auto taps = [](double step) { return std::max(1.0, std::abs(step)); };
    return taps(step_first) / std::abs(step_first) + taps(step_second) / std::abs(step_first * step_second);
}

IndexRange stored(IndexRange read, int count, Edge edge) {
    if (read.begin >= 0 && read.end <= count) return read;
    if (edge == Edge::wrap || read.end - read.begin >= count) return {0, count};
    IndexRange range{count, 0};
    for (int v = read.begin; v < read.end; ++v) {
        const int i = resolve(v, count, edge);
        if (i < 0) continue;
        range.begin = std::min(range.begin, i);
        range.end = std::max(range.end, i + 1);
    }
    return range;
}

struct Shape {
    int width, height, channels;
};
template <class Any>
Shape shape_of(const Any& view) {
    return std::visit([](const auto& v) { return Shape{v.width, v.height, v.channels}; }, view);
}

}  // namespace

Kernel auto_kernel(const Axis& src, const Axis& dst) {
    return std::abs(Mapping(src, dst).step()) > 1 ? shrink3() : grow3();
}

struct Resizer::Plan {
    Grid src, dst;
    int channels;
    ResizeOptions options;
    std::string kernel_x, kernel_y;
    Bank x, y;                         ///< of separable kernels
    std::optional<RadialBank> radial;  ///< instead of both
    bool x_first = false;

    float antiring() const { return static_cast<float>(options.antiring); }
    std::size_t row_length(const Axis& axis) const {
        return static_cast<std::size_t>(axis.count) * static_cast<std::size_t>(channels);
    }
    IndexRange rows_read(int first, int last) const {
        return radial ? radial->rows_read(first, last) : indices_read(y, first, last);
    }
};

namespace {

/// Computes a run of output rows in one thread.
template <class Plan>
class Run {
public:
    Run(const Plan& plan, const SourceRows& source, const TargetRows& target)
        : plan_(plan),
          source_(source),
          target_(target),
          window_(plan.row_length(plan.x_first ? plan.dst.x : plan.src.x)),
          decoded_(plan.x_first ? block_rows : 0, plan.row_length(plan.src.x)),
          middle_(plan.x_first || plan.radial ? 0 : block_rows, plan.row_length(plan.src.x)),
          out_(block_rows, plan.row_length(plan.dst.x)) {}

    /// Rows [begin, end) of the target.
    bool rows(int begin, int end) {
        bool lost = false;
        for (int first = begin; first < end; first += block_rows) {
            const int last = std::min(first + block_rows, end);
            filter(first, last);
            for (int i = first; i < last; ++i) lost |= store(out_[i - first], i);
        }
        return lost;
    }

private:
    void filter(int first, int last) {
        const IndexRange read = plan_.rows_read(first, last);
        window_.hold(read, [&](int v, int slot, int count) { fill(v, slot, count); });
        if (plan_.radial) return filter_radial(first, last, read);
        std::vector<const float*> lines;
        for (int v = read.begin; v < read.end; ++v) lines.push_back(window_.row(v));
        const ConstLines at_zero = lines.data() - read.begin;
        if (plan_.x_first) {
            combine(plan_.y, first, last, plan_.antiring(), at_zero, out_.lines(), plan_.row_length(plan_.dst.x));
        } else {
            combine(plan_.y, first, last, plan_.antiring(), at_zero, middle_.lines(), plan_.row_length(plan_.src.x));
            filter_x(middle_, 0, out_, 0, last - first);
        }
    }

    void filter_radial(int first, int last, IndexRange read) {
        std::vector<const float*> lines;
        for (int v = read.begin; v < read.end; ++v) lines.push_back(window_.row(v));
        for (int i = first; i < last; ++i)
            plan_.radial->row(i, lines.data() - read.begin, plan_.channels, plan_.antiring(), out_[i - first].data());
    }

    void filter_x(Rows& from, int first_from, Rows& to, int first_to, int count) {
        apply(plan_.x, from.view(first_from, count, plan_.src.x.count, plan_.channels),
              to.view(first_to, count, plan_.dst.x.count, plan_.channels), {1}, plan_.options.antiring);
    }

    /// Makes the rows of indices [v, v + count) in slots of the window.
    void fill(int v, int slot, int count) {
        if (!plan_.x_first) {
            for (int i = 0; i < count; ++i) load(v + i, window_.rows()[slot + i]);
            return;
        }
        for (int done = 0; done < count; done += block_rows) {
            const int some = std::min(block_rows, count - done);
            for (int i = 0; i < some; ++i) load(v + done + i, decoded_[i]);
            filter_x(decoded_, 0, window_.rows(), slot + done, some);
        }
    }

    void load(int v, std::span<float> row) {
        const int stored_row = resolve(v, plan_.src.y.count, plan_.options.edge);
        if (stored_row < 0) return std::fill(row.begin(), row.end(), 0.0f);
        decode_row(source_.samples, stored_row - source_.first_row, source_.encoding, plan_.options.premultiply, row);
    }

    bool store(std::span<const float> row, int i) {
        const int y = i - target_.first_row;
        if (target_.background.empty()) return encode_row(row, premultiplied(), target_.samples, y, target_.encoding);
        const auto colours = static_cast<std::size_t>(plan_.channels - 1);
        std::vector<float> opaque(static_cast<std::size_t>(plan_.dst.x.count) * colours);
        composite_row(row, premultiplied(), plan_.channels, source_.encoding.alpha, target_.background, opaque);
        return encode_row(opaque, false, target_.samples, y, target_.encoding);
    }

    bool premultiplied() const { return plan_.options.premultiply || source_.encoding.associated; }

    const Plan& plan_;
    const SourceRows& source_;
    const TargetRows& target_;
    SlidingRows window_;
    Rows decoded_, middle_, out_;
};

}  // namespace

Resizer::Resizer(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options) {
    if (channels < 1) fail("Resizer: channels = ", channels, "; pass 1 or more");
    if (!(options.antiring >= 0 && options.antiring <= 1))
        fail("Resizer: antiring = ", options.antiring, "; pass 0 (off) to 1 (no overshoot)");
    Plan plan{src, dst, channels, options, {}, {}, {}, {}, {}, false};
    const Kernel* kernel = std::get_if<Kernel>(&options.reconstruction);
    if (kernel && is_radial(*kernel)) {
        plan.radial.emplace(*kernel, src.x, dst.x, src.y, dst.y, options.edge);
        plan.kernel_x = plan.kernel_y = kernel->name;
    } else {
        plan.x = bank_of(options.reconstruction, src.x, dst.x, options.edge, plan.kernel_x);
        plan.y = bank_of(options.reconstruction, src.y, dst.y, options.edge, plan.kernel_y);
        const double step_x = Mapping(src.x, dst.x).step(), step_y = Mapping(src.y, dst.y).step();
        plan.x_first = cost(step_x, step_y) < cost(step_y, step_x);
    }
    plan_ = std::make_unique<const Plan>(std::move(plan));
}

Resizer::~Resizer() = default;
Resizer::Resizer(Resizer&&) noexcept = default;
Resizer& Resizer::operator=(Resizer&&) noexcept = default;

std::uint64_t Resizer::bytes(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options,
                             Parallel parallel) {
    const Mapping x(src.x, dst.x), y(src.y, dst.y);
    const double radius_x = radius_of(options.reconstruction, src.x, dst.x);
    const double radius_y = radius_of(options.reconstruction, src.y, dst.y);
    const Kernel* kernel = std::get_if<Kernel>(&options.reconstruction);
    const bool radial = kernel && is_radial(*kernel);
    const std::uint64_t banks = radial ? 0 : bank_bytes(radius_x, src.x, dst.x) + bank_bytes(radius_y, src.y, dst.y);
    const bool x_first = !radial && cost(x.step(), y.step()) < cost(y.step(), x.step());
    // The window of a run and its blocks of rows.
    const double outputs = std::min(block_rows, dst.y.count);
    const double read = std::min<double>(2 * radius_y * y.stretch() + outputs * std::abs(y.step()) + 1, src.y.count);
    const double window = 1.25 * read * (x_first ? dst.x.count : src.x.count);
    const double blocks = block_rows * (static_cast<double>(src.x.count) + dst.x.count);
    const double runs = std::clamp(std::ceil(double(dst.y.count) / smallest_run), 1.0, double(parallel.count()));
    return banks + static_cast<std::uint64_t>(runs * (window + blocks) * channels * sizeof(float));
}

const std::string& Resizer::kernel_x() const { return plan_->kernel_x; }
const std::string& Resizer::kernel_y() const { return plan_->kernel_y; }

IndexRange Resizer::rows_needed(int first, int last) const {
    if (first < 0 || first >= last || last > plan_->dst.y.count)
        fail("Resizer::rows_needed: rows ", first, " to ", last, " of ", plan_->dst.y.count, "; pass a part of them");
    return stored(plan_->rows_read(first, last), plan_->src.y.count, plan_->options.edge);
}

bool Resizer::run(const SourceRows& source, const TargetRows& target, Parallel parallel) const {
    const Shape from = shape_of(source.samples), to = shape_of(target.samples);
    const int out_channels = plan_->channels - (target.background.empty() ? 0 : 1);
    if (from.width != plan_->src.x.count || to.width != plan_->dst.x.count || from.channels != plan_->channels ||
        to.channels != out_channels)
        fail("Resizer::run: source ", from.width, " wide with ", from.channels, " channels, target ", to.width,
             " with ", to.channels, "; need ", plan_->src.x.count, " with ", plan_->channels, " and ",
             plan_->dst.x.count, " with ", out_channels);
    if (!target.background.empty() &&
        (source.encoding.alpha < 0 || target.background.size() != static_cast<std::size_t>(out_channels)))
        fail("Resizer::run: a background of ", target.background.size(), " channels; it needs an alpha channel and ",
             out_channels, " values");
    if (to.height == 0) return false;
    const IndexRange needed = rows_needed(target.first_row, target.first_row + to.height);
    if (needed.begin < source.first_row || needed.end > source.first_row + from.height)
        fail("Resizer::run: source rows ", source.first_row, " to ", source.first_row + from.height, "; rows ",
             needed.begin, " to ", needed.end, " are needed");
    std::atomic<bool> lost = false;
    const int share = (to.height + parallel.count() - 1) / parallel.count();
    parallel_for(to.height, std::max(share, smallest_run), parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Run<Plan> run(*plan_, source, target);
        if (run.rows(target.first_row + static_cast<int>(begin), target.first_row + static_cast<int>(end))) lost = true;
    });
    return lost;
}

Image<float> resample(View<const float> src, int width, int height, const ResizeOptions& options, Parallel parallel,
                      Layout layout) {
    Image<float> result(width, height, src.channels, layout);
    const Resizer resizer({{src.width}, {src.height}}, {{width}, {height}}, src.channels, options);
    resizer.run({src, 0, {}}, {result.view(), 0, {}, {}}, parallel);
    return result;
}

}  // namespace bandlimit
