#include "bandlimit/resample/resize.h"

#include <algorithm>
#include <cmath>
#include <memory>

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

/// Makes rows of the output: what fits them in integers, the rest in floats. Returns whether a value that is not finite
/// was lost.
bool resize_codes(const ResizePlan& plan, const RowRun& run, IndexRange rows) {
    const auto from = std::get<View<const std::uint8_t>>(run.sources[0].samples);
    const auto to = std::get<View<std::uint8_t>>(run.target.samples);
    bool lost = false;
    for_each_run(plan.bytes->banks.y, rows.begin, rows.end, [&](int first, int last, bool fits) {
        if (fits)
            resize_bytes(*plan.bytes, from, run.sources[0].first_row, to, run.target.first_row, first, last,
                         run.monitor);
        lost |= resize_floats(plan, fits ? plan.strips_past_bytes : plan.strips, run, {first, last});
    });
    return lost;
}

RowWork start(const ResizePlan& plan, const RowRun& run) {
    const bool are_codes = std::holds_alternative<View<const std::uint8_t>>(run.sources[0].samples) &&
                           std::holds_alternative<View<std::uint8_t>>(run.target.samples);
    const bool in_integers = plan.bytes && are_codes && plan.is_plain(run.sources[0].encoding, run.target);
    const RowParts parts(run.rows(), smallest_run, run.parallel.count());
    return {parts.count(), [&plan, &run, parts, in_integers](int i) {
                return in_integers ? resize_codes(plan, run, parts[i])
                                   : resize_floats(plan, plan.strips, run, parts[i]);
            }};
}

RowProtocol protocol_of(std::shared_ptr<const ResizePlan> plan) {
    return {.name = "Resizer",
            .sources = {{plan->src.x.count, plan->src.y.count, plan->edge_y()}},
            .width = plan->dst.x.count,
            .height = plan->dst.y.count,
            .channels = plan->channels,
            .rows_read = [plan](std::size_t, int first, int last) { return plan->rows_read(first, last); },
            .bytes =
                [plan](int channels, const Parallel& parallel) {
                    return double(Resizer::bytes(plan->src, plan->dst, channels, plan->options, parallel));
                },
            .start = [plan](const RowRun& run) { return start(*plan, run); }};
}

std::shared_ptr<const ResizePlan> make_plan(const Grid& src, const Grid& dst, int channels,
                                            const ResizeOptions& options, std::string& kernel_x,
                                            std::string& kernel_y) {
    if (channels < 1) fail("Resizer: channels = ", channels, "; pass 1 or more");
    if (!(options.antiring >= 0 && options.antiring <= 1))
        fail("Resizer: antiring = ", options.antiring, "; pass 0 (off) to 1 (no overshoot)");
    auto plan = std::make_shared<ResizePlan>(ResizePlan{src, dst, channels, options, {}, {}, {}, false, {}, {}, {}});
    const Kernel* kernel = std::get_if<Kernel>(&options.reconstruction);
    if (kernel && is_radial(*kernel)) {
        plan->radial.emplace(*kernel, src.x, dst.x, src.y, dst.y, options.edge, plan->edge_y());
        kernel_x = kernel_y = kernel->name;
        return plan;
    }
    plan->x = bank_of(options.reconstruction, src.x, dst.x, options.edge, kernel_x);
    plan->y = bank_of(options.reconstruction, src.y, dst.y, plan->edge_y(), kernel_y);
    const double step_x = Mapping(src.x, dst.x).step(), step_y = Mapping(src.y, dst.y).step();
    plan->x_first = cost(step_x, step_y) < cost(step_y, step_x);
    add_strips(*plan, 0, dst.x.count, plan->strips);
    if (runs_bytes_in_integers) plan_bytes(*plan);
    return plan;
}

}  // namespace

Kernel auto_kernel(const Axis& src, const Axis& dst) {
    return std::abs(Mapping(src, dst).step()) > 1 ? shrink3() : grow3();
}

Resizer::Resizer(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options)
    : rows_(protocol_of(make_plan(src, dst, channels, options, kernel_x_, kernel_y_))) {}

std::uint64_t Resizer::bytes(const Grid& src, const Grid& dst, int channels, const ResizeOptions& options,
                             const Parallel& parallel) {
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

Image<float> resample(View<const float> src, int width, int height, const ResizeOptions& options,
                      const Parallel& parallel, Layout layout) {
    Image<float> result(width, height, src.channels, layout);
    const Resizer resizer({{src.width}, {src.height}}, {{width}, {height}}, src.channels, options);
    resizer.run({src, 0, {}}, {result.view(), 0, {}, {}}, parallel);
    return result;
}

RunReport resize_srgb(const AnyConstView& src, const AnyView& dst, const ResizeOptions& options,
                      const Parallel& parallel) {
    const ViewShape from = shape_of(src), to = shape_of(dst);
    if (from.channels < 1 || from.channels > 4)
        fail("resize_srgb: ", from.channels, " channels; pass 1 to 4: grey or RGB, and alpha");
    const Encoding encoding{Transfer::srgb, from.channels % 2 == 0 ? from.channels - 1 : -1, false};
    const Resizer resizer({{from.width}, {from.height}}, {{to.width}, {to.height}}, from.channels, options);
    return resizer.run({src, 0, encoding}, {dst, 0, encoding, {}}, parallel);
}

}  // namespace bandlimit
