#include "bandlimit/resample/resize.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "bandlimit/core/error.h"
#include "bandlimit/resample/float_resize.h"
#include "bandlimit/resample/plan.h"

namespace bandlimit {
namespace {

constexpr int smallest_run = 64;  // output rows per thread: each run decodes the rows above it once more

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

void plan_bytes(ResizePlan& plan) {
    plan.bytes = make_byte_plan(make_byte_banks(plan.x, plan.y));
    for_each_run(plan.bytes->banks.x, 0, plan.dst.x.count, [&](int first, int last, bool fits) {
        if (!fits) add_strips(plan, first, last, plan.strips_past_bytes);
    });
}

/// Computes output rows [begin, end): what fits them in integers, the rest in floats. Returns whether a value that is
/// not finite was lost.
bool resize_codes(const ResizePlan& plan, const SourceRows& source, const TargetRows& target, int begin, int end) {
    const auto from = std::get<View<const std::uint8_t>>(source.samples);
    const auto to = std::get<View<std::uint8_t>>(target.samples);
    bool lost = false;
    for_each_run(plan.bytes->banks.y, begin, end, [&](int first, int last, bool fits) {
        if (fits) resize_bytes(*plan.bytes, from, source.first_row, to, target.first_row, first, last);
        lost |= resize_floats(plan, fits ? plan.strips_past_bytes : plan.strips, source, target, first, last);
    });
    return lost;
}

}  // namespace

Kernel auto_kernel(const Axis& src, const Axis& dst) {
    return std::abs(Mapping(src, dst).step()) > 1 ? shrink3() : grow3();
}

Resizer::Resizer(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options) {
    if (channels < 1) fail("Resizer: channels = ", channels, "; pass 1 or more");
    if (!(options.antiring >= 0 && options.antiring <= 1))
        fail("Resizer: antiring = ", options.antiring, "; pass 0 (off) to 1 (no overshoot)");
    auto plan =
        std::make_unique<ResizePlan>(ResizePlan{src, dst, channels, options, {}, {}, {}, {}, {}, false, {}, {}, {}});
    const Kernel* kernel = std::get_if<Kernel>(&options.reconstruction);
    if (kernel && is_radial(*kernel)) {
        plan->radial.emplace(*kernel, src.x, dst.x, src.y, dst.y, options.edge, plan->edge_y());
        plan->kernel_x = plan->kernel_y = kernel->name;
    } else {
        plan->x = bank_of(options.reconstruction, src.x, dst.x, options.edge, plan->kernel_x);
        plan->y = bank_of(options.reconstruction, src.y, dst.y, plan->edge_y(), plan->kernel_y);
        const double step_x = Mapping(src.x, dst.x).step(), step_y = Mapping(src.y, dst.y).step();
        plan->x_first = cost(step_x, step_y) < cost(step_y, step_x);
        add_strips(*plan, 0, dst.x.count, plan->strips);
        if (runs_bytes_in_integers) plan_bytes(*plan);
    }
    plan_ = std::move(plan);
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
    // The window of a run and its blocks of rows, of one strip.
    const double outputs = std::min(rows_of_block(channels), dst.y.count);
    const double read = std::min<double>(2 * radius_y * y.stretch() + outputs * std::abs(y.step()) + 1, src.y.count);
    const double strip = radial || x_first ? src.x.count : strip_columns(read, channels, 2 * radius_x * x.stretch());
    const double columns = std::min<double>(strip, src.x.count);
    const double written = std::min<double>(columns / std::abs(x.step()) + 1, dst.x.count);
    const double window = 1.25 * read * (x_first ? written : columns);
    const double blocks = rows_of_block(channels) * (columns + written);
    const double runs = std::clamp(std::ceil(double(dst.y.count) / smallest_run), 1.0, double(parallel.count()));
    return banks + static_cast<std::uint64_t>(runs * (window + blocks) * channels * sizeof(float));
}

const std::string& Resizer::kernel_x() const { return plan_->kernel_x; }
const std::string& Resizer::kernel_y() const { return plan_->kernel_y; }

IndexRange Resizer::rows_needed(int first, int last) const {
    if (first < 0 || first >= last || last > plan_->dst.y.count)
        fail("Resizer::rows_needed: rows ", first, " to ", last, " of ", plan_->dst.y.count, "; pass a part of them");
    return stored_indices(plan_->rows_read(first, last), plan_->src.y.count, plan_->edge_y());
}

bool Resizer::run(const SourceRows& source, const TargetRows& target, Parallel parallel) const {
    const ViewShape from = shape_of(source.samples), to = shape_of(target.samples);
    const int out_channels = plan_->channels - (target.background.empty() ? 0 : 1);
    if (from.width != plan_->src.x.count || to.width != plan_->dst.x.count || from.channels != plan_->channels ||
        to.channels != out_channels)
        fail("Resizer::run: source ", from.width, " wide with ", from.channels, " channels, target ", to.width,
             " with ", to.channels, "; need ", plan_->src.x.count, " with ", plan_->channels, " and ",
             plan_->dst.x.count, " with ", out_channels);
    check_encoding("Resizer::run", source.encoding, from.channels);
    check_encoding("Resizer::run", target.encoding, to.channels);
    check_apart("Resizer::run", source.samples, target.samples);
    if (!target.background.empty() &&
        (source.encoding.alpha < 0 || target.background.size() != static_cast<std::size_t>(out_channels)))
        fail("Resizer::run: a background of ", target.background.size(), " channels; it needs an alpha channel and ",
             out_channels, " values");
    if (to.height == 0) return false;
    const IndexRange needed = rows_needed(target.first_row, target.first_row + to.height);
    if (needed.begin < source.first_row || needed.end > source.first_row + from.height)
        fail("Resizer::run: source rows ", source.first_row, " to ", source.first_row + from.height, "; rows ",
             needed.begin, " to ", needed.end, " are needed");
    const bool are_codes = std::holds_alternative<View<const std::uint8_t>>(source.samples) &&
                           std::holds_alternative<View<std::uint8_t>>(target.samples);
    const bool in_integers = plan_->bytes && are_codes && plan_->is_plain(source.encoding, target);
    std::atomic<bool> lost = false;
    const int share = (to.height + parallel.count() - 1) / parallel.count();
    parallel_for(to.height, std::max(share, smallest_run), parallel, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        const int first = target.first_row + static_cast<int>(begin), last = target.first_row + static_cast<int>(end);
        if (in_integers ? resize_codes(*plan_, source, target, first, last)
                        : resize_floats(*plan_, plan_->strips, source, target, first, last))
            lost = true;
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
