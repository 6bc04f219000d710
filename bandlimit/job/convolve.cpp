#include "bandlimit/job/convolve.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "bandlimit/filter/bokeh.h"
#include "bandlimit/kernel/low_rank.h"

namespace bandlimit::job {
namespace {

/// The nearest sum of `rank` products, or the weights as they are for 0.
ConvolutionWeights approximated(ConvolutionWeights weights, int rank, const std::string& name) {
    if (rank == 0) return weights;
    const WeightSize size = size_of(weights);
    if (rank > std::min(size.width, size.height))
        throw std::runtime_error(
            fmt::format("rank {}: {} has {} x {} weights, whose rank is at most {}; pass that or less", rank, name,
                        size.width, size.height, std::min(size.width, size.height)));
    constexpr double most = 1 << 22;  // as many as fetches may spread over
    if (size.count() > most)
        throw std::runtime_error(fmt::format("rank {}: {} has {} x {} weights, too many to take apart; leave it out",
                                             rank, name, size.width, size.height));
    return {low_rank(grid_of(weights), rank), weights.first_x, weights.first_y};
}

/// Rows of a band: its first ones do anew what they share with the band before.
int rows_worth_a_band(int taps) { return std::max(64, 8 * taps); }

/// What is said once of weights that have no middle sample.
void note_shift(const Context& context, const ConvolutionWeights& weights) {
    const WeightSize size = size_of(weights);
    const double x = weights.first_x + (size.width - 1) / 2.0, y = weights.first_y + (size.height - 1) / 2.0;
    if (x == 0 && y == 0) return;
    context.say(
        fmt::format("the middle of the {} x {} weights lies {:g}, {:g} pixels from the pixel that they make: the "
                    "picture moves by {:g}, {:g}",
                    size.width, size.height, x, y, -x, -y));
}

/// Divided by their sum, unless that is to be kept.
ConvolutionWeights normalised(ConvolutionWeights weights, bool keeps_sum, const std::string& name) {
    if (keeps_sum) return weights;
    if (cancel(weights))
        throw std::runtime_error(fmt::format(
            "{}: the weights sum to {:.3g} and cannot be divided by that; keep their sum", name, sum_of(weights)));
    return with_unit_sum(std::move(weights));
}

void describe(const Convolution& convolution, const ConvolutionWeights& weights, ConvolveReport& report) {
    report.size = size_of(weights);
    report.chosen = convolution.chosen();
    report.candidates = convolution.candidates();
    // Few products may run directly all the same, where that is cheaper.
    const auto* terms = std::get_if<Terms>(&weights.weights);
    report.rank = terms ? static_cast<int>(terms->size()) : report.chosen.rank;
}

}  // namespace

ConvolveReport convolve(const ConvolveJob& job, const Context& context) {
    return convolve_by([&] { return job.weights; }, job.name, job.files, job.options, 1, "convolving", context);
}

ConvolveReport convolve_by(const std::function<ConvolutionWeights()>& weights_of, const std::string& name,
                           const PictureFiles& files, const WeightOptions& o, double gamma, const std::string& doing,
                           const Context& context) {
    ConvolveReport report;
    report.name = name;
    const auto make = [&](const ImageInfo& in) {
        ConvolutionWeights weights = approximated(weights_of(), o.rank, name);
        if (o.keeps_sum) report.sum = sum_of(weights);
        // What sums to 0 has nothing to renormalize to.
        report.edge = o.edge.value_or(cancel(weights) ? Edge::reflect : Edge::renormalize);
        weights = normalised(std::move(weights), o.keeps_sum, name);
        note_shift(context, weights);
        const Convolution convolution(weights, in.width, in.height,
                                      {o.method, report.edge, report.edge, files.premultiplies(), available_memory()});
        describe(convolution, weights, report);
        RowFilter rows = gamma == 1 ? convolution.rows() : boosted(convolution, gamma, files.premultiplies());
        require_memory(convolution.bytes(in.channels(), context.parallel),
                       fmt::format("{} {} x {} pixels", doing, in.width, in.height));
        return PictureFilter{std::move(rows), doing, {}, rows_worth_a_band(report.size.height)};
    };
    static_cast<PictureReport&>(report) = filter_picture(files, false, context, make);
    return report;
}

}  // namespace bandlimit::job
