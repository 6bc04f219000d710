#include "bandlimit/job/gradients.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/taps_json.h"
#include "bandlimit/job/channels.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pictures.h"

namespace bandlimit::job {
namespace {

constexpr std::string_view taps_prefix = "taps:";

bool is_taps(const GradientJob& job) { return job.derivative.starts_with(taps_prefix); }

void check_result(const DerivativeOperator& derivative, const GradientJob& job) {
    const GradientResult result = job.options.result;
    if (has_result(derivative, result)) return;
    const bool is_laplacian = std::holds_alternative<Laplacian>(derivative);
    throw OptionError("result", fmt::format("{} of {}: {}", name_of(result), job.derivative,
                                            is_laplacian ? "a Laplacian is a number without a direction; choose "
                                                           "magnitude or value, or another operator"
                                                         : "only Laplacians have one; choose dx, dy or magnitude"));
}

DerivativeOperator derivative_of(const GradientJob& job) {
    if (!is_taps(job)) return parse_derivative(job.derivative);
    const std::string path = job.derivative.substr(taps_prefix.size());
    try {
        return gradient_by(taps_of(read_taps(path), path), job.derivative);
    } catch (const Error& e) {
        throw OptionError(e.what());
    }
}

std::vector<std::string> names_of(GradientResult result) {
    if (has_source_units(result)) return {};
    if (result == GradientResult::tensor) return {"xx", "xy", "yy", "strength", "angle", "coherence"};
    return channel_names(channels_of(result, 1));
}

/// The files with a depth that holds what comes out, where that is left open.
PictureFiles files_of(const GradientJob& job) {
    PictureFiles files = job.files;
    const std::vector<Depth> depths = abilities_of(files.out).depths;
    if (!files.depth && std::find(depths.begin(), depths.end(), Depth::f32) != depths.end()) files.depth = Depth::f32;
    return files;
}

void note_lost_signs(const GradientJob& job, const PictureSummary& output, const Context& context) {
    using enum GradientResult;
    const GradientResult r = job.options.result;
    if (is_integer(output.depth) && (r == dx || r == dy || r == value || r == tensor))
        context.say(fmt::format("{} holds no values below 0: they became 0; write .exr, .tif or .pfm to keep them",
                                job.files.out));
}

void note_gain(const DerivativeOperator& derivative, const Context& context) {
    const auto* gradient = std::get_if<Gradient>(&derivative);
    if (!gradient) return;
    const double gain = ramp_gain(*gradient);
    if (!(std::abs(gain - 1) < 1e-6))
        context.say(
            fmt::format("a ramp of slope 1 has the gradient {:.3f} by these taps, which run as they are", gain));
}

bool is_csv(const std::string& path) { return path.ends_with(".csv"); }

std::string text_of(const std::vector<Corner>& corners, bool as_csv) {
    if (as_csv) {
        std::string text = "x,y,strength\n";
        for (const Corner& c : corners) text += fmt::format("{:.4f},{:.4f},{:.6g}\n", c.x, c.y, c.strength);
        return text;
    }
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const Corner& c : corners) all.push_back({{"x", c.x}, {"y", c.y}, {"strength", c.strength}});
    return nlohmann::ordered_json{{"corners", all}}.dump(1) + "\n";
}

/// Of the input, whole, in the values that its space gives.
int write_corners(const GradientJob& job, const Context& context) {
    const Image<float> picture = read_picture(job.files.in, job.files.space, context.parallel);
    CornerOptions options = job.of_corners;
    options.edge = job.options.edge;
    const std::vector<Corner> corners = find_corners(picture.view(), options, context.parallel);
    const std::string text = text_of(corners, is_csv(job.corners));
    AtomicFile file(job.corners);
    file.write(text.data(), text.size());
    file.commit();
    return static_cast<int>(corners.size());
}

}  // namespace

void check(const GradientJob& job) {
    if (job.options.edge == Edge::renormalize)
        throw OptionError("edge",
                          "renormalize: weights of derivatives sum to 0, which nothing can be rescaled to; choose "
                          "clamp, reflect, wrap or zero");
    if (!job.corners.empty() && !is_csv(job.corners) && !job.corners.ends_with(".json"))
        throw OptionError("corners", job.corners + ": is neither a .csv nor a .json; name one of these");
    check_result(is_taps(job) ? DerivativeOperator(Gradient{}) : parse_derivative(job.derivative), job);
}

GradientReport gradients(const GradientJob& job, const Context& context) {
    check(job);
    if (!job.corners.empty()) check_output_path(job.corners);
    const PictureFiles files = files_of(job);
    GradientReport report;
    GradientOptions options = job.options;
    options.premultiply = files.premultiplies();
    const auto make = [&](const ImageInfo& in) {
        report.derivative = derivative_of(job);
        note_gain(report.derivative, context);
        RowFilter rows = gradient_filter(report.derivative, in.width, in.height, options);
        require_memory(rows.bytes(in.channels(), context.parallel),
                       fmt::format("gradients of {} x {} pixels", in.width, in.height));
        const int taps = rows.protocol().rows_read(0, 0, 1).count();
        return PictureFilter{std::move(rows),        "differentiating",        {},
                             std::max(64, 8 * taps), names_of(options.result), !has_source_units(options.result)};
    };
    const bool has_own_channels = !has_source_units(options.result);
    static_cast<PictureReport&>(report) = filter_picture(files, has_own_channels, context, make);
    note_lost_signs(job, report.output, context);
    if (!job.corners.empty()) report.corners = write_corners(job, context);
    return report;
}

}  // namespace bandlimit::job
